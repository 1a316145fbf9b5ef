// Runs every kernel of the solver on a few hundred particles in 2-D and 3-D, to be watched by oclgrind. Prints what it ran.
#include <cmath>
#include <cstdio>
#include <exception>
#include <set>
#include <stdexcept>
#include <variant>
#include <vector>

#include "wavetank/compute/device.h"
#include "wavetank/sph/solver.h"

namespace {

using wavetank::Vector3d;

wavetank::Case column(int dimensions, wavetank::DensityDiffusion diffusion) {
  const double across = dimensions == 3 ? 0.2 : 0.0;
  wavetank::Case scene;
  scene.dimensions = dimensions;
  scene.fluid.spacing = dimensions == 3 ? 0.05 : 0.025;
  scene.fluid.fill = {wavetank::Box{Vector3d::Zero(), Vector3d(0.25, across, 0.3)}};
  scene.tank.shape = wavetank::BoxTank{Vector3d(0.5, across, 0.4), Vector3d::Zero(), false};
  scene.bodies.push_back({"box", wavetank::Box{Vector3d(0.3, 0.05, 0.0), Vector3d(0.4, 0.15, 0.1)}, wavetank::Motion::fixed});
  scene.numerics.density_diffusion = diffusion;
  return scene;
}

void run(const wavetank::compute::Device& device, const wavetank::Case& checked,
         const std::vector<Vector3d>& centres = {Vector3d::Zero(), Vector3d(0.35, 0.1, 0.05)}, wavetank::WallMover* mover = nullptr) {
  const wavetank::Layout layout = wavetank::lay_out(checked);
  const wavetank::Case scene = wavetank::settled(checked, layout);
  const auto solver = wavetank::make_solver(device, scene, layout, wavetank::discretise(scene, layout), centres);
  solver->set_film({{Vector3d(0.3, 0.1, 0.02), 1e-4, 1000.0}, {Vector3d(0.24, 0.1, 0.02), 1e-4, 1000.0}});
  solver->pack(2, {});
  solver->start();
  for (int step = 0; step < 2; ++step)
    if (!solver->advance(mover).valid()) throw std::runtime_error("a particle is in violation");
  const auto points = solver->make_points({Vector3d(0, 0, 0), Vector3d(0.1, 0.1, 0.1), Vector3d(0.5, 0.2, 0.4), Vector3d(0.45, 0.1, 0.35)});
  const double pressure = solver->evaluate(*points)[1].pressure;
  const double force = solver->wrenches()[0][0].z();
  const double energy = solver->energies().potential;
  solver->lost_volume();
  if (!std::isfinite(pressure) || !std::isfinite(force)) throw std::runtime_error("a pressure or a force is not finite");
  const wavetank::PairCount pairs = solver->count_pairs();
  if (pairs.pairs == 0 || pairs.candidates < pairs.pairs) throw std::runtime_error("the pairs are not counted right");
  const std::vector<char> saved = solver->save();
  solver->restore(saved);
  const std::size_t surface = solver->download().surface.size();
  std::printf("%d-D, diffusion %d: %zu particles (%zu downloaded), %zu wall elements, p = %.1f Pa, F = %.2f N, E = %.2f J\n",
              scene.dimensions, static_cast<int>(scene.numerics.density_diffusion), solver->particle_count(), surface, layout.walls.size(),
              pressure, force, energy);
}

/// A box that is carried from the floor into the water and turned, in a tank that turns too.
class Carried final : public wavetank::WallMover {
 public:
  explicit Carried(int dimensions) : across_(dimensions == 3 ? 1 : 0) {}

  std::vector<int> coupled() const override { return {0, 1}; }
  wavetank::WallMotions at(double, double) override { return motions(); }
  wavetank::WallMotions to_end(double, const std::vector<wavetank::WallWrench>&) override {
    ++step_;
    return motions();
  }

 private:
  wavetank::WallMotions motions() const {
    wavetank::WallMotions motions;
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

}  // namespace

int main() {
  try {
    const wavetank::compute::Device device(wavetank::compute::choose_device("auto"), true);
    std::printf("%s\n", device.info().describe().c_str());
    for (const int dimensions : {2, 3})
      for (const auto diffusion : {wavetank::DensityDiffusion::fourtakas, wavetank::DensityDiffusion::antuono})
        run(device, column(dimensions, diffusion));
    // every kind of wall, with plates thinner than the support (the box in 3-D), belts, periodic ends and ghosts
    for (const int dimensions : {2, 3}) {
      wavetank::Case scene = column(dimensions, wavetank::DensityDiffusion::fourtakas);
      scene.tank.periodic = {false, dimensions == 3, false};
      scene.bodies[0].surface_velocity = Vector3d(0.1, 0, 0);
      if (dimensions == 3) {
        std::get<wavetank::BoxTank>(scene.tank.shape).size.y() = 0.4;  // twice the support
        scene.fluid.fill = {wavetank::Box{Vector3d::Zero(), Vector3d(0.15, 0.4, 0.2)}};
      }
      for (const auto elements :
           {wavetank::WallElements::numerical, wavetank::WallElements::semi_analytical, wavetank::WallElements::facet}) {
        scene.numerics.walls.elements = elements;
        run(device, scene);
      }
      scene.bodies.clear();
      scene.numerics.walls.method = wavetank::WallMethod::ghost;
      scene.numerics.walls.repulsion = 0.1;
      run(device, scene, {Vector3d::Zero()});
    }
    // walls that move, of the kinds that are listed differently
    for (const int dimensions : {2, 3}) {
      wavetank::Case scene = column(dimensions, wavetank::DensityDiffusion::fourtakas);
      scene.numerics.walls.elements = dimensions == 2 ? wavetank::WallElements::numerical : wavetank::WallElements::facet;
      scene.tank.motion = wavetank::Motion::commanded;
      scene.bodies[0].motion = wavetank::Motion::free;
      Carried mover(dimensions);
      run(device, scene, {Vector3d::Zero(), Vector3d(0.35, 0.1, 0.05)}, &mover);
    }
    for (const auto integrator : {wavetank::Integrator::runge_kutta_4, wavetank::Integrator::predictor_corrector}) {
      wavetank::Case scene = column(2, wavetank::DensityDiffusion::fourtakas);
      scene.numerics.integrator = integrator;
      run(device, scene);
    }
    // tiles of sixteen lanes, which read beyond the last particle
    wavetank::compute::DeviceInfo wide = device.info();
    wide.vector_width = 16;
    wavetank::Case open_water = column(3, wavetank::DensityDiffusion::antuono);
    open_water.bodies.clear();
    run(wavetank::compute::Device(wide), open_water, {Vector3d::Zero()});
    run(wavetank::compute::Device(wide), column(3, wavetank::DensityDiffusion::fourtakas));  // past the box, which is thin
    std::set<std::string> kernels;
    for (const auto& timing : device.timings()) kernels.insert(timing.kernel);
    std::printf("kernels run:");
    for (const std::string& kernel : kernels) std::printf(" %s", kernel.c_str());
    std::printf("\n");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
