#include "wavetank/sph/discretisation.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

std::string brief_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// What single precision, the speed of sound and counted time cannot hold, in a sentence before the start instead of numbers that are none
/// in the midst of it.
void check_numbers(const Case& scene, const Layout& layout, const Discretisation& d) {
  const FluidCase& fluid = scene.fluid;
  const double cell = std::pow(d.spacing, d.dimensions), c = d.sound_speed;
  const std::string given = "fluid/spacing is " + brief_number(d.spacing) + " m, fluid/density " + brief_number(fluid.density) +
                            " kg/m³ and fluid/sound_speed " + brief_number(c) + " m/s: ";
  const auto check = [&](const char* what, double value) {
    constexpr double least = 1e-30, most = 1e30;  // single precision ends at 1e-38 and 3e38
    if (value >= least && value <= most) return;
    throw Error(given + what + ", " + brief_number(value) + ", is not from 1e-30 to 1e30, which single precision holds; choose others.");
  };
  check("the mass of a particle (kg)", fluid.density * cell);
  check("the slope of the kernel (1/m² and a particle's volume)", 1 / (cell * d.smoothing_length * d.smoothing_length));
  check("density times the square of the speed of sound (Pa)", fluid.density * c * c);
  // of water as high as the tank, at rest
  constexpr double most_compression = 1000;  // the watchdog stops what begins with a few
  const double compression = 0.5 * std::pow(expected_speed(scene, layout) / c, 2);
  if (compression > most_compression)
    throw Error("fluid/sound_speed is " + brief_number(c) + " m/s, with which the water's own weight would make it " +
                brief_number(compression) + " times as dense; choose about " + brief_number(10 * expected_speed(scene, layout)) +
                " m/s, ten times the greatest speed that is expected, or leave it out.");
  constexpr double most_steps = 1e15;  // beyond, a step is nothing beside the time
  const double step = std::min(d.acoustic_time, d.viscous_time);
  if (!(scene.duration <= most_steps * step))
    throw Error("the time step must be at most " + brief_number(step) + " s, by fluid/sound_speed, fluid/viscosity and numerics/courant (" +
                brief_number(c) + " m/s, " + brief_number(fluid.viscosity) + " Pa·s, " + brief_number(scene.numerics.courant) +
                "), of which duration, " + brief_number(scene.duration) + " s, takes more than 1e15; choose others.");
}

}  // namespace

double expected_speed(const Case& checked, const Layout& layout) {
  const double floor = lowest_of(layout.domain, layout.up);
  double surface = floor;
  for (const double level : layout.levels) surface = std::max(surface, level);
  for (const Opening& opening : layout.openings)
    for (const Opening::Column& column : opening.columns)
      if (column.wet) surface = std::max(surface, layout.up.dot(column.place));
  const double drop = std::max(surface - floor, layout.spacing);
  return std::sqrt(2.0 * checked.gravity.norm() * drop);
}

Case settled(const Case& checked, const Layout& layout, double fastest_wall) {
  Case result = checked;
  result.fluid.spacing = layout.spacing;
  result.fluid.particles.reset();
  if (!result.numerics.support) result.numerics.support = checked.dimensions == 2 ? 4.0 : 3.0;
  if (!result.numerics.mls.support) result.numerics.mls.support = std::min(checked.dimensions == 2 ? 3.4 : 2.6, *result.numerics.support);
  if (!result.fluid.sound_speed) {
    const double speed = std::max(expected_speed(checked, layout), fastest_wall);
    if (!(speed > 0.0))
      throw Error("fluid/sound_speed is auto, but without gravity and moving walls there is no expected speed: give it in m/s.");
    constexpr double greatest = 1e6;  // m/s, as the key has it
    if (10.0 * speed > greatest)
      throw Error("fluid/sound_speed is auto, ten times the greatest speed that is expected of water, walls and bodies, " +
                  brief_number(speed) + " m/s: that is beyond 1e6 m/s; make slower what moves so fast, or the tank smaller.");
    result.fluid.sound_speed = 10.0 * speed;
  }
  if (!result.numerics.expected_speed) result.numerics.expected_speed = 0.1 * *result.fluid.sound_speed;
  return result;
}

Discretisation discretise(const Case& settled_case, const Layout& layout) {
  Discretisation d;
  d.dimensions = settled_case.dimensions;
  d.spacing = layout.spacing;
  d.support = *settled_case.numerics.support * layout.spacing;
  d.smoothing_length = 0.5 * d.support;
  d.sound_speed = *settled_case.fluid.sound_speed;

  // sideways and below, half a spacing of tolerance; above an open tank, three times the expected speed may throw water nine times its fall
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.5 * d.spacing);
  const Box reach = with_pockets(layout.domain, layout.openings, d.dimensions);
  d.lower = reach.min - margin;
  d.upper = reach.max + margin;
  d.tank = layout.domain;
  const double speed = expected_speed(settled_case, layout), gravity = std::max(settled_case.gravity.norm(), 1e-9);
  const double throw_height = std::min(9.0 * speed * speed / (2.0 * gravity), 100.0 * (d.upper - d.lower)[top_of(settled_case).axis]);
  double depth = 0;
  for (std::size_t i = 0; i < layout.particles.size(); ++i) depth = std::max(depth, layout.levels[i] - layout.up.dot(layout.particles[i]));
  if (settled_case.gravity.dot(layout.up) != 0) d.sound_period = 4.0 * depth / d.sound_speed;
  d.top = top_of(settled_case);
  d.rim = d.top.of(layout.domain);
  d.splash_guard = settled_case.tank.splash_guard && layout.open_top;
  d.origin = d.lower;
  if (d.dimensions == 2) d.origin.y() = 0.0;
  // above the tank, one more tank of cells: what flies higher shares the topmost
  if (d.top.way < 0) d.origin[d.top.axis] -= d.upper[d.top.axis] - d.lower[d.top.axis];

  double total = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = (d.upper[axis] - d.lower[axis]) * (axis == d.top.axis ? 2.0 : 1.0);
    const double cells = d.dimensions == 2 && axis == 1 ? 1 : std::ceil(extent / d.support) + 2;
    d.cells[axis] = static_cast<int>(std::min(cells, 1e9));  // of more, the total is refused
    total *= cells;
  }
  if (layout.open_top) (d.top.way > 0 ? d.upper : d.lower)[d.top.axis] += d.top.way * throw_height;
  if (total > std::numeric_limits<int>::max() / 4.0)
    throw Error("the tank needs " + std::to_string(total) +
                " grid cells of the support's size, more than can be indexed: raise fluid/spacing.");

  const NumericsCase& numerics = settled_case.numerics;
  const double physical = settled_case.fluid.viscosity / settled_case.fluid.density;
  const double artificial = numerics.artificial_viscosity * d.smoothing_length * d.sound_speed / (2.0 * (d.dimensions + 2));
  // exchange with other particles, and with a wall as near as half a spacing, whose drag is the stiffer the smaller the spacing is beside h
  const double rate = 8.0 * (physical + artificial) + 8.0 * physical * d.smoothing_length / d.spacing;
  d.acoustic_time = numerics.courant * d.smoothing_length / d.sound_speed;
  // the acoustic damper makes sound grow from about 1.6 h/(α₂ c₀) on, and from 0.9 on beside the diffusion of Riemann problems, which is as
  // large
  const double bulk = numerics.acoustic_damping * d.smoothing_length * d.sound_speed / (numerics.scheme == Scheme::delta_sph ? 1.4 : 0.8);
  d.viscous_time = d.smoothing_length * d.smoothing_length / std::max(rate + bulk, 1e-30);
  d.least_time_step = 1e-3 * std::min(d.acoustic_time, d.viscous_time);
  check_numbers(settled_case, layout, d);
  return d;
}

}  // namespace wavetank
