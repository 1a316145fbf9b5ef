#include "outside_forces.h"

#include <algorithm>
#include <cmath>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double full_turn = 6.28318530717958647692;

void add(RigidLoad& load, const Vector3d& force, const Vector3d& arm) {
  load.force += force;
  load.torque += arm.cross(force);
}

double factor(const ForceCase& force, double time) {
  if (time < force.from || (force.to && time > *force.to)) return 0;
  return force.frequency == 0 ? 1 : std::sin(full_turn * force.frequency * (time - force.from) + force.phase);
}

}  // namespace

double mobility(const Inertia& inertia, const Quaterniond& orientation, const Vector3d& arm, const Vector3d& direction) {
  if (!(inertia.mass > 0)) return 0;
  const Vector3d lever = arm.cross(direction);
  return 1 / inertia.mass + lever.dot(inertia.inverse_in_world(orientation) * lever);
}

double spring_force(double stiffness, double damping, double stretch, double rate, double mobility, double time_step) {
  return (stiffness * stretch + damping * rate) / (1 + mobility * time_step * (0.5 * damping + 0.25 * time_step * stiffness));
}

OutsideForces::OutsideForces(const RigidCase& rigid, const Vector3d& reference, const Vector3d& tank_reference, bool anchored,
                             const std::string& what)
    : forces_(rigid.forces), moorings_(rigid.moorings), reference_(reference), tank_reference_(tank_reference), anchored_(anchored) {
  for (std::size_t m = 0; m < moorings_.size(); ++m) {
    const double distance = (moorings_[m].attachment - moorings_[m].anchor).norm();
    if (!(distance > 0) && !moorings_[m].length)
      throw Error(what + ": the anchor and the attachment of mooring " + std::to_string(m) +
                  " (counted from 0) are the same point, so that its length is not known; move one or give its length in m");
    lengths_.push_back(moorings_[m].length.value_or(distance));
  }
}

RigidLoad OutsideForces::at(double time, double time_step, const RigidState& middle, const Inertia& inertia, const RigidState& tank,
                            const Inertia& tank_inertia, RigidLoad& on_tank) const {
  RigidLoad load;
  for (const ForceCase& force : forces_) {
    const double size = factor(force, time);
    const Quaterniond turn = force.turns_with_body ? middle.orientation : Quaterniond::Identity();
    const Vector3d arm = force.point ? Vector3d(middle.orientation * (*force.point - reference_)) : Vector3d(Vector3d::Zero());
    add(load, size * (turn * force.force), arm);
    load.torque += size * (turn * force.torque);
  }
  for (std::size_t m = 0; m < moorings_.size(); ++m) {
    const RigidLoad part = pull(moorings_[m], lengths_[m], time_step, middle, inertia, tank, tank_inertia, on_tank);
    load.force += part.force;
    load.torque += part.torque;
  }
  if (time <= wrench.until) {
    const Quaterniond turn = wrench.turns_with_body ? middle.orientation : Quaterniond::Identity();
    load.force += turn * wrench.force;
    load.torque += turn * wrench.torque;
  }
  return load;
}

RigidLoad OutsideForces::pull(const MooringCase& mooring, double length, double time_step, const RigidState& middle, const Inertia& inertia,
                              const RigidState& tank, const Inertia& tank_inertia, RigidLoad& on_tank) const {
  const Vector3d end = middle.moved(mooring.attachment, reference_);
  const Vector3d anchor = anchored_ ? tank.moved(mooring.anchor, tank_reference_) : mooring.anchor;
  const Vector3d line = anchor - end;
  const double distance = line.norm();
  RigidLoad load;
  if (!(distance > 0)) return load;  // no direction to pull in
  const Vector3d direction = line / distance;
  const Vector3d anchor_velocity = anchored_ ? tank.velocity_at(anchor) : Vector3d(Vector3d::Zero());
  const double rate = direction.dot(anchor_velocity - middle.velocity_at(end));
  const double stretch = distance - length;
  if (mooring.slack && stretch <= 0) return load;
  double answer = mobility(inertia, middle.orientation, end - middle.position, direction);
  if (anchored_) answer += mobility(tank_inertia, tank.orientation, anchor - tank.position, direction);
  double force = spring_force(mooring.stiffness, mooring.damping, stretch, rate, answer, time_step);
  if (mooring.slack) force = std::max(force, 0.0);
  add(load, force * direction, end - middle.position);
  if (anchored_) add(on_tank, -force * direction, anchor - tank.position);
  return load;
}

}  // namespace wavetank
