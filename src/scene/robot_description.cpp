#include "robot_description.h"

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "link_shape.h"
#include "urdf_text.h"
#include "values.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"

namespace wavetank::scene {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;

struct Mass {
  double mass = 0;                      ///< kg
  Vector3d centre = Vector3d::Zero();   ///< m
  Matrix3d inertia = Matrix3d::Zero();  ///< kg·m², about the centre
};

Matrix3d about_distant_point(const Mass& part, const Vector3d& point) {
  const Vector3d arm = part.centre - point;
  return part.inertia + part.mass * (arm.squaredNorm() * Matrix3d::Identity() - arm * arm.transpose());
}

Mass together(const Mass& a, const Mass& b) {
  Mass sum;
  sum.mass = a.mass + b.mass;
  sum.centre = sum.mass > 0 ? Vector3d((a.mass * a.centre + b.mass * b.centre) / sum.mass) : a.centre;
  sum.inertia = about_distant_point(a, sum.centre) + about_distant_point(b, sum.centre);
  return sum;
}

Mass mass_of(const urdf::Inertial& inertial, const Isometry3d& place) {
  const Isometry3d at = place * transform_of(inertial.origin);
  Mass mass;
  mass.mass = inertial.mass;
  mass.centre = at.translation();
  mass.inertia << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz, inertial.ixz, inertial.iyz,
      inertial.izz;
  mass.inertia = (at.linear() * mass.inertia * at.linear().transpose()).eval();
  return mass;
}

/// Links that fixed joints make one, and what becomes of them.
struct Group {
  bool stands = false;            ///< fixed to the tank
  urdf::LinkConstSharedPtr top;   ///< whose joint, if any, is the group's
  urdf::LinkConstSharedPtr head;  ///< the first one with a shape, which takes the masses of those above it; null if there is none
};

class Robot {
 public:
  Robot(const std::string& urdf, const std::string& source, const std::string& directory, const RobotCase& placement)
      : source_(source), directory_(directory), placement_(placement), links_(read_links(urdf, source)) {
    for (const urdf::LinkConstSharedPtr& link : links_) place(*link);
    for (const urdf::LinkConstSharedPtr& link : links_) enter_group(link);
    for (const urdf::LinkConstSharedPtr& link : links_) weigh(*link);
  }

  RobotParts parts() const {
    RobotParts parts;
    for (const urdf::LinkConstSharedPtr& link : links_) {
      if (has_shape(*link)) parts.bodies.push_back(body(*link));
      if (link->parent_joint) add_joint(*link, parts.joints);
    }
    if (parts.bodies.empty()) throw Error(source_ + ": no link of the robot has a shape (collision or visual); give at least one");
    return parts;
  }

 private:
  std::string named(const urdf::Link& link) const { return source_ + ": link '" + link.name + "'"; }
  std::string named(const urdf::Joint& joint) const { return source_ + ": joint '" + joint.name + "'"; }
  const Isometry3d& place_of(const urdf::Link& link) const { return places_.at(link.name); }
  const Group& group_of(const urdf::Link& link) const { return groups_[group_indices_.at(link.name)]; }

  void place(const urdf::Link& link) {
    Isometry3d place;
    if (link.parent_joint) {
      place = place_of(*link.getParent()) * transform_of(link.parent_joint->parent_to_joint_origin_transform);
    } else {
      const Vector3d& angles = placement_.rotation;
      place = Eigen::Translation3d(placement_.position) * Eigen::AngleAxisd(angles.z(), Vector3d::UnitZ()) *
              Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) * Eigen::AngleAxisd(angles.x(), Vector3d::UnitX());
    }
    if (!place.matrix().allFinite()) throw Error(named(link) + " is at a place that is not finite; give its joint's origin finite numbers");
    places_.emplace(link.name, place);
  }

  void enter_group(const urdf::LinkConstSharedPtr& link) {
    const bool joins = link->parent_joint && link->parent_joint->type == urdf::Joint::FIXED;
    if (joins) {
      group_indices_[link->name] = group_indices_.at(link->getParent()->name);
    } else {
      group_indices_[link->name] = groups_.size();
      Group group;
      group.top = link;
      group.stands = !link->parent_joint && (placement_.motion == Motion::fixed || link->name == "world");
      groups_.push_back(group);
    }
    Group& group = groups_[group_indices_[link->name]];
    if (!group.head && has_shape(*link)) group.head = link;
  }

  /// The link whose body a link belongs to; null if there is none.
  const urdf::Link* carrier(const urdf::Link& link) const {
    const Group& group = group_of(link);
    for (const urdf::Link* above = &link;; above = above->getParent().get()) {
      if (has_shape(*above)) return above;
      if (above == group.top.get()) return group.head.get();
    }
  }

  void weigh(const urdf::Link& link) {
    if (!link.inertial) return;
    const Mass mass = mass_of(*link.inertial, place_of(link));
    if (!(mass.mass >= 0) || !std::isfinite(mass.mass) || !mass.centre.allFinite() || !mass.inertia.allFinite())
      throw Error(named(link) + " has a mass of " + number_text(mass.mass) +
                  "; mass and inertia must be finite, and the mass at least 0 (kg)");
    const urdf::Link* const body = carrier(link);
    if (body != nullptr) {
      masses_[body->name] = together(masses_[body->name], mass);
    } else if (!group_of(link).stands && mass.mass > 0) {
      refuse_shapeless(link);
    }
  }

  [[noreturn]] void refuse_shapeless(const urdf::Link& link) const {
    throw Error(named(link) + " moves but has no shape, nor has any link that is fixed to it; give it a collision or visual element");
  }

  BodyCase body(const urdf::Link& link) const {
    BodyCase body;
    body.name = link.name;
    body.shape = link_shape(link, place_of(link), directory_, named(link));
    if (group_of(link).stands) return body;
    body.motion = Motion::free;
    const auto weighed = masses_.find(link.name);
    if (weighed == masses_.end() || !(weighed->second.mass > 0))
      throw Error(named(link) + " moves but has no mass; give it an inertial element with a mass greater than 0 (kg)");
    const Mass& mass = weighed->second;
    const Matrix3d& inertia = mass.inertia;
    if (!(Eigen::SelfAdjointEigenSolver<Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() > 0))
      throw Error(named(link) + " moves but its inertia is not positive definite; give it moments of inertia greater than 0 (kg·m²)");
    body.rigid.mass = mass.mass;
    body.rigid.centre_of_mass = mass.centre;
    body.rigid.inertia = {inertia(0, 0), inertia(1, 1), inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2)};
    return body;
  }

  /// The joint above a link, if it is one of the case too.
  void add_joint(const urdf::Link& link, std::vector<JointCase>& joints) const {
    const urdf::Joint& from = *link.parent_joint;
    const Group& group = group_of(link);
    if (from.type == urdf::Joint::FIXED) {
      const bool apart = has_shape(link) && group.head.get() != &link && !group.stands;
      if (apart) joints.push_back(joint(link, JointType::fixed));
      return;
    }
    if (!group.head) refuse_shapeless(link);
    switch (from.type) {
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        joints.push_back(joint(link, JointType::hinge));
        break;
      case urdf::Joint::PRISMATIC:
        joints.push_back(joint(link, JointType::slider));
        break;
      case urdf::Joint::FLOATING:
        break;
      default:
        throw Error(named(from) + " is planar, which joints here are not; it must be fixed, revolute, continuous, prismatic or floating");
    }
  }

  JointCase joint(const urdf::Link& link, JointType type) const {
    const urdf::Joint& from = *link.parent_joint;
    JointCase joint;
    joint.name = from.name;
    joint.type = type;
    joint.parent = parent_name(link);
    joint.child = carrier(link)->name;
    joint.point = place_of(link).translation();
    if (type == JointType::fixed) return joint;
    if (from.mimic) throw Error(named(from) + " mimics joint '" + from.mimic->joint_name + "', which joints here cannot; leave mimic out");
    joint.axis = axis(from, place_of(link));
    joint.limits = limits(from);
    if (from.dynamics) add_dynamics(from, joint);
    joint.command = command(from);
    return joint;
  }

  /// What of it the case leaves out is the URDF's own limit, of which 0 is none.
  std::optional<JointCommandCase> command(const urdf::Joint& from) const {
    for (const RobotCommandCase& wanted : placement_.commands) {
      if (wanted.joint != from.name) continue;
      JointCommandCase command = wanted;
      if (!from.limits) return command;
      if (!command.greatest_effort) command.greatest_effort = limit(from, "effort", from.limits->effort);
      if (!command.greatest_velocity && command.quantity == JointQuantity::velocity)
        command.greatest_velocity = limit(from, "velocity", from.limits->velocity);
      return command;
    }
    return std::nullopt;
  }

  std::optional<double> limit(const urdf::Joint& from, const std::string& what, double value) const {
    if (!(value >= 0) || !std::isfinite(value))
      throw Error(named(from) + " has the limit " + what + " " + number_text(value) + "; it must be a number at least 0");
    return value > 0 ? std::optional<double>(value) : std::nullopt;
  }

  std::string parent_name(const urdf::Link& link) const {
    const urdf::Link& above = *link.getParent();
    if (const urdf::Link* const body = carrier(above)) return body->name;
    if (group_of(above).stands) return "tank";
    throw Error(named(*link.parent_joint) + " hangs on link '" + above.name +
                "', which has no shape and is free; give that one a shape and a mass, name the root link world, or set motion to fixed");
  }

  Vector3d axis(const urdf::Joint& from, const Isometry3d& place) const {
    const Vector3d axis = place.linear() * Vector3d(from.axis.x, from.axis.y, from.axis.z);
    if (!axis.allFinite() || !(axis.norm() > 0))
      throw Error(named(from) + " has an axis without a direction; give one of any length but 0");
    return axis.normalized();
  }

  std::optional<std::array<double, 2>> limits(const urdf::Joint& from) const {
    if (from.type == urdf::Joint::CONTINUOUS || !from.limits) return std::nullopt;
    const double lower = from.limits->lower, upper = from.limits->upper;
    if (!(lower <= 0 && upper >= 0) || !std::isfinite(lower) || !std::isfinite(upper)) {
      throw Error(named(from) + " has the limits " + number_text(lower) + " and " + number_text(upper) +
                  "; they must be finite, with 0, where it begins, at or between them");
    }
    return std::array<double, 2>{lower, upper};
  }

  void add_dynamics(const urdf::Joint& from, JointCase& joint) const {
    joint.damping = from.dynamics->damping;
    if (!(joint.damping >= 0) || !std::isfinite(joint.damping))
      throw Error(named(from) + " has a damping of " + number_text(joint.damping) + "; it must be a number at least 0");
    if (from.dynamics->friction != 0)
      log(LogLevel::warning, named(from) + " has friction, which is left out; joints here have damping only");
  }

  const std::string& source_;
  const std::string& directory_;
  const RobotCase& placement_;
  std::vector<urdf::LinkConstSharedPtr> links_;
  std::map<std::string, Isometry3d> places_;  ///< of links' frames, by name
  std::vector<Group> groups_;
  std::map<std::string, std::size_t> group_indices_;  ///< by link
  std::map<std::string, Mass> masses_;                ///< by the body's link
};

}  // namespace

RobotParts robot_parts(const std::string& urdf, const std::string& source, const std::string& directory, const RobotCase& placement) {
  return Robot(urdf, source, directory, placement).parts();
}

}  // namespace wavetank::scene
