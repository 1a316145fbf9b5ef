#include "tiles.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "wavetank/common/error.h"
#include "wavetank/sph/solver.h"

namespace wavetank::bench {
namespace {

constexpr double length = 0.8, width = 0.4, tank_depth = 0.32, density = 1000, weight_of_kilogram = 9.81;
constexpr int spray = 60;  // particles, high above the water and in no order: tiles of them lie apart
constexpr unsigned seed = 2024;

struct TileClass {
  const char* name;
  unsigned vector_width;
  bool is_gpu;
};
constexpr TileClass one{"one", 1, true};
constexpr TileClass others[] = {{"narrow tiles (2 x 2)", 4, false}, {"wide tiles (4 x 4)", 16, false}};  // as src/sph/tiling.cpp has them

Case column() {
  Case scene;
  scene.fluid.density = density;
  scene.fluid.spacing = 0.04;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.4, width, tank_depth)}};
  scene.tank.shape = BoxTank{Vector3d(length, width, 0.5), Vector3d::Zero(), false};
  BodyCase box;
  box.name = "box";
  box.shape = Box{Vector3d(0.48, 0.12, 0.0), Vector3d(0.62, 0.28, 0.14)};
  scene.bodies = {box};
  return scene;
}

Layout disordered(Layout layout) {
  std::mt19937 random(seed);
  const auto between = [&random](double low, double high) { return low + (high - low) * random() / 4294967296.0; };
  for (Vector3d& particle : layout.particles)
    for (int axis = 0; axis < 3; ++axis) particle[axis] += between(-0.15, 0.15) * layout.spacing;
  for (int k = 0; k < spray; ++k) {
    const double x = between(0.02, length - 0.02), y = between(0.02, width - 0.02);
    layout.particles.emplace_back(x, y, between(tank_depth + 0.01, 1.2));
    layout.volumes.push_back(layout.volumes.front());
    layout.levels.push_back(tank_depth);
  }
  return layout;
}

struct Outcome {
  PairCount pairs;
  std::vector<Vector3d> positions, velocities;  // by particle id
  std::vector<double> pressures;
  std::vector<WallWrench> wrenches;
};

Outcome outcome(const compute::DeviceInfo& device, const TileClass& tiles) {
  compute::DeviceInfo disguised = device;
  disguised.vector_width = tiles.vector_width;
  disguised.is_gpu = tiles.is_gpu;
  const Case checked = column();
  const Layout layout = disordered(lay_out(checked));
  const Case scene = settled(checked, layout);
  const auto solver =
      make_solver(compute::Device(disguised), scene, layout, discretise(scene, layout), {Vector3d::Zero(), Vector3d::Zero()});
  solver->start();
  Outcome result;
  result.pairs = solver->count_pairs();
  for (int step = 0; step < 3; ++step)
    if (!solver->advance().valid()) throw Error(std::string("tiles of ") + tiles.name + ": a particle is in violation");
  const FluidState fluid = solver->download();
  const std::size_t count = fluid.id.size();
  result.positions.resize(count);
  result.velocities.resize(count);
  result.pressures.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    result.positions.at(fluid.id[i]) = fluid.position[i];
    result.velocities.at(fluid.id[i]) = fluid.velocity[i];
    result.pressures.at(fluid.id[i]) = fluid.pressure[i];
  }
  result.wrenches = solver->wrenches();
  return result;
}

/// The greatest of f(i) for i < count; NaN if one is.
template <class Function>
double greatest(std::size_t count, const Function& f) {
  double most = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double value = f(i);
    if (!(value <= most)) most = value;
    if (std::isnan(most)) break;
  }
  return most;
}

std::vector<Check> differences(const std::string& name, const Outcome& a, const Outcome& b) {
  // Sums in another order: some roundings (6e-8) of the largest terms, 1e-7 for places and speeds and 3e-7 for pressures and forces on
  // pocl. A device's compiler may round on the way in other places for each class; a neighbour left out is 1e-3 and more.
  constexpr double few_pairs = 4, rounding_of_places = 2e-6, rounding_of_speeds = 1e-5, rounding_of_pressures = 1e-4;
  const double pressure = density * weight_of_kilogram * tank_depth, speed = std::sqrt(weight_of_kilogram * tank_depth);
  const double pairs = std::abs(static_cast<double>(a.pairs.pairs) - static_cast<double>(b.pairs.pairs));
  const double places = greatest(a.positions.size(), [&](std::size_t i) { return (a.positions[i] - b.positions[i]).norm() / tank_depth; });
  const double speeds = greatest(a.velocities.size(), [&](std::size_t i) { return (a.velocities[i] - b.velocities[i]).norm() / speed; });
  const double pressures =
      greatest(a.pressures.size(), [&](std::size_t i) { return std::abs(a.pressures[i] - b.pressures[i]) / pressure; });
  const double forces = greatest(4 * a.wrenches.size(), [&](std::size_t k) {
    return (a.wrenches[k / 4][k % 4] - b.wrenches[k / 4][k % 4]).norm() / (pressure * width * tank_depth);
  });
  const auto within = [&](const std::string& what, double value, double most, const char* unit) {
    return Check{name + ": " + what, value, 0, most, unit};
  };
  return {within("pairs", pairs, few_pairs, "pairs"),  // at R itself rounding decides, and the kernel vanishes
          within("places", places, rounding_of_places, "depth"), within("speeds", speeds, rounding_of_speeds, "sqrt(g depth)"),
          within("pressures", pressures, rounding_of_pressures, "rho g depth"),
          within("forces", forces, rounding_of_pressures, "rho g depth area")};
}

}  // namespace

std::vector<Check> check_tiles(const compute::DeviceInfo& device) {
  const Outcome scalar = outcome(device, one);
  std::vector<Check> checks;
  for (const TileClass& tiles : others)
    for (Check& check : differences(tiles.name, scalar, outcome(device, tiles))) checks.push_back(std::move(check));
  return checks;
}

}  // namespace wavetank::bench
