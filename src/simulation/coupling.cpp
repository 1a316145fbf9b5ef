#include "coupling.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

// The mass of water that answers to a wall's acceleration at once, a layer of this part of h on it: ∫ d w(d)/γ(d) dd of the wall integral
// w, 0.27 h on a flat wall.
constexpr double answering_layer = 0.3;

// Of the step in which ρ c₀ S Δt reaches the body's mass. Measured: see docs/bodies.md.
constexpr double safe_step = 2.0;

/// What a body's surface makes of a layer of water on it: ∫ n nᵀ dS and ∫ (r × n)(r × n)ᵀ dS about the centre of mass.
struct Surface {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero(), angular = Eigen::Matrix3d::Zero();

  void operator+=(const Surface& other) {
    linear += other.linear;
    angular += other.angular;
  }
};

Surface surface_of(const Layout& layout, int owner, const Vector3d& centre, int dimensions) {
  Surface surface;
  for (const Facet& facet : layout.facets) {
    if (facet.owner != owner) continue;
    const Vector3d a = facet.corners[1] - facet.corners[0], b = facet.corners[2] - facet.corners[0];
    const double area = dimensions == 2 ? a.norm() : 0.5 * a.cross(b).norm();
    // exact for what is quadratic: the middles of a triangle's sides, Simpson's points of a segment
    const auto add = [&](const Vector3d& place, double weight) {
      const Vector3d lever = (place - centre).cross(facet.normal);
      surface.angular += weight * area * lever * lever.transpose();
    };
    surface.linear += area * facet.normal * facet.normal.transpose();
    if (dimensions == 2) {
      add(facet.corners[0], 1.0 / 6);
      add(0.5 * (facet.corners[0] + facet.corners[1]), 4.0 / 6);
      add(facet.corners[1], 1.0 / 6);
    } else {
      for (int k = 0; k < 3; ++k) add(0.5 * (facet.corners[k] + facet.corners[(k + 1) % 3]), 1.0 / 3);
    }
  }
  return surface;
}

/// The greatest ratio of what the surface gathers to what the body has of inertia, over all directions.
double greatest_ratio(const Surface& surface, const MassProperties& body, int dimensions) {
  const double linear = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(surface.linear).eigenvalues().maxCoeff() / body.mass;
  if (dimensions == 2) return std::max(linear, surface.angular(1, 1) / body.inertia(1, 1));
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d> angular(surface.angular, body.inertia);
  return std::max(linear, angular.eigenvalues().maxCoeff());
}

}  // namespace

Coupling::Coupling(RigidWorld& world, const Case& scene, const Layout& layout, const Discretisation& d)
    : world_(world),
      farthest_allowed_(Discretisation::wall_reach * d.spacing),
      gravity_(scene.gravity),
      tank_moves_(scene.tank.motion != Motion::fixed),
      belts_(world.count(), Vector3d::Zero()),
      relaxation_(world.count(), 1.0),
      felt_(world.count()),
      longest_time_step_(std::numeric_limits<double>::infinity()) {
  for (std::size_t o = 0; o < world.count(); ++o) {
    const Box box = layout.meshes[o].bounding_box();
    reaches_.push_back((box.max - world.reference(o)).cwiseAbs().cwiseMax((box.min - world.reference(o)).cwiseAbs()).norm());
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) belts_[b + 1] = scene.bodies[b].surface_velocity;
  for (std::size_t o = 0; o < world.count(); ++o) {
    const bool rides_free_tank = !world.moves(o) && world.is_free(0);
    if (world.is_free(o) || rides_free_tank) coupled_.push_back(static_cast<int>(o));
    if (!world.is_free(o)) continue;
    Surface surface = surface_of(layout, static_cast<int>(o), world.reference(o), scene.dimensions);
    for (std::size_t rider = 1; o == 0 && rider < world.count(); ++rider)
      if (!world.moves(rider)) surface += surface_of(layout, static_cast<int>(rider), world.reference(o), scene.dimensions);
    const double ratio = greatest_ratio(surface, world.properties(o), scene.dimensions);  // 1/(kg/m²)
    const double density = scene.fluid.density;
    relaxation_[o] = 1.0 / (1.0 + answering_layer * d.smoothing_length * density * ratio);
    longest_time_step_ = std::min(longest_time_step_, safe_step / (density * d.sound_speed * ratio));
  }
}

std::vector<RigidState> Coupling::present() const {
  std::vector<RigidState> states;
  for (std::size_t o = 0; o < world_.count(); ++o) states.push_back(world_.state(o));
  return states;
}

WallMotions Coupling::motions_of(const std::vector<RigidState>& states) const {
  WallMotions motions;
  motions.owners.resize(states.size());
  const RigidState& tank = states[0];
  if (tank_moves_) {
    const Quaterniond back = tank.orientation.conjugate();
    const Vector3d acceleration = world_.is_free(0) ? felt_[0].linear : tank.acceleration;
    const Vector3d spin_up = world_.is_free(0) ? felt_[0].angular : tank.angular_acceleration;
    motions.frame = FrameMotion{back * (gravity_ - acceleration), world_.reference(0), back * tank.angular_velocity, back * spin_up};
  }
  for (std::size_t o = 1; o < states.size(); ++o) {
    WallMotion& motion = motions.owners[o];
    motion.surface_velocity = belts_[o];
    if (!world_.moves(o)) continue;
    RigidState state = states[o];
    RigidState frame = tank;
    if (world_.is_free(o)) {
      state.acceleration = felt_[o].linear;
      state.angular_acceleration = felt_[o].angular;
    }
    if (world_.is_free(0)) {
      frame.acceleration = felt_[0].linear;
      frame.angular_acceleration = felt_[0].angular;
    }
    const RigidState seen = tank_moves_ ? seen_from(frame, world_.reference(0), state) : state;
    motion.displacement = seen.position - world_.reference(o);
    motion.orientation = seen.orientation;
    motion.velocity = seen.velocity;
    motion.angular_velocity = seen.angular_velocity;
    motion.acceleration = seen.acceleration;
    motion.angular_acceleration = seen.angular_acceleration;
  }
  return motions;
}

double Coupling::farthest(const WallMotions& from, const std::vector<RigidState>& to) const {
  const WallMotions moved = motions_of(to);
  double farthest = 0;
  for (std::size_t o = 1; o < to.size(); ++o) {
    const WallMotion &a = from.owners[o], &b = moved.owners[o];
    const double turn = a.orientation.angularDistance(b.orientation);
    farthest = std::max(farthest, (b.displacement - a.displacement).norm() + turn * reaches_[o]);
  }
  return farthest;
}

double Coupling::allowed_step(double time_step) const {
  constexpr int most_halvings = 60;
  const WallMotions from = now();
  for (int k = 0; k < most_halvings; ++k) {
    const double way = std::max(farthest(from, world_.at_middle(time_, time_step)), farthest(from, world_.at_end(time_, time_step)));
    if (!(way > farthest_allowed_)) break;  // so too where a place is not finite: check_bodies names it
    time_step *= std::max(0.5, 0.99 * farthest_allowed_ / way);
  }
  return time_step;
}

WallMotions Coupling::now() const { return motions_of(present()); }

WallMotions Coupling::at(double time_step, double fraction) {
  return motions_of(fraction < 1 ? world_.at_middle(time_, time_step) : world_.at_end(time_, time_step));
}

WallMotions Coupling::to_end(double time_step, const std::vector<WallWrench>& wrenches) {
  const Quaterniond tank_at_middle = world_.at_middle(time_, time_step)[0].orientation;
  std::vector<RigidLoad> loads(world_.count());
  for (std::size_t k = 0; k < coupled_.size(); ++k) {
    const WallWrench& wrench = wrenches[k];
    loads[coupled_[k]] = {tank_at_middle * (wrench[0] + wrench[1]), tank_at_middle * (wrench[2] + wrench[3])};
  }
  for (std::size_t o = 0; o < film_.size(); ++o) {
    loads[o].force += tank_at_middle * film_[o].force;
    loads[o].torque += tank_at_middle * film_[o].torque;
  }
  world_time_.tick();
  {
    const Stopwatch::Lap lap(world_time_);
    world_.advance(time_, time_step, loads);
  }
  time_ += time_step;
  for (const int o : coupled_) {
    const RigidState state = world_.state(o);
    felt_[o].linear += relaxation_[o] * (state.acceleration - felt_[o].linear);
    felt_[o].angular += relaxation_[o] * (state.angular_acceleration - felt_[o].angular);
  }
  return now();
}

std::vector<double> Coupling::save() const {
  std::vector<double> values;
  for (const Felt& felt : felt_)
    for (const Vector3d& vector : {felt.linear, felt.angular}) values.insert(values.end(), vector.data(), vector.data() + 3);
  return values;
}

void Coupling::restore(const std::vector<double>& values) {
  if (values.size() != 6 * felt_.size())
    throw Error("the snapshot's bodies have " + std::to_string(values.size()) + " accelerations, but this case's have " +
                std::to_string(6 * felt_.size()) + ".");
  for (std::size_t o = 0; o < felt_.size(); ++o)
    for (int axis = 0; axis < 3; ++axis) {
      felt_[o].linear[axis] = values[6 * o + axis];
      felt_[o].angular[axis] = values[6 * o + 3 + axis];
    }
}

}  // namespace wavetank
