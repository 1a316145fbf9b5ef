#include <algorithm>
#include <chrono>
#include <iostream>
#include <random>

#include "rigid_fixture.h"

namespace wavetank {
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

/// Boxes and eight-cornered hulls dropped into a box tank.
Case pile(unsigned seed, const ScratchDirectory& scratch) {
  std::cout << "seed " << seed << "\n";
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  Case scene = dry_case({1.2, 1.2, 2}, spacing);
  for (int k = 0; k < 10; ++k) {
    const Vector3d centre(0.3 + 0.3 * (k % 3) + 0.02 * part(random), 0.35 + 0.4 * (k / 3 % 2) + 0.02 * part(random), 0.3 + 0.35 * (k / 3));
    const Vector3d size = Vector3d::Constant(0.12) + 0.12 * Vector3d(part(random), part(random), part(random));
    BodyCase body = free_box("piece" + std::to_string(k), centre, size);
    if (k % 2 == 1) {
      TriangleMesh mesh = box_mesh({-0.5 * size, 0.5 * size}, false, "piece");
      for (Vector3d& vertex : mesh.vertices) vertex *= 0.8 + 0.2 * part(random);
      const Eigen::Quaterniond turn = Eigen::Quaterniond(1, part(random), part(random), part(random)).normalized();
      for (Vector3d& vertex : mesh.vertices) vertex = turn * vertex + centre;
      MeshSource source;
      source.uri = scratch.write(body.name + ".obj", obj_text(mesh));
      body.shape = source;
      body.rigid.collision = CollisionShape::convex_hull;
    }
    body.rigid.velocity = Vector3d(part(random) - 0.5, part(random) - 0.5, 0);
    body.rigid.angular_velocity = 5 * Vector3d(part(random), part(random), part(random));
    body.rigid.restitution = 0.2;
    scene.bodies.push_back(body);
  }
  return scene;
}

class Pile : public ::testing::Test {
 protected:
  const ScratchDirectory scratch;
  const Logged logged;
};

TEST_F(Pile, StaysInTheTankAndComesToRest) {
  Trial run(pile(7, scratch), 2e-4);
  int contacts_seen = 0;
  std::chrono::duration<double> spent{0};
  run.until(1.5, [&] {
    for (std::size_t o = 1; o < run.world.count(); ++o) {
      const Vector3d place = run.world.state(o).position;
      ASSERT_TRUE(place.allFinite() && (place.array() > 0.03).all() && place.x() < 1.17 && place.y() < 1.17) << o << " at " << run.time;
      contacts_seen += run.world.state(o).acceleration.norm() < 1;
    }
  });
  const double energy = run.world.kinetic_energy();
  const auto begin = std::chrono::steady_clock::now();
  run.steps(1000);
  spent = std::chrono::steady_clock::now() - begin;
  std::cout << "10 bodies in a heap: " << 1e3 * spent.count() << " µs a step\n";
  EXPECT_GT(contacts_seen, 0);
  double mass = 0;
  for (std::size_t o = 1; o < run.world.count(); ++o) mass += run.world.properties(o).mass;
  EXPECT_LT(energy, 0.5 * mass * 0.05 * 0.05) << "after 1.5 s the heap still moves";
  // No corner is deeper in a wall than a tenth of the spacing.
  for (std::size_t o = 1; o < run.world.count(); ++o)
    for (const Vector3d& vertex : run.layout.meshes[o].vertices) {
      const Vector3d place = run.world.state(o).moved(vertex, run.world.reference(o));
      EXPECT_GT(std::min({place.x(), place.y(), place.z(), 1.2 - place.x(), 1.2 - place.y()}), -0.1 * spacing) << o;
    }
}

TEST_F(Pile, GoesOnFromSavedBytesBitForBit) {
  const Case scene = pile(11, scratch);
  Trial whole(scene, 1e-3);
  whole.steps(150);
  const std::vector<char> saved = whole.world.save();
  whole.steps(450);
  Trial rest(scene, 1e-3);
  rest.world.restore(saved);
  rest.taken = 150;
  rest.time = 150 * 1e-3;
  rest.steps(450);
  const std::vector<char> expected = whole.world.save(), found = rest.world.save();
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(std::memcmp(found.data(), expected.data(), expected.size()), 0);
  EXPECT_LT(whole.world.state(1).position.z(), 0.25) << "nothing has reached the floor, so that the test says little";
}

class MeshTank : public ::testing::Test {
 protected:
  /// An open box whose floor is cut into many uneven triangles, not quite flat ones if `bumps` is given.
  MeshSource tank(const Vector3d& size, int cells, double bumps) const {
    TriangleMesh mesh = box_mesh({Vector3d::Zero(), size}, true, "tank");
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(),
                                        [&](const Vector3i& t) {
                                          return std::all_of(t.data(), t.data() + 3, [&](int v) { return mesh.vertices[v].z() == 0; });
                                        }),
                         mesh.triangles.end());
    TriangleMesh walls;  // from the floor's edge points up, so that floor and walls share them
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-0.3, 0.3);
    TriangleMesh result;
    for (int j = 0; j <= cells; ++j)
      for (int i = 0; i <= cells; ++i) {
        const bool inner = i > 0 && j > 0 && i < cells && j < cells;
        const Vector3d shift = inner ? Vector3d(part(random), part(random), 0) : Vector3d(Vector3d::Zero());
        result.vertices.emplace_back((i + shift.x()) / cells * size.x(), (j + shift.y()) / cells * size.y(), inner ? bumps * part(random) : 0.0);
      }
    const auto at = [&](int i, int j) { return i + j * (cells + 1); };
    for (int j = 0; j < cells; ++j)
      for (int i = 0; i < cells; ++i) {
        result.triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        result.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
    const auto wall = [&](int from, int to) {
      const int base = static_cast<int>(result.vertices.size());
      for (const int v : {from, to}) result.vertices.push_back(result.vertices[v] + Vector3d(0, 0, size.z()));
      result.triangles.emplace_back(from, to, base + 1);
      result.triangles.emplace_back(from, base + 1, base);
    };
    for (int k = 0; k < cells; ++k) {
      wall(at(k, 0), at(k + 1, 0));
      wall(at(k + 1, cells), at(k, cells));
      wall(at(0, k + 1), at(0, k));
      wall(at(cells, k), at(cells, k + 1));
    }
    MeshSource source;
    source.uri = scratch.write("tank.obj", obj_text(result));
    return source;
  }
  const ScratchDirectory scratch;
};

TEST_F(MeshTank, ABoxSlidesOverItsTrianglesWithoutCatching) {
  const double tilt = 0.5, friction = 0.3;
  Case scene = on_floor(tilt, friction);
  scene.tank.shape = tank({8, 2, 2}, 24, 0);
  Trial run(scene, 2e-4);
  run.until(1);
  const double speed = gravity * (std::sin(tilt) - friction * std::cos(tilt));
  EXPECT_NEAR(run.world.state(1).velocity.x(), speed, 1e-4 * speed);
  EXPECT_LT(std::abs(run.world.state(1).velocity.z()) + run.world.state(1).angular_velocity.norm(), 1e-4);
  EXPECT_NEAR(run.world.state(1).position.z(), 0.1, 0.02 * spacing);
}

TEST_F(MeshTank, ABoxOnABumpyFloorStaysOnIt) {
  Case scene = on_floor(0.3, 0.05);
  scene.tank.shape = tank({8, 2, 2}, 24, 0.01);
  scene.bodies[0] = free_box("brick", {2, 1, 0.15}, {0.4, 0.3, 0.2});
  scene.bodies[0].rigid.friction = 0.05;
  Trial run(scene, 2e-4);
  double lowest = 1, highest = 0;
  run.until(1, [&] {
    lowest = std::min(lowest, run.world.state(1).position.z());
    highest = std::max(highest, run.world.state(1).position.z());
  });
  // On a flat floor it would go 1.2 m; up and down 3 mm of bumps costs little.
  EXPECT_NEAR(run.world.state(1).position.x(), 2 + 0.5 * gravity * (std::sin(0.3) - 0.05 * std::cos(0.3)), 0.1);
  EXPECT_GT(lowest, 0.1 - 0.003 - 0.1 * spacing);
  EXPECT_LT(highest, 0.16);
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
  run.until(1.2, [&] { farthest = std::max(farthest, (run.world.state(2).position - run.world.state(1).position - Vector3d(0, 0, 0.2)).norm()); });
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
  run.until(1);
  EXPECT_GT(run.world.state(0).velocity.x(), 0.1) << "the box has not hit the tank";
  run.until(5);
  const Vector3d momentum = mass * run.world.state(1).velocity + 50 * run.world.state(0).velocity;
  EXPECT_LT((momentum - mass * Vector3d(2, 0.3, -0.4)).norm(), 1e-9);
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
  EXPECT_LT(tipping.world.state(3).position.z(), 0.35);
  EXPECT_GT(tipping.world.state(3).position.z(), 0);
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

class Notch : public ::testing::Test {
 protected:
  /// An L of legs 0.8 m long and 0.3 m thick, its hollow upwards, at the place of a body.
  BodyCase angle() const {
    const std::vector<Vector3d> corners{{0.3, 0, 0.3}, {0.3, 0, 0.8}, {0, 0, 0.8}, {0, 0, 0}, {0.8, 0, 0}, {0.8, 0, 0.3}};
    BodyCase body;
    body.name = "angle";
    MeshSource source;
    source.uri = scratch.write("angle.obj", obj_text(prism_mesh(corners, -0.3, 0.3)));
    source.translation = {1, 1, 0};
    body.shape = source;
    body.motion = Motion::free;
    body.rigid.density = 500;
    return body;
  }
  void drop(int dimensions) const {
    Case scene = dimensions == 2 ? dry_case({3, 0, 2}, spacing) : dry_case({3, 2, 2}, spacing);
    BodyCase body = angle();
    if (dimensions == 2) std::get<MeshSource>(body.shape).translation.y() = 0;
    const Vector3d peg(1.55, dimensions == 2 ? 0.0 : 1.0, 0.6);
    scene.bodies = {body, free_box("peg", peg, {0.3, dimensions == 2 ? 0.0 : 0.3, 0.3})};
    Trial run(scene, 2e-4);
    run.until(0.6);
    // The peg falls into the hollow and lies on the lower leg, not on the hull over both.
    EXPECT_NEAR(run.world.state(2).position.z(), 0.45, 0.1 * spacing);
    EXPECT_NEAR(run.world.state(1).position.z(), run.world.reference(1).z(), 0.1 * spacing);
  }
  const ScratchDirectory scratch;
};

TEST_F(Notch, OfADecompositionIsOpen) {
  const Logged logged;
  drop(3);
  ASSERT_EQ(logged.lines.size(), 1u);
  EXPECT_NE(logged.lines[0].find("body 'angle' is"), std::string::npos) << logged.lines[0];
  EXPECT_NE(logged.lines[0].find("convex parts"), std::string::npos) << logged.lines[0];
  std::cout << logged.lines[0] << "\n";
}

TEST_F(Notch, OfASectionIsOpen) {
  const Logged logged;
  drop(2);
  EXPECT_TRUE(logged.lines.empty()) << "a section falls into convex parts exactly: " << logged.lines[0];
}

TEST_F(Notch, OfAConvexHullIsFilledAndItSaysSo) {
  const Logged logged;
  Case scene = dry_case({3, 2, 2}, spacing);
  scene.bodies = {angle()};
  scene.bodies[0].rigid.collision = CollisionShape::convex_hull;
  const Trial run(scene, 1e-3);
  ASSERT_EQ(logged.lines.size(), 1u);
  // The L has 0.39 m² of section, the triangle between its tips 0.125 m².
  EXPECT_NE(logged.lines[0].find("32.05"), std::string::npos) << logged.lines[0];
}

TEST_F(Notch, OfListedPartsIsOpen) {
  const Logged logged;
  Case scene = dry_case({3, 2, 2}, spacing);
  scene.bodies = {angle(), free_box("peg", {1.55, 1, 0.6}, {0.3, 0.3, 0.3})};
  scene.bodies[0].rigid.collision = CollisionShape::parts;
  for (const Box& box : {Box{{0, -0.3, 0}, {0.8, 0.3, 0.3}}, Box{{0, -0.3, 0.3}, {0.3, 0.3, 0.8}}}) {
    MeshSource part;
    part.uri = scratch.write("part" + std::to_string(scene.bodies[0].rigid.collision_parts.size()) + ".obj", obj_text(box_mesh(box, false, "part")));
    part.translation = {1, 1, 0};
    scene.bodies[0].rigid.collision_parts.push_back(part);
  }
  Trial run(scene, 2e-4);
  run.until(0.6);
  EXPECT_NEAR(run.world.state(2).position.z(), 0.45, 0.1 * spacing);
  ASSERT_EQ(logged.lines.size(), 1u);
  EXPECT_NE(logged.lines[0].find("2 convex parts in contacts, as listed: they lack 0 % of its volume and hold 0 %"), std::string::npos)
      << logged.lines[0];
}

}  // namespace
}  // namespace wavetank
