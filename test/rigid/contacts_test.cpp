#include <algorithm>
#include <random>

#include "rigid_fixture.h"

namespace wavetank::contacts_test {
namespace {

constexpr double spacing = 0.05;

/// A tank with a floor at z = 0 and one box on it.
Case on_floor(double tilt, double friction) {
  Case scene = dry_case({8, 2, 2}, spacing);
  scene.gravity = gravity * Vector3d(std::sin(tilt), 0, -std::cos(tilt));
  scene.bodies = {free_box("brick", {2, 1, 0.1}, {0.4, 0.3, 0.2})};
  scene.bodies[0].rigid.friction = scene.tank.rigid.friction = friction;
  return scene;
}

TEST(Contacts, FrictionSlowsASlidingBoxByItsCoefficient) {
  const double tilt = 0.5, friction = 0.3;
  Trial run(on_floor(tilt, friction), 2e-4);
  run.until(1);
  const RigidState state = run.world.state(1);
  const double speed = gravity * (std::sin(tilt) - friction * std::cos(tilt));
  // Contacts are solved to 1e-6 of g Δt; the box settles on its faces in the first steps.
  EXPECT_NEAR(state.velocity.x(), speed, 1e-4 * speed);
  EXPECT_NEAR(state.velocity.y(), 0, 1e-6);
  EXPECT_NEAR(state.velocity.z(), 0, 1e-6);
  EXPECT_LT(state.angular_velocity.norm(), 1e-5);
  EXPECT_NEAR(state.position.z(), 0.1, 0.02 * spacing);
  EXPECT_NEAR(state.acceleration.x(), speed, 1e-3 * speed);
}

TEST(Contacts, FrictionHoldsABoxBelowItsAngle) {
  const double friction = 0.6;
  Trial run(on_floor(0.95 * std::atan(friction), friction), 2e-4);
  run.until(1);
  EXPECT_NEAR(run.world.state(1).position.x(), 2, 1e-5);
  EXPECT_LT(run.world.state(1).velocity.norm(), 1e-5);
}

TEST(Contacts, FrictionIsTheProductsRootAndTheSameInEveryDirection) {
  Case scene = on_floor(0, 0.9);
  scene.tank.rigid.friction = 0.1;
  scene.bodies[0] = free_box("brick", {2, 1, 0.1}, {0.3, 0.3, 0.2});
  scene.bodies[0].rigid.friction = 0.9;
  scene.bodies[0].rigid.velocity = 1.5 * Vector3d(std::cos(0.6), std::sin(0.6), 0);
  Trial run(scene, 2e-4);
  run.until(0.25);
  const Vector3d velocity = run.world.state(1).velocity;
  EXPECT_NEAR(velocity.norm(), 1.5 - 0.3 * gravity * 0.25, 1e-3);
  EXPECT_NEAR(std::atan2(velocity.y(), velocity.x()), 0.6, 1e-3);
}

TEST(Contacts, ReboundsToTheSquareOfTheRestitution) {
  Case scene = on_floor(0, 0.5);
  scene.bodies[0] = free_box("brick", {2, 1, 1.1}, {0.4, 0.3, 0.2});
  scene.bodies[0].rigid.restitution = 0.5;
  scene.tank.rigid.restitution = 0.2;  // the greater counts
  for (const double step : {1e-3, 1e-4, 1e-5}) {
    Trial run(scene, step);
    run.until(0.5);
    double top = 0;
    run.until(0.9, [&] { top = std::max(top, run.world.state(1).position.z() - 0.1); });
    // The box turns round up to the way of a step above the floor, v Δt with v = 4.4 m/s, and its speed is known to g Δt.
    EXPECT_NEAR(top, 0.25, 6 * step + 1e-4) << "at steps of " << step << " s";
  }
}

TEST(Contacts, AStackRestsWithoutJitterAndWithoutSinking) {
  Case scene = on_floor(0, 0.5);
  scene.bodies.clear();
  for (int k = 0; k < 5; ++k) scene.bodies.push_back(free_box("brick" + std::to_string(k), {2, 1, 0.1 + 0.2 * k}, {0.4, 0.3, 0.2}));
  Trial run(scene, 2e-4);
  run.until(0.2);
  double greatest = 0;
  run.until(2.2, [&] { greatest = std::max(greatest, run.world.kinetic_energy()); });
  // A body at rest is left with what the solver resolves, about 1e-3 g Δt = 2e-6 m/s in a stack: 12 kg make 2.4e-11 J each.
  EXPECT_LT(greatest, 1e-8);
  for (int k = 0; k < 5; ++k) {
    const RigidState state = run.world.state(1 + k);
    EXPECT_LT((state.position - Vector3d(2, 1, 0.1 + 0.2 * k)).norm(), 0.1 * spacing) << k;
    EXPECT_GT(state.orientation.w(), 1 - 1e-6) << k;
  }
}

TEST(Contacts, APrescribedFloorCarriesABox) {
  Case scene = on_floor(0, 0.5);
  BodyCase lift = free_box("lift", {2, 1, 0.1}, {1, 1, 0.2});
  lift.motion = Motion::prescribed;
  lift.rigid.density.reset();
  lift.rigid.prescribed.ramps = {RampCase{Direction::heave, 0.5, 0, 1}, RampCase{Direction::surge, 0.3, 0, 1}};
  scene.bodies = {lift, free_box("brick", {2, 1, 0.3}, {0.4, 0.3, 0.2})};
  Trial run(scene, 2e-4);
  double farthest = 0;
  run.until(1.2, [&] {
    farthest = std::max(farthest, (run.world.state(2).position - run.world.state(1).position - Vector3d(0, 0, 0.2)).norm());
  });
  EXPECT_NEAR(run.world.state(1).position.z(), 0.6, 1e-12);
  EXPECT_LT(farthest, 0.05 * spacing);
}

TEST(Contacts, ATankThatHeavesAndSwaysCarriesABox) {
  Case scene = on_floor(0, 0.8);
  scene.tank.motion = Motion::prescribed;
  scene.tank.rigid.prescribed.harmonics = {HarmonicCase{Direction::heave, 0.1, 0.8, 0, 0}, HarmonicCase{Direction::sway, 0.1, 0.8, 0, 0},
                                           HarmonicCase{Direction::roll, 0.1, 0.5, 0, 0.5}};
  Trial run(scene, 2e-4);
  run.until(3);
  const RigidState seen = run.world.state_in_tank(1);
  EXPECT_LT((seen.position - Vector3d(2, 1, 0.1)).norm(), 0.1 * spacing);
  EXPECT_LT(seen.velocity.norm(), 1e-2);
}

TEST(Contacts, AFreeTankAndABoxInItKeepTheirMomentum) {
  Case scene = on_floor(0, 0.2);
  scene.gravity = Vector3d::Zero();
  scene.tank.motion = Motion::free;
  scene.tank.rigid.mass = 50;
  scene.tank.rigid.centre_of_mass = Vector3d(4, 1, 1);
  scene.tank.rigid.inertia = {40, 200, 200, 0, 0, 0};
  scene.bodies[0] = free_box("brick", {7, 1, 1}, {0.4, 0.3, 0.2});
  scene.bodies[0].rigid.velocity = {2, 0.3, -0.4};
  scene.bodies[0].rigid.restitution = 1;
  Trial run(scene, 2e-4);
  const double mass = run.world.properties(1).mass;
  const auto spin = [&] {
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t o : {0, 1}) {
      const RigidState state = run.world.state(o);
      const Eigen::Matrix3d turn = state.orientation.toRotationMatrix();
      sum += run.world.properties(o).mass * state.position.cross(state.velocity) +
             turn * run.world.properties(o).inertia * turn.transpose() * state.angular_velocity;
    }
    return sum;
  };
  const Vector3d spin_before = spin();
  run.until(1);
  EXPECT_GT(run.world.state(0).velocity.x(), 0.1) << "the box has not hit the tank";
  run.until(5);
  const Vector3d momentum = mass * run.world.state(1).velocity + 50 * run.world.state(0).velocity;
  EXPECT_LT((momentum - mass * Vector3d(2, 0.3, -0.4)).norm(), 1e-9);
  EXPECT_LT((spin() - spin_before).norm(), 1e-3 * spin_before.norm());
  EXPECT_LT((run.world.state_in_tank(1).position - Vector3d(4, 1, 1)).cwiseAbs().x(), 4);
}

TEST(Contacts, ABoxLiesOnTheEdgesOfWhatIsFixed) {
  // Across a ridge and a post's corner, where only edges touch.
  Case scene = on_floor(0, 0.8);
  BodyCase left = free_box("left", {1.7, 1, 0.2}, {0.1, 0.1, 0.4}), right = free_box("right", {2.3, 1, 0.2}, {0.1, 0.1, 0.4});
  left.motion = right.motion = Motion::fixed;
  left.rigid.density.reset();
  right.rigid.density.reset();
  scene.bodies = {left, right, free_box("plank", {2, 1, 0.43}, {1.0, 0.3, 0.06})};
  Trial run(scene, 2e-4);
  run.until(1.5);
  EXPECT_LT((run.world.state(3).position - Vector3d(2, 1, 0.43)).norm(), 0.05 * spacing);
  // Moved so far that its centre hangs over an edge, it tips and falls.
  scene.bodies[2] = free_box("plank", {2.45, 1, 0.43}, {1.0, 0.3, 0.06});
  Trial tipping(scene, 2e-4);
  tipping.until(1.5);
  const auto corner = [&](double x) { return tipping.world.state(3).moved({x, 1, 0.4}, tipping.world.reference(3)); };
  const Vector3d low = corner(2.95), high = corner(1.95), along = (high - low).normalized();
  EXPECT_NEAR(low.z(), 0, 0.02 * spacing) << "one end lies on the floor";
  EXPECT_GT(high.z(), 0.5);
  const Vector3d edge(2.35, 1, 0.4);
  EXPECT_NEAR((edge - low - along.dot(edge - low) * along).norm(), 0, 0.02 * spacing) << "its lower face leans on the post's edge";
}

TEST(Contacts, IgnoresWhatPassesThroughEverything) {
  Case scene = on_floor(0, 0.5);
  scene.bodies[0].rigid.collision = CollisionShape::none;
  Trial run(scene, 1e-3);
  run.until(0.5);
  EXPECT_NEAR(run.world.state(1).position.z(), 0.1 - 0.5 * gravity * 0.25, 1e-9);
}

TEST(Contacts, InTwoDimensionsEverythingStaysInThePlane) {
  Case scene = dry_case({2, 0, 2}, spacing);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 6; ++k) {
    BodyCase body = free_box("brick" + std::to_string(k), {0.5 + 0.4 * (k % 3), 0, 0.4 + 0.4 * (k / 3)}, {0.25, 0, 0.15});
    body.rigid.velocity = {part(random) - 0.5, 0.3, 0};
    body.rigid.angular_velocity = {1, 8 * (part(random) - 0.5), 2};
    scene.bodies.push_back(body);
  }
  Trial run(scene, 5e-4);
  run.until(2, [&] {
    for (std::size_t o = 1; o < run.world.count(); ++o) {
      const RigidState state = run.world.state(o);
      ASSERT_EQ(state.position.y(), 0);
      ASSERT_EQ(state.velocity.y(), 0);
      ASSERT_EQ(state.orientation.x(), 0);
      ASSERT_EQ(state.orientation.z(), 0);
      ASSERT_EQ(state.angular_velocity.x(), 0);
      ASSERT_EQ(state.angular_velocity.z(), 0);
      ASSERT_GT(state.position.z(), 0.07);
    }
  });
  EXPECT_LT(run.world.kinetic_energy(), 1e-3 * 6 * 500 * 0.25 * 0.15);
  EXPECT_NEAR(run.world.properties(1).mass, 500 * 0.25 * 0.15, 1e-9);
}

}  // namespace
}  // namespace wavetank::contacts_test
