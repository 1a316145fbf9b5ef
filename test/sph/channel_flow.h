#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "wavetank/scene/case.h"
#include "wavetank/sph/solver.h"

/// Flow between two plates at Re = 10, in a tank that repeats itself along x: Poiseuille's, driven by a body force, and Couette's, by a
/// plate that runs; SI units.
namespace wavetank::channel_flow {

constexpr double height = 1, viscosity = 0.1, density = 1, top_speed = 1;
const double pi = std::acos(-1.0);

/// A channel along x between z = 0 and `height`; at its top the tank's wall, or a plate. Without a force that drives it.
inline Case channel(double spacing, bool plate) {
  Case scene;
  scene.dimensions = 2;
  scene.gravity = Vector3d::Zero();
  scene.duration = 1;
  scene.fluid.density = density;
  scene.fluid.viscosity = viscosity;
  scene.fluid.sound_speed = 10 * top_speed;
  scene.fluid.spacing = spacing;
  const double length = 10 * spacing;  // no less than twice the support
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(length, 0, height)}};
  scene.tank.shape = BoxTank{Vector3d(length, 0, plate ? 1.2 * height : height), Vector3d::Zero(), true};
  scene.tank.periodic = {true, false, false};
  scene.numerics.artificial_viscosity = 0;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  if (!plate) return scene;
  BodyCase body;
  body.name = "plate";
  body.shape = Box{Vector3d(0, 0, height), Vector3d(length, 0, 1.2 * height)};
  body.surface_velocity = Vector3d(top_speed, 0, 0);
  scene.bodies.push_back(body);
  return scene;
}

/// Of Poiseuille's flow, m/s².
constexpr double driving_force = 8 * viscosity * top_speed / (density * height * height);

/// Speed at height z and time t after the start, from rest.
inline double poiseuille(double z, double t) {
  double speed = 4 * top_speed * z * (height - z) / (height * height);
  for (int n = 1; n < 400; n += 2)
    speed -= 32 * top_speed / std::pow(n * pi, 3) * std::sin(n * pi * z / height) * std::exp(-std::pow(n * pi / height, 2) * viscosity * t);
  return speed;
}

inline double couette(double z, double t) {
  double speed = top_speed * z / height;
  for (int n = 1; n < 400; ++n)
    speed += 2 * top_speed / (n * pi) * (n % 2 == 0 ? 1 : -1) * std::sin(n * pi * z / height) *
             std::exp(-std::pow(n * pi / height, 2) * viscosity * t);
  return speed;
}

/// Mean differences of the speed of layers, as thick as the spacing, from what it should be; relative to the greatest speed.
class Layers {
 public:
  explicit Layers(int count) : difference_(count, 0.0), members_(count, 0.0) {}

  void add(const FluidState& fluid, double time, double (*exact)(double, double)) {
    const int count = static_cast<int>(difference_.size());
    for (std::size_t i = 0; i < fluid.id.size(); ++i) {
      const int layer = std::clamp(static_cast<int>(fluid.position[i].z() / height * count), 0, count - 1);
      difference_[layer] += (fluid.velocity[i].x() - exact(fluid.position[i].z(), time)) / top_speed;
      members_[layer] += 1;
    }
  }
  /// Root of the mean square.
  double mean() const {
    double sum = 0;
    for (std::size_t layer = 0; layer < difference_.size(); ++layer) sum += std::pow(error(layer), 2);
    return std::sqrt(sum / static_cast<double>(difference_.size()));
  }
  double greatest() const {
    double most = 0;
    for (std::size_t layer = 0; layer < difference_.size(); ++layer) most = std::max(most, std::abs(error(layer)));
    return most;
  }

 private:
  double error(std::size_t layer) const { return difference_[layer] / std::max(members_[layer], 1.0); }
  std::vector<double> difference_, members_;
};

}  // namespace wavetank::channel_flow
