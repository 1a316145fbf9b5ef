#include "instrument_checks.h"

#include <algorithm>
#include <cmath>

#include "opening_pockets.h"
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

/// `kind`: of instrument, for messages.
template <class Probe>
void check_probe(const char* kind, const Probe& probe, const Basin& basin, const OpenSpace& open, double spacing) {
  Vector3d place = probe.position;
  if (basin.dimensions == 2) place.y() = 0;
  const double skin = 0.25 * spacing;
  const std::string name = std::string(kind) + " '" + probe.name + "' at " + describe(probe.position) + " m ";
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

/// Evenly spread on the disc's rim (2-D: its ends), and half way to it.
std::vector<Vector3d> places_on_disc(const PressureProbeCase& probe, const Vector3d& normal, int dimensions) {
  std::vector<Vector3d> places;
  for (const double radius : {0.5 * probe.diameter, 0.25 * probe.diameter}) {
    if (dimensions == 2) {
      const Vector3d along = normal.cross(Vector3d::UnitY());
      places.insert(places.end(), {probe.position - radius * along, probe.position + radius * along});
      continue;
    }
    const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
    constexpr int count = 12;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::acos(-1.0) * k / count;
      places.push_back(probe.position + radius * (std::cos(angle) * a + std::sin(angle) * b));
    }
  }
  return places;
}

/// Whether a wall that faces about the same way is so near to a place of a sensor's disc that it may be curved, but does not end before it.
bool on_wall(const Vector3d& place, const Vector3d& normal, double diameter, const TriangleGrid& grid) {
  constexpr double bent = 0.05, beyond = 1e-6, slope = 0.25;  // of the diameter, along the normal and across; of a curved wall
  const auto wall = grid.nearest(place, bent * diameter);
  if (!wall) return false;
  const Vector3d way = wall->point - place;
  const double along = way.dot(normal);
  return (way - along * normal).norm() <= beyond * diameter + slope * std::abs(along);
}

bool in_opening(const Vector3d& place, const Opening& opening, double spacing) {
  const std::vector<PocketSide> sides = sides_of_pocket(opening, spacing);
  return std::all_of(sides.begin(), sides.end(), [&](const PocketSide& side) { return side.normal.dot(place) < side.offset; });
}

Vector3d disc_normal(const PressureProbeCase& probe, const Basin& basin, const std::vector<Opening>& openings, double spacing) {
  const std::string name = "pressure probe '" + probe.name + "' at " + describe(probe.position) + " m has a disc ";
  const auto wall = basin.grid->nearest(probe.position, 0.25 * spacing);
  if (!wall) throw Error(name + "and lies on no wall; leave out its diameter, or put it on a wall");
  const Vector3d normal = basin.grid->normal(wall->triangle);
  for (const Vector3d& place : places_on_disc(probe, normal, basin.dimensions)) {
    if (!on_wall(place, normal, probe.diameter, *basin.grid))
      throw Error(name + "that reaches beyond its wall at " + describe(place) + " m; make its diameter less, or move it");
    for (const Opening& opening : openings)
      if (in_opening(place, opening, spacing))
        throw Error(name + "that reaches over opening '" + opening.name + "' at " + describe(place) +
                    " m; make its diameter less, or move it");
  }
  return normal;
}

}  // namespace

std::vector<Vector3d> disc_normals(const InstrumentsCase& instruments, const Basin& basin, const std::vector<Opening>& openings,
                                   double spacing) {
  std::vector<Vector3d> normals;
  for (PressureProbeCase probe : instruments.pressure_probes) {
    if (basin.dimensions == 2) probe.position.y() = 0;
    normals.push_back(probe.diameter > 0 ? disc_normal(probe, basin, openings, spacing) : Vector3d(Vector3d::Zero()));
  }
  return normals;
}

void check_instruments(const InstrumentsCase& instruments, const Basin& basin, const OpenSpace& open, double spacing) {
  for (const PressureProbeCase& probe : instruments.pressure_probes) check_probe("pressure probe", probe, basin, open, spacing);
  for (const VelocityProbeCase& probe : instruments.velocity_probes) check_probe("velocity probe", probe, basin, open, spacing);
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
