#include "wind.h"

#include <cmath>
#include <random>

#include "uniform_numbers.h"

namespace wavetank {
namespace {

constexpr int components = 64;

}  // namespace

Wind::Wind(const WindCase& wind) : wind_(wind) {
  if (wind.gust_intensity == 0) return;
  std::mt19937_64 generator(static_cast<std::uint64_t>(wind.seed));
  for (int k = 0; k < components; ++k) {
    const double below = (k + uniform(generator)) / components;  // of the energy, at lower frequencies
    gusts_.push_back({std::tan(0.5 * M_PI * below) / wind.gust_time, 2 * M_PI * uniform(generator)});
  }
}

Vector3d Wind::velocity(double time) const {
  double gust = 0;
  for (const Component& component : gusts_) gust += std::sin(component.angular_frequency * time + component.phase);
  return (1 + wind_.gust_intensity * std::sqrt(2.0 / components) * gust) * wind_.velocity;
}

Vector3d Wind::force(double time, const Vector3d& of_area) const {
  const Vector3d relative = velocity(time) - of_area;
  return 0.5 * wind_.density * wind_.drag_coefficient * wind_.area * relative.norm() * relative;
}

}  // namespace wavetank
