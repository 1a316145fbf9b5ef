#include "rigid_world_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solids.h"
#include "start_checks.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double correction_time = 5e-3;  // s, in which overlaps and what joints have drifted go away
constexpr double greatest_correction = 0.2;
constexpr double slop_of_spacing = 0.01, rebound_of_spacing = 0.01;
constexpr int contact_iterations = 240, joint_iterations = 300;

JointEnd end_of(const std::string& name, const std::string& joint, const Case& scene, const std::vector<RigidOwner>& owners) {
  const int world = static_cast<int>(owners.size());
  if (name == "world") return {world, world, Vector3d::Zero()};
  if (name == "tank") return {0, 0, owners[0].reference};
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    if (scene.bodies[b].name != name) continue;
    const int owner = static_cast<int>(b + 1);
    if (owners[owner].motion == Motion::fixed) return {owner, 0, owners[0].reference};  // it is part of the tank
    return {owner, owner, owners[owner].reference};
  }
  throw Error("joint '" + joint + "' names '" + name + "', which is no body of the case; name one, tank or world");
}

bool passes_through(int a, int b, const std::vector<std::pair<int, int>>& apart) {
  return std::any_of(apart.begin(), apart.end(),
                     [&](const std::pair<int, int>& pair) { return pair == std::pair(a, b) || pair == std::pair(b, a); });
}

/// Whether another body that touches it starts in a closed cavity of a body.
bool has_in_cavity(const Case& scene, const Layout& layout, std::size_t owner, const std::vector<std::pair<int, int>>& apart) {
  const std::vector<TriangleMesh> cavities = cavities_of(layout.meshes[owner]);
  if (cavities.empty()) return false;
  for (std::size_t o = 1; o < layout.meshes.size(); ++o) {
    const bool touches = o != owner && scene.bodies[o - 1].rigid.collision != CollisionShape::none &&
                         !passes_through(static_cast<int>(o), static_cast<int>(owner), apart);
    const auto is_in = [&](const TriangleMesh& cavity) { return inside(cavity, layout.meshes[o].vertices.front()); };
    if (touches && std::any_of(cavities.begin(), cavities.end(), is_in)) return true;
  }
  return false;
}

}  // namespace

RigidWorld::Parts::Parts(const Case& scene, const Layout& layout, const ResourceResolver& resolve)
    : dimensions(scene.dimensions), gravity(scene.gravity), spacing(layout.spacing), owners(make_owners(scene, layout, resolve)) {
  for (const RigidOwner& owner : owners) inertias.push_back(owner.inertia);
  inertias.emplace_back();  // the world
  make_joints(scene);
  if (std::none_of(owners.begin(), owners.end(), [](const RigidOwner& owner) { return owner.is_free(); })) return;
  check_places(scene, layout, owners, joints);
  make_contacts(scene, layout, resolve);
  tell_of_overlaps(contacts->find(present()), owners, spacing);
}

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

std::vector<std::size_t> RigidWorld::Parts::hanging_on(std::size_t joint, const JointEnd& end) const {
  std::vector<std::size_t> found{static_cast<std::size_t>(end.owner)};
  for (std::size_t k = 0; k < found.size(); ++k)
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (j == joint || !joints[j].holds_together()) continue;
      const auto child = static_cast<std::size_t>(joints[j].child().owner), parent = static_cast<std::size_t>(joints[j].parent().owner);
      if (child != found[k] && parent != found[k]) continue;
      const std::size_t other = child == found[k] ? parent : child;
      const bool is_free = other < owners.size() && owners[other].is_free();
      if (is_free && std::find(found.begin(), found.end(), other) == found.end()) found.push_back(other);
    }
  return found;
}

double RigidWorld::Parts::acceleration_by(std::size_t joint, const JointEnd& end, double effort) const {
  const Joint& hinge = joints[joint];
  std::vector<RigidState> states = present();
  states.emplace_back();
  const RigidState& child = states[hinge.child().frame];
  const Vector3d point = child.moved(hinge.given().point, hinge.child().reference),
                 axis = states[hinge.parent().frame].orientation * hinge.given().axis.normalized();
  double mass = 0, moment = 0;
  for (const std::size_t o : hanging_on(joint, end)) {
    const Inertia& inertia = owners[o].inertia;
    mass += inertia.mass;
    moment +=
        axis.dot(inertia.in_world(states[o].orientation) * axis) + inertia.mass * axis.cross(states[o].position - point).squaredNorm();
  }
  return hinge.given().type == JointType::hinge ? effort / std::sqrt(moment * mass) : effort / mass;
}

void RigidWorld::Parts::make_contacts(const Case& scene, const Layout& layout, const ResourceResolver& resolve) {
  double half_width = spacing;
  for (std::size_t o = 1; o < owners.size(); ++o) {
    if (owners[o].motion == Motion::fixed) continue;
    const Box box = layout.meshes[o].bounding_box();
    half_width = std::max({half_width, 0.5 * (box.max.x() - box.min.x()), 0.5 * (box.max.z() - box.min.z())});
  }
  std::vector<std::pair<int, int>> apart;
  for (const Joint& joint : joints)
    if (joint.holds_together()) apart.emplace_back(joint.child().owner, joint.parent().owner);
  std::vector<ContactBody> bodies(owners.size());
  for (std::size_t o = 0; o < owners.size(); ++o) {
    const RigidCase& rigid = o == 0 ? scene.tank.rigid : scene.bodies[o - 1].rigid;
    ContactBody& body = bodies[o];
    body.free = owners[o].is_free();
    body.frame = frame_of(o);
    body.reference = owners[o].reference;
    body.friction = rigid.friction;
    body.restitution = rigid.restitution;
    const bool as_listed = rigid.collision == CollisionShape::parts || rigid.collision == CollisionShape::none;
    body.as_walls = o == 0 ? !as_listed : !body.free && rigid.collision == CollisionShape::automatic;
    // The fluid has no walls in cavities: what is in one touches convex parts.
    const bool has_content = o > 0 && has_in_cavity(scene, layout, o, apart);
    body.as_walls = body.as_walls && !has_content;
    if (body.as_walls) continue;
    ShapeRequest request;
    request.rigid = &rigid;
    request.mesh = &layout.meshes[o];
    TriangleMesh without_cavities;
    if (o > 0 && !has_content && dimensions == 3) {
      without_cavities = filled_up(layout.meshes[o]);
      request.mesh = &without_cavities;
    }
    request.is_solid = o > 0;
    if (o > 0) request.source = std::get_if<MeshSource>(&scene.bodies[o - 1].shape);
    request.dimensions = dimensions;
    request.reference = owners[o].reference;
    request.spacing = spacing;
    request.half_width = half_width;
    request.what = owners[o].what;
    body.parts = make_shape(request, scene.directory, resolve);
  }
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
      states.push_back(owner.prescribed_at(time + step));
    } else if (owner.commanded) {
      CommandedMotion copy = *owner.commanded;
      states.push_back(copy.advance(time, step));
    } else {
      states.push_back(owner.is_free() ? moved_on(owner.state, step) : owner.state);
    }
  }
  ride(states);
  return states;
}

void RigidWorld::Parts::ride(std::vector<RigidState>& states) const {
  for (std::size_t o = 1; o < owners.size(); ++o)
    if (frame_of(o) == 0) states[o] = riding(states[0], owners[0].reference, owners[o].reference);
}

std::vector<RigidState> RigidWorld::Parts::at_middle(double time, double time_step) const {
  std::vector<RigidState> states = ahead(time, 0.5 * time_step);
  for (std::size_t o = 0; o < owners.size(); ++o) {
    if (!owners[o].commanded) continue;
    // A velocity that jumps does so within the half step, but what feels the acceleration feels it for all of the step.
    CommandedMotion copy = *owners[o].commanded;
    const RigidState& end = copy.advance(time, time_step);
    states[o].acceleration = end.acceleration;
    states[o].angular_acceleration = end.angular_acceleration;
  }
  ride(states);
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
    if (!load.force.allFinite() || !load.torque.allFinite())
      throw Error("the fluid's load on " + owners[o].what + " is not finite" + at_time(time));
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
  for (const Joint& joint : joints) joint.add_loads(states, inertias, time, time_step, sums);
  if (dimensions == 2) {
    for (RigidLoad& load : sums) {
      load.force.y() = 0;
      load.torque.x() = load.torque.z() = 0;
    }
  }
  return sums;
}

/// What contacts and joints change; `given` has the mean velocities of what is not free.
std::vector<BodyChange> RigidWorld::Parts::changes(double time, double time_step, const StepStates& states,
                                                   const std::vector<RigidState>& given, const std::vector<FreeMotion>& motions) const {
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
  for (const Joint& joint : joints) joint.add_rows(states, inertias, time, time_step, settings.correction, rows);
  const std::vector<Contact> touching = contacts->find(states.start);
  if (rows.empty() && touching.empty()) return std::vector<BodyChange>(owners.size() + 1);
  std::vector<BodyChange> result = solver.solve(bodies, touching, rows, settings);
  // What hangs on a body that a contact stops must move as it does.
  for (std::size_t pass = 0; pass < joints.size(); ++pass)
    for (const Joint& joint : joints) {
      const auto joined = [&](int frame) { return inertias[frame].mass > 0; };
      const int child = joint.child().frame, parent = joint.parent().frame;
      if (!joined(child) || !joined(parent)) continue;
      result[child].touched = result[parent].touched = result[child].touched || result[parent].touched;
    }
  return result;
}

RigidOwner& RigidWorld::Parts::checked(std::size_t owner, Motion motion, const char* word) {
  if (owner >= owners.size()) throw Error("there is no body " + std::to_string(owner) + " (0 is the tank, 1 the first body)");
  if (owners[owner].motion != motion) throw Error(owners[owner].what + " is not " + word);
  return owners[owner];
}

}  // namespace wavetank
