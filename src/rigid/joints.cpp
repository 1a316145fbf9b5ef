#include "joints.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "number_text.h"
#include "outside_forces.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The rotation vector of a quaternion, by the shorter way.
Vector3d rotation_of(const Quaterniond& turn) {
  const double sign = turn.w() < 0 ? -1 : 1, sine = turn.vec().norm();
  if (sine < 1e-12) return 2 * sign * turn.vec();
  return sign * 2 * std::atan2(sine, sign * turn.w()) / sine * turn.vec();
}

/// Two unit vectors across an axis; in 2-D the one in the plane.
std::vector<Vector3d> across(const Vector3d& axis, int dimensions) {
  if (dimensions == 2) return {axis.cross(Vector3d::UnitY()).normalized()};
  const Vector3d first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

}  // namespace

double Joint::Coordinate::rate(const RigidState& child, const RigidState& parent) const {
  return linear.dot(child.velocity - parent.velocity) + angular_child.dot(child.angular_velocity) -
         angular_parent.dot(parent.angular_velocity);
}

Joint::Joint(const JointCase& joint, const JointEnd& child, const JointEnd& parent, int dimensions)
    : joint_(joint), child_(child), parent_(parent), dimensions_(dimensions) {
  const std::string what = "joint '" + joint.name + "'";
  const bool has_axis = joint.type == JointType::hinge || joint.type == JointType::slider;
  if (has_axis) {
    if (!(joint.axis.norm() > 0) || !joint.axis.allFinite())
      throw Error(what + ": its axis has no direction; give one of any length but 0");
    axis_ = joint.axis.normalized();
    if (dimensions == 2 && (joint.type == JointType::hinge) != (std::abs(axis_.y()) == 1))
      throw Error(what + ": in two dimensions a hinge turns about y, and a slider's axis lies in the x–z plane");
  }
  if (joint.limits && !((*joint.limits)[0] <= (*joint.limits)[1]))
    throw Error(what + ": its lower limit " + number_text((*joint.limits)[0]) + " is above its upper limit " +
                number_text((*joint.limits)[1]));
  if (joint.type == JointType::spring) {
    if (!joint.parent_point) throw Error(what + ": a spring needs parent_point, the place of its other end");
    const double distance = (joint.point - *joint.parent_point).norm();
    if (!(distance > 0) && !joint.length)
      throw Error(what + ": both of its ends are at the same place, so that its length is not known; move one or give its length in m");
    length_ = joint.length.value_or(distance);
  }
  const std::size_t turning = dimensions == 2 ? 1 : 3, moving = dimensions == 2 ? 2 : 3;
  const auto lock = [&](std::size_t count) { bounds_.insert(bounds_.end(), count, Bounds{}); };
  switch (joint.type) {
    case JointType::fixed:
      lock(moving + turning);
      break;
    case JointType::hinge:
    case JointType::slider:
      lock(moving + turning - 1);
      break;
    case JointType::ball:
      lock(moving);
      break;
    case JointType::spring:
      break;
    case JointType::six_dof:
      for (int k = 0; k < 6; ++k) {
        if (dimensions == 2 && (k == 1 || k == 3 || k == 5)) continue;
        const auto& limits = joint.six_limits[k];
        if (limits && !((*limits)[0] <= (*limits)[1])) throw Error(what + ": a lower limit is above its upper limit");
        bounds_.push_back(limits ? Bounds{(*limits)[0], (*limits)[1]} : Bounds{-infinite, infinite});
      }
      break;
  }
  if (has_axis) bounds_.push_back(joint.limits ? Bounds{(*joint.limits)[0], (*joint.limits)[1]} : Bounds{-infinite, infinite});
}

bool Joint::holds_together() const {
  if (joint_.type == JointType::spring) return false;
  if (joint_.type != JointType::six_dof) return true;
  return std::all_of(bounds_.begin(), bounds_.begin() + (dimensions_ == 2 ? 2 : 3), [](const Bounds& bounds) { return bounds.locked(); });
}

Joint::Coordinate Joint::along(const Vector3d& direction, const std::vector<RigidState>& states) const {
  const RigidState &child = states[child_.frame], &parent = states[parent_.frame];
  const Vector3d end = child.moved(joint_.point, child_.reference), n = parent.orientation * direction;
  return {n.dot(end - parent.moved(joint_.point, parent_.reference)), n, (end - child.position).cross(n), (end - parent.position).cross(n)};
}

Joint::Coordinate Joint::tilt(const Vector3d& direction, const std::vector<RigidState>& states) const {
  const Quaterniond &child = states[child_.frame].orientation, &parent = states[parent_.frame].orientation;
  const Vector3d n = parent * direction;
  return {n.dot((parent * axis_).cross(child * axis_)), Vector3d::Zero(), n, n};
}

std::array<Joint::Coordinate, 3> Joint::turns(const std::vector<RigidState>& states) const {
  const Quaterniond& parent = states[parent_.frame].orientation;
  const Vector3d rotation = rotation_of(parent.conjugate() * states[child_.frame].orientation);
  std::array<Coordinate, 3> result;
  for (int k = 0; k < 3; ++k) {
    const Vector3d n = parent * Vector3d::Unit(k);
    result[k] = {rotation[k], Vector3d::Zero(), n, n};
  }
  return result;
}

std::array<Joint::Coordinate, 3> Joint::rotations(const std::vector<RigidState>& states) const {
  const Quaterniond& parent = states[parent_.frame].orientation;
  const Eigen::Matrix3d turn = (parent.conjugate() * states[child_.frame].orientation).toRotationMatrix();
  const double pitch = std::asin(std::clamp(-turn(2, 0), -1.0, 1.0));
  const double roll = std::atan2(turn(2, 1), turn(2, 2)), yaw = std::atan2(turn(1, 0), turn(0, 0));
  // ω = roll' a + pitch' b + yaw' c about axes that are not square to each other: the angles' rates are ω's products with the reciprocal
  // axes, which grow without bound towards a pitch of 90°.
  const double cosine = std::max(std::cos(pitch), 1e-3);
  const Vector3d a(std::cos(yaw) * cosine, std::sin(yaw) * cosine, -std::sin(pitch)), b(-std::sin(yaw), std::cos(yaw), 0);
  const Vector3d c = Vector3d::UnitZ();
  const double volume = a.dot(b.cross(c));
  const std::array<double, 3> values{roll, pitch, yaw};
  const std::array<Vector3d, 3> reciprocal{b.cross(c) / volume, c.cross(a) / volume, a.cross(b) / volume};
  std::array<Coordinate, 3> result;
  for (int k = 0; k < 3; ++k) {
    const Vector3d n = parent * reciprocal[k];
    result[k] = {values[k], Vector3d::Zero(), n, n};
  }
  return result;
}

Joint::Coordinate Joint::stretched(const std::vector<RigidState>& states) const {
  const RigidState &child = states[child_.frame], &parent = states[parent_.frame];
  const Vector3d end = child.moved(joint_.point, child_.reference), other = parent.moved(*joint_.parent_point, parent_.reference);
  const double length = (end - other).norm();
  if (!(length > 0)) return {};  // no direction to pull in
  const Vector3d n = (end - other) / length;
  return {length, n, (end - child.position).cross(n), (other - parent.position).cross(n)};
}

Joint::Coordinate Joint::free_one(const std::vector<RigidState>& states) const {
  if (joint_.type == JointType::slider) return along(axis_, states);
  const Quaterniond relative = states[parent_.frame].orientation.conjugate() * states[child_.frame].orientation;
  const Vector3d n = states[parent_.frame].orientation * axis_;
  const double wrapped = 2 * std::atan2(relative.vec().dot(axis_), relative.w());
  return {angle + std::remainder(wrapped - angle, 2 * pi), Vector3d::Zero(), n, n};
}

std::vector<Joint::Coordinate> Joint::bounded(const std::vector<RigidState>& states, const Eigen::Matrix3d& axes) const {
  std::vector<Coordinate> result;
  const bool plane = dimensions_ == 2;
  const auto add_turns = [&](const std::array<Coordinate, 3>& all) {
    for (int k = 0; k < 3; ++k)
      if (!plane || k == 1) result.push_back(all[k]);
  };
  if (joint_.type == JointType::spring) return result;
  if (joint_.type == JointType::slider) {
    for (const Vector3d& direction : across(axis_, dimensions_)) result.push_back(along(direction, states));
  } else {
    const Eigen::Matrix3d directions = joint_.type == JointType::six_dof ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : axes;
    for (int k = 0; k < 3; ++k)
      if (!plane || k != 1) result.push_back(along(directions.col(k), states));
  }
  if (joint_.type == JointType::fixed || joint_.type == JointType::slider) add_turns(turns(states));
  if (joint_.type == JointType::six_dof && plane) result.push_back(free_one(states));
  if (joint_.type == JointType::six_dof && !plane) add_turns(rotations(states));
  if (joint_.type == JointType::hinge && !plane)
    for (const Vector3d& direction : across(axis_, dimensions_)) result.push_back(tilt(direction, states));
  if (joint_.type == JointType::hinge || joint_.type == JointType::slider) result.push_back(free_one(states));
  return result;
}

double Joint::answer(const Coordinate& a, const Coordinate& b, const std::vector<RigidState>& states,
                     const std::vector<Inertia>& inertias) const {
  double sum = 0;
  const auto add = [&](int frame, const Vector3d& first, const Vector3d& second) {
    const Inertia& inertia = inertias[frame];
    if (!(inertia.mass > 0)) return;
    sum += a.linear.dot(b.linear) / inertia.mass + first.dot(inertia.inverse_in_world(states[frame].orientation) * second);
  };
  add(child_.frame, a.angular_child, b.angular_child);
  add(parent_.frame, a.angular_parent, b.angular_parent);
  return sum;
}

/// The axes, fixed to the parent, along which the joint's point answers to forces in their own direction, so that its rows do not fight.
Eigen::Matrix3d Joint::settled_axes(const std::vector<RigidState>& states, const std::vector<Inertia>& inertias) const {
  std::array<Coordinate, 3> unit;
  for (int k = 0; k < 3; ++k) unit[k] = along(Vector3d::Unit(k), states);
  Eigen::Matrix3d mobility;
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) mobility(k, l) = answer(unit[k], unit[l], states, inertias);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (dimensions_ == 2) {
    const double turn = 0.5 * std::atan2(2 * mobility(0, 2), mobility(0, 0) - mobility(2, 2));
    axes.col(0) = Vector3d(std::cos(turn), 0, std::sin(turn));
    axes.col(2) = Vector3d(-std::sin(turn), 0, std::cos(turn));
  } else {
    axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(mobility).eigenvectors();
  }
  return axes;
}

double Joint::wanted(double time) const {
  const JointCommandCase& limits = *joint_.command;
  if (!command.given || (limits.timeout > 0 && time - command.at >= limits.timeout)) return 0;
  const double greatest = (limits.quantity == JointQuantity::effort ? limits.greatest_effort : limits.greatest_velocity).value_or(infinite);
  return std::clamp(command.value, -greatest, greatest);
}

/// A velocity that is commanded, by an effort within its limit; not on through the joint's own limits.
void Joint::add_drive(const StepStates& states, double time, double time_step, std::vector<JointRow>& rows) const {
  if (!joint_.command || joint_.command->quantity != JointQuantity::velocity) return;
  const Coordinate start = free_one(states.start), middle = free_one(states.middle);
  JointRow row{child_.frame, parent_.frame, middle.linear, middle.angular_child, middle.angular_parent};
  row.target = wanted(time);
  if (joint_.limits) {
    const double least = ((*joint_.limits)[0] - start.value) / time_step, greatest = ((*joint_.limits)[1] - start.value) / time_step;
    row.target = std::clamp(row.target, std::min(least, 0.0), std::max(greatest, 0.0));
  }
  if (joint_.command->greatest_effort) {
    row.greatest_impulse = *joint_.command->greatest_effort * time_step;
    row.least_impulse = -row.greatest_impulse;
  }
  rows.push_back(row);
}

void Joint::add_rows(const StepStates& states, const std::vector<Inertia>& inertias, double time, double time_step, double correction,
                     std::vector<JointRow>& rows) const {
  add_drive(states, time, time_step, rows);
  const Eigen::Matrix3d axes = settled_axes(states.middle, inertias);
  const std::vector<Coordinate> start = bounded(states.start, axes), middle = bounded(states.middle, axes), end = bounded(states.end, axes);
  for (std::size_t k = 0; k < bounds_.size(); ++k) {
    const Bounds& bounds = bounds_[k];
    if (std::isinf(bounds.least) && std::isinf(bounds.greatest)) continue;
    JointRow row{child_.frame, parent_.frame, middle[k].linear, middle[k].angular_child, middle[k].angular_parent};
    const double value = start[k].value;
    if (bounds.locked()) {
      const RigidState &child = states.middle[child_.frame], &parent = states.middle[parent_.frame];
      const double bend = middle[k].rate(child, parent) - end[k].rate(states.end[child_.frame], states.end[parent_.frame]);
      row.target = bend - correction * (value - bounds.least) / time_step;
      rows.push_back(row);
      continue;
    }
    // As a contact: what is apart may come together in this step, and what has gone beyond is pushed back.
    const auto limit = [&](double gap, double side) {
      row.target = side * -std::max(gap, 0.0) / time_step;
      row.push = side * std::max(-gap, 0.0) * correction / time_step;
      row.least_impulse = side > 0 ? 0 : -1e300;
      row.greatest_impulse = side > 0 ? 1e300 : 0;
      rows.push_back(row);
    };
    if (!std::isinf(bounds.least)) limit(value - bounds.least, 1);
    if (!std::isinf(bounds.greatest)) limit(bounds.greatest - value, -1);
  }
}

/// How the coordinate answers to its own force while the joint's locked ones hold.
double Joint::free_mobility(const Coordinate& coordinate, const std::vector<RigidState>& states,
                            const std::vector<Inertia>& inertias) const {
  const std::vector<Coordinate> all = bounded(states, Eigen::Matrix3d::Identity());
  std::vector<Coordinate> locked;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (bounds_[k].locked()) locked.push_back(all[k]);
  const Eigen::Index count = static_cast<Eigen::Index>(locked.size());
  Eigen::MatrixXd held(count, count);
  Eigen::VectorXd cross(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    cross[k] = answer(locked[k], coordinate, states, inertias);
    for (Eigen::Index l = 0; l < count; ++l) held(k, l) = answer(locked[k], locked[l], states, inertias);
  }
  const double whole = answer(coordinate, coordinate, states, inertias);
  return count == 0 ? whole : std::max(whole - cross.dot(held.ldlt().solve(cross)), 0.0);
}

void Joint::add_loads(const StepStates& states, const std::vector<Inertia>& inertias, double time, double time_step,
                      std::vector<RigidLoad>& loads) const {
  add_spring(states, inertias, time_step, loads);
  if (!joint_.command || joint_.command->quantity != JointQuantity::effort) return;
  const double effort = wanted(time);
  if (effort == 0) return;
  const Coordinate coordinate = free_one(states.middle);
  loads[child_.frame].force += effort * coordinate.linear;
  loads[child_.frame].torque += effort * coordinate.angular_child;
  loads[parent_.frame].force -= effort * coordinate.linear;
  loads[parent_.frame].torque -= effort * coordinate.angular_parent;
}

void Joint::add_spring(const StepStates& states, const std::vector<Inertia>& inertias, double time_step,
                       std::vector<RigidLoad>& loads) const {
  if (joint_.stiffness == 0 && joint_.damping == 0) return;
  const bool is_spring = joint_.type == JointType::spring;
  const Coordinate coordinate = is_spring ? stretched(states.middle) : free_one(states.middle);
  const double rate = coordinate.rate(states.middle[child_.frame], states.middle[parent_.frame]);
  const double stretch = coordinate.value - (is_spring ? length_ : 0.0);
  const double mobility = free_mobility(coordinate, states.middle, inertias);
  const double force = spring_force(joint_.stiffness, joint_.damping, stretch, rate, mobility, time_step);
  // The row's lever arms are about the centres, so that its angular parts are the torques of a unit force.
  loads[child_.frame].force -= force * coordinate.linear;
  loads[child_.frame].torque -= force * coordinate.angular_child;
  loads[parent_.frame].force += force * coordinate.linear;
  loads[parent_.frame].torque += force * coordinate.angular_parent;
}

JointState Joint::state(const std::vector<RigidState>& states) const {
  JointState result;
  const bool is_spring = joint_.type == JointType::spring;
  if (!is_spring && joint_.type != JointType::hinge && joint_.type != JointType::slider) return result;
  const Coordinate coordinate = is_spring ? stretched(states) : free_one(states);
  result.position = coordinate.value;
  result.velocity = coordinate.rate(states[child_.frame], states[parent_.frame]);
  result.effort = -joint_.stiffness * (result.position - (is_spring ? length_ : 0.0)) - joint_.damping * result.velocity;
  return result;
}

void Joint::follow(const std::vector<RigidState>& states) {
  if (joint_.type == JointType::hinge || (joint_.type == JointType::six_dof && dimensions_ == 2)) angle = free_one(states).value;
}

}  // namespace wavetank
