#include "rigid_owner.h"

#include <algorithm>

#include "wavetank/common/error.h"
#include "wavetank/scene/file_path.h"

namespace wavetank {
namespace {

RigidOwner make_owner(const Case& scene, const RigidCase& rigid, Motion motion, const TriangleMesh& mesh, const std::string& what) {
  RigidOwner owner;
  owner.what = what;
  owner.motion = motion;
  owner.properties = mass_properties(rigid, mesh, scene.dimensions, what, motion == Motion::free);
  owner.reference = owner.properties.centre;
  if (motion == Motion::free) owner.inertia = Inertia(owner.properties, scene.dimensions);
  return owner;
}

void set_going(RigidOwner& owner, const Case& scene, const RigidCase& rigid, const Vector3d& tank_reference, bool is_tank,
               const ResourceResolver& resolve) {
  owner.state.position = owner.reference;
  if (owner.motion == Motion::prescribed) {
    owner.prescribed.emplace(rigid.prescribed, owner.reference, scene.dimensions, scene.gravity.norm(), scene.directory, resolve,
                             owner.what);
    owner.state = owner.prescribed->at(0);
  } else if (owner.motion == Motion::commanded) {
    owner.commanded.emplace(rigid.command, owner.reference, scene.dimensions);
    owner.state = owner.commanded->state();
  } else if (owner.is_free()) {
    owner.forces.emplace(rigid, scene.gravity, owner.reference, tank_reference, !is_tank, owner.what);
    owner.state.velocity = rigid.velocity;
    owner.state.angular_velocity = rigid.angular_velocity;
    if (scene.dimensions == 2) {
      owner.state.velocity.y() = 0;
      owner.state.angular_velocity.x() = owner.state.angular_velocity.z() = 0;
    }
  }
}

/// Along a unit vector, the farthest corner of a box, m.
double farthest(const Box& box, const Vector3d& way) { return way.cwiseMax(0.0).dot(box.max) + way.cwiseMin(0.0).dot(box.min); }

/// Of a paddle that takes away the waves which come back to it.
void add_absorption(RigidOwner& owner, const Case& scene, const PrescribedCase& prescribed, const Layout& layout, const TriangleMesh& mesh,
                    const ResourceResolver& resolve) {
  const WaveCase& wave = *prescribed.waves;
  const auto& gauges = scene.instruments.wave_gauges;
  const auto gauge =
      std::find_if(gauges.begin(), gauges.end(), [&](const WaveGaugeCase& known) { return known.name == wave.absorption->gauge; });
  if (gauge == gauges.end())
    throw Error(owner.what + ": prescribed/waves/absorption/gauge is " + wave.absorption->gauge + ", which is no wave gauge of the case");
  owner.wave_way = piston_way(wave, prescribed);
  const Box box = mesh.bounding_box();
  PaddlePlace place;
  place.gauge = owner.wave_way.dot(gauge->position) - farthest(box, owner.wave_way);
  place.ahead = farthest(layout.domain, owner.wave_way) - farthest(box, owner.wave_way);
  place.behind = farthest(layout.domain, -owner.wave_way) - farthest(box, -owner.wave_way);
  const std::string path =
      wave.kind == WaveKind::record ? file_path("wave record", wave.record.file, scene.directory, resolve) : std::string();
  owner.absorption.emplace(wave, scene.gravity.norm(), place, path, owner.what);
}

}  // namespace

RigidState RigidOwner::prescribed_at(double time) const {
  RigidState state = prescribed->at(time);
  if (!absorption) return state;
  const Change change = absorption->at(time);
  state.position += change.value * wave_way;
  state.velocity += change.rate * wave_way;
  state.acceleration += change.acceleration * wave_way;
  return state;
}

std::vector<RigidOwner> make_owners(const Case& scene, const Layout& layout, const ResourceResolver& resolve) {
  std::vector<RigidOwner> owners;
  owners.push_back(make_owner(scene, scene.tank.rigid, scene.tank.motion, layout.meshes.at(0), "the tank"));
  if (!owners[0].is_free()) owners[0].reference = Vector3d::Zero();
  set_going(owners[0], scene, scene.tank.rigid, owners[0].reference, true, resolve);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyCase& body = scene.bodies[b];
    owners.push_back(make_owner(scene, body.rigid, body.motion, layout.meshes.at(b + 1), "body '" + body.name + "'"));
    set_going(owners.back(), scene, body.rigid, owners[0].reference, false, resolve);
    const auto& waves = body.rigid.prescribed.waves;
    if (body.motion == Motion::prescribed && waves && waves->absorption)
      add_absorption(owners.back(), scene, body.rigid.prescribed, layout, layout.meshes.at(b + 1), resolve);
  }
  return owners;
}

RigidState riding(const RigidState& frame, const Vector3d& frame_reference, const Vector3d& place) {
  RigidState state = frame;
  state.position = frame.moved(place, frame_reference);
  const Vector3d arm = state.position - frame.position;
  state.velocity = frame.velocity_at(state.position);
  state.acceleration =
      frame.acceleration + frame.angular_acceleration.cross(arm) + frame.angular_velocity.cross(frame.angular_velocity.cross(arm));
  return state;
}

void append(std::vector<double>& values, const RigidState& state) {
  const auto add = [&](const auto& vector) { values.insert(values.end(), vector.data(), vector.data() + vector.size()); };
  add(state.position);
  add(state.orientation.coeffs());
  add(state.velocity);
  add(state.angular_velocity);
  add(state.acceleration);
  add(state.angular_acceleration);
}

RigidState take_state(const double*& values) {
  RigidState state;
  const auto take = [&](auto& vector) {
    for (Eigen::Index k = 0; k < vector.size(); ++k) vector[k] = *values++;
  };
  take(state.position);
  take(state.orientation.coeffs());
  take(state.velocity);
  take(state.angular_velocity);
  take(state.acceleration);
  take(state.angular_acceleration);
  return state;
}

}  // namespace wavetank
