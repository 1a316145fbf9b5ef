#include "outside_forces.h"

#include <algorithm>
#include <cmath>

#include "number_text.h"
#include "roots.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double full_turn = 6.28318530717958647692;
constexpr int drawn_places = 25;   // on a catenary
constexpr int implicit_bits = 30;  // of a catenary's pull

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

OutsideForces::OutsideForces(const RigidCase& rigid, const Vector3d& gravity, const Vector3d& reference, const Vector3d& tank_reference,
                             bool anchored, const std::string& what)
    : forces_(rigid.forces),
      moorings_(rigid.moorings),
      up_(gravity.isZero(0.0) ? gravity : Vector3d(-gravity.normalized())),
      reference_(reference),
      tank_reference_(tank_reference),
      anchored_(anchored),
      what_(what) {
  for (std::size_t m = 0; m < moorings_.size(); ++m) {
    const double distance = (moorings_[m].attachment - moorings_[m].anchor).norm();
    if (!(distance > 0) && !moorings_[m].length)
      throw Error(what + ": the anchor and the attachment of mooring " + std::to_string(m) +
                  " (counted from 0) are the same point, so that its length is not known; move one or give its length in m");
    lengths_.push_back(moorings_[m].length.value_or(distance));
    if (moorings_[m].line != MooringLine::catenary) continue;
    if (up_.isZero(0.0)) throw Error(what + ": mooring " + std::to_string(m) + " (counted from 0) is a catenary, which needs gravity");
    catenary_pull_of(m, moorings_[m].attachment - moorings_[m].anchor);
  }
  if (!rigid.wind) return;
  wind_.emplace(*rigid.wind);
  wind_centre_ = rigid.wind->centre.value_or(reference);
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
    const RigidLoad part = moorings_[m].line == MooringLine::catenary
                               ? pull_catenary(m, time_step, middle, inertia, tank, tank_inertia, on_tank)
                               : pull(moorings_[m], lengths_[m], time_step, middle, inertia, tank, tank_inertia, on_tank);
    load.force += part.force;
    load.torque += part.torque;
  }
  if (wind_) {
    const Vector3d centre = middle.moved(wind_centre_, reference_);
    add(load, wind_->force(time, middle.velocity_at(centre)), centre - middle.position);
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
  const auto [anchor, end, anchor_velocity, end_velocity] = ends_of(mooring, middle, tank);
  const Vector3d line = anchor - end;
  const double distance = line.norm();
  RigidLoad load;
  if (!(distance > 0)) return load;  // no direction to pull in
  const Vector3d direction = line / distance;
  const double rate = direction.dot(anchor_velocity - end_velocity);
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

OutsideForces::Ends OutsideForces::ends_of(const MooringCase& mooring, const RigidState& body, const RigidState& tank) const {
  Ends ends;
  ends.end = body.moved(mooring.attachment, reference_);
  ends.anchor = anchored_ ? tank.moved(mooring.anchor, tank_reference_) : mooring.anchor;
  ends.end_velocity = body.velocity_at(ends.end);
  ends.anchor_velocity = anchored_ ? tank.velocity_at(ends.anchor) : Vector3d(Vector3d::Zero());
  return ends;
}

Catenary OutsideForces::catenary(std::size_t mooring) const {
  const MooringCase& line = moorings_[mooring];
  return {lengths_[mooring], line.weight, line.axial_stiffness ? 1 / *line.axial_stiffness : 0.0, line.bed};
}

CatenaryPull OutsideForces::catenary_pull_of(std::size_t mooring, const Vector3d& way) const {
  const double rise = up_.dot(way), span = (way - rise * up_).norm();
  const std::optional<CatenaryPull> pull = catenary_pull(catenary(mooring), span, rise);
  if (!pull)
    throw Error(what_ + ": mooring " + std::to_string(mooring) + " (counted from 0) is taut: its ends are " + number_text(way.norm()) +
                " m apart, and its length of " + number_text(lengths_[mooring]) +
                " m does not stretch; give its axial_stiffness, or make it longer");
  return *pull;
}

Vector3d OutsideForces::beside(const Vector3d& way) const {
  const Vector3d across = way - up_.dot(way) * up_;
  const double span = across.norm();
  return span > 0 ? Vector3d(across / span) : Vector3d(Vector3d::Zero());
}

Vector3d OutsideForces::force_on_top(const CatenaryPull& pull, const Vector3d& way) const {
  return -pull.vertical * up_ - pull.horizontal * beside(way);
}

RigidLoad OutsideForces::pull_catenary(std::size_t mooring, double time_step, const RigidState& middle, const Inertia& inertia,
                                       const RigidState& tank, const Inertia& tank_inertia, RigidLoad& on_tank) const {
  const Ends ends = ends_of(moorings_[mooring], middle, tank);
  const Vector3d way = ends.end - ends.anchor;
  const CatenaryPull pull = catenary_pull_of(mooring, way);
  const Vector3d force = force_on_top(pull, way);
  RigidLoad load;
  const double size = force.norm();
  if (!(size > 0)) return load;
  // Implicit in its own motion, as springs are: the pull is that at the end of the way that it gives within half the step.
  const Vector3d direction = force / size;
  double answer = mobility(inertia, middle.orientation, ends.end - middle.position, direction);
  if (anchored_) answer += mobility(tank_inertia, tank.orientation, ends.anchor - tank.position, direction);
  const double give = 0.25 * answer * time_step * time_step;
  const auto more_than_pulls = [&](double pulled) {
    const Vector3d nearer = way + give * pulled * direction;
    return pulled - force_on_top(catenary_pull_of(mooring, nearer), nearer).dot(direction);
  };
  const double part = zero_of(more_than_pulls, 0.0, size, implicit_bits) / size;
  add(load, part * force, ends.end - middle.position);
  if (!anchored_) return load;
  // The tank holds the anchor and, as the bed, bears what lies on it.
  const Vector3d arm = ends.anchor - tank.position, along = beside(way);
  add(on_tank, part * (pull.horizontal * along + pull.anchor_vertical * up_), arm);
  add(on_tank, -moorings_[mooring].weight * pull.lying * up_, arm + 0.5 * pull.lying * along);
  return load;
}

std::vector<MooringState> OutsideForces::moorings(const RigidState& body, const RigidState& tank) const {
  std::vector<MooringState> states;
  const auto in_tank = [&](const Vector3d& place) -> Vector3d {
    return tank.orientation.conjugate() * (place - tank.position) + tank_reference_;
  };
  for (std::size_t m = 0; m < moorings_.size(); ++m) {
    const MooringCase& mooring = moorings_[m];
    const Ends ends = ends_of(mooring, body, tank);
    const Vector3d way = ends.end - ends.anchor;
    MooringState state;
    if (mooring.line == MooringLine::spring) {
      const double distance = way.norm(), stretch = distance - lengths_[m];
      const double rate = distance > 0 ? way.dot(ends.end_velocity - ends.anchor_velocity) / distance : 0.0;
      const double tension = mooring.stiffness * stretch + mooring.damping * rate;
      state.tension = mooring.slack ? (stretch > 0 ? std::max(tension, 0.0) : 0.0) : tension;
      state.anchor_tension = state.tension;
      state.line = {in_tank(ends.anchor), in_tank(ends.end)};
    } else {
      const CatenaryPull pull = catenary_pull_of(m, way);
      state.tension = pull.tension();
      state.anchor_tension = pull.anchor_tension();
      state.lying = pull.lying;
      const double rise = up_.dot(way), span = (way - rise * up_).norm();
      for (const Eigen::Vector2d& place : catenary_shape(catenary(m), span, rise, pull, drawn_places))
        state.line.push_back(in_tank(ends.anchor + place.x() * beside(way) + place.y() * up_));
    }
    states.push_back(std::move(state));
  }
  return states;
}

}  // namespace wavetank
