#include <algorithm>
#include <cmath>
#include <cstring>

#include "fnv_hash.h"
#include "simulation_parts.h"
#include "snapshot.h"
#include "texts.h"
#include "wavetank/common/error.h"
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

/// What was there before; where that had gone wrong already there is nothing to go back to.
template <class Restore>
void put_back(const Restore& restore) {
  try {
    restore();
  } catch (const Error&) {
  }
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
  if (size > 0) std::memcpy(felt.data(), bytes.data(), size);
  if (!std::all_of(felt.begin(), felt.end(), [](double value) { return std::isfinite(value); }))
    throw Error("the snapshot's bodies have an acceleration that is not finite.");
  world.restore({bytes.begin() + static_cast<std::ptrdiff_t>(size), bytes.end()});
  coupling.restore(felt);
}

void Simulation::Parts::place_walls() {
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

/// Throws Error for times that no step of the case can have ended with: the recorder would make samples without end.
void Simulation::Parts::check_clocks(const Snapshot& snapshot) const {
  const double longest = discretisation.support / discretisation.sound_speed;  // of a step, in which sound passes a part of this
  if (!(snapshot.time >= 0) || !std::isfinite(snapshot.time)) throw Error("its time is " + number(snapshot.time) + " s.");
  if (!(snapshot.time_step > 0) || snapshot.time_step > longest)
    throw Error("its time step is " + number(snapshot.time_step) + " s, but one of this case is above 0 and at most " + number(longest) +
                " s.");
  if (!recorder.can_stand_at(snapshot.clocks, snapshot.time, longest))
    throw Error("its instruments are not where they are at its time, " + number(snapshot.time) + " s.");
}

void Simulation::restore(const std::string& path) {
  Parts& parts = *parts_;
  const Snapshot snapshot = read_snapshot(path);
  if (snapshot.scene != flow_of(parts.scene, parts.layout, parts.world, parts.laws))
    throw Error("the snapshot " + path +
                " belongs to another case: everything but title, duration, device and publishing must be the same, meshes and records of "
                "motions and flows too.");
  const std::vector<char> bodies = parts.saved_bodies(), openings = parts.openings.save();
  const std::vector<double> memory = parts.recorder.memory();
  try {
    parts.check_clocks(snapshot);
    parts.recorder.set_memory(snapshot.instruments);
    parts.openings.restore(snapshot.openings);
    parts.restore_bodies(snapshot.bodies);
    parts.solver->restore(snapshot.fluid);
  } catch (const Error& error) {
    put_back([&] { parts.recorder.set_memory(memory); });
    put_back([&] { parts.openings.restore(openings); });
    put_back([&] { parts.restore_bodies(bodies); });
    throw Error("the snapshot " + path + " cannot be gone on from: " + error.what());
  }
  if (snapshot.device != parts.kind_of_device())
    log(LogLevel::warning, "the snapshot " + path + " was written on " + snapshot.device + ": it continues, but not bit for bit.");
  parts.time = snapshot.time;
  parts.place_walls();
  parts.time_step = snapshot.time_step;
  parts.step = snapshot.step;
  parts.guard_hits = snapshot.guard_hits;
  parts.report = StepReport{};
  parts.report.time_step = snapshot.time_step;
  parts.recorder.set_clock_indices(snapshot.clocks);
}

}  // namespace wavetank
