#include "wavetank/rigid/prescribed_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion_terms.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t direction_count = 8;
constexpr double fewest_samples = 2000, most_samples = 200000;  // of times that the greatest speed is looked for at

using Changes = std::array<Change, direction_count>;

const Change& of(const Changes& changes, Direction direction) { return changes[static_cast<std::size_t>(direction)]; }

/// A rotation that changes with time: orientation, angular velocity and its derivative.
struct Turn {
  Quaterniond orientation = Quaterniond::Identity();
  Vector3d velocity = Vector3d::Zero();
  Vector3d acceleration = Vector3d::Zero();

  /// Turned once more, by a changing angle about an axis that stands: this carries round the axes of all turns before.
  void about(const Vector3d& axis, const Change& angle) {
    const Quaterniond outer(Eigen::AngleAxisd(angle.value, axis));
    orientation = outer * orientation;
    velocity = outer * velocity;
    acceleration = angle.acceleration * axis + outer * acceleration + angle.rate * axis.cross(velocity);
    velocity += angle.rate * axis;
  }
};

bool is_used(const std::vector<MotionTerm>& terms, Direction direction) {
  return std::any_of(terms.begin(), terms.end(), [&](const MotionTerm& term) { return term.direction == direction; });
}

}  // namespace

struct PrescribedMotion::Parts {
  std::vector<MotionTerm> terms;
  Vector3d reference, point;
  Vector3d stroke_axis, angle_axis;  ///< unit

  Changes changes_at(double time) const {
    Changes sums;
    for (const MotionTerm& term : terms) {
      const Change change = term.at(time);
      Change& sum = sums[static_cast<std::size_t>(term.direction)];
      sum.value += change.value;
      sum.rate += change.rate;
      sum.acceleration += change.acceleration;
    }
    return sums;
  }
};

PrescribedMotion::PrescribedMotion(const PrescribedCase& prescribed, const Vector3d& reference, int dimensions, double gravity,
                                   const std::string& case_directory, const ResourceResolver& resolve, const std::string& what)
    : parts_(std::make_unique<Parts>()) {
  parts_->terms = motion_terms(prescribed, dimensions, gravity, case_directory, resolve, what);
  parts_->reference = reference;
  parts_->point = prescribed.point.value_or(reference);
  if (!parts_->point.allFinite()) throw Error(what + ": the point that the motion turns about is not a finite place");
  const double length = prescribed.axis.stableNorm();
  if (!(length > 0) || !std::isfinite(length)) throw Error(what + ": the motion's axis must have a length, greater than 0 and finite");
  parts_->stroke_axis = parts_->angle_axis = prescribed.axis / length;
  if (dimensions == 2) {
    parts_->angle_axis = prescribed.axis.y() < 0 ? Vector3d(-Vector3d::UnitY()) : Vector3d(Vector3d::UnitY());
    if (is_used(parts_->terms, Direction::stroke) && prescribed.axis.y() != 0)
      throw Error(what + ": in a two-dimensional case a stroke's axis must lie in the x–z plane: give an axis [x, 0, z]");
  }
}

PrescribedMotion::~PrescribedMotion() = default;
PrescribedMotion::PrescribedMotion(PrescribedMotion&&) noexcept = default;
PrescribedMotion& PrescribedMotion::operator=(PrescribedMotion&&) noexcept = default;

RigidState PrescribedMotion::at(double time) const {
  const Parts& parts = *parts_;
  const Changes changes = parts.changes_at(std::max(time, 0.0));
  const auto vector = [&](double Change::*part) {
    return Vector3d(Vector3d(of(changes, Direction::surge).*part, of(changes, Direction::sway).*part, of(changes, Direction::heave).*part) +
                    of(changes, Direction::stroke).*part * parts.stroke_axis);
  };
  Turn turn;
  turn.about(Vector3d::UnitX(), of(changes, Direction::roll));
  turn.about(Vector3d::UnitY(), of(changes, Direction::pitch));
  turn.about(Vector3d::UnitZ(), of(changes, Direction::yaw));
  turn.about(parts.angle_axis, of(changes, Direction::angle));

  const Vector3d arm = turn.orientation * (parts.reference - parts.point);
  RigidState state;
  state.position = parts.point + vector(&Change::value) + arm;
  state.orientation = turn.orientation.normalized();
  if (time < 0) return state;
  state.velocity = vector(&Change::rate) + turn.velocity.cross(arm);
  state.angular_velocity = turn.velocity;
  state.acceleration = vector(&Change::acceleration) + turn.acceleration.cross(arm) + turn.velocity.cross(turn.velocity.cross(arm));
  state.angular_acceleration = turn.acceleration;
  return state;
}

double PrescribedMotion::greatest_speed(const Box& box, double duration) const {
  double interval = duration / fewest_samples;
  for (const MotionTerm& term : parts_->terms) interval = std::min(interval, term.resolution);
  const int samples = static_cast<int>(std::clamp(std::ceil(duration / std::max(interval, 1e-300)), fewest_samples, most_samples));
  double greatest = 0;
  for (int k = 0; k <= samples; ++k) {
    const RigidState state = at(duration * k / samples);
    for (int corner = 0; corner < 8; ++corner) {  // the speed is a convex function of the place: greatest at one of them
      const Vector3d given(corner & 1 ? box.max.x() : box.min.x(), corner & 2 ? box.max.y() : box.min.y(),
                           corner & 4 ? box.max.z() : box.min.z());
      greatest = std::max(greatest, state.velocity_at(state.moved(given, parts_->reference)).norm());
    }
  }
  return greatest;
}

}  // namespace wavetank
