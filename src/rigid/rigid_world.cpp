#include "wavetank/rigid/rigid_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "contacts.h"
#include "joints.h"
#include "number_text.h"
#include "rigid_owner.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double correction_time = 5e-3;  // s, in which overlaps and what joints have drifted go away
constexpr double greatest_correction = 0.2;
constexpr double slop_of_spacing = 0.01, rebound_of_spacing = 0.01;
constexpr int contact_iterations = 240, joint_iterations = 300;
constexpr double mark = 4.0919e5;  // opens what save() returns

JointEnd end_of(const std::string& name, const std::string& joint, const Case& scene, const std::vector<RigidOwner>& owners) {
  if (name == "world") return {static_cast<int>(owners.size()), Vector3d::Zero()};
  if (name == "tank") return {0, owners[0].reference};
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].name != name) continue;
    if (owners[b + 1].motion == Motion::fixed) return {0, owners[0].reference};  // it is part of the tank
    return {static_cast<int>(b + 1), owners[b + 1].reference};
  }
  throw Error("joint '" + joint + "' names '" + name + "', which is no body of the case; name one, tank or world");
}

}  // namespace

struct RigidWorld::Parts {
  Parts(const Case& scene, const Layout& layout, const ResourceResolver& resolve)
      : dimensions(scene.dimensions), gravity(scene.gravity), spacing(layout.spacing), owners(make_owners(scene, layout, resolve)) {
    for (const RigidOwner& owner : owners) inertias.push_back(owner.inertia);
    inertias.emplace_back();  // the world
    make_joints(scene);
    if (std::any_of(owners.begin(), owners.end(), [](const RigidOwner& owner) { return owner.is_free(); })) make_contacts(scene, layout, resolve);
  }

  void make_joints(const Case& scene);
  void make_contacts(const Case& scene, const Layout& layout, const ResourceResolver& resolve);

  int frame_of(std::size_t owner) const { return owner > 0 && owners[owner].motion == Motion::fixed ? 0 : static_cast<int>(owner); }
  RigidState state(std::size_t owner) const {
    return frame_of(owner) == static_cast<int>(owner) ? owners[owner].state : riding(owners[0].state, owners[0].reference, owners[owner].reference);
  }
  std::vector<RigidState> present() const;
  std::vector<RigidState> ahead(double time, double step) const;
  std::vector<RigidLoad> loads(double time, double time_step, const std::vector<RigidLoad>& fluid, const StepStates& states) const;
  std::vector<BodyChange> changes(double time_step, const StepStates& states, const std::vector<RigidState>& given,
                                  const std::vector<FreeMotion>& motions) const;
  std::string at_time(double time) const { return " at " + number_text(time) + " s"; }
  RigidOwner& checked(std::size_t owner, Motion motion, const char* word);

  int dimensions;
  Vector3d gravity;
  double spacing;
  std::vector<RigidOwner> owners;
  std::vector<Inertia> inertias;  ///< by frame, the world's last
  std::vector<Joint> joints;
  std::unique_ptr<ContactFinder> contacts;  ///< none where nothing is free
  mutable ImpulseSolver solver;             ///< keeps nothing but memory
};

void RigidWorld::Parts::make_joints(const Case& scene) {
  for (const JointCase& joint : scene.joints) {
    const JointEnd child = end_of(joint.child, joint.name, scene, owners), parent = end_of(joint.parent, joint.name, scene, owners);
    if (child.frame == parent.frame)
      throw Error("joint '" + joint.name + "': '" + joint.child + "' and '" + joint.parent + "' do not move relative to each other");
    if (!(inertias[child.frame].mass > 0) && !(inertias[parent.frame].mass > 0))
      throw Error("joint '" + joint.name + "': neither '" + joint.child + "' nor '" + joint.parent + "' is free; at least one end must be");
    joints.emplace_back(joint, child, parent, dimensions);
  }
}

void RigidWorld::Parts::make_contacts(const Case& scene, const Layout& layout, const ResourceResolver& resolve) {
  double half_width = 0;
  for (const TriangleMesh& mesh : layout.meshes) {
    const Box box = mesh.bounding_box();
    half_width = std::max({half_width, 0.5 * (box.max.x() - box.min.x()), 0.5 * (box.max.z() - box.min.z())});
  }
  std::vector<ContactBody> bodies(owners.size());
  for (std::size_t o = 0; o < owners.size(); ++o) {
    const RigidCase& rigid = o == 0 ? scene.tank.rigid : scene.bodies[o - 1].rigid;
    ContactBody& body = bodies[o];
    body.free = owners[o].is_free();
    body.frame = frame_of(o);
    body.reference = owners[o].reference;
    body.friction = rigid.friction;
    body.restitution = rigid.restitution;
    body.as_walls = rigid.collision != CollisionShape::none && (o == 0 || (!body.free && rigid.collision == CollisionShape::automatic));
    if (body.as_walls || o == 0) continue;
    ShapeRequest request;
    request.rigid = &rigid;
    request.mesh = &layout.meshes[o];
    request.is_box = std::holds_alternative<Box>(scene.bodies[o - 1].shape);
    request.dimensions = dimensions;
    request.reference = owners[o].reference;
    request.spacing = spacing;
    request.half_width = half_width;
    request.what = owners[o].what;
    body.parts = make_shape(request, scene.directory, resolve);
  }
  std::vector<std::pair<int, int>> apart;
  for (const Joint& joint : joints) apart.emplace_back(joint.child(), joint.parent());
  contacts = std::make_unique<ContactFinder>(std::move(bodies), layout, dimensions, half_width, std::move(apart));
}

std::vector<RigidState> RigidWorld::Parts::present() const {
  std::vector<RigidState> states;
  for (std::size_t o = 0; o < owners.size(); ++o) states.push_back(state(o));
  return states;
}

/// States a step later, free bodies with their present velocities.
std::vector<RigidState> RigidWorld::Parts::ahead(double time, double step) const {
  std::vector<RigidState> states;
  for (const RigidOwner& owner : owners) {
    if (owner.prescribed) {
      states.push_back(owner.prescribed->at(time + step));
    } else if (owner.commanded) {
      CommandedMotion copy = *owner.commanded;
      states.push_back(copy.advance(time, step));
    } else {
      states.push_back(owner.is_free() ? moved_on(owner.state, step) : owner.state);
    }
  }
  for (std::size_t o = 1; o < owners.size(); ++o)
    if (frame_of(o) == 0) states[o] = riding(states[0], owners[0].reference, owners[o].reference);
  return states;
}

std::vector<RigidLoad> RigidWorld::Parts::loads(double time, double time_step, const std::vector<RigidLoad>& fluid,
                                                const StepStates& states) const {
  std::vector<RigidLoad> sums(owners.size() + 1);
  const auto add = [&](std::size_t frame, const RigidLoad& load) {
    sums[frame].force += load.force;
    sums[frame].torque += load.torque;
  };
  for (std::size_t o = 0; o < owners.size(); ++o) {
    const int frame = frame_of(o);
    if (!owners[frame].is_free()) continue;
    RigidLoad load = fluid.at(o);
    if (!load.force.allFinite() || !load.torque.allFinite()) throw Error("the fluid's load on " + owners[o].what + " is not finite" + at_time(time));
    load.torque += (states.middle[o].position - states.middle[frame].position).cross(load.force);
    add(frame, load);
  }
  for (std::size_t o = 0; o < owners.size(); ++o) {
    if (!owners[o].is_free()) continue;
    add(o, {owners[o].inertia.mass * gravity, Vector3d::Zero()});
    RigidLoad on_tank;
    add(o, owners[o].forces->at(time + 0.5 * time_step, time_step, states.middle[o], inertias[o], states.middle[0], inertias[0], on_tank));
    add(0, on_tank);
  }
  for (const Joint& joint : joints) joint.add_loads(states, inertias, time_step, sums);
  if (dimensions == 2) {
    for (RigidLoad& load : sums) {
      load.force.y() = 0;
      load.torque.x() = load.torque.z() = 0;
    }
  }
  return sums;
}

/// What contacts and joints change; `given` has the mean velocities of what is not free.
std::vector<BodyChange> RigidWorld::Parts::changes(double time_step, const StepStates& states, const std::vector<RigidState>& given,
                                                   const std::vector<FreeMotion>& motions) const {
  std::vector<SolverBody> bodies(owners.size() + 1);
  for (std::size_t o = 0; o < owners.size(); ++o) {
    SolverBody& body = bodies[o];
    body.centre = states.start[o].position;
    if (owners[o].is_free()) {
      body.inverse_mass = 1 / inertias[o].mass;
      body.inverse_inertia = inertias[o].inverse_in_world(states.start[o].orientation);
      body.velocity = motions[o].velocity;
      body.angular_velocity = motions[o].angular_velocity;
    } else {
      body.velocity = given[o].velocity;
      body.angular_velocity = given[o].angular_velocity;
    }
  }
  SolverSettings settings;
  settings.time_step = time_step;
  settings.correction = std::min(greatest_correction, time_step / correction_time);
  settings.slop = slop_of_spacing * spacing;
  settings.least_rebound = std::max(std::sqrt(2 * gravity.norm() * rebound_of_spacing * spacing), 1e-6);
  settings.resolution = std::max(1e-6 * gravity.norm() * time_step, 1e-14);
  settings.iterations = joints.empty() ? contact_iterations : joint_iterations;
  settings.planar = dimensions == 2;
  std::vector<JointRow> rows;
  for (const Joint& joint : joints) joint.add_rows(states, inertias, time_step, settings.correction, rows);
  const std::vector<Contact> touching = contacts->find(states.start);
  if (rows.empty() && touching.empty()) return std::vector<BodyChange>(owners.size() + 1);
  std::vector<BodyChange> result = solver.solve(bodies, touching, rows, settings);
  // What hangs on a body that a contact stops must move as it does.
  for (std::size_t pass = 0; pass < joints.size(); ++pass)
    for (const Joint& joint : joints) {
      const auto joined = [&](int frame) { return inertias[frame].mass > 0; };
      if (!joined(joint.child()) || !joined(joint.parent())) continue;
      result[joint.child()].touched = result[joint.parent()].touched = result[joint.child()].touched || result[joint.parent()].touched;
    }
  return result;
}

RigidOwner& RigidWorld::Parts::checked(std::size_t owner, Motion motion, const char* word) {
  if (owner >= owners.size()) throw Error("there is no body " + std::to_string(owner) + " (0 is the tank, 1 the first body)");
  if (owners[owner].motion != motion) throw Error(owners[owner].what + " is not " + word);
  return owners[owner];
}

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

std::vector<RigidState> RigidWorld::at_middle(double time, double time_step) const { return parts_->ahead(time, 0.5 * time_step); }

void RigidWorld::advance(double time, double time_step, const std::vector<RigidLoad>& fluid) {
  Parts& parts = *parts_;
  std::vector<RigidOwner>& owners = parts.owners;
  if (!anything_moves()) return;
  if (!(time_step > 0) || !std::isfinite(time_step) || !std::isfinite(time))
    throw Error("bodies cannot be moved by a step of " + number_text(time_step) + " s" + parts.at_time(time));
  if (fluid.size() != owners.size())
    throw Error("the fluid's loads are of " + std::to_string(fluid.size()) + " bodies, but the case has " + std::to_string(owners.size()) + " with the tank");
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
    const std::vector<BodyChange> changes = parts.changes(time_step, states, given, motions);
    for (std::size_t o = 0; o < owners.size(); ++o) {
      if (!owners[o].is_free()) continue;
      owners[o].state = after_step(owners[o].state, motions[o], changes[o], time_step);
      if (!owners[o].state.position.allFinite() || !owners[o].state.orientation.coeffs().allFinite())
        throw Error(owners[o].what + " has no finite place after the step" + parts.at_time(time));
    }
  }
  for (RigidOwner& owner : owners) {
    if (owner.prescribed) owner.state = owner.prescribed->at(time + time_step);
    if (owner.commanded) owner.state = owner.commanded->advance(time, time_step);
  }
  std::vector<RigidState> now = parts.present();
  now.emplace_back();
  for (Joint& joint : parts.joints) joint.follow(now);
}

void RigidWorld::set_outside_wrench(std::size_t owner, const OutsideWrench& wrench) {
  RigidOwner& body = parts_->checked(owner, Motion::free, "free, so that no force from outside can act on it");
  if (!wrench.force.allFinite() || !wrench.torque.allFinite() || std::isnan(wrench.until))
    throw Error("the force from outside on " + body.what + " is not finite");
  body.forces->wrench = wrench;
}

void RigidWorld::command(std::size_t owner, double time, const Vector3d& velocity, const Vector3d& angular_velocity) {
  RigidOwner& body = parts_->checked(owner, Motion::commanded, "commanded, so that it takes no velocities");
  if (!velocity.allFinite() || !angular_velocity.allFinite()) throw Error("the velocity commanded of " + body.what + " is not finite");
  body.commanded->command(time, velocity, angular_velocity);
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
    energy += 0.5 * owner.inertia.mass * owner.state.velocity.squaredNorm() + 0.5 * spin.dot(owner.inertia.in_world(owner.state.orientation) * spin);
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
  for (const Joint& joint : parts_->joints) values.push_back(joint.angle);
  std::vector<char> bytes(values.size() * sizeof(double));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

void RigidWorld::restore(const std::vector<char>& bytes) {
  const std::vector<char> own = save();
  if (bytes.size() != own.size() || std::memcmp(bytes.data(), own.data(), 3 * sizeof(double)) != 0)
    throw Error("the saved motion is not of this case's bodies");
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  const double* next = values.data() + 3;
  for (RigidOwner& owner : parts_->owners) {
    owner.state = take_state(next);
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
  for (Joint& joint : parts_->joints) joint.angle = *next++;
}

}  // namespace wavetank
