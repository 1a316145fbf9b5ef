#include "wavetank/rigid/rigid_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "rigid_world_parts.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double mark = 4.0919e5;  // opens what save() returns

std::vector<double> values_of(const std::vector<char>& saved) {
  std::vector<double> values(saved.size() / sizeof(double));
  std::memcpy(values.data(), saved.data(), values.size() * sizeof(double));
  return values;
}

/// What a wrench alone makes of a free body, m/s²: α = I⁻¹ τ at the radius of gyration about it, √(α·I α/(m α²)), is √(τ·I⁻¹ τ/m).
double acceleration_of(const RigidOwner& body, const OutsideWrench& wrench) {
  const Inertia& inertia = body.inertia;
  const Eigen::Matrix3d inverse = wrench.turns_with_body ? inertia.own_inverse : inertia.inverse_in_world(body.state.orientation);
  return wrench.force.norm() / inertia.mass + std::sqrt(std::max(wrench.torque.dot(inverse * wrench.torque), 0.0) / inertia.mass);
}

/// Throws Error beyond what is allowed. `what`: "the force from outside on body 'box'".
void check_acceleration(const std::string& what, double acceleration, double greatest) {
  if (acceleration <= greatest) return;  // which what overflows is not
  throw Error(what + " alone would accelerate it at " + number_text(acceleration) + " m/s², beyond " + number_text(greatest) +
              " m/s²: it is ignored, and the one before stays");
}

}  // namespace

RigidWorld::RigidWorld(const Case& settled_case, const Layout& layout, const ResourceResolver& resolve)
    : parts_(std::make_unique<Parts>(settled_case, layout, resolve)) {}
RigidWorld::~RigidWorld() = default;

std::size_t RigidWorld::count() const { return parts_->owners.size(); }
bool RigidWorld::moves(std::size_t owner) const { return parts_->owners.at(owner).motion != Motion::fixed; }
bool RigidWorld::anything_moves() const {
  return std::any_of(parts_->owners.begin(), parts_->owners.end(), [](const RigidOwner& owner) { return owner.motion != Motion::fixed; });
}
bool RigidWorld::is_free(std::size_t owner) const { return parts_->owners.at(owner).is_free(); }
const MassProperties& RigidWorld::properties(std::size_t owner) const { return parts_->owners.at(owner).properties; }
const Vector3d& RigidWorld::reference(std::size_t owner) const { return parts_->owners.at(owner).reference; }
RigidState RigidWorld::state(std::size_t owner) const { return parts_->state(owner); }

RigidState RigidWorld::state_in_tank(std::size_t owner) const {
  const RigidOwner& tank = parts_->owners[0];
  if (tank.motion == Motion::fixed) return state(owner);
  if (parts_->frame_of(owner) == 0) {
    RigidState at_rest;
    at_rest.position = parts_->owners[owner].reference;
    return at_rest;
  }
  return seen_from(tank.state, tank.reference, state(owner));
}

std::vector<RigidState> RigidWorld::at_end(double time, double time_step) const { return parts_->ahead(time, time_step); }

std::vector<RigidState> RigidWorld::at_middle(double time, double time_step) const { return parts_->at_middle(time, time_step); }

void RigidWorld::advance(double time, double time_step, const std::vector<RigidLoad>& fluid) {
  Parts& parts = *parts_;
  std::vector<RigidOwner>& owners = parts.owners;
  if (!anything_moves()) return;
  if (!(time_step > 0) || !std::isfinite(time_step) || !std::isfinite(time))
    throw Error("bodies cannot be moved by a step of " + number_text(time_step) + " s" + parts.at_time(time));
  if (fluid.size() != owners.size())
    throw Error("the fluid's loads are of " + std::to_string(fluid.size()) + " bodies, but the case has " + std::to_string(owners.size()) +
                " with the tank");
  StepStates states{parts.present(), parts.ahead(time, 0.5 * time_step), parts.ahead(time, time_step)};
  std::vector<RigidState> given = states.middle;
  for (std::size_t o = 0; o < owners.size(); ++o) {
    if (!owners[o].commanded) continue;  // its velocity is straight in time within a step, but for where a limit ends
    given[o].velocity = 0.5 * (states.start[o].velocity + states.end[o].velocity);
    given[o].angular_velocity = 0.5 * (states.start[o].angular_velocity + states.end[o].angular_velocity);
  }
  for (auto* list : {&states.start, &states.middle, &states.end}) list->emplace_back();  // the world

  if (parts.contacts) {
    const std::vector<RigidLoad> loads = parts.loads(time, time_step, fluid, states);
    std::vector<FreeMotion> motions(owners.size());
    for (std::size_t o = 0; o < owners.size(); ++o)
      if (owners[o].is_free()) motions[o] = free_motion(owners[o].state, owners[o].inertia, loads[o], time_step);
    const std::vector<BodyChange> changes = parts.changes(time, time_step, states, given, motions);
    for (std::size_t o = 0; o < owners.size(); ++o) {
      if (!owners[o].is_free()) continue;
      owners[o].state = after_step(owners[o].state, motions[o], changes[o], time_step);
      if (!owners[o].state.position.allFinite() || !owners[o].state.orientation.coeffs().allFinite())
        throw Error(owners[o].what + " has no finite place after the step" + parts.at_time(time));
    }
  }
  for (RigidOwner& owner : owners) {
    if (owner.prescribed) owner.state = owner.prescribed_at(time + time_step);
    if (owner.absorption) owner.absorption->advance(time, time_step);
    if (owner.commanded) owner.state = owner.commanded->advance(time, time_step);
  }
  std::vector<RigidState> now = parts.present();
  now.emplace_back();
  for (Joint& joint : parts.joints) joint.follow(now);
}

void RigidWorld::set_outside_wrench(std::size_t owner, const OutsideWrench& wrench) {
  RigidOwner& body = parts_->checked(owner, Motion::free, "free, so that no force from outside can act on it");
  if (!wrench.force.allFinite() || !wrench.torque.allFinite() || std::isnan(wrench.until))
    throw Error("the force from outside on " + body.what + " is not finite: it is ignored, and the one before stays");
  OutsideWrench felt = wrench;
  if (parts_->dimensions == 2) felt.force.y() = 0;  // nor do torques about x and z count, of which there is no inertia
  check_acceleration("the force from outside on " + body.what, acceleration_of(body, felt), greatest_acceleration);
  body.forces->wrench = wrench;
}

void RigidWorld::command(std::size_t owner, double time, const Vector3d& velocity, const Vector3d& angular_velocity) {
  RigidOwner& body = parts_->checked(owner, Motion::commanded, "commanded, so that it takes no velocities");
  if (!velocity.allFinite() || !angular_velocity.allFinite()) throw Error("the velocity commanded of " + body.what + " is not finite");
  body.commanded->command(time, velocity, angular_velocity);
}

void RigidWorld::command_joint(std::size_t joint, double time, double value) {
  if (joint >= joint_count()) throw Error("there is no joint " + std::to_string(joint) + " (0 is the first)");
  Joint& commanded = parts_->joints[joint];
  if (!commanded.is_commanded())
    throw Error("joint '" + commanded.name() + "' is not commanded, so that it takes no efforts or velocities");
  if (!std::isfinite(value)) throw Error("what is commanded of joint '" + commanded.name() + "' is not finite");
  const JointCase& given = commanded.given();
  // within the effort that the case, or the URDF, itself allows, all is meant
  if (given.command->quantity == JointQuantity::effort && !given.command->greatest_effort) {
    for (const JointEnd* end : {&commanded.child(), &commanded.parent()}) {
      if (end->owner >= static_cast<int>(count()) || !is_free(end->owner)) continue;
      check_acceleration("the effort commanded of joint '" + commanded.name() + "' on " + parts_->owners[end->owner].what,
                         parts_->acceleration_by(joint, *end, std::abs(value)), greatest_joint_acceleration);
    }
  }
  commanded.command = {value, time, true};
}

std::vector<MooringState> RigidWorld::moorings() const {
  std::vector<MooringState> states;
  for (const RigidOwner& owner : parts_->owners) {
    if (!owner.is_free()) continue;
    for (MooringState& state : owner.forces->moorings(owner.state, parts_->owners[0].state)) states.push_back(std::move(state));
  }
  return states;
}

bool RigidWorld::absorbs(std::size_t owner) const { return parts_->owners.at(owner).absorption.has_value(); }

void RigidWorld::see_waves(std::size_t owner, double time, double level) {
  RigidOwner& paddle = parts_->owners.at(owner);
  if (!paddle.absorption) throw Error(paddle.what + " does not absorb waves");
  if (!std::isfinite(level)) throw Error("the gauge of " + paddle.what + " shows no finite level" + parts_->at_time(time));
  paddle.absorption->see(time, level);
}

double RigidWorld::absorption_taken(std::size_t owner) const {
  const RigidOwner& paddle = parts_->owners.at(owner);
  return paddle.absorption ? paddle.absorption->taken() : 0.0;
}

std::vector<double> RigidWorld::absorption_settings(std::size_t owner) const {
  const RigidOwner& paddle = parts_->owners.at(owner);
  return paddle.absorption ? paddle.absorption->settings() : std::vector<double>();
}

RigidState RigidWorld::planned(std::size_t owner, double time) const {
  const RigidOwner& body = parts_->owners.at(owner);
  if (!body.prescribed) throw Error(body.what + " has no prescribed motion");
  return body.prescribed->at(time);
}

std::size_t RigidWorld::joint_count() const { return parts_->joints.size(); }
JointState RigidWorld::joint_state(std::size_t joint) const {
  std::vector<RigidState> states = parts_->present();
  states.emplace_back();
  return parts_->joints.at(joint).state(states);
}

double RigidWorld::kinetic_energy() const {
  double energy = 0;
  for (const RigidOwner& owner : parts_->owners) {
    if (!owner.is_free()) continue;
    const Vector3d& spin = owner.state.angular_velocity;
    energy += 0.5 * owner.inertia.mass * owner.state.velocity.squaredNorm() +
              0.5 * spin.dot(owner.inertia.in_world(owner.state.orientation) * spin);
  }
  return energy;
}

double RigidWorld::potential_energy() const {
  double energy = 0;
  for (const RigidOwner& owner : parts_->owners)
    if (owner.is_free()) energy -= owner.inertia.mass * parts_->gravity.dot(owner.state.position);
  return energy;
}

std::vector<char> RigidWorld::save() const {
  std::vector<double> values{mark, static_cast<double>(count()), static_cast<double>(joint_count())};
  for (const RigidOwner& owner : parts_->owners) {
    append(values, owner.state);
    if (owner.absorption) {
      const std::vector<double> more = owner.absorption->save();
      values.insert(values.end(), more.begin(), more.end());
    }
    if (owner.commanded) {
      const std::vector<double> more = owner.commanded->save();
      values.insert(values.end(), more.begin(), more.end());
    }
    if (owner.is_free()) {
      const OutsideWrench& wrench = owner.forces->wrench;
      for (const Vector3d& vector : {wrench.force, wrench.torque}) values.insert(values.end(), vector.data(), vector.data() + 3);
      values.push_back(wrench.turns_with_body ? 1.0 : 0.0);
      values.push_back(wrench.until);
    }
  }
  for (const Joint& joint : parts_->joints) {
    values.push_back(joint.angle);
    if (joint.is_commanded()) values.insert(values.end(), {joint.command.value, joint.command.at, joint.command.given ? 1.0 : 0.0});
  }
  std::vector<char> bytes(values.size() * sizeof(double));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

void RigidWorld::restore(const std::vector<char>& bytes) {
  const std::vector<char> own = save();
  if (bytes.size() != own.size() || std::memcmp(bytes.data(), own.data(), 3 * sizeof(double)) != 0)
    throw Error("the saved motion is not of this case's bodies");
  const std::vector<double> values = values_of(bytes);
  if (std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) {
    parts_->take(values);
    if (parts_->turns_are_turns()) return;
    parts_->take(values_of(own));
  }
  throw Error("the saved motion has a place, a velocity or a turn that no body can have");
}

void RigidWorld::Parts::take(const std::vector<double>& values) {
  const double* next = values.data() + 3;
  for (RigidOwner& owner : owners) {
    owner.state = take_state(next);
    if (owner.absorption) {
      owner.absorption->restore(next);
      next += WaveAbsorption::saved_numbers;
    }
    if (owner.commanded) {
      const std::size_t size = owner.commanded->saved_size();
      owner.commanded->restore(std::vector<double>(next, next + size));
      next += size;
    }
    if (owner.is_free()) {
      OutsideWrench& wrench = owner.forces->wrench;
      for (Vector3d* vector : {&wrench.force, &wrench.torque})
        for (int axis = 0; axis < 3; ++axis) (*vector)[axis] = *next++;
      wrench.turns_with_body = *next++ != 0;
      wrench.until = *next++;
    }
  }
  for (Joint& joint : joints) {
    joint.angle = *next++;
    if (!joint.is_commanded()) continue;
    joint.command.value = *next++;
    joint.command.at = *next++;
    joint.command.given = *next++ != 0;
  }
}

bool RigidWorld::Parts::turns_are_turns() const {
  constexpr double rounding = 1e-6;  // of a turn's length
  return std::all_of(owners.begin(), owners.end(),
                     [](const RigidOwner& owner) { return std::abs(owner.state.orientation.norm() - 1) < rounding; });
}

}  // namespace wavetank
