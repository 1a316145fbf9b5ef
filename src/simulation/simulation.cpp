#include "wavetank/simulation/simulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "expected_waves.h"
#include "simulation_parts.h"
#include "texts.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/common/version.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/parallel/group.h"
#include "wavetank/rigid/prescribed_motion.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {
namespace {

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
      speed = PrescribedMotion(rigid.prescribed, reference, scene.dimensions, scene.gravity.norm(), scene.directory, resolve, what)
                  .greatest_speed(box, scene.duration);
      if (rigid.prescribed.waves && rigid.prescribed.waves->absorption) speed *= 2;  // of waves as high that come back
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

void tell_of_thin_walls(const Case& scene, const Discretisation& discretisation, const Solver& solver) {
  const std::optional<ThinWall> wall = solver.thinnest_wall();
  if (!wall) return;
  const std::string whose = wall->owner == 0 ? "the tank" : "body " + scene.bodies[wall->owner - 1].name;
  log(LogLevel::info, whose + " is only " + number(wall->thickness) + " m thick at " + point(wall->place) +
                          " m, with fluid possible on both sides, less than the kernel's support of " + number(discretisation.support) +
                          " m: it is taken for a thin plate, through which the water on one side does not feel that on the other.");
}

bool meet(const Box& a, const Box& b, int dimensions) {
  for (int axis = 0; axis < 3; ++axis)
    if ((dimensions == 3 || axis != 1) && !(a.min[axis] < b.max[axis] && a.max[axis] > b.min[axis])) return false;
  return true;
}

/// A zone would hold a body, and the body the water, without a word about the force; and what is behind an opening moves as that has it.
void check_damping_zones(const Case& scene, const Layout& layout) {
  for (std::size_t k = 0; k < scene.fluid.damping.size(); ++k) {
    const Box& zone = scene.fluid.damping[k].box;
    const std::string what = "fluid/damping/" + std::to_string(k) + "/box ";
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      const Box body = layout.meshes[b + 1].bounding_box();
      if (meet(zone, body, scene.dimensions))
        throw Error(what + "lies over body '" + scene.bodies[b].name + "', from " + point(body.min) + " to " + point(body.max) +
                    " m; a zone must not: move one of them");
    }
    for (const Opening& opening : layout.openings) {
      Box pocket{opening.centre, opening.centre};
      for (const Vector3d& corner : opening.outline)
        for (const double depth : {1e-3 * layout.spacing, opening.pocket}) {
          const Vector3d place = corner - depth * opening.normal;
          pocket.min = pocket.min.cwiseMin(place);
          pocket.max = pocket.max.cwiseMax(place);
        }
      if (meet(zone, pocket, scene.dimensions))
        throw Error(what + "reaches behind opening '" + opening.name +
                    "', where the water moves as that has it; end it before the opening");
    }
  }
}

void tell_of_noise(const Case& scene) {
  const WallCase& walls = scene.numerics.walls;
  if (walls.method == WallMethod::boundary_integral && walls.shepard == ShepardFactor::none)
    log(LogLevel::warning,
        "numerics/walls/shepard is none: walls push unevenly, and water at rest does not stay so; it is for comparison only.");
  if (scene.numerics.density_diffusion != DensityDiffusion::none || scene.numerics.scheme != Scheme::delta_sph)
    return;  // the others diffuse by themselves
  log(LogLevel::warning,
      "numerics/density_diffusion is none: nothing damps the noise of pressures, and water at rest does not stay so for long; choose "
      "fourtakas or antuono unless that is what you look at.");
}

}  // namespace

std::vector<Vector3d> reference_points(const RigidWorld& world) {
  std::vector<Vector3d> points;
  for (std::size_t o = 0; o < world.count(); ++o) points.push_back(world.reference(o));
  return points;
}

std::size_t walls_in_use(const Case& scene, const Layout& layout) {
  const WallCase& walls = scene.numerics.walls;
  if (walls.method == WallMethod::ghost || walls.elements == WallElements::facet) return layout.facets.size();
  return walls.elements == WallElements::semi_analytical ? layout.triangles.size() : layout.walls.size();
}

Simulation::Parts::Parts(const Case& checked, SimulationOptions given)
    : options(std::move(given)),
      layout(laid_out(checked)),
      laws(laws_of(checked)),
      fastest(fastest_inflow(checked, fastest_wall(checked, layout, options.resolve))),
      scene(settled(checked, layout, fastest)),
      discretisation(discretise(scene, layout)),
      world(scene, layout, options.resolve),
      coupling(world, scene, layout, discretisation),
      film(world, scene, layout, discretisation),
      openings(scene, layout, discretisation, laws, reference_points(world)),
      devices(chosen_devices()),
      solver(prepared_solver()),
      recorder(
          scene, layout, *solver, world, [this](Solver& fluid) { return wrenches(fluid); },
          [this] {
            std::vector<FlowAtOpening> flows;
            for (const OpeningState& state : openings.states()) flows.push_back({state.discharge, state.volume});
            return flows;
          }),
      paddles(scene, layout, *solver, world) {
  tell_of_noise(scene);
  tell_of_waves(scene, layout, options.resolve);
  tell_of_shallow_water(layout);
  tell_of_thin_walls(scene, discretisation, *solver);
  solver->limit_time_step(coupling.longest_time_step());
  openings.hold(*solver);
  initial_bodies = world.save();
  for (std::size_t o = 0; o < world.count(); ++o) reaches.push_back(reach_of(layout.meshes[o].bounding_box(), world.reference(o)));
  left_tank.resize(world.count(), false);
}

Layout Simulation::Parts::laid_out(const Case& checked) const {
  progress("laying out", 0.0);
  Layout result = lay_out(checked, options.resolve);
  check_damping_zones(checked, result);
  progress("laying out", 1.0);
  return result;
}

std::vector<FlowLaw> Simulation::Parts::laws_of(const Case& checked) const {
  std::vector<FlowLaw> result;
  for (const OpeningCase& opening : checked.openings) result.emplace_back(opening, checked.directory, options.resolve);
  return result;
}

double Simulation::Parts::fastest_inflow(const Case& checked, double fastest_wall) const {
  double fastest_of_all = 0;
  for (std::size_t o = 0; o < laws.size(); ++o)
    fastest_of_all = std::max({fastest_of_all,
                               fastest_at(o, checked.openings, layout.openings, laws, checked.duration) +
                                   (layout.moving[layout.openings[o].owner] ? fastest_wall : 0.0),
                               fastest_by_head(checked.openings[o], layout.openings[o], laws[o], checked)});
  if (fastest_of_all > 0) fastest_of_all = std::hypot(fastest_of_all, expected_speed(checked, layout));  // and falls on from there
  return std::max(fastest_wall, fastest_of_all);
}

std::vector<compute::Device> Simulation::Parts::chosen_devices() const {
  std::vector<compute::Device> chosen;
  for (const compute::DeviceInfo& info : compute::choose_devices(scene.device)) chosen.emplace_back(info, options.time_kernels);
  if (options.team != nullptr) chosen.resize(1, chosen[0]);  // the others are for the other processes of this machine
  return chosen;
}

std::unique_ptr<Solver> Simulation::Parts::solver_on(const std::vector<compute::Device>& those) const {
  const std::vector<Vector3d> centres = reference_points(world);
  if (options.team != nullptr)
    return make_parted_solver(*options.team, those[0], write_case(scene), scene, layout, discretisation, centres);
  if (those.size() == 1 && !options.in_parts) return make_solver(those[0], scene, layout, discretisation, centres);
  PartedSolverOptions parts;
  parts.takes_turns = options.parts_take_turns;
  return make_parted_solver(those, scene, layout, discretisation, centres, parts);
}

std::unique_ptr<Solver> Simulation::Parts::prepared_solver() {
  const Stopwatch::Lap lap(compiling);
  progress("compiling kernels", 0.0);
  std::unique_ptr<Solver> result = solver_on(devices);
  progress("compiling kernels", 1.0);
  return result;
}

void Simulation::Parts::progress(const char* what, double fraction) const {
  if (options.progress) options.progress(what, fraction);
}

std::vector<WallWrench> Simulation::Parts::wrenches(Solver& fluid) {
  const WaterFilm::State films = film.find(fluid, coupling.now().frame, true);
  fluid.set_film(films.lumps);
  std::vector<WallWrench> wrenches = fluid.wrenches();
  for (std::size_t o = 0; o < wrenches.size(); ++o) {
    wrenches[o][0] += films.loads[o].force;
    wrenches[o][2] += films.loads[o].torque;
  }
  if (!scene.fluid.damping.empty()) {  // which the tank holds
    const FluidEnergies energies = fluid.energies();
    wrenches[0][0] += energies.zone_force;
    wrenches[0][2] += energies.zone_moment - world.reference(0).cross(energies.zone_force);
  }
  return wrenches;
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
  parts.check_start();
  if (parts.world.anything_moves()) parts.solver->set_wall_motions(parts.coupling.now());
  parts.initial_fluid = parts.solver->save();
  parts.initial_bodies = parts.saved_bodies();
  parts.initial_openings = parts.openings.save();
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
  paddles.look(*solver, time);
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
  if (openings.any_moves())
    openings.before_step(*solver, time, time_step, coupling.now(), coupling.at(time_step, 1));
  else
    openings.before_step(*solver, time, time_step, {}, {});
  report = solver->advance(world.anything_moves() ? &coupling : nullptr);
  openings.after_step(report);
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
  parts.place_walls();
  parts.openings.restore(parts.initial_openings);
  parts.time_step = parts.initial_time_step;
  parts.step = 0;
  parts.guard_hits = 0;
  parts.report = StepReport{};
  parts.report.time_step = parts.initial_time_step;
  parts.left_tank.assign(parts.left_tank.size(), false);
  parts.told_of_loss = false;
  parts.told_of_speed = false;
  parts.paddles.reset();
  parts.recorder.take();
  parts.recorder.start(*parts.solver);
}

void Simulation::set_outside_wrench(std::size_t owner, const OutsideWrench& wrench) { parts_->world.set_outside_wrench(owner, wrench); }

void Simulation::command(std::size_t owner, const Vector3d& velocity, const Vector3d& angular_velocity) {
  Parts& parts = *parts_;
  if (parts.world.count() > owner && velocity.allFinite() && angular_velocity.allFinite())  // or the world says what is wrong
    parts.check_commanded_speed(owner == 0 ? "the tank" : "body '" + parts.scene.bodies[owner - 1].name + "'",
                                parts.commanded_speed(owner, velocity, angular_velocity));
  parts.world.command(owner, parts.time, velocity, angular_velocity);
}

double Simulation::Parts::commanded_speed(std::size_t owner, Vector3d velocity, Vector3d angular_velocity) const {
  if (scene.dimensions == 2) velocity.y() = angular_velocity.x() = angular_velocity.z() = 0;  // which do not count
  const CommandCase& limits = owner == 0 ? scene.tank.rigid.command : scene.bodies[owner - 1].rigid.command;
  const auto limited = [](const Vector3d& wanted, const std::optional<double>& greatest) -> Vector3d {
    const double length = wanted.stableNorm();
    return greatest && length > *greatest ? Vector3d(*greatest / length * wanted) : wanted;
  };
  const RigidState now = world.state(owner), tank = world.state(0);
  const Vector3d carried = tank.velocity + tank.angular_velocity.cross(now.position - tank.position);
  const double going = (now.orientation * limited(velocity, limits.greatest_speed) - carried).stableNorm(),
               turning = (now.orientation * limited(angular_velocity, limits.greatest_angular_speed) - tank.angular_velocity).stableNorm();
  // of a tank's own speed the water in it feels nothing, but for a jump, which its limits of acceleration ease
  const bool goes_gently = owner == 0 && limits.greatest_acceleration, turns_gently = owner == 0 && limits.greatest_angular_acceleration;
  return (goes_gently ? 0 : going) + (turns_gently ? 0 : turning * reaches[owner]);
}

void Simulation::Parts::check_commanded_speed(const std::string& whose, double speed) const {
  const double most = 0.5 * discretisation.sound_speed;
  if (speed < most) return;
  throw Error("a velocity commanded of " + whose + " would be " + number(speed) + " m/s, not below half the speed of sound, " +
              number(most) + " m/s: it is ignored, and the one before stays");
}

void Simulation::command_discharge(std::size_t opening, double discharge) { parts_->openings.command(opening, parts_->time, discharge); }

void Simulation::command_joint(std::size_t joint, double value) {
  Parts& parts = *parts_;
  if (joint < parts.scene.joints.size() && parts.scene.joints[joint].command) {
    const JointCase& given = parts.scene.joints[joint];
    const double most = given.command->greatest_velocity.value_or(std::numeric_limits<double>::infinity());
    double reach = 0;
    for (std::size_t b = 0; b < parts.scene.bodies.size(); ++b)
      if (parts.scene.bodies[b].name == given.child) reach = parts.reaches[b + 1];
    const double speed = std::min(std::abs(value), most) * (given.type == JointType::hinge ? reach : 1.0);
    if (given.command->quantity == JointQuantity::velocity) parts.check_commanded_speed("joint '" + given.name + "'", speed);
  }
  parts.world.command_joint(joint, parts.time, value);
}

const std::vector<OpeningState>& Simulation::openings() const { return parts_->openings.states(); }

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
  state.fits_of_first_order = parts.report.counted("fits_of_first_order");
  state.fits_below_first_order = parts.report.counted("fits_below_first_order");
  const PartsState in_parts = parts.solver->parts();
  state.parts = in_parts.count;
  state.imbalance = in_parts.imbalance;
  state.cuts = in_parts.cuts;
  state.exchange_share = in_parts.exchange_share;
  state.messages = in_parts.messages;
  state.message_bytes = in_parts.bytes;
  return state;
}

EnergySample Simulation::energies() const { return parts_->recorder.energies(*parts_->solver, parts_->time); }

namespace {

ParticleCloud cloud_of(const FluidState& fluid, const FluidSurface& surface, double time, double density, bool surface_only) {
  ParticleCloud cloud;
  cloud.time = time;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    if (surface_only && surface.on_surface[i] == 0) continue;
    cloud.id.push_back(fluid.id[i]);
    cloud.position.push_back(fluid.position[i].cast<float>());
    cloud.velocity.push_back(fluid.velocity[i].cast<float>());
    cloud.pressure.push_back(static_cast<float>(fluid.pressure[i]));
    cloud.density.push_back(static_cast<float>(density * (1.0 + fluid.compression[i])));
    cloud.mass.push_back(static_cast<float>(fluid.mass[i]));
    cloud.shepard.push_back(static_cast<float>(surface.shepard[i]));
    cloud.surface.push_back(surface.on_surface[i]);
    cloud.eigenvalue.push_back(static_cast<float>(surface.eigenvalue[i]));
  }
  return cloud;
}

}  // namespace

ParticleCloud Simulation::particles() const {
  return cloud_of(parts_->solver->download(), parts_->solver->find_surface(), parts_->time, parts_->scene.fluid.density, false);
}

ParticleCloud Simulation::free_surface() const {
  return cloud_of(parts_->solver->download(), parts_->solver->find_surface(), parts_->time, parts_->scene.fluid.density, true);
}

const Case& Simulation::scene() const { return parts_->scene; }

const Layout& Simulation::layout() const { return parts_->layout; }

std::string Simulation::device_description() const {
  const std::vector<compute::Device>& devices = parts_->devices;
  if (const parallel::Team* const team = parts_->options.team)
    return std::to_string(team->size()) + (team->size() == 1 ? " process" : " processes") + ", the first on " +
           devices[0].info().describe();
  if (devices.size() == 1) return devices[0].info().describe();
  std::string text = std::to_string(devices.size()) + " parts on " + devices[0].info().describe();
  for (std::size_t k = 1; k < devices.size(); ++k) {
    const std::string other = devices[k].info().describe();
    if (other != devices[k - 1].info().describe()) text += ", " + other;
  }
  return text;
}

std::string Simulation::Parts::kind_of_device() const {
  const compute::DeviceInfo& first = devices[0].info();
  if (devices.size() == 1 && options.team == nullptr) return first.describe();
  return "parts on " + first.name + " (" + first.platform_name + ", driver " + first.driver + ")";
}

std::string Simulation::summary() const {
  const Parts& parts = *parts_;
  const Discretisation& d = parts.discretisation;
  const std::size_t count = parts.solver->particle_count();
  std::string text;
  const auto line = [&](const std::string& key, const std::string& value) { text += key + ": " + value + "\n"; };
  line("wavetank", version());
  line("case", visible_text(parts.scene.title));
  line("device", device_description());
  line("particles", std::to_string(count) + ", spacing " + number(d.spacing) + " m, smoothing length " + number(d.smoothing_length) +
                        " m, support " + number(d.support / d.spacing) + " spacings");
  line("wall elements", std::to_string(walls_in_use(parts.scene, parts.layout)));
  line("sound speed", number(d.sound_speed) + " m/s, expected Mach number " +
                          number(std::max(expected_speed(parts.scene, parts.layout), parts.fastest) / d.sound_speed, "%.3f"));
  line("bounds on the time step",
       "acoustic " + number(d.acoustic_time) + " s at rest, of viscosity and the acoustic damper " + number(d.viscous_time) + " s");
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
  for (const compute::Device& device : parts_->devices)
    for (const compute::KernelTiming& timing : device.timings()) {
      const auto same = std::find_if(times.begin(), times.end(), [&](const KernelTime& time) { return time.kernel == timing.kernel; });
      if (same == times.end()) {
        times.push_back({timing.kernel, timing.launches, timing.seconds});
      } else {
        same->launches += timing.launches;
        same->seconds += timing.seconds;
      }
    }
  const auto add_host = [&times](const char* what, const Stopwatch& watch) {
    if (watch.count() > 0) times.push_back({std::string("(host) ") + what, watch.count(), watch.seconds()});
  };
  add_host("bodies, contacts, joints", parts_->coupling.world_time());
  add_host("water films", parts_->film.time());
  return times;
}

PairCount Simulation::count_pairs() const { return parts_->solver->count_pairs(); }

std::size_t Simulation::device_memory() const { return parts_->solver->device_memory(); }

}  // namespace wavetank
