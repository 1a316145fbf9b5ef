#include <cmath>

#include "method.h"

namespace wavetank {
namespace {

using Source = ParameterSource;

/// h_m of the fit's weights, m; its support is twice that.
double length(const Source& s) { return 0.5 * *s.scene.numerics.mls.support * s.discretisation.spacing; }

/// α of W with that smoothing length, per m^d.
double weight_scale(const Source& s) {
  Discretisation d = s.discretisation;
  d.smoothing_length = length(s);
  return kernel_scale(d);
}

std::vector<ParameterRow> mls_numbers() {
  return {{"mls_support", "m", "R_m of the weights", [](const Source& s) { return 2 * length(s); }},
          {"mls_inverse_support", "1/m", "1/R_m", [](const Source& s) { return 0.5 / length(s); }},
          {"mls_inverse", "1/m", "1/h_m, by which the basis is scaled", [](const Source& s) { return 1 / length(s); }},
          {"mls_weight_scale", "1/m^d", "α of the weights", weight_scale},
          {"mls_slope_scale", "1/m^(d+2)", "5α/h_m² of F with the weights' support",
           [](const Source& s) { return 5 * weight_scale(s) / std::pow(length(s), 2); }},
          {"mls_pivot", "", "least part of a basis function that those before it do not explain",
           [](const Source& s) { return s.scene.numerics.mls.pivot; }},
          {"mls_viscosity", "m²/s", "ν", [](const Source& s) { return s.scene.fluid.viscosity / s.scene.fluid.density; }},
          {"mls_artificial", "m²/s", "α h c₀", [](const Source& s) {
             return s.scene.numerics.artificial_viscosity * s.discretisation.smoothing_length * s.discretisation.sound_speed;
           }}};
}

MlsPressure settled_form(const NumericsCase& numerics) {
  if (numerics.mls.pressure != MlsPressure::automatic) return numerics.mls.pressure;
  const bool adjoint = numerics.gradients == Gradients::mls && numerics.walls.method == WallMethod::ghost;
  return adjoint ? MlsPressure::adjoint : MlsPressure::sum;
}

}  // namespace

Method mls_pressure_of(const Case& scene) {
  const NumericsCase& numerics = scene.numerics;
  if (numerics.gradients == Gradients::sph) return {"mls_pressure", "sum"};
  const MlsPressure form = settled_form(numerics);
  Method method{"mls_pressure", word_of(form)};
  method.parameters = mls_numbers();
  method.fields = {{ParticleArray::rates, {"fit"}, "", "0: of second order; 1: but for its Laplacian; 2: of first order; 3: less"}};
  const auto is = [](const char* level) { return "rates[RATE_FIT * stride + i] == R(" + std::string(level) + ") ? 1 : 0"; };
  method.reports = {{"fits_of_first_order", ReportRow::Kind::count, "", "particles whose fit is of first order", is("2.0")},
                    {"fits_below_first_order", ReportRow::Kind::count, "", "particles whose fit is less", is("3.0")}};
  // one sweep builds the fit and what it is applied to where the registers hold both, and no particle needs the fits of others
  if (scene.dimensions == 2 && form != MlsPressure::adjoint) return method;
  const int basis = scene.dimensions == 2 ? 5 : 9;
  method.stored_values = (scene.dimensions + 1) * basis + 1;
  method.accelerates_by_gradients = true;
  method.needs_compression_gradient = true;
  return method;
}

}  // namespace wavetank
