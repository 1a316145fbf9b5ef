#include <cmath>

#include "method.h"

namespace wavetank {
namespace {

/// At ghosts without slip, which turn velocities otherwise than places, the rate of strain is not enough.
Method riemann_parshikov(const Case& scene) {
  const WallCase& walls = scene.numerics.walls;
  Method method{"scheme", word_of(Scheme::riemann_parshikov)};
  method.needs_compression_gradient = true;
  method.needs_velocity_gradient = walls.method == WallMethod::ghost && walls.slip == Slip::no_slip;
  method.needs_strain_rate = !method.needs_velocity_gradient;
  method.accelerates_by_gradients = true;
  method.parameters = {{"limiter", "", "θ of minmod", [](const ParameterSource& s) { return s.scene.numerics.limiter; }}};
  return method;
}

Method riemann_ale(const Case& scene) {
  Method method = riemann_parshikov(scene);
  method.word = word_of(Scheme::riemann_ale);
  method.needs_strain_rate = false;
  method.needs_velocity_gradient = true;
  method.needs_shepard_factors = true;
  method.fields = {
      {ParticleArray::state, {"volume"}, "m³", "that evolves; the mass follows from it", true, FieldRow::Evolution::conjugate}};
  method.parameters.push_back({"cell_volume", "m³", "Δx^d",
                               [](const ParameterSource& s) { return std::pow(s.discretisation.spacing, s.discretisation.dimensions); }});
  const std::string relative = "state[FIELD_VOLUME * stride + i] / p->cell_volume";
  method.reports = {{"largest_volume", ReportRow::Kind::greatest, "Δx^d", "of a particle", relative},
                    {"volumes_beyond", ReportRow::Kind::count, "", "below half or above twice that of a lattice",
                     "w->own && (" + relative + " < R(0.5) || " + relative + " > R(2.0)) ? 1 : 0"}};
  return method;
}

}  // namespace

Method scheme_of(const Case& scene) {
  switch (scene.numerics.scheme) {
    case Scheme::riemann_parshikov:
      return riemann_parshikov(scene);
    case Scheme::riemann_ale:
      return riemann_ale(scene);
    case Scheme::delta_sph:
      break;
  }
  return {"scheme", word_of(Scheme::delta_sph)};
}

}  // namespace wavetank
