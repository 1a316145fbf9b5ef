// What a surface of the water is found from.
#include "simulation_parts.h"
#include "wavetank/instruments/filled.h"

namespace wavetank {

std::vector<Eigen::Vector3f> Simulation::places() const {
  std::vector<Eigen::Vector3f> places;
  const FluidState fluid = parts_->solver->download();
  places.reserve(fluid.position.size());
  for (const Vector3d& place : fluid.position) places.push_back(place.cast<float>());
  return places;
}

std::vector<float> Simulation::filling(const std::vector<Vector3d>& places) const {
  Solver& solver = *parts_->solver;
  std::vector<float> filling;
  filling.reserve(places.size());
  for (const PointValue& value : solver.evaluate(*solver.make_points(places))) filling.push_back(static_cast<float>(filled(value)));
  return filling;
}

}  // namespace wavetank
