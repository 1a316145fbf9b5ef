// Walls whose places move: they are as if they had always stood there, give the water what it gives them, and the tank's own frame makes
// the forces of a frame that accelerates and turns.
#include <Eigen/Geometry>
#include <algorithm>
#include <random>

#include "sph_fixture.h"

namespace wavetank::moving_walls_test {
namespace {

struct Kind {
  const char* name;
  WallElements elements;
};
constexpr Kind every_kind[] = {
    {"numerical", WallElements::numerical}, {"semi_analytical", WallElements::semi_analytical}, {"facet", WallElements::facet}};

// ---- places

const Vector3d middle(0.744, 0.5, 0.0805);  // of the box in its file, m

/// Water in a box tank about a box of 0.161 × 0.403 × 0.161 m, which is turned about its file's origin and then moved.
Case tank_with_box(int dimensions, WallElements elements, const Vector3d& translation, const Vector3d& rotation) {
  Case scene = dimensions == 2 ? box_case(Vector3d(1.2, 0, 1), 0.8, 0.02) : box_case(Vector3d(1.2, 1, 1), 0.8, 0.05);
  MeshSource box;
  box.uri = WAVETANK_SOURCE_DIRECTORY "/meshes/spheric2_box.stl";
  box.translation = translation;
  box.rotation = rotation;
  BodyCase body;
  body.name = "box";
  body.shape = box;
  body.motion = Motion::commanded;
  scene.bodies = {body};
  scene.numerics.walls.elements = elements;
  return scene;
}

std::unique_ptr<Solver> solver_about(const Tank& tank, const Vector3d& centre) {
  return make_solver(test_device(), tank.scene, tank.layout, tank.discretisation, {Vector3d::Zero(), centre});
}

WallMotions placed(const Vector3d& displacement, const Eigen::Quaterniond& orientation) {
  WallMotions motions;
  motions.owners.resize(2);
  motions.owners[1].displacement = displacement;
  motions.owners[1].orientation = orientation;
  return motions;
}

// γ at points about the box: carried there in steps, against a box that was laid out there. Facets are exact, so what differs is rounding
// of coordinates of 1 m in float32, 1e-7 of them and thus 1e-6 of h, times the greatest slope of γ, 1/h. Elements of the tilted box are cut
// where those of the other are, but their corners round otherwise.
TEST(MovingWalls, AreWhereABodyLaidOutThereHasThem) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind) {
      const bool flat = dimensions == 2;
      const Vector3d turn = flat ? Vector3d(0, 0.5, 0) : Vector3d(0.2, 0.5, -0.3);
      const Eigen::Quaterniond orientation = Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()) *
                                             Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()) *
                                             Eigen::AngleAxisd(turn.x(), Vector3d::UnitX());
      const Vector3d from = Vector3d(0.4, flat ? 0 : 0.5, 0.28) - middle;
      const Vector3d to = Vector3d(0.62, flat ? 0 : 0.53, 0.4) - orientation * middle;
      const Tank here(tank_with_box(dimensions, elements, from, Vector3d::Zero())), there(tank_with_box(dimensions, elements, to, turn));
      const std::unique_ptr<Solver> carried = solver_about(here, from), standing = solver_about(there, to);
      // the last step is so short, at most a twelfth of the spacing for any corner, that the lists made in the one before must still do
      const double last =
          0.08 * there.layout.spacing / ((to - from).norm() + orientation.angularDistance(Eigen::Quaterniond::Identity()) * 0.5);
      for (int step = 0; step <= 20; ++step) {
        const double share = (1 - last) * step / 19.0;
        const double place = step == 20 ? 1.0 : share;
        carried->set_wall_motions(placed(place * (to - from), Eigen::Quaterniond::Identity().slerp(place, orientation)));
      }

      std::mt19937 random(7);
      std::uniform_real_distribution<double> uniform(-1, 1);
      std::vector<Vector3d> points;
      const Box box = there.layout.meshes[1].bounding_box();
      while (points.size() < 400) {
        Vector3d point = 0.5 * (box.min + box.max) + Vector3d(uniform(random), uniform(random), uniform(random)) * 0.4;
        if (dimensions == 2) point.y() = 0;
        if (!inside(there.layout.meshes[1], point) && distance(there.layout.meshes[1], point) > 0.05 * there.layout.spacing)
          points.push_back(point);
      }
      const std::vector<PointValue> found = carried->evaluate(*carried->make_points(points));
      const std::vector<PointValue> expected = standing->evaluate(*standing->make_points(points));
      double error = 0, least = 1;
      for (std::size_t i = 0; i < points.size(); ++i) {
        error = std::max(error, std::abs(found[i].shepard - expected[i].shepard));
        least = std::min(least, expected[i].shepard);
      }
      std::printf("%d-D, %-16s γ from %.3f, greatest difference %.2e\n", dimensions, name, least, error);
      EXPECT_LT(least, 0.6) << name << ": no point is near the box";
      EXPECT_LT(error, 1e-5) << name << ", " << dimensions << "-D";
    }
}

/// Two bars of 0.3 m × 0.1 m × 0.1 m, the second of which is turned about the end of the first, in which its own end lies.
Case tank_with_bars(int dimensions, WallElements elements, Motion motion, double turn) {
  Case scene = dimensions == 2 ? box_case(Vector3d(1, 0, 0.8), 0.7, 0.02) : box_case(Vector3d(1, 0.6, 0.8), 0.7, 0.04);
  const Vector3d hinge(0.5, dimensions == 2 ? 0 : 0.3, 0.4);
  for (int bar = 0; bar < 2; ++bar) {
    MeshSource source;
    source.uri = "shape://box?size=0.3,0.1,0.1";
    source.rotation = {0, bar == 0 ? 0.0 : turn, 0};
    const Vector3d from_hinge(bar == 0 ? -0.1 : 0.1, 0, bar == 0 ? 0.0 : 0.013);
    source.translation = hinge + Eigen::AngleAxisd(source.rotation.y(), Vector3d::UnitY()) * from_hinge;
    BodyCase body;
    body.name = bar == 0 ? "upper" : "lower";
    body.shape = source;
    body.motion = motion;
    scene.bodies.push_back(body);
  }
  scene.numerics.walls.elements = elements;
  return scene;
}

// The ends of two links that move against each other, each within the other, are no walls. They are hidden in pieces of half a spacing,
// a quarter of h, those whose middle is inside: γ beside the seam is off by what a piece of that length may cover, not by a whole end.
TEST(MovingWalls, AreHiddenWhereTheyLieInAnotherBodyThatMovesOtherwise) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind)
      for (const double turn : {0.0, 0.7}) {
        const Tank moved(tank_with_bars(dimensions, elements, Motion::commanded, 0)),
            standing(tank_with_bars(dimensions, elements, Motion::fixed, turn));
        const Vector3d hinge(0.5, dimensions == 2 ? 0 : 0.3, 0.4);
        const std::vector<Vector3d> centres{Vector3d::Zero(), hinge, hinge};
        const auto solver = make_solver(test_device(), moved.scene, moved.layout, moved.discretisation, centres);
        for (int step = 1; step <= 20; ++step) {
          WallMotions motions;
          motions.owners.resize(3);
          motions.owners[2].orientation = Eigen::AngleAxisd(turn * step / 20, Vector3d::UnitY());
          solver->set_wall_motions(motions);
        }
        std::mt19937 random(7);
        std::uniform_real_distribution<double> uniform(-1, 1);
        std::vector<Vector3d> points;
        while (points.size() < 600) {
          Vector3d point = hinge + 0.25 * Vector3d(uniform(random), uniform(random), uniform(random));
          if (dimensions == 2) point.y() = 0;
          const auto off = [&](int body) {
            return !inside(standing.layout.meshes[body], point) &&
                   distance(standing.layout.meshes[body], point) > 0.5 * moved.layout.spacing;
          };
          if (off(1) && off(2)) points.push_back(point);
        }
        const std::vector<PointValue> found = solver->evaluate(*solver->make_points(points));
        const std::vector<PointValue> expected = standing.solver->evaluate(*standing.solver->make_points(points));
        double error = 0, square = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
          const double difference = found[i].shepard - expected[i].shepard;
          error = std::max(error, std::abs(difference));
          square += difference * difference / static_cast<double>(points.size());
        }
        std::printf("%d-D, %-16s turned by %.1f: γ off by %.4f at most, %.4f rms\n", dimensions, name, turn, error, std::sqrt(square));
        EXPECT_LT(error, 0.1) << name << ", " << dimensions << "-D";
        EXPECT_LT(std::sqrt(square), 0.02) << name << ", " << dimensions << "-D";
      }
}

// ---- forces

/// Moves the second owner at a constant velocity and keeps what it is told.
class Carrier final : public WallMover {
 public:
  explicit Carrier(const WallMotion& motion) : motion_(motion) {}
  std::vector<int> coupled() const override { return {0, 1}; }
  WallMotions at(double time_step, double fraction) override { return moved(fraction * time_step); }
  WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) override {
    force = wrenches[0][0] + wrenches[0][1] + wrenches[1][0] + wrenches[1][1];
    on_body = (wrenches[1][0] + wrenches[1][1]).norm();
    return moved(0.5 * time_step);
  }
  Vector3d force = Vector3d::Zero();
  double on_body = 0;

 private:
  WallMotions moved(double time) {
    motion_.displacement += time * motion_.velocity;
    motion_.orientation =
        Eigen::Quaterniond(Eigen::AngleAxisd(time * motion_.angular_velocity.norm(), motion_.angular_velocity.normalized())) *
        motion_.orientation;
    WallMotions motions;
    motions.owners = {WallMotion(), motion_};
    return motions;
  }
  WallMotion motion_;
};

// What tank and body get is what the water loses, to rounding of the sums: over a few thousand particles in float32, whose forces partly
// cancel. The velocities' differences are rounded too: half a unit in the last place of each, over the step.
TEST(MovingWalls, GetWhatTheWaterLoses) {
  for (const int dimensions : {2, 3})
    for (const auto& [name, elements] : every_kind) {
      const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.3, Vector3d::UnitY()));
      const Vector3d centre(0.6, dimensions == 2 ? 0 : 0.5, 0.6);
      Case scene = tank_with_box(dimensions, elements, centre - tilt * middle, Vector3d(0, 0.3, 0));
      scene.numerics.walls.guard_distance = 0;  // which takes momentum outside the sums
      scene.fluid.viscosity = 0.5;
      const Tank tank(scene);
      const std::unique_ptr<Solver> solver = solver_about(tank, centre);
      WallMotion motion;
      motion.velocity = Vector3d(0.4, 0, -0.3);
      motion.angular_velocity = Vector3d(0, 1.5, 0);
      motion.acceleration = Vector3d(2, 0, 3);
      Carrier carrier(motion);
      double step = solver->start().time_step;
      FluidState before = solver->download();
      double greatest = 0, on_body = 0, weight = 0;
      for (int k = 0; k < 5; ++k) {
        const StepReport report = solver->advance(&carrier);
        ASSERT_TRUE(report.valid()) << name;
        const FluidState after = solver->download();
        std::vector<Vector3d> velocity(after.id.size());
        for (std::size_t i = 0; i < before.id.size(); ++i) velocity[before.id[i]] = before.velocity[i];
        Vector3d gained = Vector3d::Zero();
        weight = 0;
        for (std::size_t i = 0; i < after.id.size(); ++i) {
          gained += after.mass[i] * (after.velocity[i] - velocity[after.id[i]]) / step;
          weight += after.mass[i] * 9.81;
        }
        const Vector3d lost = weight * -Vector3d::UnitZ() - gained;
        greatest = std::max(greatest, (carrier.force - lost).norm() / weight);
        on_body = carrier.on_body;
        before = after;
        step = report.time_step;
      }
      std::printf("%d-D, %-16s action less reaction: %.1e of the water's weight, of which the body feels %.2f\n", dimensions, name,
                  greatest, on_body / weight);
      EXPECT_GT(on_body / weight, 0.01) << name;
      EXPECT_LT(greatest, 2e-5) << name << ", " << dimensions << "-D";
    }
}

// ---- the tank's frame

// Far from walls, water without pressure feels −a − α × r − ω × (ω × r) − 2 ω × u and nothing else: exactly, up to the second order of a
// step.
TEST(MovingWalls, ATankThatMovesCarriesItsFrameWithIt) {
  for (const int dimensions : {2, 3}) {
    Case scene = dimensions == 2 ? box_case(Vector3d(1, 0, 1), 1, 0.02) : box_case(Vector3d(1, 1, 1), 1, 0.05);
    std::get<BoxTank>(scene.tank.shape).closed = true;
    scene.tank.motion = Motion::commanded;
    scene.gravity = Vector3d::Zero();
    scene.fluid.sound_speed = 20;
    scene.fluid.viscosity = 0;
    scene.numerics.artificial_viscosity = 0;
    scene.numerics.density_diffusion = DensityDiffusion::none;
    const Tank tank(scene);
    const Vector3d in_turn = dimensions == 2 ? Vector3d(0, 1, 0) : Vector3d(1, 1, 1), in_plane = Vector3d(1, dimensions == 2 ? 0 : 1, 1);
    FrameMotion frame;
    frame.gravity = Vector3d(0.5, -0.7, 0.9).cwiseProduct(in_plane);
    frame.origin = Vector3d(0.2, 0.3, -0.1).cwiseProduct(in_plane);
    frame.angular_velocity = Vector3d(0.8, 2, -1).cwiseProduct(in_turn);
    frame.angular_acceleration = Vector3d(-3, 2, 1).cwiseProduct(in_turn);
    WallMotions motions;
    motions.owners.resize(1);
    motions.frame = frame;
    tank.solver->set_wall_motions(motions);
    double step = tank.solver->start().time_step;
    std::vector<Vector3d> velocity(tank.layout.particles.size(), Vector3d::Zero());
    double error = 0, greatest = 0;
    int members = 0;
    for (int k = 0; k < 3; ++k) {
      const double next = tank.solver->advance().time_step;
      const FluidState fluid = tank.solver->download();
      for (std::size_t i = 0; i < fluid.id.size(); ++i) {
        const Vector3d u = velocity[fluid.id[i]], arm = fluid.position[i] - frame.origin;
        velocity[fluid.id[i]] = fluid.velocity[i];
        const Vector3d off = (fluid.position[i] - Vector3d::Constant(0.5)).cwiseProduct(in_plane).cwiseAbs();
        // in the later steps the walls' pressure has come as far as the support a step
        if (off.maxCoeff() > 0.5 - (k + 1.5) * tank.discretisation.support) continue;
        ++members;
        const Vector3d w = frame.angular_velocity;
        const Vector3d expected = frame.gravity - frame.angular_acceleration.cross(arm) - w.cross(w.cross(arm)) - 2 * w.cross(u);
        error = std::max(error, ((fluid.velocity[i] - u) / step - expected).norm());
        greatest = std::max(greatest, expected.norm());
      }
      step = next;
    }
    std::printf("%d-D: %d particles, greatest error %.1e of %.2f m/s²\n", dimensions, members, error, greatest);
    EXPECT_GT(members, 100);
    EXPECT_LT(error, 3e-3 * greatest);  // the middle of the step is half a step's fall away: 2 ω × a Δt/2 and ω² u Δt/2
  }
}

}  // namespace
}  // namespace wavetank::moving_walls_test
