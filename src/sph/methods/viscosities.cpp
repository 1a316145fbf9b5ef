#include "method.h"

namespace wavetank {
namespace {

using Source = ParameterSource;

double artificial(const Source& s) {
  const Discretisation& d = s.discretisation;
  return s.scene.numerics.artificial_viscosity * d.smoothing_length * d.sound_speed * s.scene.fluid.density;
}

double physical(const Source& s) {
  if (s.scene.numerics.viscosity_model != ViscosityModel::monaghan_gingold) return 0;
  return 2.0 * (s.discretisation.dimensions + 2) * s.scene.fluid.viscosity;
}

double bulk(const Source& s) {
  const Discretisation& d = s.discretisation;
  return s.scene.numerics.acoustic_damping * d.smoothing_length * d.sound_speed * s.scene.fluid.density;
}

}  // namespace

Method viscosity_of(const Case& scene) {
  Method method{"viscosity", word_of(scene.numerics.viscosity_model)};
  method.parameters = {{"viscosity", "Pa s", "μ, of the wall's shear", [](const Source& s) { return s.scene.fluid.viscosity; }},
                       {"pair_viscosity", "Pa s", "α h c₀ ρ₀ + 2(d+2) μ: artificial and Monaghan–Gingold viscosity have one form",
                        [](const Source& s) { return artificial(s) + physical(s); }},
                       {"bulk_viscosity", "Pa s", "α₂ h c₀ ρ₀, of the acoustic damper", bulk}};
  return method;
}

}  // namespace wavetank
