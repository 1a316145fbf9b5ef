// Particles shot at walls, into corners and onto an obstacle's edges, without gravity: none may end up behind a wall.
#include <random>

#include "sph_fixture.h"

namespace wavetank::guard_test {
namespace {

constexpr double sound_speed = 10;
constexpr double shot_speed = 0.2 * sound_speed;
constexpr double spacing = 0.05;

struct Outcome {
  int guard_hits;
  double greatest_speed;  ///< m/s
};

struct Shot {
  Vector3d from;
  Vector3d at;
};

Case weightless(const Vector3d& size, const Box& obstacle, WallElements elements) {
  Case scene = box_case(size, size.z(), spacing);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(4 * spacing, size.y() == 0 ? 0 : 4 * spacing, 4 * spacing)}};
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = sound_speed;
  scene.numerics.walls.elements = elements;
  std::get<BoxTank>(scene.tank.shape).closed = true;
  scene.bodies.push_back({"obstacle", obstacle, Motion::fixed});
  return scene;
}

/// How far a point is outside the tank or inside the obstacle; at most 0 in the fluid.
double behind(const Vector3d& point, const Vector3d& size, const Box& obstacle) {
  const bool flat = size.y() == 0;
  double depth = -1, in_obstacle = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (flat && axis == 1) continue;
    depth = std::max({depth, -point[axis], point[axis] - size[axis]});
    in_obstacle = std::min({in_obstacle, point[axis] - obstacle.min[axis], obstacle.max[axis] - point[axis]});
  }
  return std::max(depth, in_obstacle);
}

/// Runs all shots at once, one particle each; none may ever be behind a wall after a step.
Outcome shoot(const Case& scene, const std::vector<Shot>& shots, int steps) {
  Layout layout = lay_out(scene);
  layout.particles.clear();
  for (const Shot& shot : shots) layout.particles.push_back(shot.from);
  layout.volumes.assign(shots.size(), std::pow(spacing, scene.dimensions));
  layout.levels.assign(shots.size(), 0);
  Tank tank(scene, layout);
  tank.solver->start();
  StateBytes<float> state(*tank.solver);
  for (std::size_t i = 0; i < shots.size(); ++i) {
    const Shot& shot = shots[i];
    const Vector3d velocity = shot_speed * (shot.at - shot.from).normalized();
    for (int axis = 0; axis < 3; ++axis) state.set(velocities[axis], i, velocity[axis]);
  }
  tank.solver->restore(state.bytes());

  const Vector3d size = std::get<BoxTank>(scene.tank.shape).size;
  const Box obstacle = std::get<Box>(scene.bodies[0].shape);
  double greatest = -1, fastest = 0;
  int hits = 0;
  for (int step = 0; step < steps; ++step) {
    const StepReport report = tank.solver->advance();
    EXPECT_EQ(report.offender, -1) << "step " << step << ", particle " << report.offender_id << " at "
                                   << report.offender_position.transpose();
    if (report.offender >= 0) break;
    hits += report.guard_hits;
    fastest = std::max(fastest, report.greatest_speed);
    const FluidState fluid = tank.solver->download();
    for (std::size_t i = 0; i < fluid.id.size(); ++i) {
      const double depth = behind(fluid.position[i], size, obstacle);
      if (depth <= greatest) continue;
      greatest = depth;
      EXPECT_LT(depth, 1e-3 * spacing) << "step " << step << ": particle " << fluid.id[i] << ", shot at "
                                       << shots[fluid.id[i]].at.transpose() << ", is at " << fluid.position[i].transpose();
    }
  }
  std::printf("%zu shots at %.1f m/s in %d-D: %d guard hits, greatest speed %.2f m/s, deepest behind a wall %.1e spacings\n", shots.size(),
              shot_speed, scene.dimensions, hits, fastest, std::max(greatest, 0.0) / spacing);
  return {hits, fastest};
}

class Guard : public ::testing::TestWithParam<WallElements> {};

std::string name_of(const ::testing::TestParamInfo<WallElements>& info) {
  return info.param == WallElements::facet ? "Facet" : "Numerical";
}

INSTANTIATE_TEST_SUITE_P(Elements, Guard, ::testing::Values(WallElements::numerical, WallElements::facet), name_of);

TEST_P(Guard, LoneParticlesStayInFrontOfWallsIn2D) {
  const Vector3d size(2, 0, 2);
  const Box obstacle{Vector3d(0.8, 0, 0.8), Vector3d(1.2, 0, 1.2)};
  std::vector<Shot> shots;
  for (const double z : {0.9, 1.3}) shots.push_back({Vector3d(0.3, 0, z), Vector3d(0, 0, z - 0.1)});  // at a wall
  for (const double x : {0.0, 2.0})
    for (const double z : {0.0, 2.0}) shots.push_back({Vector3d(1 + 0.6 * (x - 1), 0, 1 + 0.6 * (z - 1)), Vector3d(x, 0, z)});  // corners
  for (const double x : {0.8, 1.2})
    for (const double z : {0.8, 1.2}) {  // the obstacle's edges, each from another side
      const double turn = 0.25 * static_cast<double>(shots.size()) - 2.0;
      const Vector3d edge(x, 0, z), out((x - 1), 0, (z - 1));
      const Vector3d from(out.x() * std::cos(turn) - out.z() * std::sin(turn), 0, out.x() * std::sin(turn) + out.z() * std::cos(turn));
      shots.push_back({edge + from, edge});
    }
  // for so long that none meets another: the walls give no energy
  EXPECT_LT(shoot(weightless(size, obstacle, GetParam()), shots, 90).greatest_speed, 1.02 * shot_speed);
}

TEST_P(Guard, LoneParticlesStayInFrontOfWallsIn3D) {
  const Vector3d size(1.2, 1.2, 1.2);
  const Box obstacle{Vector3d(0.45, 0.45, 0.45), Vector3d(0.75, 0.75, 0.75)};
  const Vector3d middle = 0.5 * size;
  std::vector<Shot> shots;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d towards((corner & 1) * 2 - 1, (corner & 2) - 1, (corner & 4) / 2 - 1);
    shots.push_back({middle + 0.45 * towards, middle + 0.6 * towards});                             // the tank's corners
    shots.push_back({middle + 0.36 * towards + Vector3d(0.02, 0, 0.01), middle + 0.15 * towards});  // the obstacle's
  }
  for (const double s : {-1.0, 1.0})
    for (const double t : {-1.0, 1.0}) {
      shots.push_back({middle + Vector3d(0.33 * s, 0.03, 0.33 * t), middle + Vector3d(0.15 * s, 0, 0.15 * t)});  // its edges
      shots.push_back({middle + Vector3d(0.04, 0.31 * s, 0.35 * t), middle + Vector3d(0, 0.15 * s, 0.15 * t)});
      shots.push_back({middle + Vector3d(0.5 * s, 0.1 * t, 0.5 * t), middle + Vector3d(0.6 * s, 0, 0.6 * t)});  // the tank's edges
    }
  shoot(weightless(size, obstacle, GetParam()), shots, 250);
}

TEST_P(Guard, ABlockOfFluidStaysInFrontOfWalls) {
  const Vector3d size(1.2, 0, 1.2);
  const Box obstacle{Vector3d(0.6, 0, 0.0), Vector3d(0.8, 0, 0.4)};
  std::vector<Shot> shots;
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < 6; ++k) {
      const Vector3d at_corner(0.075 + spacing * i, 0, 0.075 + spacing * k), at_edge(0.45 - spacing * i, 0, 0.55 + spacing * k);
      shots.push_back({at_corner, at_corner - Vector3d(1, 0, 1)});
      shots.push_back({at_edge, at_edge + Vector3d(1, 0, -1)});
    }
  EXPECT_GT(shoot(weightless(size, obstacle, GetParam()), shots, 300).guard_hits, 0) << "the guard had nothing to do: the shots missed";
}

TEST_P(Guard, ParticlesStayInFrontOfTheFloorBesideABoxOffItsGrid) {
  const Vector3d size(1, 1, 0.8);
  const Box box{Vector3d(0.312, 0.287, 0), Vector3d(0.668, 0.701, 0.2)};
  std::vector<Shot> shots;
  // so near the strips of floor beside the box, whose elements are cut, that pressure has no time to stop them
  for (const double along : {0.02, 0.26, 0.5, 0.74, 0.98}) {
    const double x = box.min.x() + along * (box.max.x() - box.min.x()), y = box.min.y() + along * (box.max.y() - box.min.y());
    for (const double away : {0.004, 0.013, 0.027}) {
      for (const Vector3d& place : {Vector3d(x, box.min.y() - away, 0), Vector3d(x, box.max.y() + away, 0),
                                    Vector3d(box.min.x() - away, y, 0), Vector3d(box.max.x() + away, y, 0)})
        shots.push_back({place + Vector3d(0, 0, 0.004), place});
    }
  }
  // the corners of the box's foot
  for (const double cx : {box.min.x(), box.max.x()})
    for (const double cy : {box.min.y(), box.max.y()}) {
      const Vector3d place(cx + (cx < 0.5 ? -0.006 : 0.006), cy + (cy < 0.5 ? -0.006 : 0.006), 0);
      shots.push_back({place + Vector3d(0, 0, 0.004), place});
    }
  EXPECT_GT(shoot(weightless(size, box, GetParam()), shots, 40).guard_hits, 0);
}

/// Lone particles thrown upwards and outwards from near the sides of an open tank; the number of steps until the watchdog speaks, or all.
int throw_over_the_rim(bool splash_guard, double width, int steps, const Top& top = {}) {
  const double height = 0.5;
  // between a tank that is open above and one whose top is another side
  const auto turned = [&](Vector3d way) {
    std::swap(way.z(), way[top.axis]);
    return Vector3d(way.cwiseProduct(Vector3d::Ones() - (1 - top.way) * Vector3d::Unit(top.axis)));
  };
  const auto place_in_tank = [&](const Vector3d& upright) {
    return Vector3d(turned(upright) + (top.way < 0 ? height : 0) * Vector3d::Unit(top.axis));
  };
  const auto upright = [&](Vector3d place) {
    if (top.way < 0) place[top.axis] = height - place[top.axis];
    std::swap(place.z(), place[top.axis]);
    return place;
  };
  Vector3d size(1, width, height), filled(1, width, 0.1);
  std::swap(size.z(), size[top.axis]);
  std::swap(filled.z(), filled[top.axis]);
  Case scene = box_case(size, 0.1, spacing);
  scene.gravity = turned(scene.gravity);
  Box water{Vector3d::Zero(), filled};
  if (top.way < 0) water.min[top.axis] = height - 0.1, water.max[top.axis] = height;
  scene.fluid.fill = {water};
  scene.fluid.sound_speed = sound_speed;
  scene.tank.splash_guard = splash_guard;
  std::vector<Vector3d> from, velocity;
  for (const double side : {-1.0, 1.0}) {
    from.push_back(Vector3d(0.5 + 0.4 * side, 0.5 * width, 0.4));
    velocity.push_back(Vector3d(side, 0, 3));
    if (width == 0) continue;
    from.push_back(Vector3d(0.5 + 0.2 * side, width * (0.5 + 0.4 * side), 0.4));
    velocity.push_back(Vector3d(0.1 * side, side, 3));
    from.push_back(Vector3d(0.5 - 0.4 * side, width * (0.5 + 0.4 * side), 0.4));  // at a corner
    velocity.push_back(Vector3d(-side, side, 3));
  }
  for (Vector3d& place : from) place = place_in_tank(place);
  for (Vector3d& way : velocity) way = turned(way);
  Layout layout = lay_out(scene);
  layout.particles = from;
  layout.volumes.assign(from.size(), std::pow(spacing, scene.dimensions));
  layout.levels.assign(from.size(), top.way > 0 ? 0.1 : 0.1 - height);
  Tank tank(scene, layout);
  tank.solver->start();
  StateBytes<float> state(*tank.solver);
  for (std::size_t i = 0; i < from.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) state.set(velocities[axis], i, velocity[i][axis]);
  tank.solver->restore(state.bytes());
  double highest = 0, time = 0;
  for (int step = 0; step < steps; ++step) {
    const StepReport report = tank.solver->advance();
    if (report.offender >= 0) return step;
    time += report.time_step;
    for (const Vector3d& position : tank.solver->download().position) {
      const Vector3d place = upright(position);
      highest = std::max(highest, place.z());
      const double outside = std::max({-place.x(), place.x() - 1, -place.y(), place.y() - width});
      if (splash_guard) EXPECT_LT(outside, 1e-5) << "after " << time << " s at " << place.transpose();
    }
  }
  EXPECT_GT(highest, 0.7) << "none came above the rim";
  EXPECT_GT(time, 0.7) << "none came down again";
  return steps;
}

TEST(SplashGuard, KeepsSprayOverTheTank) {
  EXPECT_EQ(throw_over_the_rim(true, 0.6, 240), 240);
  EXPECT_EQ(throw_over_the_rim(true, 0, 240), 240);
}

TEST(SplashGuard, KeepsSprayOverATankWhoseTopIsAnotherSide) {
  for (const Top& top : {Top{1, 1}, Top{0, -1}, Top{2, -1}}) EXPECT_EQ(throw_over_the_rim(true, 0.6, 240, top), 240) << top.axis;
  EXPECT_EQ(throw_over_the_rim(true, 0, 240, Top{0, 1}), 240);
}

// A tank that does not fill its bounding box: what comes down outside its walls would be lost.
TEST(SplashGuard, KeepsSprayOverARoundTank) {
  for (const WallElements elements : {WallElements::numerical, WallElements::facet}) {
    Case scene = box_case(Vector3d(1, 1, 1), 0.1, spacing);
    scene.fluid.sound_speed = sound_speed;
    scene.tank.shape = MeshSource{std::string(WAVETANK_SOURCE_DIRECTORY) + "/meshes/cylinder_tank.stl"};
    scene.fluid.fill = {FloodFill{Vector3d(0, 0, 0.05), 0.1}};
    scene.numerics.walls.elements = elements;
    Layout layout = lay_out(scene);
    layout.particles.clear();
    const int shots = 24;
    const auto outwards = [](double angle) { return Vector3d(std::cos(angle), std::sin(angle), 0); };
    for (int k = 0; k < shots; ++k) layout.particles.push_back(0.4 * outwards(0.26 * k) + Vector3d(0, 0, 0.9));
    layout.volumes.assign(shots, std::pow(spacing, 3));
    layout.levels.assign(shots, 0.1);
    Tank tank(scene, layout);
    tank.solver->start();
    StateBytes<float> state(*tank.solver);
    for (std::size_t i = 0; i < shots; ++i) {
      const Vector3d velocity = outwards(0.26 * i) + Vector3d(0, 0, 2.5);
      for (int axis = 0; axis < 3; ++axis) state.set(velocities[axis], i, velocity[axis]);
    }
    tank.solver->restore(state.bytes());
    double highest = 0, time = 0;
    while (time < 0.8) {
      const StepReport report = tank.solver->advance();
      ASSERT_TRUE(report.valid()) << "after " << time << " s at " << report.offender_position.transpose();
      time += report.time_step;
      for (const Vector3d& place : tank.solver->download().position) {
        highest = std::max(highest, place.z());
        EXPECT_LT(place.head<2>().norm(), 0.5 + 1e-5) << "after " << time << " s at " << place.transpose();
      }
    }
    EXPECT_GT(highest, 1.1) << "none came above the rim";
  }
}

TEST(SplashGuard, WithoutItSprayIsLostAndReported) {
  EXPECT_LT(throw_over_the_rim(false, 0.6, 240), 240);
  EXPECT_LT(throw_over_the_rim(false, 0, 240), 240);
}

// ---- corners and edges: a step may lead from in front of the one wall's reach to behind both, over neither

class Corners : public ::testing::TestWithParam<WallElements> {
 protected:
  /// Lone particles on their way to `at`, from many distances, so that in some the last step before it begins just out of the guard's
  /// sight.
  static void expect_held(Case scene, const std::vector<Shot>& shots, double speed) {
    scene.numerics.walls.elements = GetParam();
    scene.numerics.negative_pressure = NegativePressure::allowed;
    Layout layout = lay_out(scene);
    layout.particles.clear();
    for (const Shot& shot : shots) layout.particles.push_back(shot.from);
    layout.volumes.assign(shots.size(), std::pow(spacing, scene.dimensions));
    layout.levels.assign(shots.size(), 0);
    Tank tank(scene, layout);
    tank.solver->start();
    const StateBytes<float> still(*tank.solver);
    const Vector3d size = std::get<BoxTank>(scene.tank.shape).size;
    const Box obstacle = std::get<Box>(scene.bodies[0].shape);
    double deepest = 0;
    for (int phase = 0; phase < 24; ++phase) {
      StateBytes<float> state = still;
      for (std::size_t i = 0; i < shots.size(); ++i) {
        const Shot& shot = shots[i];
        const Vector3d way = (shot.at - shot.from).normalized();
        const Vector3d place = shot.at - (0.12 + 0.02 * phase) * spacing * way - tank.discretisation.origin;
        for (int axis = 0; axis < 3; ++axis) {
          if (scene.dimensions == 2 && axis == 1) continue;
          state.set(places[axis], i, place[axis]);
          state.set(velocities[axis], i, speed * way[axis]);
        }
      }
      tank.solver->restore(state.bytes());
      for (int step = 0; step < 5; ++step) {
        const StepReport report = tank.solver->advance();
        ASSERT_TRUE(report.valid()) << "phase " << phase << ", step " << step << ": " << report.outside << " outside, " << report.too_fast
                                    << " too fast; the one shot at " << shots[report.offender_id].at.transpose() << " is at "
                                    << report.offender_position.transpose() << " m with " << report.offender_velocity.transpose() << " m/s";
        const FluidState fluid = tank.solver->download();
        for (std::size_t i = 0; i < fluid.id.size(); ++i) {
          const double depth = behind(fluid.position[i], size, obstacle);
          deepest = std::max(deepest, depth);
          EXPECT_LT(depth, 1e-3 * spacing) << "phase " << phase << ", step " << step << ": shot at " << shots[fluid.id[i]].at.transpose()
                                           << ", it is at " << fluid.position[i].transpose();
        }
      }
    }
    std::printf("deepest behind a wall: %.1e spacings\n", deepest / spacing);
  }
};

std::string kind_name(const ::testing::TestParamInfo<WallElements>& info) {
  return info.param == WallElements::facet ? "Facet" : info.param == WallElements::numerical ? "Numerical" : "SemiAnalytical";
}

INSTANTIATE_TEST_SUITE_P(Elements, Corners, ::testing::Values(WallElements::numerical, WallElements::semi_analytical, WallElements::facet),
                         kind_name);

TEST_P(Corners, HoldIn2D) {
  const Vector3d size(2, 0, 2);
  const Box obstacle{Vector3d(0.8, 0, 0), Vector3d(1.2, 0, 0.6)};  // stands on the floor
  std::vector<Shot> shots;
  for (const double x : {0.0, 2.0})
    for (const double z : {0.0, 2.0}) shots.push_back({Vector3d(x == 0 ? 0.3 : 1.7, 0, z == 0 ? 0.25 : 1.72), Vector3d(x, 0, z)});
  shots.push_back({Vector3d(0.5, 0, 0.3), Vector3d(0.8, 0, 0)});  // the foot of the obstacle
  shots.push_back({Vector3d(1.5, 0, 0.27), Vector3d(1.2, 0, 0)});
  shots.push_back({Vector3d(0.76, 0, 1.0), Vector3d(0.8, 0, 0.6)});  // its edges, from above and from the side
  shots.push_back({Vector3d(1.6, 0, 0.64), Vector3d(1.2, 0, 0.6)});
  for (const double mach : {0.15, 0.3}) expect_held(weightless(size, obstacle, GetParam()), shots, mach * sound_speed);
}

TEST_P(Corners, HoldIn3D) {
  const Vector3d size(1.2, 1.2, 1.2);
  const Box obstacle{Vector3d(0.4, 0.4, 0), Vector3d(0.8, 0.8, 0.5)};
  const Vector3d middle(0.6, 0.6, 0.85);
  std::vector<Shot> shots;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d at(corner & 1 ? 1.2 : 0, corner & 2 ? 1.2 : 0, corner & 4 ? 1.2 : 0);
    shots.push_back({middle + Vector3d(0.01 * corner, 0, 0), at});
  }
  shots.push_back({Vector3d(0.3, 0.6, 0.3), Vector3d(0, 0.5, 0)});  // edges
  shots.push_back({Vector3d(0.2, 0.2, 0.6), Vector3d(0, 0, 0.7)});
  shots.push_back({Vector3d(0.2, 0.6, 0.2), Vector3d(0.4, 0.55, 0)});   // the obstacle's foot
  shots.push_back({Vector3d(0.3, 0.3, 0.8), Vector3d(0.4, 0.4, 0.5)});  // its upper corner and edge
  shots.push_back({Vector3d(0.38, 0.62, 0.9), Vector3d(0.4, 0.6, 0.5)});
  for (const double mach : {0.15, 0.3}) expect_held(weightless(size, obstacle, GetParam()), shots, mach * sound_speed);
}

/// Carries body 0 along.
class Pusher final : public WallMover {
 public:
  explicit Pusher(const Vector3d& velocity) { motions_.owners.resize(2), motions_.owners[1].velocity = velocity; }
  std::vector<int> coupled() const override { return {}; }
  WallMotions at(double time_step, double fraction) override { return moved(fraction * time_step); }
  WallMotions to_end(double time_step, const std::vector<WallWrench>&) override { return moved(0.5 * time_step); }
  const WallMotions& motions() const { return motions_; }

 private:
  const WallMotions& moved(double time) {
    motions_.owners[1].displacement += time * motions_.owners[1].velocity;
    return motions_;
  }
  WallMotions motions_;
};

// The corner between the floor and a box that is pushed along it towards particles that fall into that corner.
TEST_P(Corners, HoldBetweenTheFloorAndABoxThatMoves) {
  const Vector3d size(2, 0, 2);
  Case scene = weightless(size, Box{Vector3d(0.8, 0, 0), Vector3d(1.2, 0, 0.6)}, GetParam());
  scene.bodies[0].motion = Motion::prescribed;
  Layout layout = lay_out(scene);
  layout.particles = {Vector3d(0.5, 0, 0.5)};
  layout.volumes = {spacing * spacing};
  layout.levels = {0};
  Tank tank(scene, layout);
  tank.solver->start();
  const StateBytes<float> still(*tank.solver);
  const double speed = 1.5;
  for (int phase = 0; phase < 24; ++phase) {
    Pusher pusher(Vector3d(-speed, 0, 0));
    tank.solver->set_wall_motions(pusher.motions());
    StateBytes<float> state = still;
    const double away = (0.105 + 0.02 * phase) * spacing;
    state.set("x", 0, 0.8 - away - tank.discretisation.origin.x());
    state.set("z", 0, away - tank.discretisation.origin.z());
    state.set("w", 0, -speed);
    tank.solver->restore(state.bytes());
    for (int step = 0; step < 6; ++step) {
      ASSERT_TRUE(tank.solver->advance(&pusher).valid());
      const Vector3d place = tank.solver->download().position[0];
      EXPECT_GT(place.z(), -1e-3 * spacing) << "phase " << phase << ", step " << step;
      EXPECT_LT(place.x(), 0.8 + pusher.motions().owners[1].displacement.x() + 1e-3 * spacing) << "phase " << phase << ", step " << step;
    }
  }
}

TEST_P(Guard, RandomShotsStayInFrontOfWalls) {
  const unsigned seed = 7;
  std::mt19937 random(seed);
  const Vector3d size(2, 0, 2);
  const Box obstacle{Vector3d(0.8, 0, 0.8), Vector3d(1.2, 0, 1.2)};
  std::uniform_real_distribution<double> across(0.05, 1.95);
  std::vector<Shot> shots;
  while (shots.size() < 100) {
    const Vector3d from(across(random), 0, across(random));
    if (behind(from, size, obstacle) > -spacing) continue;
    shots.push_back({from, Vector3d(across(random), 0, across(random))});
  }
  std::printf("seed %u: ", seed);
  shoot(weightless(size, obstacle, GetParam()), shots, 500);
}

}  // namespace
}  // namespace wavetank::guard_test
