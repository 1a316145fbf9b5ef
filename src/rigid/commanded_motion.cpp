#include "wavetank/rigid/commanded_motion.h"

#include <cmath>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr std::size_t saved_numbers = 27;

Vector3d limited(const Vector3d& vector, const std::optional<double>& greatest) {
  const double length = vector.norm();
  return greatest && length > *greatest ? Vector3d(*greatest / length * vector) : vector;
}

/// From `present` towards `wanted`, by no more than the limit allows in this time.
Vector3d approached(const Vector3d& present, const Vector3d& wanted, const std::optional<double>& greatest_rate, double time_step) {
  const Vector3d change = wanted - present;
  if (!greatest_rate || change.norm() <= *greatest_rate * time_step) return wanted;
  return present + limited(change, *greatest_rate * time_step);
}

Quaterniond exponential(const Vector3d& rotation) {
  const double angle = rotation.norm();
  return angle > 0 ? Quaterniond(Eigen::AngleAxisd(angle, rotation / angle)) : Quaterniond::Identity();
}

/// Calls `visit` with every number that a state consists of.
template <class State, class Visit>
void visit_numbers(State& state, const Visit& visit) {
  for (auto* vector : {&state.position, &state.velocity, &state.angular_velocity, &state.acceleration, &state.angular_acceleration}) {
    for (int k = 0; k < 3; ++k) visit((*vector)[k]);
  }
  for (int k = 0; k < 4; ++k) visit(state.orientation.coeffs()[k]);
}

}  // namespace

CommandedMotion::CommandedMotion(const CommandCase& limits, const Vector3d& reference, int dimensions)
    : limits_(limits), dimensions_(dimensions) {
  state_.position = reference;
}

void CommandedMotion::command(double time, const Vector3d& velocity, const Vector3d& angular_velocity) {
  wanted_velocity_ = velocity;
  wanted_angular_velocity_ = angular_velocity;
  if (dimensions_ == 2) {
    wanted_velocity_.y() = 0;
    wanted_angular_velocity_.x() = wanted_angular_velocity_.z() = 0;
  }
  wanted_velocity_ = limited(wanted_velocity_, limits_.greatest_speed);
  wanted_angular_velocity_ = limited(wanted_angular_velocity_, limits_.greatest_angular_speed);
  commanded_at_ = time;
  commanded_ = true;
}

const RigidState& CommandedMotion::advance(double time, double time_step) {
  if (!(time_step > 0)) return state_;
  const bool brakes = !commanded_ || (limits_.timeout > 0 && time - commanded_at_ >= limits_.timeout);
  const Vector3d none = Vector3d::Zero();
  const RigidState before = state_;
  const Quaterniond to_body = before.orientation.conjugate();
  const Vector3d velocity =
      approached(to_body * before.velocity, brakes ? none : wanted_velocity_, limits_.greatest_acceleration, time_step);
  const Vector3d angular_before = to_body * before.angular_velocity;
  const Vector3d angular =
      approached(angular_before, brakes ? none : wanted_angular_velocity_, limits_.greatest_angular_acceleration, time_step);

  state_.orientation = (before.orientation * exponential(0.5 * time_step * (angular_before + angular))).normalized();
  state_.velocity = state_.orientation * velocity;
  state_.angular_velocity = state_.orientation * angular;
  state_.position += 0.5 * time_step * (before.velocity + state_.velocity);
  state_.acceleration = (state_.velocity - before.velocity) / time_step;
  state_.angular_acceleration = (state_.angular_velocity - before.angular_velocity) / time_step;
  return state_;
}

std::size_t CommandedMotion::saved_size() const { return saved_numbers; }

std::vector<double> CommandedMotion::save() const {
  std::vector<double> values;
  visit_numbers(state_, [&](double value) { values.push_back(value); });
  for (const Vector3d* wanted : {&wanted_velocity_, &wanted_angular_velocity_})
    values.insert(values.end(), wanted->data(), wanted->data() + 3);
  values.push_back(commanded_at_);
  values.push_back(commanded_ ? 1.0 : 0.0);
  return values;
}

void CommandedMotion::restore(const std::vector<double>& values) {
  if (values.size() != saved_numbers) {
    throw Error("a commanded motion is restored from " + std::to_string(values.size()) + " numbers; it takes " +
                std::to_string(saved_numbers));
  }
  auto next = values.begin();
  visit_numbers(state_, [&](double& value) { value = *next++; });
  for (Vector3d* wanted : {&wanted_velocity_, &wanted_angular_velocity_}) {
    for (int k = 0; k < 3; ++k) (*wanted)[k] = *next++;
  }
  commanded_at_ = *next++;
  commanded_ = *next++ != 0;
}

}  // namespace wavetank
