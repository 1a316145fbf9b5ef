#include "method.h"

namespace wavetank {

Method turbulence_of(const Case& scene) {
  const Turbulence turbulence = scene.numerics.turbulence;
  Method method{"turbulence", word_of(turbulence)};
  if (turbulence == Turbulence::none) return method;
  method.parameters = {{"eddy_length", "m", "C_s Δx",
                        [](const ParameterSource& s) { return s.scene.numerics.smagorinsky_coefficient * s.discretisation.spacing; }}};
  method.needs_strain_rate = true;
  method.accelerates_by_gradients = true;
  method.brings_eddy_viscosity = true;
  return method;
}

}  // namespace wavetank
