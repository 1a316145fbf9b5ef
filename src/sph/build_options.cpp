#include "build_options.h"

#include <algorithm>
#include <sstream>

namespace wavetank {

WallKind kind_of(const WallCase& walls) {
  if (walls.method == WallMethod::ghost || walls.elements == WallElements::facet) return WallKind::facets;
  return walls.elements == WallElements::semi_analytical ? WallKind::triangles : WallKind::rectangles;
}

bool anything_free(const Case& scene) {
  return scene.tank.motion == Motion::free ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyCase& body) { return body.motion == Motion::free; });
}

std::string build_options(const Case& scene, const BuildChoice& choice) {
  const NumericsCase& n = scene.numerics;
  const ShepardFactor shepard = n.walls.method == WallMethod::ghost ? ShepardFactor::none : n.walls.shepard;
  std::ostringstream options;
  options << "-DDIMENSIONS=" << scene.dimensions << " -DUSE_DOUBLE=" << choice.use_double
          << " -DDIFFUSION_FOURTAKAS=" << (n.density_diffusion == DensityDiffusion::fourtakas)
          << " -DDIFFUSION_ANTUONO=" << (n.density_diffusion == DensityDiffusion::antuono)
          << " -DVISCOSITY_MORRIS=" << (n.viscosity_model == ViscosityModel::morris) << " -DNO_SLIP=" << (n.walls.slip == Slip::no_slip)
          << " -DCOLE=" << (n.equation_of_state == EquationOfState::cole)
          << " -DCLAMP_PRESSURE=" << (n.negative_pressure == NegativePressure::clamped)
          << " -DFACETS=" << (kind_of(n.walls) == WallKind::facets) << " -DTRIANGLES=" << (kind_of(n.walls) == WallKind::triangles)
          << " -DGHOSTS=" << (n.walls.method == WallMethod::ghost) << " -DIMAGES=" << choice.images
          << " -DMOVING_WALLS=" << choice.moving_walls << " -DMOVING_FRAME=" << choice.moving_frame << " -DTHIN_WALLS=" << choice.thin_walls
          << " -DGUARD_IMPULSES=" << anything_free(scene)
          << " -DSHEPARD_GEOMETRIC=" << (shepard == ShepardFactor::geometric || shepard == ShepardFactor::monolithic)
          << " -DSHEPARD_MONOLITHIC=" << (shepard == ShepardFactor::monolithic)
          << " -DSHEPARD_VOLUMETRIC=" << (shepard == ShepardFactor::volumetric)
          << " -DRENORMALISE_DIVERGENCE=" << n.walls.renormalise_divergence;
  return options.str();
}

}  // namespace wavetank
