#include <cstring>

#include "fnv_hash.h"
#include "simulation_parts.h"
#include "snapshot.h"
#include "wavetank/common/log.h"
#include "wavetank/common/version.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank {
namespace {

/// Tells one geometry, prescribed motions, absorptions and laws of flow from others: a case names its meshes and records, but does
/// not hold them.
std::uint64_t fingerprint(const Case& scene, const Layout& layout, const RigidWorld& world, const std::vector<FlowLaw>& laws) {
  std::uint64_t hash = fnv_1a(nullptr, 0);
  const auto add = [&hash](const double* values, std::size_t count) { hash = fnv_1a(values, count * sizeof(double), hash); };
  for (const Vector3d& particle : layout.particles) add(particle.data(), 3);
  for (const WallElement& wall : layout.walls) {
    add(wall.centre.data(), 3);
    add(wall.normal.data(), 3);
    add(&wall.area, 1);
  }
  std::vector<std::size_t> prescribed;
  if (scene.tank.motion == Motion::prescribed) prescribed.push_back(0);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].motion == Motion::prescribed) prescribed.push_back(1 + b);
  constexpr double interval = 0.01, end = 20;  // s
  for (double time = 0; !prescribed.empty() && time < end; time += interval) {
    for (const std::size_t owner : prescribed) {
      const RigidState state = world.planned(owner, time + 0.5 * interval);
      add(state.position.data(), 3);
      add(state.orientation.coeffs().data(), 4);
    }
  }
  for (const std::size_t owner : prescribed) {  // what is planned is without what is absorbed
    const std::vector<double> settings = world.absorption_settings(owner);
    add(settings.data(), settings.size());
  }
  for (const FlowLaw& law : laws)
    for (double time = 0; law.is_of_time() && time < end; time += interval) {
      const double value = law.unchecked_at(time);
      add(&value, 1);
    }
  return hash;
}

/// The case and its geometry as far as they decide the flow and the samples: what a snapshot must agree on.
std::string flow_of(Case scene, const Layout& layout, const RigidWorld& world, const std::vector<FlowLaw>& laws) {
  const std::uint64_t geometry = fingerprint(scene, layout, world, laws);
  scene.title.clear();
  scene.duration = 1;
  scene.device = "auto";
  scene.publishing = PublishingCase{};
  return write_case(scene) + "geometry " + std::to_string(geometry) + "\n";
}

}  // namespace

std::vector<char> Simulation::Parts::saved_bodies() const {
  const std::vector<double> felt = coupling.save();
  std::vector<char> bytes(felt.size() * sizeof(double));
  std::memcpy(bytes.data(), felt.data(), bytes.size());
  const std::vector<char> rest = world.save();
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

void Simulation::Parts::restore_bodies(const std::vector<char>& bytes) {
  std::vector<double> felt(coupling.save().size());
  const std::size_t size = felt.size() * sizeof(double);
  if (bytes.size() < size) throw Error("the snapshot's bodies are not those of this case.");
  std::memcpy(felt.data(), bytes.data(), size);
  world.restore({bytes.begin() + static_cast<std::ptrdiff_t>(size), bytes.end()});
  coupling.restore(felt);
  coupling.set_time(time);
  if (world.anything_moves()) solver->set_wall_motions(coupling.now());
}

void Simulation::save(const std::string& path) const {
  const Parts& parts = *parts_;
  Snapshot snapshot;
  snapshot.version = version();
  snapshot.device = parts.kind_of_device();
  snapshot.scene = flow_of(parts.scene, parts.layout, parts.world, parts.laws);
  snapshot.time = parts.time;
  snapshot.time_step = parts.time_step;
  snapshot.step = parts.step;
  snapshot.guard_hits = parts.guard_hits;
  snapshot.clocks = parts.recorder.clock_indices();
  snapshot.instruments = parts.recorder.memory();
  snapshot.bodies = parts.saved_bodies();
  snapshot.openings = parts.openings.save();
  snapshot.fluid = parts.solver->save();
  write_snapshot(path, snapshot);
}

void Simulation::restore(const std::string& path) {
  Parts& parts = *parts_;
  const Snapshot snapshot = read_snapshot(path);
  if (snapshot.scene != flow_of(parts.scene, parts.layout, parts.world, parts.laws))
    throw Error("the snapshot " + path +
                " belongs to another case: everything but title, duration, device and publishing must be the same, meshes and records of "
                "motions and flows too.");
  try {
    parts.solver->restore(snapshot.fluid);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  if (snapshot.device != parts.kind_of_device())
    log(LogLevel::warning, "the snapshot " + path + " was written on " + snapshot.device + ": it continues, but not bit for bit.");
  parts.time = snapshot.time;
  parts.restore_bodies(snapshot.bodies);
  parts.openings.restore(snapshot.openings);
  parts.time_step = snapshot.time_step;
  parts.step = snapshot.step;
  parts.guard_hits = snapshot.guard_hits;
  parts.report = StepReport{};
  parts.report.time_step = snapshot.time_step;
  parts.recorder.set_clock_indices(snapshot.clocks);
  parts.recorder.set_memory(snapshot.instruments);
}

}  // namespace wavetank
