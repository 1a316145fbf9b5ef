#include "still_tank.h"

#include <algorithm>
#include <cmath>

#include "wavetank/simulation/simulation.h"

namespace wavetank::bench {
namespace {

constexpr double duration = 0.3;  // s, t √(g/depth) = 1.7
constexpr double depth = 0.3, side = 0.3, spacing = 0.02, gravity = 9.81;

Case still_tank_for(const compute::DeviceInfo& device) {
  Case scene;
  scene.title = "still tank";
  scene.duration = duration;
  scene.device = device.indices();
  scene.fluid.spacing = spacing;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(side, side, depth)}};
  scene.tank.shape = BoxTank{Vector3d(side, side, 0.4), Vector3d::Zero(), false};
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 100;
  return scene;
}

}  // namespace

std::vector<Check> check_still_tank(const compute::DeviceInfo& device) {
  Simulation simulation(still_tank_for(device));
  const std::size_t particles = simulation.state().particles;
  double speed = 0;
  while (simulation.state().time < duration) {
    simulation.advance();
    const double now = simulation.state().greatest_speed;
    if (!(now <= speed)) speed = now;
  }
  const ParticleCloud cloud = simulation.particles();
  const double bottom_pressure = simulation.scene().fluid.density * gravity * depth;
  double sum = 0, above = 0;
  for (std::size_t i = 0; i < cloud.id.size(); ++i) {
    sum += std::pow(cloud.pressure[i] / bottom_pressure - (1 - cloud.position[i].z() / depth), 2);
    above = std::max(above, static_cast<double>(cloud.position[i].z()) - depth);
  }
  // On pocl the error is 0.0064 and the speed 0.034: three times as much is allowed.
  const double expected = static_cast<double>(particles);
  return {{"particles after 0.3 s", static_cast<double>(cloud.id.size()), expected, expected, ""},
          {"L2 error of the pressure", std::sqrt(sum / static_cast<double>(cloud.id.size())), 0, 0.02, "rho g depth"},
          {"greatest speed", speed / std::sqrt(gravity * depth), 0, 0.1, "sqrt(g depth)"},
          {"highest particle over the level", above / spacing, 0, 1, "spacings"}};
}

}  // namespace wavetank::bench
