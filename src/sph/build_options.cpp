#include "build_options.h"

#include <algorithm>

namespace wavetank {

WallKind kind_of(const WallCase& walls) {
  if (walls.method == WallMethod::ghost || walls.elements == WallElements::facet) return WallKind::facets;
  return walls.elements == WallElements::semi_analytical ? WallKind::triangles : WallKind::rectangles;
}

bool anything_free(const Case& scene) {
  return scene.tank.motion == Motion::free ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyCase& body) { return body.motion == Motion::free; });
}

int long_axes(const Discretisation& d, Precision precision) {
  constexpr double most = 4096;  // spacings, whose float32 coordinates have steps of 2.4e-4 of the spacing
  int axes = 0;
  for (int axis = 0; axis < 3 && precision == Precision::single; ++axis)
    if (d.cells[axis] * d.support > most * d.spacing) axes |= 1 << axis;
  return axes;
}

namespace {

/// Whether all walls of the case have this friction.
bool all_have(const Case& scene, FrictionLaw law) {
  for (std::size_t owner = 0; owner <= scene.bodies.size(); ++owner)
    if (friction_of(scene, owner).law != law) return false;
  return true;
}

}  // namespace

BuildOptions build_options(const Case& scene, const BuildChoice& choice) {
  const NumericsCase& n = scene.numerics;
  const ShepardFactor shepard = n.walls.method == WallMethod::ghost ? ShepardFactor::none : n.walls.shepard;
  BuildOptions options{
      {"DIMENSIONS", scene.dimensions},
      {"USE_DOUBLE", choice.use_double},
      {"NO_SLIP", !all_have(scene, FrictionLaw::none)},
      {"FRICTION_LAWS",
       n.walls.method != WallMethod::ghost && !all_have(scene, FrictionLaw::none) && !all_have(scene, FrictionLaw::viscous)},
      {"CLAMP_PRESSURE", n.negative_pressure == NegativePressure::clamped},
      {"ACOUSTIC_DAMPER", n.acoustic_damping > 0},
      {"FACETS", kind_of(n.walls) == WallKind::facets},
      {"TRIANGLES", kind_of(n.walls) == WallKind::triangles},
      {"GHOSTS", n.walls.method == WallMethod::ghost},
      {"IMAGES", choice.images},
      {"MOVING_WALLS", choice.moving_walls},
      {"MOVING_FRAME", choice.moving_frame},
      {"THIN_WALLS", choice.thin_walls},
      {"OPENINGS", !scene.openings.empty()},
      {"LONG_AXES", choice.long_axes},
      {"GUARD_IMPULSES", anything_free(scene)},
      {"SHEPARD_GEOMETRIC", shepard == ShepardFactor::geometric || shepard == ShepardFactor::monolithic},
      {"SHEPARD_MONOLITHIC", shepard == ShepardFactor::monolithic},
      {"SHEPARD_VOLUMETRIC", shepard == ShepardFactor::volumetric},
      {"RENORMALISE_DIVERGENCE", n.walls.renormalise_divergence},
  };
  if (n.gradients != Gradients::sph) options["MLS_DIRECT"] = n.gradients == Gradients::mls;
  return options;
}

std::string text_of(const BuildOptions& options) {
  std::string text;
  for (const auto& [name, value] : options) text += (text.empty() ? "-D" : " -D") + name + "=" + std::to_string(value);
  return text;
}

}  // namespace wavetank
