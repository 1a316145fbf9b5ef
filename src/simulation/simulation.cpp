#include "wavetank/simulation/simulation.h"

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "coupling.h"
#include "snapshot.h"
#include "wavetank/common/log.h"
#include "wavetank/common/version.h"
#include "wavetank/compute/device.h"
#include "wavetank/instruments/recorder.h"
#include "wavetank/rigid/prescribed_motion.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/sph/solver.h"

namespace wavetank {
namespace {

std::string number(double value, const char* format = "%.6g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string point(const Vector3d& p) { return "(" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ")"; }

/// Where torques are taken about.
std::vector<Vector3d> reference_points(const RigidWorld& world) {
  std::vector<Vector3d> points;
  for (std::size_t o = 0; o < world.count(); ++o) points.push_back(world.reference(o));
  return points;
}

/// What the speed of sound must allow for beside the water's own fall: prescribed motions, and the fall of bodies, m/s.
double fastest_wall(const Case& scene, const Layout& layout, const ResourceResolver& resolve) {
  double fastest = 0;
  const auto look_at = [&](Motion motion, const RigidCase& rigid, const TriangleMesh& mesh, const std::string& what) {
    const Box box = mesh.bounding_box();
    if (motion == Motion::prescribed)
      fastest = std::max(fastest, PrescribedMotion(rigid.prescribed, rigid.prescribed.point.value_or(Vector3d::Zero()), scene.dimensions,
                                                   scene.directory, resolve, what)
                                      .greatest_speed(box, scene.duration));
    if (motion != Motion::free) return;
    const double fall = std::max(box.min.z() - layout.domain.min.z(), 0.0);
    fastest = std::max(fastest, rigid.velocity.norm() + std::sqrt(2.0 * scene.gravity.norm() * fall));
  };
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    look_at(scene.bodies[b].motion, scene.bodies[b].rigid, layout.meshes[b + 1], "body '" + scene.bodies[b].name + "'");
  // a tank's own motion is not seen in its frame, but what the water makes of a standstill is
  if (scene.tank.motion == Motion::prescribed) look_at(scene.tank.motion, scene.tank.rigid, layout.meshes[0], "tank");
  return fastest;
}

/// Tells one geometry from another (FNV-1a): a case names its meshes, but does not hold them.
std::uint64_t fingerprint(const Layout& layout) {
  std::uint64_t hash = 14695981039346656037ULL;
  const auto add = [&hash](const double* values, std::size_t count) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values);
    for (std::size_t k = 0; k < count * sizeof(double); ++k) hash = (hash ^ bytes[k]) * 1099511628211ULL;
  };
  for (const Vector3d& particle : layout.particles) add(particle.data(), 3);
  for (const WallElement& wall : layout.walls) {
    add(wall.centre.data(), 3);
    add(wall.normal.data(), 3);
    add(&wall.area, 1);
  }
  return hash;
}

/// The case and its geometry as far as they decide the flow and the samples: what a snapshot must agree on.
std::string flow_of(Case scene, const Layout& layout) {
  scene.title.clear();
  scene.duration = 1;
  scene.device = "auto";
  scene.publishing = PublishingCase{};
  return write_case(scene) + "geometry " + std::to_string(fingerprint(layout)) + "\n";
}

/// Elements or facets, whichever the case has; ghosts have facets for the guard.
std::size_t walls_in_use(const Case& scene, const Layout& layout) {
  const WallCase& walls = scene.numerics.walls;
  if (walls.method == WallMethod::ghost || walls.elements == WallElements::facet) return layout.facets.size();
  return walls.elements == WallElements::semi_analytical ? layout.triangles.size() : layout.walls.size();
}

void tell_of_thin_walls(const Case& scene, const Discretisation& discretisation, const Solver& solver) {
  const std::optional<ThinWall> wall = solver.thinnest_wall();
  if (!wall) return;
  const std::string whose = wall->owner == 0 ? "the tank" : "body " + scene.bodies[wall->owner - 1].name;
  log(LogLevel::info, whose + " is only " + number(wall->thickness) + " m thick at " + point(wall->place) +
                          " m, with fluid possible on both sides, less than the kernel's support of " + number(discretisation.support) +
                          " m: it is taken for a thin plate, through which the water on one side does not feel that on the other.");
}

}  // namespace

struct Simulation::Parts {
  Parts(const Case& checked, SimulationOptions given)
      : options(std::move(given)),
        layout(laid_out(checked)),
        fastest(fastest_wall(checked, layout, options.resolve)),
        scene(settled(checked, layout, fastest)),
        discretisation(discretise(scene, layout)),
        world(scene, layout, options.resolve),
        coupling(world, scene, layout, discretisation),
        device(compute::choose_device(scene.device), options.time_kernels),
        solver(prepared_solver()),
        recorder(scene, layout, *solver, world) {
    tell_of_thin_walls(scene, discretisation, *solver);
    solver->limit_time_step(coupling.longest_time_step());
    initial_bodies = world.save();
  }

  Layout laid_out(const Case& checked) const {
    progress("laying out", 0.0);
    Layout result = lay_out(checked, options.resolve);
    progress("laying out", 1.0);
    return result;
  }

  std::unique_ptr<Solver> prepared_solver() const {
    progress("compiling kernels", 0.0);
    std::unique_ptr<Solver> result = make_solver(device, scene, layout, discretisation, reference_points(world));
    progress("compiling kernels", 1.0);
    return result;
  }

  void progress(const char* what, double fraction) const {
    if (options.progress) options.progress(what, fraction);
  }

  void check(const StepReport& report) const;
  /// Bodies and what the fluid has been told of them, as bytes; and back.
  std::vector<char> saved_bodies() const;
  void restore_bodies(const std::vector<char>& bytes);

  SimulationOptions options;
  Layout layout;
  double fastest;  ///< m/s, expected of walls
  Case scene;
  Discretisation discretisation;
  RigidWorld world;
  Coupling coupling;
  compute::Device device;
  std::unique_ptr<Solver> solver;
  Recorder recorder;
  PackingReport packing;
  std::vector<char> initial_fluid, initial_bodies;
  double initial_time_step = 0;
  double time = 0;
  double time_step = 0;
  std::uint64_t step = 0;
  std::uint64_t guard_hits = 0;
  StepReport report;
};

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

/// Throws Violation for a step that the simulation may not go on from.
void Simulation::Parts::check(const StepReport& r) const {
  const std::string when = " at t = " + number(time) + " s, step " + std::to_string(step) + ": the simulation stops";
  if (r.offender >= 0) {
    std::string what;
    const auto add = [&](int count, const std::string& text) {
      if (count > 0) what += (what.empty() ? "" : ", ") + std::to_string(count) + text;
    };
    add(r.not_finite, " with values that are not finite");
    add(r.outside, " outside the tank");
    add(r.too_fast, " faster than half the speed of sound (" + number(0.5 * discretisation.sound_speed) + " m/s)");
    throw Violation("particles in violation: " + what + "; the first is particle " + std::to_string(r.offender_id) + " at " +
                    point(r.offender_position) + " m with velocity " + point(r.offender_velocity) + " m/s," + when);
  }
  if (!(r.time_step >= discretisation.least_time_step))
    throw Violation("the time step collapsed to " + number(r.time_step) + " s (greatest speed " + number(r.greatest_speed) +
                    " m/s, greatest acceleration " + number(r.greatest_acceleration) + " m/s²)," + when);
}

Simulation::Simulation(const Case& checked, SimulationOptions options) : parts_(std::make_unique<Parts>(checked, std::move(options))) {
  Parts& parts = *parts_;
  const int iterations = parts.scene.numerics.packing.iterations;
  parts.packing = parts.solver->pack(iterations, [&](double fraction) { parts.progress("packing", fraction); });
  parts.report =
      parts.solver->settle(parts.scene.numerics.packing.settling, [&](double fraction) { parts.progress("settling", fraction); });
  try {
    parts.check(parts.report);
  } catch (const Violation& violation) {
    throw Violation(std::string("before the start (numerics/packing/settling is ") + number(parts.scene.numerics.packing.settling) +
                    "): " + violation.what());
  }
  if (parts.world.anything_moves()) parts.solver->set_wall_motions(parts.coupling.now());
  parts.initial_fluid = parts.solver->save();
  parts.initial_bodies = parts.saved_bodies();
  parts.initial_time_step = parts.report.time_step;
  parts.time_step = parts.initial_time_step;
  parts.recorder.start(*parts.solver);
}

Simulation::~Simulation() = default;

void Simulation::advance() {
  Parts& parts = *parts_;
  const double next_time = parts.time + parts.time_step;
  parts.recorder.before_step(*parts.solver, parts.time, next_time);
  parts.coupling.set_time(parts.time);
  parts.report = parts.solver->advance(parts.world.anything_moves() ? &parts.coupling : nullptr);
  const double time = std::exchange(parts.time, next_time);
  ++parts.step;
  parts.guard_hits += static_cast<std::uint64_t>(parts.report.guard_hits);
  parts.check(parts.report);
  parts.time_step = parts.report.time_step;
  parts.recorder.after_step(*parts.solver, time, next_time);
}

void Simulation::reset() {
  Parts& parts = *parts_;
  parts.solver->restore(parts.initial_fluid);
  parts.time = 0;
  parts.restore_bodies(parts.initial_bodies);
  parts.time_step = parts.initial_time_step;
  parts.step = 0;
  parts.guard_hits = 0;
  parts.report = StepReport{};
  parts.report.time_step = parts.initial_time_step;
  parts.recorder.take();
  parts.recorder.start(*parts.solver);
}

void Simulation::save(const std::string& path) const {
  const Parts& parts = *parts_;
  Snapshot snapshot;
  snapshot.version = version();
  snapshot.device = device_description();
  snapshot.scene = flow_of(parts.scene, parts.layout);
  snapshot.time = parts.time;
  snapshot.time_step = parts.time_step;
  snapshot.step = parts.step;
  snapshot.guard_hits = parts.guard_hits;
  snapshot.clocks = parts.recorder.clock_indices();
  snapshot.bodies = parts.saved_bodies();
  snapshot.fluid = parts.solver->save();
  write_snapshot(path, snapshot);
}

void Simulation::restore(const std::string& path) {
  Parts& parts = *parts_;
  const Snapshot snapshot = read_snapshot(path);
  if (snapshot.scene != flow_of(parts.scene, parts.layout))
    throw Error("the snapshot " + path +
                " belongs to another case: everything but title, duration, device and publishing must be the same, meshes too.");
  try {
    parts.solver->restore(snapshot.fluid);
  } catch (const Error& error) {
    throw Error(path + ": " + error.what());
  }
  if (snapshot.device != device_description())
    log(LogLevel::warning, "the snapshot " + path + " was written on " + snapshot.device + ": it continues, but not bit for bit.");
  parts.time = snapshot.time;
  parts.restore_bodies(snapshot.bodies);
  parts.time_step = snapshot.time_step;
  parts.step = snapshot.step;
  parts.guard_hits = snapshot.guard_hits;
  parts.report = StepReport{};
  parts.report.time_step = snapshot.time_step;
  parts.recorder.set_clock_indices(snapshot.clocks);
}

void Simulation::set_outside_wrench(std::size_t owner, const OutsideWrench& wrench) { parts_->world.set_outside_wrench(owner, wrench); }

void Simulation::command(std::size_t owner, const Vector3d& velocity, const Vector3d& angular_velocity) {
  parts_->world.command(owner, parts_->time, velocity, angular_velocity);
}

const RigidWorld& Simulation::bodies() const { return parts_->world; }

Samples Simulation::take_samples() { return parts_->recorder.take(); }

SolverState Simulation::state() const {
  const Parts& parts = *parts_;
  SolverState state;
  state.time = parts.time;
  state.step = parts.step;
  state.time_step = parts.time_step;
  state.particles = parts.solver->particle_count();
  state.greatest_speed = parts.report.greatest_speed;
  state.guard_hits = parts.guard_hits;
  state.shepard_bounded = static_cast<std::uint64_t>(parts.report.shepard_bounded);
  return state;
}

EnergySample Simulation::energies() const {
  const FluidEnergies energies = parts_->solver->energies();
  return {parts_->time, energies.kinetic, energies.potential, energies.compression, energies.mass};
}

namespace {

ParticleCloud cloud_of(const FluidState& fluid, double time, double density, bool surface_only) {
  ParticleCloud cloud;
  cloud.time = time;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    if (surface_only && fluid.surface[i] == 0) continue;
    cloud.id.push_back(fluid.id[i]);
    cloud.position.push_back(fluid.position[i].cast<float>());
    cloud.velocity.push_back(fluid.velocity[i].cast<float>());
    cloud.pressure.push_back(static_cast<float>(fluid.pressure[i]));
    cloud.density.push_back(static_cast<float>(density * (1.0 + fluid.compression[i])));
    cloud.shepard.push_back(static_cast<float>(fluid.shepard[i]));
    cloud.surface.push_back(fluid.surface[i]);
  }
  return cloud;
}

}  // namespace

ParticleCloud Simulation::particles() const {
  return cloud_of(parts_->solver->download(), parts_->time, parts_->scene.fluid.density, false);
}

ParticleCloud Simulation::free_surface() const {
  return cloud_of(parts_->solver->download(), parts_->time, parts_->scene.fluid.density, true);
}

const Case& Simulation::scene() const { return parts_->scene; }

const Layout& Simulation::layout() const { return parts_->layout; }

std::string Simulation::device_description() const { return parts_->device.info().describe(); }

std::string Simulation::summary() const {
  const Parts& parts = *parts_;
  const Discretisation& d = parts.discretisation;
  const std::size_t count = parts.solver->particle_count();
  std::string text;
  const auto line = [&](const std::string& key, const std::string& value) { text += key + ": " + value + "\n"; };
  line("wavetank", version());
  line("case", parts.scene.title);
  line("device", device_description());
  line("particles", std::to_string(count) + ", spacing " + number(d.spacing) + " m, smoothing length " + number(d.smoothing_length) +
                        " m, support " + number(d.support / d.spacing) + " spacings");
  line("wall elements", std::to_string(walls_in_use(parts.scene, parts.layout)));
  line("sound speed", number(d.sound_speed) + " m/s, expected Mach number " +
                          number(std::max(expected_speed(parts.scene, parts.layout), parts.fastest) / d.sound_speed, "%.3f"));
  line("bounds on the time step", "acoustic " + number(d.acoustic_time) + " s at rest, viscous " + number(d.viscous_time) + " s");
  line("packing", std::to_string(parts.packing.iterations) + " iterations, h|E| from " + number(parts.packing.first_error, "%.3g") +
                      " to " + number(parts.packing.last_error, "%.3g"));
  line("settling", number(parts.scene.numerics.packing.settling) + " periods of the slowest sound");
  line("device memory", number(static_cast<double>(parts.solver->device_memory()) / 1e6, "%.1f") + " MB, " +
                            number(static_cast<double>(parts.solver->device_memory()) / static_cast<double>(count), "%.0f") +
                            " bytes a particle");
  return text;
}

std::vector<KernelTime> Simulation::kernel_times() const {
  std::vector<KernelTime> times;
  for (const compute::KernelTiming& timing : parts_->device.timings()) times.push_back({timing.kernel, timing.launches, timing.seconds});
  return times;
}

Estimate estimate(const Case& checked, const SimulationOptions& options) {
  const Layout layout = lay_out(checked, options.resolve);
  const Case scene = settled(checked, layout, fastest_wall(checked, layout, options.resolve));
  const Discretisation discretisation = discretise(scene, layout);
  RigidWorld world(scene, layout, options.resolve);
  Coupling coupling(world, scene, layout, discretisation);
  WallMover* const mover = world.anything_moves() ? &coupling : nullptr;
  const compute::Device device(compute::choose_device(scene.device));
  const std::unique_ptr<Solver> solver = make_solver(device, scene, layout, discretisation, reference_points(world));
  solver->limit_time_step(coupling.longest_time_step());
  tell_of_thin_walls(scene, discretisation, *solver);
  solver->start();
  solver->advance(mover);  // the first launch of a kernel may still compile it
  constexpr int measured_steps = 3;
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < measured_steps; ++k) solver->advance(mover);
  const double step_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / measured_steps;

  Estimate result;
  result.particles = layout.particles.size();
  result.wall_elements = walls_in_use(scene, layout);
  result.lid_elements = layout.lid.size();
  result.device_memory = static_cast<double>(solver->device_memory());
  result.time_step = std::min({discretisation.acoustic_time, discretisation.viscous_time, coupling.longest_time_step()});
  const double steps = (scene.duration + scene.numerics.packing.settling * discretisation.sound_period) / result.time_step;
  result.wall_seconds = (steps + 0.5 * scene.numerics.packing.iterations) * step_seconds;
  return result;
}

}  // namespace wavetank
