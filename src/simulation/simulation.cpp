#include "wavetank/simulation/simulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include "coupling.h"
#include "snapshot.h"
#include "water_film.h"
#include "wavetank/common/log.h"
#include "wavetank/common/stopwatch.h"
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

/// The greatest distance of the box from a point, m.
double reach_of(const Box& box, const Vector3d& point) {
  return (box.max - point).cwiseAbs().cwiseMax((box.min - point).cwiseAbs()).norm();
}

/// What the speed of sound must allow for beside the water's own fall: motions that are prescribed or limited, and the fall of bodies, m/s.
double fastest_wall(const Case& scene, const Layout& layout, const ResourceResolver& resolve) {
  double fastest = 0;
  const auto look_at = [&](Motion motion, const RigidCase& rigid, const TriangleMesh& mesh, const Vector3d& reference,
                           const std::string& what) {
    const Box box = mesh.bounding_box();
    double speed = 0;
    if (motion == Motion::prescribed) {
      speed = PrescribedMotion(rigid.prescribed, reference, scene.dimensions, scene.directory, resolve, what)
                  .greatest_speed(box, scene.duration);
    } else if (motion == Motion::commanded) {
      speed = rigid.command.greatest_speed.value_or(0) + rigid.command.greatest_angular_speed.value_or(0) * reach_of(box, reference);
    } else if (motion == Motion::free) {
      const double fall = std::max(lowest_of(box, layout.up) - lowest_of(layout.domain, layout.up), 0.0);
      speed = rigid.velocity.norm() + std::sqrt(2.0 * scene.gravity.norm() * fall);
    }
    fastest = std::max(fastest, speed);
  };
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyCase& body = scene.bodies[b];
    if (body.motion == Motion::fixed) continue;
    const std::string what = "body '" + body.name + "'";
    const TriangleMesh& mesh = layout.meshes[b + 1];
    look_at(body.motion, body.rigid, mesh, mass_properties(body.rigid, mesh, scene.dimensions, what, body.motion == Motion::free).centre,
            what);
  }
  // a tank's own motion is not seen in its frame, but what the water makes of a standstill is
  if (scene.tank.motion != Motion::free) look_at(scene.tank.motion, scene.tank.rigid, layout.meshes[0], Vector3d::Zero(), "tank");
  return fastest;
}

/// Tells one geometry, and prescribed motions, from others (FNV-1a): a case names its meshes and records, but does not hold them.
std::uint64_t fingerprint(const Case& scene, const Layout& layout, const RigidWorld& world) {
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
  std::vector<std::size_t> prescribed;
  if (scene.tank.motion == Motion::prescribed) prescribed.push_back(0);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].motion == Motion::prescribed) prescribed.push_back(1 + b);
  constexpr double interval = 0.01, end = 20;  // s
  for (double time = 0; !prescribed.empty() && time < end; time += interval) {
    const std::vector<RigidState> states = world.at_middle(time, interval);
    for (const std::size_t owner : prescribed) {
      add(states[owner].position.data(), 3);
      add(states[owner].orientation.coeffs().data(), 4);
    }
  }
  return hash;
}

/// The case and its geometry as far as they decide the flow and the samples: what a snapshot must agree on.
std::string flow_of(Case scene, const Layout& layout, const RigidWorld& world) {
  const std::uint64_t geometry = fingerprint(scene, layout, world);
  scene.title.clear();
  scene.duration = 1;
  scene.device = "auto";
  scene.publishing = PublishingCase{};
  return write_case(scene) + "geometry " + std::to_string(geometry) + "\n";
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

void tell_of_noise(const Case& scene) {
  const WallCase& walls = scene.numerics.walls;
  if (walls.method == WallMethod::boundary_integral && walls.shepard == ShepardFactor::none)
    log(LogLevel::warning,
        "numerics/walls/shepard is none: walls push unevenly, and water at rest does not stay so; it is for comparison only.");
  if (scene.numerics.density_diffusion != DensityDiffusion::none) return;
  log(LogLevel::warning,
      "numerics/density_diffusion is none: nothing damps the noise of pressures, and water at rest does not stay so for long; choose "
      "fourtakas or antuono unless that is what you look at.");
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
        film(world, scene, layout, discretisation),
        device(compute::choose_device(scene.device), options.time_kernels),
        solver(prepared_solver()),
        recorder(scene, layout, *solver, world, [this](Solver& fluid) { return wrenches(fluid); }) {
    tell_of_noise(scene);
    tell_of_shallow_water(layout);
    tell_of_thin_walls(scene, discretisation, *solver);
    solver->limit_time_step(coupling.longest_time_step());
    initial_bodies = world.save();
    for (std::size_t o = 0; o < world.count(); ++o) reaches.push_back(reach_of(layout.meshes[o].bounding_box(), world.reference(o)));
    left_tank.resize(world.count(), false);
  }

  Layout laid_out(const Case& checked) const {
    progress("laying out", 0.0);
    Layout result = lay_out(checked, options.resolve);
    progress("laying out", 1.0);
    return result;
  }

  std::unique_ptr<Solver> prepared_solver() {
    const Stopwatch::Lap lap(compiling);
    progress("compiling kernels", 0.0);
    std::unique_ptr<Solver> result = make_solver(device, scene, layout, discretisation, reference_points(world));
    progress("compiling kernels", 1.0);
    return result;
  }

  void progress(const char* what, double fraction) const {
    if (options.progress) options.progress(what, fraction);
  }

  /// The fluid's, with those of films that particles do not resolve.
  std::vector<WallWrench> wrenches(Solver& fluid) {
    const WaterFilm::State films = film.find(fluid, coupling.now().frame, true);
    fluid.set_film(films.lumps);
    std::vector<WallWrench> wrenches = fluid.wrenches();
    for (std::size_t o = 0; o < wrenches.size(); ++o) {
      wrenches[o][0] += films.loads[o].force;
      wrenches[o][2] += films.loads[o].torque;
    }
    return wrenches;
  }

  /// One step with the samples that fall into it.
  void advance();
  /// The next step is short enough for what walls do in it.
  void shorten_step();
  /// The films that the next step begins with.
  void find_films();
  /// The step alone.
  void step_on();
  void check(const StepReport& report);
  /// Throws Violation where particles lie upon each other instead of filling their volume.
  void check_volume();
  /// What preparing the solver takes when its kernels were compiled before, as they are when the run comes.
  double loading_seconds();
  /// Throws Violation for a body too fast to be followed; says once of one that it has left the tank.
  void check_bodies();
  std::string when() const;
  /// Bodies and what the fluid has been told of them, as bytes; and back.
  std::vector<char> saved_bodies() const;
  void restore_bodies(const std::vector<char>& bytes);

  SimulationOptions options;
  Stopwatch compiling;
  Layout layout;
  double fastest;  ///< m/s, expected of walls
  Case scene;
  Discretisation discretisation;
  RigidWorld world;
  Coupling coupling;
  WaterFilm film;
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
  std::vector<double> reaches;  ///< of each owner, of its bounding box from its reference point at the start, m
  std::vector<bool> left_tank;  ///< of each owner: it has, and that was said
  bool told_of_loss = false;    ///< of the water's volume
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
void Simulation::Parts::check(const StepReport& r) {
  if (r.offender >= 0) {
    std::string what;
    const auto add = [&](int count, const std::string& text) {
      if (count > 0) what += (what.empty() ? "" : ", ") + std::to_string(count) + text;
    };
    add(r.not_finite, " with values that are not finite");
    add(r.outside, " outside the tank");
    add(r.too_fast, " faster than half the speed of sound (" + number(0.5 * discretisation.sound_speed) + " m/s)");
    throw Violation("particles in violation: " + what + "; the first is particle " + std::to_string(r.offender_id) + " at " +
                    point(r.offender_position) + " m with velocity " + point(r.offender_velocity) + " m/s," + when());
  }
  if (!(r.time_step >= discretisation.least_time_step))
    throw Violation("the time step collapsed to " + number(r.time_step) + " s (greatest speed " + number(r.greatest_speed) +
                    " m/s, greatest acceleration " + number(r.greatest_acceleration) + " m/s²)," + when());
  check_bodies();
}

void Simulation::Parts::check_volume() {
  constexpr std::uint64_t interval = 200;    // steps: it takes long to come about, and a look at it as long as half a step
  constexpr double told = 0.03, most = 0.1;  // of the volume; dam breaks stay at 0.01
  if (step % interval != 0) return;
  const LostVolume volume = solver->lost_volume();
  if (!(volume.lost > told * volume.whole)) return;
  const std::string unit = scene.dimensions == 2 ? " m²" : " m³";
  const std::string what = "of the water's volume of " + number(volume.whole) + unit + " by its density, " + number(volume.lost, "%.3g") +
                           unit + " are missing: particles lie upon each other, most of all at " + point(volume.place) + " m";
  if (volume.lost > most * volume.whole) throw Violation(what + "," + when());
  if (!std::exchange(told_of_loss, true)) log(LogLevel::warning, what + ", at t = " + number(time) + " s.");
}

void Simulation::Parts::check_bodies() {
  for (std::size_t o = 1; o < world.count(); ++o) {
    if (!world.moves(o)) continue;
    const std::string what = "body '" + scene.bodies[o - 1].name + "'";
    const RigidState state = world.state_in_tank(o);
    const double speed = state.velocity.norm() + state.angular_velocity.norm() * reaches[o];
    if (!(speed < 0.5 * discretisation.sound_speed))
      throw Violation(what + " moves at " + number(speed) + " m/s, faster than half the speed of sound (" +
                      number(0.5 * discretisation.sound_speed) + " m/s)," + when());
    const Vector3d beyond = (layout.domain.min - state.position).cwiseMax(state.position - layout.domain.max);
    const double farthest = std::max({beyond.x(), beyond.z(), scene.dimensions == 3 ? beyond.y() : -1.0});
    if (left_tank[o] || farthest < reaches[o]) continue;
    left_tank[o] = true;
    log(LogLevel::warning, what + " has left the tank: it is at " + point(state.position) + " m at t = " + number(time) + " s.");
  }
}

double Simulation::Parts::loading_seconds() {
  constexpr double loading = 1.5;  // s: whatever took longer compiled
  const double spent = compiling.seconds();
  if (spent < loading) return spent;
  try {
    const Stopwatch::Lap lap(compiling);
    make_solver(compute::Device(compute::choose_device(scene.device), options.time_kernels), scene, layout, discretisation,
                reference_points(world));  // another device keeps no programs yet
  } catch (const Error&) {                 // there is no room for two
    return 0;
  }
  return compiling.seconds() - spent;
}

std::string Simulation::Parts::when() const {
  return " at t = " + number(time) + " s, step " + std::to_string(step) + ": the simulation stops";
}

Simulation::Simulation(const Case& checked, SimulationOptions options) : parts_(std::make_unique<Parts>(checked, std::move(options))) {
  Parts& parts = *parts_;
  const int iterations = parts.scene.numerics.packing.iterations;
  parts.find_films();  // of the lattice: how much they fill
  parts.packing = parts.solver->pack(iterations, [&](double fraction) { parts.progress("packing", fraction); });
  parts.solver->start();
  parts.find_films();  // with the pressures of the start
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
  try {
    parts_->advance();
  } catch (const Violation&) {
    throw;
  } catch (const Error& error) {  // a lost device, say: what is known until here is worth keeping
    throw Violation(error.what() + parts_->when());
  }
}

void Simulation::Parts::shorten_step() {
  if (!world.anything_moves()) return;
  coupling.set_time(time);
  const double allowed = coupling.allowed_step(time_step);
  if (!(allowed >= discretisation.least_time_step) && time_step >= discretisation.least_time_step)
    throw Violation("a body jumps: it would move by more than " + number(Discretisation::wall_reach * discretisation.spacing) + " m in " +
                    number(discretisation.least_time_step) + " s," + when());
  time_step = solver->shorten_step(allowed);
}

void Simulation::Parts::advance() {
  shorten_step();
  const double last_time = time, next_time = time + time_step;
  recorder.before_step(*solver, last_time, next_time);
  step_on();
  recorder.after_step(*solver, last_time, next_time);
}

void Simulation::Parts::find_films() {
  WaterFilm::State films = film.find(*solver, coupling.now().frame, false);
  solver->set_film(films.lumps);
  coupling.set_film(std::move(films.loads));
}

void Simulation::Parts::step_on() {
  coupling.set_time(time);
  find_films();
  report = solver->advance(world.anything_moves() ? &coupling : nullptr);
  time += time_step;
  ++step;
  guard_hits += static_cast<std::uint64_t>(report.guard_hits);
  check(report);
  check_volume();
  time_step = report.time_step;
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
  parts.left_tank.assign(parts.left_tank.size(), false);
  parts.told_of_loss = false;
  parts.recorder.take();
  parts.recorder.start(*parts.solver);
}

void Simulation::save(const std::string& path) const {
  const Parts& parts = *parts_;
  Snapshot snapshot;
  snapshot.version = version();
  snapshot.device = device_description();
  snapshot.scene = flow_of(parts.scene, parts.layout, parts.world);
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
  if (snapshot.scene != flow_of(parts.scene, parts.layout, parts.world))
    throw Error("the snapshot " + path +
                " belongs to another case: everything but title, duration, device and publishing must be the same, meshes and records of "
                "motions too.");
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

EnergySample Simulation::energies() const { return parts_->recorder.energies(*parts_->solver, parts_->time); }

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
  const auto add_host = [&times](const char* what, const Stopwatch& watch) {
    if (watch.count() > 0) times.push_back({std::string("(host) ") + what, watch.count(), watch.seconds()});
  };
  add_host("bodies, contacts, joints", parts_->coupling.world_time());
  add_host("water films", parts_->film.time());
  return times;
}

PairCount Simulation::count_pairs() const { return parts_->solver->count_pairs(); }

std::size_t Simulation::device_memory() const { return parts_->solver->device_memory(); }

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// The middle of what each of several goes takes, which a hiccup of the machine does not change.
template <class Go>
double median_seconds(const Go& go) {
  constexpr int fewest = 5, most = 60;
  constexpr double enough = 0.6;  // s in all
  std::vector<double> laps;
  const Clock::time_point begin = Clock::now();
  while (static_cast<int>(laps.size()) < fewest || (static_cast<int>(laps.size()) < most && seconds_since(begin) < enough)) {
    const Clock::time_point lap = Clock::now();
    go();
    laps.push_back(seconds_since(lap));
  }
  const auto middle = laps.begin() + static_cast<std::ptrdiff_t>(laps.size() / 2);
  std::nth_element(laps.begin(), middle, laps.end());
  return *middle;
}

}  // namespace

Estimate estimate(const Case& checked, const SimulationOptions& options) {
  const Clock::time_point begin = Clock::now();
  Simulation::Parts parts(checked, options);
  Estimate result;
  result.start_seconds = seconds_since(begin) - parts.compiling.seconds();
  result.start_seconds += parts.loading_seconds();
  Solver& solver = *parts.solver;
  const NumericsCase& numerics = parts.scene.numerics;
  const auto unheard = [](double) {};
  if (numerics.packing.iterations > 0) {
    solver.pack(1, unheard);  // the first launch of a kernel may still compile it
    constexpr int iterations = 8;
    const Clock::time_point packing = Clock::now();
    solver.pack(iterations, unheard);
    result.start_seconds += seconds_since(packing) / iterations * numerics.packing.iterations;
  }
  parts.report = solver.start();
  parts.time_step = parts.report.time_step;
  if (parts.world.anything_moves()) solver.set_wall_motions(parts.coupling.now());
  parts.shorten_step();
  parts.step_on();
  const double step_seconds = median_seconds([&] {
    parts.shorten_step();
    parts.step_on();
  });

  result.particles = parts.layout.particles.size();
  result.wall_elements = walls_in_use(parts.scene, parts.layout);
  result.lid_elements = parts.layout.lid.size();
  result.device_memory = static_cast<double>(solver.device_memory());
  result.size = size_of(parts.scene, parts.layout, parts.world);
  if (const std::optional<ThinWall> wall = solver.thinnest_wall()) result.thinnest_wall = wall->thickness;
  result.spacing = parts.layout.spacing;
  result.time_step = std::min(
      {parts.discretisation.acoustic_time, parts.discretisation.viscous_time, parts.coupling.longest_time_step(), parts.time_step});
  result.start_seconds += numerics.packing.settling * parts.discretisation.sound_period / result.time_step * step_seconds;
  const double steps = parts.scene.duration / result.time_step;
  result.step_seconds = steps * step_seconds;
  result.instrument_seconds = steps * parts.recorder.seconds_a_step(solver, result.time_step);
  result.wall_seconds = result.start_seconds + result.step_seconds + result.instrument_seconds;
  return result;
}

}  // namespace wavetank
