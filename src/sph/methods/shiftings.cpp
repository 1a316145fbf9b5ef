#include <cmath>

#include "method.h"

namespace wavetank {
namespace {

using Source = ParameterSource;

/// W(Δx), per m^d.
double kernel_at_spacing(const Discretisation& d) {
  const double q = d.spacing / d.smoothing_length;
  return kernel_scale(d) * std::pow(1 - 0.5 * q, 4) * (1 + 2 * q);
}

}  // namespace

Method shifting_of(const Case& scene) {
  const Shifting law = scene.numerics.shifting;
  Method method{"shifting", word_of(law)};
  if (law == Shifting::none) return method;
  method.fields = {
      {ParticleArray::state, {"shift_x", "shift_y", "shift_z"}, "m/s", "δu, found at a step's start and held throughout", true}};
  method.parameters = {
      {"expected_speed", "m/s", "greatest one expected", [](const Source& s) { return s.scene.numerics.expected_speed.value(); }},
      {"inverse_kernel_at_spacing", "m^d", "1/W(Δx)", [](const Source& s) { return 1 / kernel_at_spacing(s.discretisation); }},
      {"tensile", "", "factor of (W/W(Δx))⁴ in the concentration's gradient",
       [](const Source& s) { return s.scene.numerics.tensile == Tensile::plain ? 0.0 : 0.2; }},
      {"tensile_by_walls", "", "1: also within the support of a wall",
       [](const Source& s) { return s.scene.numerics.tensile == Tensile::hybrid ? 0.0 : 1.0; }},
      {"tensile_of_walls", "", "factor of the same in the walls' part; a fifth of the water's balances it", [](const Source& s) {
         const Tensile tensile = s.scene.numerics.tensile;
         return tensile == Tensile::printed ? 0.2 : tensile == Tensile::consistent ? 0.04 : 0.0;
       }}};
  method.reports = {{"shift", ReportRow::Kind::greatest, "m/s", "greatest |δu|",
                     "state[FIELD_SHIFT_X * stride + i] * state[FIELD_SHIFT_X * stride + i] + state[FIELD_SHIFT_Y * stride + i] * "
                     "state[FIELD_SHIFT_Y * stride + i] + state[FIELD_SHIFT_Z * stride + i] * state[FIELD_SHIFT_Z * stride + i]",
                     "sqrt(greatest)"}};
  return method;
}

}  // namespace wavetank
