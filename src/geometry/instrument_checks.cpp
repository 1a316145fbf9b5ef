#include "instrument_checks.h"

#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

/// `ignored`: an axis, or -1.
bool within(const Basin& basin, const Vector3d& place, int ignored, double margin) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((axis == 1 && basin.dimensions == 2) || axis == ignored) continue;
    if (place[axis] < basin.domain.min[axis] - margin || place[axis] > basin.domain.max[axis] + margin) return false;
  }
  return true;
}

std::string span(const Basin& basin) { return "the tank spans " + describe(basin.domain.min) + " to " + describe(basin.domain.max) + " m"; }

void check_probe(const PressureProbeCase& probe, const Basin& basin, const OpenSpace& open, double spacing) {
  Vector3d place = probe.position;
  if (basin.dimensions == 2) place.y() = 0;
  const double skin = 0.25 * spacing;
  const std::string name = "pressure probe '" + probe.name + "' at " + describe(probe.position) + " m ";
  if (!within(basin, place, -1, skin)) throw Error(name + "lies outside the tank; " + span(basin));
  for (const Solid& solid : basin.solids) {
    if (!solid.contains(place)) continue;
    const auto surface = basin.grid->nearest(place, skin);
    if (!surface) throw Error(name + "lies inside body '" + solid.name + "'; put it on the body's surface or into the fluid");
  }
  // Farther than a spacing from every wall the open space's voxels about the probe are all in sight.
  if (!basin.grid->nearest(place, 1.01 * spacing) && !open.reached(place, place)) {
    throw Error(name + "lies where the fluid cannot come: walls part it from the fluid");
  }
}

}  // namespace

void check_instruments(const InstrumentsCase& instruments, const Basin& basin, const OpenSpace& open, double spacing) {
  for (const PressureProbeCase& probe : instruments.pressure_probes) check_probe(probe, basin, open, spacing);
  for (const WaveGaugeCase& gauge : instruments.wave_gauges) {
    if (within(basin, gauge.position, basin.top.axis, 1e-6 * spacing)) continue;
    std::string place;
    for (int axis = 0; axis < 3; ++axis)
      if (axis != basin.top.axis)
        place += (place.empty() ? "" : ", ") + std::string(1, "xyz"[axis]) + " = " + describe(gauge.position[axis]);
    throw Error("wave gauge '" + gauge.name + "' at " + place + " m lies outside the tank; " + span(basin));
  }
}

}  // namespace wavetank
