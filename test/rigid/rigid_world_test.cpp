#include "rigid_fixture.h"

namespace wavetank::rigid_world_test {
namespace {

const Vector3d room(4, 4, 4);

/// A brick in the middle of a large tank, without gravity.
Case weightless() {
  Case scene = dry_case(room, 0.25);
  scene.gravity = Vector3d::Zero();
  scene.bodies = {free_box("brick", {2, 2, 2}, {0.4, 0.6, 1.0})};
  return scene;
}

Eigen::Matrix3d inertia_now(const RigidWorld& world, std::size_t owner) {
  const Eigen::Matrix3d turn = world.state(owner).orientation.toRotationMatrix();
  return turn * world.properties(owner).inertia * turn.transpose();
}

TEST(RigidWorld, FallsAsTheParabolaSays) {
  Case scene = dry_case({2, 2, 12}, 0.5);
  scene.bodies = {free_box("brick", {1, 1, 10}, {0.4, 0.6, 1.0})};
  scene.bodies[0].rigid.velocity = {0.1, 0, 1};
  Trial run(scene, 1e-4);
  const double energy = run.world.kinetic_energy() + run.world.potential_energy();
  run.until(1);
  const RigidState state = run.world.state(1);
  // Place and velocity are exact for a constant force but for the rounding of 10⁴ sums.
  EXPECT_LT((state.position - Vector3d(1.1, 1, 10 + 1 - 0.5 * gravity)).norm(), 1e-11);
  EXPECT_LT((state.velocity - Vector3d(0.1, 0, 1 - gravity)).norm(), 1e-11);
  EXPECT_LT((state.acceleration - Vector3d(0, 0, -gravity)).norm(), 1e-9);
  EXPECT_NEAR(run.world.kinetic_energy() + run.world.potential_energy(), energy, 1e-9 * energy);
}

TEST(RigidWorld, TurnsFreelyWithItsAngularMomentumAndEnergy) {
  Case scene = weightless();
  scene.bodies[0].rigid.angular_velocity = {0.3, 6, 0.2};  // about the middle axis, which tumbles
  Trial run(scene, 1e-4);
  const Vector3d momentum = inertia_now(run.world, 1) * run.world.state(1).angular_velocity;
  const double energy = run.world.kinetic_energy();
  double farthest = 0, turned_over = 1;
  run.until(5, [&] {
    farthest = std::max(farthest, std::abs(run.world.kinetic_energy() / energy - 1));
    turned_over = std::min(turned_over, run.world.state(1).orientation.toRotationMatrix()(1, 1));
  });
  EXPECT_LT(turned_over, -0.9) << "the brick has not tumbled, so that the test says little";
  // Momentum is kept by construction, energy to second order: (ω Δt)² = 4e-7.
  EXPECT_LT((inertia_now(run.world, 1) * run.world.state(1).angular_velocity - momentum).norm(), 1e-10 * momentum.norm());
  EXPECT_LT(farthest, 4e-7);
}

TEST(RigidWorld, PrecessesAtTheRateOfASymmetricTop) {
  Case scene = weightless();
  scene.bodies = {free_box("top", {2, 2, 2}, {0.5, 0.5, 0.2})};
  scene.bodies[0].rigid.angular_velocity = {1, 0, 5};
  Trial run(scene, 1e-4);
  const Vector3d momentum = inertia_now(run.world, 1) * run.world.state(1).angular_velocity;
  const double across = run.world.properties(1).inertia(0, 0), period = 2 * pi * across / momentum.norm();
  const Vector3d axis = run.world.state(1).orientation * Vector3d::UnitZ();
  run.time_step = period / 20000;
  run.steps(20000);
  // The axis goes round the momentum once in 2π I/L; what is left is second order in the step.
  EXPECT_LT((run.world.state(1).orientation * Vector3d::UnitZ() - axis).norm(), 1e-6);
  run.steps(10000);
  const Vector3d along = momentum.normalized();
  EXPECT_LT((run.world.state(1).orientation * Vector3d::UnitZ() - (2 * axis.dot(along) * along - axis)).norm(), 1e-6);
}

TEST(RigidWorld, TheFluidsLoadActsAboutTheCentreOfMass) {
  Case scene = weightless();
  Trial run(scene, 1e-3);
  run.load = [&] {
    std::vector<RigidLoad> loads(2);
    loads[1] = {{12, 0, 6}, {0, 2, 0}};
    return loads;
  };
  run.steps(100);
  const MassProperties& body = run.world.properties(1);
  EXPECT_NEAR(body.mass, 500 * 0.24, 1e-9);
  EXPECT_LT((run.world.state(1).velocity - 0.1 / body.mass * Vector3d(12, 0, 6)).norm(), 1e-12);
  EXPECT_LT((run.world.state(1).angular_velocity - Vector3d(0, 0.2 / body.inertia(1, 1), 0)).norm(), 1e-10);
}

TEST(RigidWorld, SaysWhoseLoadIsNotANumberAndWhen) {
  Trial run(weightless(), 1e-3);
  run.steps(5);
  std::vector<RigidLoad> loads(2);
  loads[1].torque.y() = std::nan("");
  const std::string message = error_of([&] { run.world.advance(run.time, run.time_step, loads); });
  EXPECT_NE(message.find("body 'brick'"), std::string::npos) << message;
  EXPECT_NE(message.find("0.005 s"), std::string::npos) << message;
}

TEST(RigidWorld, RefusesWrenchesAndCommandsThatDoNotFit) {
  Case scene = weightless();
  scene.bodies.push_back(free_box("rover", {1, 1, 1}, {0.2, 0.2, 0.2}));
  scene.bodies[1].motion = Motion::commanded;
  scene.bodies[1].rigid.density.reset();
  Trial run(scene, 1e-3);
  OutsideWrench wrench;
  const auto says = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says(error_of([&] { run.world.set_outside_wrench(2, wrench); }), "body 'rover' is not free");
  says(error_of([&] { run.world.set_outside_wrench(0, wrench); }), "the tank is not free");
  says(error_of([&] { run.world.set_outside_wrench(3, wrench); }), "no body 3");
  says(error_of([&] { run.world.command(1, 0, Vector3d::Zero(), Vector3d::Zero()); }), "body 'brick' is not commanded");
  wrench.force.x() = std::numeric_limits<double>::infinity();
  says(error_of([&] { run.world.set_outside_wrench(1, wrench); }), "body 'brick' is not finite");
  for (const double force : {1e308, 1e10, 1.01 * RigidWorld::greatest_acceleration * run.world.properties(1).mass}) {
    wrench.force.x() = force;
    says(error_of([&] { run.world.set_outside_wrench(1, wrench); }), "beyond 1000 m/s²");
  }
  wrench.force.x() = 0.99 * RigidWorld::greatest_acceleration * run.world.properties(1).mass;
  run.world.set_outside_wrench(1, wrench);
  for (const bool turns : {true, false}) {
    wrench = {};
    wrench.turns_with_body = turns;
    wrench.torque.z() = 1e200;
    says(error_of([&] { run.world.set_outside_wrench(1, wrench); }), "beyond 1000 m/s²");
    const MassProperties& body = run.world.properties(1);  // at its radius of gyration
    wrench.torque.z() = 1.01 * RigidWorld::greatest_acceleration * std::sqrt(body.inertia(2, 2) * body.mass);
    says(error_of([&] { run.world.set_outside_wrench(1, wrench); }), "beyond 1000 m/s²");
    wrench.torque.z() *= 0.98;
    run.world.set_outside_wrench(1, wrench);
  }
  says(error_of([&] { run.world.command(2, 0, Vector3d(0, std::nan(""), 0), Vector3d::Zero()); }), "body 'rover' is not finite");
  says(error_of([&] { run.world.restore(std::vector<char>(7)); }), "not of this case's bodies");
  says(error_of([&] { run.world.advance(0, -1e-3, run.none); }), "-0.001 s");
}

TEST(RigidWorld, HoldsAnOutsideWrenchUntilItsTime) {
  Case scene = weightless();
  scene.bodies[0].rigid.angular_velocity = {0, 0, pi};
  Trial run(scene, 1e-3);
  OutsideWrench wrench;
  wrench.force = {60, 0, 0};
  wrench.until = 1;
  run.world.set_outside_wrench(1, wrench);
  run.until(1.5);
  // Turning with the body through half a turn, it pushes by 2/π of its size along y.
  EXPECT_LT((run.world.state(1).velocity - 60 / run.world.properties(1).mass * Vector3d(0, 2 / pi, 0)).norm(), 1e-5);
  wrench.turns_with_body = false;
  wrench.until = 1e300;
  run.world.set_outside_wrench(1, wrench);
  const Vector3d before = run.world.state(1).velocity;
  run.steps(500);
  EXPECT_LT((run.world.state(1).velocity - before - 0.5 * 60 / run.world.properties(1).mass * Vector3d(1, 0, 0)).norm(), 1e-9);
}

TEST(RigidWorld, AppliesTheCasesForces) {
  Case scene = weightless();
  ForceCase push;
  push.force = {0, 0, 120};
  push.point = Vector3d(2.2, 2, 2);
  push.from = 0.25;
  push.to = 0.75;
  ForceCase shake;
  shake.force = {120, 0, 0};
  shake.frequency = 2;
  scene.bodies[0].rigid.forces = {push, shake};
  Trial run(scene, 1e-3);
  run.until(0.125);  // a quarter of a period: ∫ sin = 1/(2π f)
  const double mass = run.world.properties(1).mass;
  EXPECT_NEAR(run.world.state(1).velocity.x(), 120 / mass / (2 * pi * 2), 1e-4 * 120 / mass);
  run.until(1);
  EXPECT_NEAR(run.world.state(1).velocity.z(), 0.5 * 120 / mass, 1e-9);
  EXPECT_LT(run.world.state(1).angular_velocity.y(), 0) << "a push upwards on the side of +x turns against y";
}

TEST(RigidWorld, AMooringSwingsAtItsFrequencyAndFollowsTheTank) {
  Case scene = weightless();
  MooringCase line;
  line.anchor = {2, 2, 0};
  line.attachment = {2, 2, 1.5};
  line.stiffness = 1200;
  line.slack = false;
  scene.bodies[0].rigid.moorings = {line};
  scene.bodies[0].rigid.velocity = {0, 0, 0.1};
  Trial run(scene, 1e-3);
  const double rate = std::sqrt(1200 / run.world.properties(1).mass);
  double greatest = 0;
  run.until(20, [&] { greatest = std::max(greatest, run.world.state(1).position.z() - 2); });
  // The midpoint rule keeps the amplitude, and is late by (ω Δt)²/24 of a period: 2e-6 rad per rad.
  EXPECT_NEAR(greatest, 0.1 / rate, 1e-4 * 0.1 / rate);
  EXPECT_NEAR(run.world.state(1).position.z() - 2, 0.1 / rate * std::sin(rate * 20), 1e-3 * 0.1 / rate);
  scene.tank.motion = Motion::prescribed;
  RampCase ramp{Direction::heave, 0.5, 0, 1};
  scene.tank.rigid.prescribed.ramps = {ramp};
  scene.bodies[0].rigid.moorings[0].damping = 2000;
  Trial carried(scene, 1e-3);
  carried.until(20);
  EXPECT_NEAR(carried.world.state(1).position.z(), 2.5, 1e-3) << "the anchor has not moved with the tank";
}

TEST(RigidWorld, ASlackMooringPullsAndNeverPushes) {
  Case scene = weightless();
  MooringCase line;
  line.anchor = {2, 2, 0};
  line.attachment = {2, 2, 1.5};
  line.stiffness = 1200;
  line.damping = 50;
  line.length = 1.7;
  scene.bodies[0].rigid.moorings = {line};
  scene.bodies[0].rigid.velocity = {0, 0, -0.5};
  Trial run(scene, 1e-3);
  run.until(1);  // it hangs loose all that way down to 1 m
  EXPECT_EQ(run.world.state(1).velocity.z(), -0.5);
  scene.bodies[0].rigid.velocity.z() = 0.5;
  Trial taut(scene, 1e-3);
  double highest = 0, slowest = 1;
  taut.until(2, [&] {
    highest = std::max(highest, taut.world.state(1).position.z());
    slowest = std::min(slowest, taut.world.state(1).velocity.z());
  });
  const double mass = taut.world.properties(1).mass;
  EXPECT_GT(highest, 2.2 + 0.02);
  EXPECT_LT(highest, 2.2 + 0.5 * std::sqrt(mass / 1200)) << "the damper takes some";
  EXPECT_LT(taut.world.state(1).velocity.z(), -0.3) << "it has not been drawn back";
  EXPECT_GE(slowest, -0.5) << "it comes back faster than it went";
  const double loose = taut.world.state(1).velocity.z();
  taut.until(3);
  EXPECT_EQ(taut.world.state(1).velocity.z(), loose);
}

TEST(RigidWorld, AMooringPullsAFreeTankAsHardAsTheBody) {
  Case scene = weightless();
  scene.tank.motion = Motion::free;
  scene.tank.rigid.mass = 300;
  scene.tank.rigid.centre_of_mass = Vector3d(2, 2, 1.5);
  scene.tank.rigid.inertia = {700, 800, 900, 0, 0, 0};
  MooringCase line;
  line.anchor = {0.5, 2, 0};
  line.attachment = {2, 2, 1.5};
  line.stiffness = 2000;
  line.damping = 30;
  line.length = 1;
  scene.bodies[0].rigid.moorings = {line};
  scene.bodies[0].rigid.collision = CollisionShape::none;
  scene.bodies[0].rigid.velocity = {0.1, 0.2, 0.3};
  Trial run(scene, 2e-4);
  const double mass = run.world.properties(1).mass;
  const auto momentum = [&] { return Vector3d(mass * run.world.state(1).velocity + 300 * run.world.state(0).velocity); };
  const auto spin = [&] {
    Vector3d sum = Vector3d::Zero();
    for (const std::size_t o : {0, 1}) {
      const RigidState state = run.world.state(o);
      sum += run.world.properties(o).mass * state.position.cross(state.velocity) + inertia_now(run.world, o) * state.angular_velocity;
    }
    return sum;
  };
  const Vector3d before = momentum(), spin_before = spin();
  double pulled = 0;
  run.until(1, [&] { pulled = std::max(pulled, 300 * run.world.state(0).velocity.norm()); });
  EXPECT_GT(pulled, 50) << "the line has hardly pulled";
  EXPECT_LT((momentum() - before).norm(), 1e-9);
  EXPECT_LT((spin() - spin_before).norm(), 1e-9);
}

TEST(RigidWorld, StiffMooringsAreStableAtAnyStep) {
  Case scene = weightless();
  MooringCase line;
  line.anchor = {2, 2, 0};
  line.attachment = {2, 2, 1.5};
  line.stiffness = 1e12;
  line.damping = 1e9;
  line.slack = false;
  scene.bodies[0].rigid.moorings = {line};
  scene.bodies[0].rigid.velocity = {0, 0, 0.1};
  Trial run(scene, 1e-3);
  run.steps(2000);
  EXPECT_NEAR(run.world.state(1).position.z(), 2, 1e-3);
}

TEST(RigidWorld, StatesHalfwayLeaveTheWorldAlone) {
  Case scene = weightless();
  scene.bodies[0].rigid.velocity = {1, 2, 3};
  scene.bodies[0].rigid.angular_velocity = {0, 0, 2};
  scene.tank.motion = Motion::prescribed;
  scene.tank.rigid.prescribed.harmonics = {HarmonicCase{Direction::surge, 0.1, 1, 0, 0}};
  Trial run(scene, 1e-2);
  run.steps(3);
  const std::vector<char> before = run.world.save();
  const std::vector<RigidState> middle = run.world.at_middle(run.time, 0.02);
  EXPECT_EQ(run.world.save(), before);
  EXPECT_LT((middle[1].position - run.world.state(1).position - 0.01 * Vector3d(1, 2, 3)).norm(), 1e-14);
  EXPECT_LT((middle[1].orientation.toRotationMatrix() -
             Eigen::AngleAxisd(0.02, Vector3d::UnitZ()).toRotationMatrix() * run.world.state(1).orientation.toRotationMatrix())
                .norm(),
            1e-14);
  EXPECT_NEAR(middle[0].position.x(), 0.1 * std::sin(2 * pi * 0.04), 1e-14);
}

// Without a limit a command changes the velocity within one step, and the fluid feels that as an acceleration over the whole of it.
TEST(RigidWorld, HalfwayThroughAJumpOfACommandTheAccelerationIsThatOfTheWholeStep) {
  for (const bool tank : {false, true}) {
    Case scene = weightless();
    scene.bodies.push_back(free_box("post", {3, 1, 1}, {0.2, 0.2, 0.2}));
    scene.bodies[1].motion = Motion::fixed;
    scene.bodies[1].rigid.density.reset();
    RigidCase& driven = tank ? scene.tank.rigid : scene.bodies[0].rigid;
    (tank ? scene.tank.motion : scene.bodies[0].motion) = Motion::commanded;
    driven.density.reset();
    driven.command.greatest_acceleration.reset();
    driven.command.greatest_angular_acceleration = 1000;
    Trial run(scene, 1e-3);
    const std::size_t owner = tank ? 0 : 1;
    run.world.command(owner, 0, {0.3, 0, 0.1}, {0, 0.2, 0});
    const RigidState middle = run.world.at_middle(0, 1e-3)[owner], post = run.world.at_middle(0, 1e-3)[2];
    run.steps(1);
    const RigidState end = run.world.state(owner);
    EXPECT_LT((middle.acceleration - end.velocity / 1e-3).norm(), 1e-9);
    EXPECT_LT((middle.angular_acceleration - end.angular_velocity / 1e-3).norm(), 1e-9);
    const Vector3d arm = post.position - middle.position;
    const Vector3d riding =
        middle.acceleration + middle.angular_acceleration.cross(arm) + middle.angular_velocity.cross(middle.angular_velocity.cross(arm));
    if (tank) EXPECT_LT((post.acceleration - riding).norm(), 1e-9) << "what is fixed to the tank feels another acceleration";
  }
}

TEST(RigidWorld, SeenFromARollingTankVelocitiesAreThePlacesDerivatives) {
  Case scene = dry_case(room, 0.25);
  scene.bodies = {free_box("brick", {2, 2, 3}, {0.4, 0.6, 0.2}), free_box("post", {3, 1, 1}, {0.2, 0.2, 0.2})};
  scene.bodies[0].rigid.angular_velocity = {0.5, -1, 2};
  scene.bodies[1].motion = Motion::fixed;
  scene.bodies[1].rigid.density.reset();
  scene.tank.motion = Motion::prescribed;
  scene.tank.rigid.prescribed.point = Vector3d(2, 2, 0);
  scene.tank.rigid.prescribed.harmonics = {HarmonicCase{Direction::roll, 0.3, 0.7, 0, 0}, HarmonicCase{Direction::sway, 0.2, 0.9, 1, 0}};
  Trial run(scene, 1e-4);
  run.until(0.3);
  std::vector<RigidState> seen, post;
  run.steps(3, [&] {
    seen.push_back(run.world.state_in_tank(1));
    post.push_back(run.world.state(2));
    EXPECT_LT((run.world.state_in_tank(2).position - run.world.reference(2)).norm(), 1e-15) << "what is fixed stays in the tank";
  });
  const auto check = [&](const std::vector<RigidState>& s, const char* what) {
    // Central differences are second order in 1e-4 s; a free body's acceleration is that of the last step, half a step behind.
    EXPECT_LT((s[1].velocity - (s[2].position - s[0].position) / 2e-4).norm(), 1e-5) << what;
    const Eigen::AngleAxisd turn(s[2].orientation * s[0].orientation.conjugate());
    EXPECT_LT((s[1].angular_velocity - turn.angle() * turn.axis() / 2e-4).norm(), 1e-5) << what;
    EXPECT_LT((s[1].acceleration - (s[2].velocity - s[0].velocity) / 2e-4).norm(), 5e-3) << what;
    EXPECT_LT((s[1].angular_acceleration - (s[2].angular_velocity - s[0].angular_velocity) / 2e-4).norm(), 5e-3) << what;
  };
  check(seen, "the brick as the tank sees it");
  check(post, "what is fixed to the tank, in the world");
  EXPECT_GT(seen[1].acceleration.norm(), 1) << "too little happens for a test";
}

TEST(RigidWorld, WithoutMotionNothingIsMade) {
  Case scene = dry_case(room, 0.25);
  scene.bodies = {free_box("post", {3, 1, 1}, {0.2, 0.2, 0.2})};
  scene.bodies[0].motion = Motion::fixed;
  scene.bodies[0].rigid.density.reset();
  Trial run(scene, 1e-3);
  EXPECT_FALSE(run.world.anything_moves());
  EXPECT_FALSE(run.world.moves(1));
  EXPECT_LT((run.world.reference(1) - Vector3d(3, 1, 1)).norm(), 1e-12);
  const std::vector<char> before = run.world.save();
  run.steps(3);
  EXPECT_EQ(run.world.save(), before);
}

TEST(RigidWorld, AFreeTankCarriesWhatIsFixedToIt) {
  Case scene = dry_case(room, 0.25);
  scene.tank.motion = Motion::free;
  scene.tank.rigid.mass = 100;
  scene.tank.rigid.centre_of_mass = Vector3d(2, 2, 1);
  scene.tank.rigid.inertia = {50, 50, 50, 0, 0, 0};
  scene.gravity = Vector3d::Zero();
  scene.bodies = {free_box("post", {3, 2, 1}, {0.2, 0.2, 0.2})};
  scene.bodies[0].motion = Motion::fixed;
  scene.bodies[0].rigid.density.reset();
  Trial run(scene, 1e-3);
  run.load = [] {
    std::vector<RigidLoad> loads(2);
    loads[1].force = {0, 0, 10};
    return loads;
  };
  run.steps(10);
  EXPECT_NEAR(run.world.state(0).velocity.z(), 0.1 / 100, 1e-12);
  EXPECT_NEAR(run.world.state(0).angular_velocity.y(), -0.1 / 50, 1e-9) << "the water on the post, 1 m from the centre, turns the tank";
  EXPECT_NEAR(run.world.state(1).velocity.z(), 0.1 / 100 + 0.1 / 50, 1e-9);
}

}  // namespace
}  // namespace wavetank::rigid_world_test
