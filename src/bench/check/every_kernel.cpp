#include "every_kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <variant>

#include "wavetank/sph/kernel_sources.h"
#include "wavetank/sph/parted_solver.h"
#include "wavetank/sph/solver.h"

namespace wavetank::bench {
namespace {

const Vector3d box_centre(0.25, 0.1, 0.05);

Case column(int dimensions, DensityDiffusion diffusion = DensityDiffusion::fourtakas) {
  // of 75 and 63 particles: no whole number of tiles, of which the last reads beyond the end
  const double across = dimensions == 3 ? 0.25 : 0.0;
  Case scene;
  scene.dimensions = dimensions;
  scene.fluid.spacing = dimensions == 3 ? 0.05 : 0.025;
  scene.fluid.fill = {Box{Vector3d::Zero(), dimensions == 3 ? Vector3d(0.15, across, 0.25) : Vector3d(0.175, 0, 0.225)}};
  scene.tank.shape = BoxTank{Vector3d(0.35, across, 0.3), Vector3d::Zero(), false};
  BodyCase box;
  box.name = "box";
  box.shape = Box{Vector3d(0.2, 0.05, 0.0), Vector3d(0.3, 0.15, 0.1)};
  scene.bodies = {box};
  scene.numerics.density_diffusion = diffusion;
  scene.numerics.support = dimensions == 3 ? 2.2 : 3.0;  // few neighbours, of which what watches has to see each
  return scene;
}

template <class Choice>
Choice nth(std::size_t k) {
  return method_words<Choice>()[k % method_words<Choice>().size()].choice;
}

/// A box that is carried from the floor into the water and turned, in a tank that turns too.
class Carried final : public WallMover {
 public:
  explicit Carried(int dimensions) : across_(dimensions == 3 ? 1 : 0) {}

  std::vector<int> coupled() const override { return {0, 1}; }
  WallMotions at(double, double) override { return motions(); }
  WallMotions to_end(double, const std::vector<WallWrench>&) override {
    ++step_;
    return motions();
  }

 private:
  WallMotions motions() const {
    WallMotions motions;
    motions.owners.resize(2);
    motions.owners[1].displacement = step_ * Vector3d(-0.02, 0.01 * across_, 0.02);  // lists are made anew after a quarter of the spacing
    motions.owners[1].orientation = Eigen::AngleAxisd(0.1 * step_, Vector3d(across_, 1, across_).normalized());
    motions.owners[1].velocity = Vector3d(-0.1, 0.05 * across_, 0.1);
    motions.frame.emplace();
    motions.frame->gravity = Vector3d(0.5, 0, -9.81);
    motions.frame->angular_velocity = Vector3d(0, 0.3, 0);
    motions.frame->angular_acceleration = Vector3d(0, 1, 0);
    return motions;
  }

  int across_;
  int step_ = 0;
};

std::size_t not_finite_in(const FluidState& fluid) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < fluid.id.size(); ++i)
    if (!fluid.position[i].allFinite() || !fluid.velocity[i].allFinite() || !std::isfinite(fluid.pressure[i]) ||
        !std::isfinite(fluid.compression[i]))
      ++count;
  return count;
}

std::size_t not_finite_of(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double value) { return !std::isfinite(value); }));
}

class Runs {
 public:
  Runs(const compute::DeviceInfo& info, const std::function<void(const std::string&)>& tell) : device_(info, true), tell_(tell) {}

  void run(const Case& scene, WallMover* mover = nullptr) { run(device_, scene, mover); }
  void run_wide(const Case& scene) {
    compute::DeviceInfo wide = device_.info();
    wide.vector_width = 16;
    wide.is_gpu = false;
    run(compute::Device(wide), scene, nullptr);
  }
  /// Particles come, for which there is no room yet, and go.
  void run_drains(const Case& scene);
  /// Of a case whose one opening's water moves in at 0.1 m/s.
  void run_openings(const Case& checked);
  /// In two parts, what the one has not been sent by the other being no number.
  void run_parts(const Case& checked);
  EveryKernel result();

 private:
  void run(const compute::Device& device, const Case& checked, WallMover* mover);
  void read(Solver& solver);

  compute::Device device_;
  std::function<void(const std::string&)> tell_;
  EveryKernel found_;
};

void Runs::run(const compute::Device& device, const Case& checked, WallMover* mover) {
  const Layout layout = lay_out(checked);
  const Case scene = settled(checked, layout);
  std::vector<Vector3d> centres(1, Vector3d::Zero());
  centres.resize(1 + scene.bodies.size(), box_centre);
  const auto solver = make_solver(device, scene, layout, discretise(scene, layout), centres);
  solver->set_film({{Vector3d(0.2, 0.1, 0.02), 1e-4, 1000.0, 1e-4}, {Vector3d(0.14, 0.1, 0.02), 1e-4, 1000.0, 1e-4}});
  solver->pack(2, {});
  solver->start();
  bool valid = true;
  // Several evaluations a step bring each integrator's kernels to states that have moved: a second step is for the one that has one, and
  // for walls that move, whose lists are made anew.
  const int steps = scene.numerics.integrator == Integrator::symplectic || mover != nullptr ? 2 : 1;
  for (int step = 0; step < steps; ++step) valid = solver->advance(mover).valid() && valid;
  ++found_.cases;
  if (!valid) ++found_.violations;
  read(*solver);
  char line[200];
  std::snprintf(line, sizeof line, "%d-D, diffusion %d: %zu particles, %zu wall elements", scene.dimensions,
                static_cast<int>(scene.numerics.density_diffusion), solver->particle_count(), layout.walls.size());
  tell_(line);
}

void Runs::run_drains(const Case& checked) {
  const Layout layout = lay_out(checked);
  const Case scene = settled(checked, layout);
  const auto solver = make_solver(device_, scene, layout, discretise(scene, layout), {1 + scene.bodies.size(), box_centre});
  solver->start();
  NewParticles particles;
  for (int k = 0; k < 40; ++k) {
    particles.position.emplace_back(0.02 + 0.007 * k, 0, 0.28);
    particles.velocity.emplace_back(0, 0, -0.1);
    particles.volume.push_back(1e-4);
    particles.pressure.push_back(0);
  }
  solver->let_in(particles);
  solver->set_drains({Drain{Vector3d(0.1, 0, 0.1), Vector3d(0.04, 1, 0.04).asDiagonal()}});
  const std::size_t before = solver->particle_count();
  ++found_.cases;
  const bool valid = solver->advance().valid();
  if (!valid || solver->particle_count() <= before || solver->particle_count() >= before + 40) ++found_.violations;
  read(*solver);
}

void Runs::run_openings(const Case& checked) {
  const Layout layout = lay_out(checked);
  const Case scene = settled(checked, layout);
  const auto solver = make_solver(device_, scene, layout, discretise(scene, layout), {Vector3d::Zero()});
  const Opening& opening = layout.openings[0];
  const std::size_t cells = opening.column_of.size();
  ImposedZone zone;
  zone.centre = opening.centre;
  zone.normal = opening.normal;
  zone.across = opening.across;
  zone.up = opening.up;
  zone.depth = opening.pocket;
  zone.cells = opening.cells;
  zone.cell_size = opening.cell_size;
  zone.first_edge = opening.first_edge;
  zone.speed.assign(cells, 0.1);
  zone.pressure.assign(cells, 1000.0);
  solver->set_zones({zone});
  solver->start();
  ++found_.cases;
  if (!solver->advance().valid()) ++found_.violations;
  read(*solver);
}

void Runs::run_parts(const Case& checked) {
  const Layout layout = lay_out(checked);
  const Case scene = settled(checked, layout);
  PartedSolverOptions options;
  options.spoils = true;
  options.takes_turns = true;  // oclgrind knows of one thread alone
  const auto solver = make_parted_solver({device_, compute::Device(device_.info(), true)}, scene, layout, discretise(scene, layout),
                                         {1 + scene.bodies.size(), box_centre}, options);
  solver->pack(1, {});
  solver->start();
  ++found_.cases;
  bool valid = true;
  Carried mover(scene.dimensions);
  for (int step = 0; step < 2; ++step) valid = solver->advance(&mover).valid() && valid;
  if (!valid) ++found_.violations;
  read(*solver);
}

Case moved(int dimensions, WallElements elements) {
  Case scene = column(dimensions);
  scene.numerics.walls.elements = elements;
  scene.tank.motion = Motion::commanded;
  scene.bodies[0].motion = Motion::free;
  return scene;
}

/// Over the whole floor, long enough for two parts.
Case long_water(int dimensions) {
  Case scene = moved(dimensions, WallElements::facet);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.35, dimensions == 3 ? 0.25 : 0, 0.15)}};
  return scene;
}

/// Water that comes in by a wall, a shifting law that leaves it be, and a zone that damps some of the rest.
Case with_inlet(int dimensions) {
  Case scene = column(dimensions);
  scene.bodies.clear();
  scene.numerics.shifting = Shifting::michel;
  OpeningCase inlet;
  inlet.name = "inlet";
  inlet.centre = Vector3d(0, dimensions == 3 ? 0.125 : 0, 0.12);
  inlet.normal = Vector3d::UnitX();
  if (dimensions == 3) {
    inlet.diameter = 0.12;
  } else {
    inlet.centre.z() = 0.1;
    inlet.size = std::array<double, 2>{1, 0.1};
  }
  inlet.velocity = "0.1";
  scene.openings = {inlet};
  DampingCase damping;
  damping.box = Box{Vector3d(0.05, 0, 0), Vector3d(0.35, dimensions == 3 ? 0.25 : 0, 0.3)};
  damping.strength = 10;
  scene.fluid.damping = {damping};
  return scene;
}

/// Likewise between ghosts, whose planes have a hole there: of edges, of a disc.
void run_openings_between_ghosts(Runs& runs, int dimensions) {
  Case scene = with_inlet(dimensions);
  scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.walls.repulsion = 0.1;
  scene.numerics.turbulence = nth<Turbulence>(1);
  runs.run_openings(scene);
  if (dimensions == 3) return;
  scene.numerics.turbulence = Turbulence::none;
  scene.numerics.scheme = Scheme::riemann_ale;
  runs.run_openings(scene);
}

/// All that a solver can be asked.
void Runs::read(Solver& solver) {
  const std::vector<Vector3d> places{Vector3d(0, 0, 0), Vector3d(0.1, 0.1, 0.1), Vector3d(0.35, 0.25, 0.3), Vector3d(0.3, 0.1, 0.25)};
  for (const PointValues wanted : {PointValues::pressure, PointValues::velocity})
    for (const PointValue& value : solver.evaluate(*solver.make_points(places, wanted)))
      found_.not_finite +=
          not_finite_of({value.pressure, value.filling, value.shepard, value.velocity.x(), value.velocity.y(), value.velocity.z()});
  for (const WallWrench& wrench : solver.wrenches())
    for (const Vector3d& part : wrench) found_.not_finite += not_finite_of({part.x(), part.y(), part.z()});
  const FluidEnergies energies = solver.energies();
  found_.not_finite += not_finite_of({energies.kinetic, energies.potential, energies.compression, energies.mass});
  const LostVolume volume = solver.lost_volume();
  found_.not_finite += not_finite_of({volume.lost, volume.whole});
  const PairCount pairs = solver.count_pairs();
  if (pairs.pairs == 0 || pairs.candidates < pairs.pairs) ++found_.wrong_pairs;
  solver.restore(solver.save());
  found_.not_finite += not_finite_in(solver.download()) + not_finite_of(solver.find_surface().shepard);
}

/// Of the definitions "__kernel void NAME(" in the sources.
std::set<std::string> names_of_kernels() {
  const std::string head = "__kernel void ";
  std::set<std::string> names;
  for (const auto& [file, text] : kernel_sources())
    for (std::size_t at = text.find(head); at != std::string::npos; at = text.find(head, at + 1)) {
      const std::size_t begin = at + head.size();
      names.insert(text.substr(begin, text.find('(', begin) - begin));
    }
  return names;
}

EveryKernel Runs::result() {
  std::set<std::string> run;
  for (const auto& timing : device_.timings()) run.insert(timing.kernel);
  found_.run.assign(run.begin(), run.end());
  for (const std::string& name : names_of_kernels())
    if (run.count(name) == 0) found_.missing.push_back(name);
  return found_;
}

/// Every kind of wall, with plates thinner than the support (the box in 3-D), belts, periodic ends and ghosts.
void run_walls(Runs& runs, int dimensions) {
  Case scene = column(dimensions);
  scene.tank.periodic = {false, dimensions == 3, false};
  scene.bodies[0].surface_velocity = Vector3d(0.1, 0, 0);
  for (const auto elements : {WallElements::numerical, WallElements::semi_analytical, WallElements::facet}) {
    scene.numerics.walls.elements = elements;
    runs.run(scene);
    if (dimensions == 3) scene.bodies.clear();  // what is seen past a thin box takes most of the time, and is the same for all elements
  }
  scene.bodies.clear();
  scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.walls.repulsion = 0.1;
  runs.run(scene);
}

/// Walls that move, of the kinds that are listed differently.
void run_motion(Runs& runs, int dimensions) {
  Carried mover(dimensions);
  runs.run(moved(dimensions, dimensions == 2 ? WallElements::numerical : WallElements::facet), &mover);
}

/// Walls of elements that move, in 3-D, with the diffusion that needs a gradient, by every integrator; and the plain case in 2-D.
void run_few(Runs& runs) {
  Case scene = moved(3, WallElements::numerical);
  scene.numerics.density_diffusion = DensityDiffusion::antuono;
  for (const auto integrator : {Integrator::symplectic, Integrator::runge_kutta_4, Integrator::predictor_corrector}) {
    scene.numerics.integrator = integrator;
    Carried mover(3);
    runs.run(scene, &mover);
  }
  runs.run(column(2));
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.scheme = Scheme::riemann_ale;
  scene.numerics.shifting = Shifting::michel;
  Carried mover(3);
  runs.run(scene, &mover);
  runs.run_openings(with_inlet(2));
  runs.run_parts(long_water(2));
}

/// Least squares between wall integrals, by fits found as they are used, and between ghosts, by fits that neighbours are asked for.
void run_least_squares(Runs& runs, int dimensions) {
  Case scene = column(dimensions);
  scene.bodies.clear();
  scene.numerics.gradients = Gradients::mls_corrected;
  runs.run(scene);
  if (dimensions == 2) runs.run_wide(scene);
  scene.numerics.gradients = Gradients::mls;
  scene.numerics.mls.pressure = MlsPressure::adjoint;
  scene.numerics.integrator = Integrator::predictor_corrector;
  scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.walls.repulsion = 0.1;
  runs.run(scene);
}

/// Every word of every key by which a case chooses its method, in as few runs as the longest list has words.
void run_methods(Runs& runs, int dimensions) {
  const std::size_t most = std::max({method_words<Scheme>().size(), method_words<DensityDiffusion>().size(),
                                     method_words<Integrator>().size(), dimensions == 2 ? method_words<Shifting>().size() : 0});
  for (std::size_t k = 0; k < most; ++k) {
    Case scene = column(dimensions);
    NumericsCase& numerics = scene.numerics;
    numerics.scheme = nth<Scheme>(k);
    numerics.density_diffusion = nth<DensityDiffusion>(k + 1);
    numerics.integrator = nth<Integrator>(k);
    numerics.shifting = dimensions == 2 ? nth<Shifting>(k) : Shifting::michel;
    numerics.tensile = nth<Tensile>(k);
    numerics.equation_of_state = nth<EquationOfState>(k);
    numerics.viscosity_model = nth<ViscosityModel>(k);
    numerics.turbulence = nth<Turbulence>(k);
    if (k == 0) numerics.walls.friction.law = FrictionLaw::law_of_the_wall;
    numerics.acoustic_damping = numerics.integrator == Integrator::symplectic ? 2 : 0;
    if (dimensions == 3) scene.bodies.clear();  // what is seen past a thin box takes most of the time, and is run with walls and motions
    runs.run(scene);
  }
}

void run_all(Runs& runs) {
  for (const int dimensions : {2, 3}) {
    run_methods(runs, dimensions);
    run_walls(runs, dimensions);
    run_motion(runs, dimensions);
    run_least_squares(runs, dimensions);
    run_openings_between_ghosts(runs, dimensions);
  }
  // tiles of sixteen lanes, which read beyond the last particle
  Case open_water = column(3, DensityDiffusion::antuono);
  open_water.bodies.clear();
  runs.run_wide(open_water);
  runs.run_wide(column(3));  // past the box, which is thin
  Case shifted = column(3);
  shifted.numerics.scheme = Scheme::riemann_ale;
  shifted.numerics.shifting = Shifting::michel;
  shifted.numerics.acoustic_damping = 1;
  shifted.bodies.clear();
  runs.run_wide(shifted);
  runs.run_drains(column(2));
  runs.run_openings(with_inlet(2));
  runs.run_parts(long_water(2));
}

}  // namespace

EveryKernel run_every_kernel(const compute::DeviceInfo& device, KernelCases cases, const std::function<void(const std::string&)>& tell) {
  Runs runs(device, tell);
  if (cases == KernelCases::few) {
    run_few(runs);
  } else {
    run_all(runs);
  }
  return runs.result();
}

std::vector<Check> check_every_kernel(const compute::DeviceInfo& device) {
  const EveryKernel found = run_every_kernel(device, KernelCases::few, [](const std::string&) {});
  const auto none = [](const std::string& what, std::size_t count) { return Check{what, static_cast<double>(count), 0, 0, ""}; };
  return {none("kernels that did not run, of " + std::to_string(found.run.size() + found.missing.size()), found.missing.size()),
          none("values that are not finite", found.not_finite), none("cases stopped, of " + std::to_string(found.cases), found.violations),
          none("cases with wrong counts of pairs", found.wrong_pairs)};
}

}  // namespace wavetank::bench
