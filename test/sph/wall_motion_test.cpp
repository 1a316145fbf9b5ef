// Walls that move: their acceleration in the pressure that they put on the water, their velocity in the water's compression and drag. One
// step each from rest, so that there are exact values for it.
#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "sph_fixture.h"

namespace wavetank::wall_motion_test {
namespace {

struct Kind {
  const char* name;
  WallElements elements;
};
constexpr Kind every_kind[] = {
    {"numerical", WallElements::numerical}, {"semi_analytical", WallElements::semi_analytical}, {"facet", WallElements::facet}};

std::unique_ptr<Solver> solver_about(const Tank& tank, const std::vector<Vector3d>& centres) {
  return make_solver(test_device(), tank.scene, tank.layout, tank.discretisation, centres);
}

// ---- acceleration

// Of the acceleration. Above the sums' rounding in float32 (1e-4), and above what the walls' acceleration differs by over a tank that turns
// about a centre 1000 m away (0.0007, of which a tenth reaches the water). Acceleration that the walls do not feel makes 0.05 and more.
constexpr double equality = 1e-3;
constexpr double far_away = 1000;  // m

/// Water about a pier. Gravity acts by its own pull and in the walls' pressure only: without diffusion, which knows hydrostatics, and
/// guard.
Case tank_with_pier(int dimensions, WallElements elements) {
  const bool flat = dimensions == 2;
  Case scene = flat ? box_case(Vector3d(0.4, 0, 0.3), 0.2, 0.02) : box_case(Vector3d(0.6, 0.4, 0.5), 0.3, 0.05);
  const Box pier = flat ? Box{Vector3d(0.14, 0, 0), Vector3d(0.26, 0, 0.1)} : Box{Vector3d(0.2, 0.1, 0), Vector3d(0.4, 0.3, 0.2)};
  scene.bodies.push_back({"pier", pier, Motion::fixed});
  scene.fluid.sound_speed = 20;
  scene.fluid.viscosity = 0;  // walls that turn must not drag
  scene.numerics.density_diffusion = DensityDiffusion::none;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.numerics.walls.guard_distance = 0;
  scene.numerics.walls.elements = elements;
  return scene;
}

struct Response {
  std::vector<Vector3d> accelerations;  ///< by particle id, m/s²
  std::vector<WallWrench> wrenches;
};

/// The first step from a state at rest, which was saved with this time step.
Response respond(Solver& solver, const std::vector<char>& state, double step) {
  solver.restore(state);
  Response result;
  result.wrenches = solver.wrenches();
  solver.advance();
  const FluidState fluid = solver.download();
  result.accelerations.resize(fluid.id.size());
  for (std::size_t i = 0; i < fluid.id.size(); ++i) result.accelerations[fluid.id[i]] = fluid.velocity[i] / step;
  return result;
}

/// The greatest difference of the accelerations, beyond a constant.
double greatest_difference(const Response& one, const Response& other, const Vector3d& constant) {
  double greatest = 0;
  for (std::size_t i = 0; i < one.accelerations.size(); ++i)
    greatest = std::max(greatest, (one.accelerations[i] - other.accelerations[i] - constant).norm());
  return greatest;
}

struct Acceleration {
  const char* name;
  Vector3d centre;
  WallMotion motion;
};

/// Three motions that accelerate the walls about `middle` alike: on a straight line, by turning faster about a far centre, and by turning
/// steadily about one, towards which it is, while their speed about `middle` passes through zero.
std::vector<Acceleration> ways_to(const Vector3d& acceleration, const Vector3d& middle, int dimensions) {
  const Vector3d axis = dimensions == 2 ? Vector3d(Vector3d::UnitY()) : acceleration.unitOrthogonal();
  std::vector<Acceleration> ways(3);
  ways[0].name = "straight";
  ways[0].centre = middle;
  ways[0].motion.acceleration = acceleration;
  ways[1].name = "turning faster";
  ways[1].motion.angular_acceleration = acceleration.norm() / far_away * axis;
  ways[1].centre = middle - far_away * acceleration.normalized().cross(axis);  // α × (a × α)/α² = a
  ways[2].name = "turning steadily";
  ways[2].motion.angular_velocity = std::sqrt(acceleration.norm() / far_away) * axis;
  ways[2].centre = middle + far_away * acceleration.normalized();
  ways[2].motion.velocity = -ways[2].motion.angular_velocity.cross(middle - ways[2].centre);
  return ways;
}

// A tank with the acceleration a in the gravity g is a tank at rest in g − a: the walls press alike, so in the same state all water
// accelerates alike but for a itself, and the forces on the walls are the same.
TEST(WallMotion, AnAcceleratedTankIsOneInAnotherGravity) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind) {
      if (dimensions == 3 && elements == WallElements::numerical) continue;  // the time is the compiler's: 2-D has the rectangles' motion
      const Vector3d acceleration(3, dimensions == 3 ? 1.5 : 0.0, -4), middle(0.2, dimensions == 3 ? 0.2 : 0.0, 0.1);
      Case scene = tank_with_pier(dimensions, elements);
      const Layout layout = lay_out(scene);
      const Tank standing(scene, layout);
      scene.gravity -= acceleration;
      const Tank reference(scene, layout);
      reference.solver->pack(20, {});
      const double step = reference.solver->start().time_step;
      const std::vector<char> state = reference.solver->save();
      const Response expected = respond(*reference.solver, state, step);
      const double size = acceleration.norm(), mass = scene.fluid.density * total(layout.volumes);

      const double ignored = greatest_difference(respond(*standing.solver, state, step), expected, acceleration) / size;
      EXPECT_GT(ignored, 20 * equality) << name << ", " << dimensions << "-D: the test would not see that the acceleration is ignored";
      for (const Acceleration& way : ways_to(acceleration, middle, dimensions)) {
        const std::unique_ptr<Solver> solver = solver_about(standing, {way.centre, way.centre});
        solver->set_wall_motions({{way.motion, way.motion}, {}});
        const Response found = respond(*solver, state, step);
        const double difference = greatest_difference(found, expected, acceleration) / size;
        std::printf("%d-D, %-16s %-17s the water's accelerations differ by %.1e of the walls' (if that is ignored: %.1e)\n", dimensions,
                    name, way.name, difference, ignored);
        EXPECT_LT(difference, equality) << name << ", " << way.name << ", " << dimensions << "-D";
        for (std::size_t owner = 0; owner < 2; ++owner)
          EXPECT_LT((found.wrenches[owner][0] - expected.wrenches[owner][0]).norm(), equality * mass * size)
              << name << ", " << way.name << ", " << dimensions << "-D, owner " << owner;
      }
    }
}

// ---- velocity

// Of the greatest value. Elements' midpoint rule is right to 0.002 here, and what the step itself changes is below 0.003.
constexpr double closeness = 0.02;

/// A flat wall as a particle sees it.
struct Seen {
  std::size_t owner;
  Vector3d normal;  ///< out of the fluid
  double distance;  ///< m
};

/// The one wall that a place in the water between a tank and a body in it sees; none if it sees an edge, several walls or no wall.
std::optional<Seen> only_wall(const Vector3d& place, const Box& tank, const Box& body, int dimensions, double support) {
  std::vector<Seen> seen;
  const Vector3d away = place - place.cwiseMax(body.min).cwiseMin(body.max);
  bool on_edge = away.norm() < support && (away.array() != 0.0).count() > 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (dimensions == 2 && axis == 1) continue;
    for (const double side : {-1.0, 1.0}) {
      const double distance = side > 0 ? tank.max[axis] - place[axis] : place[axis] - tank.min[axis];
      if (distance < support) seen.push_back({0, side * Vector3d::Unit(axis), distance});
    }
    const double within = std::min(place[axis] - body.min[axis], body.max[axis] - place[axis]);
    if (away.norm() < support && away[axis] == 0.0 && within < support) on_edge = true;
  }
  if (away.norm() < support) seen.push_back({1, -away.normalized(), away.norm()});
  if (on_edge || seen.size() != 1) return std::nullopt;
  return seen.front();
}

/// ∫ W dS over a plane (2-D: a line) at a distance.
double whole_weight(const Discretisation& d, double distance) {
  const double h = d.smoothing_length, pi = std::acos(-1.0);
  const double scale = d.dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  const double reach = std::sqrt(d.support * d.support - distance * distance);
  constexpr int rings = 1000;
  double sum = 0;
  for (int k = 0; k < rings; ++k) {
    const double radius = reach * (k + 0.5) / rings, q = std::hypot(distance, radius) / h;
    sum += scale * std::pow(1 - 0.5 * q, 4) * (1 + 2 * q) * (d.dimensions == 2 ? 2.0 : 2.0 * pi * radius);
  }
  return sum * reach / rings;
}

/// A full tank with a body in its middle. Both have particles that see one of their walls and nothing else.
struct Rooms {
  Box tank, body;
};

Rooms rooms(int dimensions) {
  const double size = dimensions == 2 ? 0.52 : 0.8, from = dimensions == 2 ? 0.16 : 0.2;
  const Vector3d one = dimensions == 2 ? Vector3d(1, 0, 1) : Vector3d(1, 1, 1);
  return {{Vector3d::Zero(), size * one}, {from * one, (size - from) * one}};
}

Case full_tank(int dimensions, WallElements elements) {
  const Rooms places = rooms(dimensions);
  Case scene = box_case(places.tank.max, places.tank.max.z(), dimensions == 2 ? 0.02 : 0.05);
  std::get<BoxTank>(scene.tank.shape).closed = true;
  scene.bodies.push_back({"body", places.body, Motion::fixed});
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 20;
  scene.fluid.viscosity = 0.1;  // small enough that a step's drag hardly moves the water
  scene.numerics.viscosity_model = ViscosityModel::morris;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.numerics.walls.elements = elements;
  return scene;
}

struct Comparison {
  double greatest = 0, error = 0;
  void add(const Vector3d& found, const Vector3d& expected) {
    greatest = std::max(greatest, expected.norm());
    error = std::max(error, (found - expected).norm());
  }
  double relative() const { return error / greatest; }
};

// Water at rest in a tank that moves and turns, with a body in it that moves and turns otherwise. Where a particle sees one wall, of the
// velocity v + ω × (y − c) at its foot y,
//   ds/dt = −v·n ∫ W dS/√γ   and along the wall   du/dt = 2 μ v ∫ W dS/(γ ρ d).
TEST(WallMotion, WallsCompressAndDragTheWaterWithTheirOwnVelocity) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind) {
      const bool flat = dimensions == 2;
      const Vector3d in_plane = flat ? Vector3d(1, 0, 1) : Vector3d(1, 1, 1), in_turn = flat ? Vector3d(0, 1, 0) : Vector3d(1, 1, 1);
      const std::vector<Vector3d> centres = {Vector3d(0.1, 0.3, 0.7).cwiseProduct(in_plane),
                                             Vector3d(0.5, -0.1, 0.2).cwiseProduct(in_plane)};
      std::vector<WallMotion> motions(2);
      motions[0].velocity = Vector3d(0.3, 0.4, -0.2).cwiseProduct(in_plane);
      motions[0].angular_velocity = Vector3d(1, 1.5, -0.5).cwiseProduct(in_turn);
      motions[1].velocity = Vector3d(-0.4, 0.1, 0.5).cwiseProduct(in_plane);
      motions[1].angular_velocity = Vector3d(0.5, -2, 1).cwiseProduct(in_turn);

      const Tank tank(full_tank(dimensions, elements));
      const Rooms places = rooms(dimensions);
      const Discretisation& d = tank.discretisation;
      const std::unique_ptr<Solver> solver = solver_about(tank, centres);
      const double step = solver->start().time_step;
      solver->set_wall_motions({motions, {}});  // after the start, which finds no rates then: the step's first half changes no density
      ASSERT_TRUE(solver->advance().valid());
      const FluidState fluid = solver->download();
      const std::vector<double> shepard = solver->find_surface().shepard;

      Comparison compression, drag;
      int members[2] = {0, 0};
      for (std::size_t i = 0; i < fluid.id.size(); ++i) {
        const Vector3d& place = fluid.position[i];
        const std::optional<Seen> seen = only_wall(place, places.tank, places.body, dimensions, d.support);
        if (!seen) continue;
        ++members[seen->owner];
        const WallMotion& motion = motions[seen->owner];
        const Vector3d n = seen->normal, foot = place + seen->distance * n;
        const Vector3d velocity = motion.velocity + motion.angular_velocity.cross(foot - centres[seen->owner]);
        const double weight = whole_weight(d, seen->distance) / shepard[i];
        const auto along = [&n](const Vector3d& v) { return Vector3d(v - v.dot(n) * n); };
        // by √γ, not γ: see continuity.cl
        compression.add(2 * fluid.compression[i] / step * n, -velocity.dot(n) * weight * std::sqrt(shepard[i]) * n);
        const double friction =
            2 * tank.scene.fluid.viscosity * weight / (tank.scene.fluid.density * std::max(seen->distance, 0.5 * d.spacing));
        drag.add(along(fluid.velocity[i]) / step, friction * along(velocity));
      }
      std::printf("%d-D, %-16s %d particles by the tank, %d by the body: error of the compression %.4f, of the drag %.4f of the greatest\n",
                  dimensions, name, members[0], members[1], compression.relative(), drag.relative());
      EXPECT_GT(members[0], 200) << name;
      EXPECT_GE(members[1], 20) << name;
      EXPECT_LT(compression.relative(), closeness) << name << ", " << dimensions << "-D";
      EXPECT_LT(drag.relative(), closeness) << name << ", " << dimensions << "-D";
    }
}

// ---- far away

// Cells near a belt list its walls for particles that no wall reaches: these must not be touched at all.
TEST(WallMotion, WaterOutOfReachOfABeltDoesNotFeelIt) {
  for (const auto& [name, elements] : every_kind) {
    Case scene = box_case(Vector3d(0.8, 0, 1), 0.8, 0.02);
    scene.fluid.viscosity = 1;
    scene.numerics.walls.elements = elements;
    const Tank tank(scene);
    const double reach = tank.discretisation.support + scene.fluid.spacing.value();
    std::vector<Vector3d> velocities[2];
    for (const bool runs : {false, true}) {
      const std::unique_ptr<Solver> solver = solver_about(tank, {Vector3d::Zero()});
      std::vector<WallMotion> motions(1);
      if (runs) motions[0].surface_velocity = Vector3d(1, 0, 1);
      solver->set_wall_motions({motions, {}});
      solver->start();
      ASSERT_TRUE(solver->advance().valid()) << name;
      const FluidState fluid = solver->download();
      ASSERT_TRUE(all_finite(fluid)) << name;
      velocities[runs].resize(fluid.id.size());
      for (std::size_t i = 0; i < fluid.id.size(); ++i) velocities[runs][fluid.id[i]] = fluid.velocity[i];
    }
    int near = 0, far = 0;
    for (std::size_t i = 0; i < tank.layout.particles.size(); ++i) {
      const Vector3d& place = tank.layout.particles[i];
      const double change = (velocities[1][i] - velocities[0][i]).norm();
      if (std::min({place.x(), 0.8 - place.x(), place.z()}) > reach) {
        ++far;
        EXPECT_LT(change, 1e-7) << name << " at " << place.transpose();  // the fit in single precision, done anew for walls that move
      } else if (change > 1e-5) {
        ++near;
      }
    }
    EXPECT_GT(far, 500) << name;
    EXPECT_GT(near, 50) << name;
  }
}

}  // namespace
}  // namespace wavetank::wall_motion_test
