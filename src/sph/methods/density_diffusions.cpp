#include "method.h"

namespace wavetank {
namespace {

using Source = ParameterSource;

const std::vector<FieldRow> steady_part{
    {ParticleArray::state, {"steady"}, "1/s", "steady part of the density diffusion", true, FieldRow::Evolution::follower}};

std::vector<ParameterRow> diffusion_numbers() {
  return {{"density_diffusion", "m²/s", "δ h c₀",
           [](const Source& s) {
             return s.scene.numerics.density_diffusion_coefficient * s.discretisation.smoothing_length * s.discretisation.sound_speed;
           }},
          {"steady_rate", "1/s", "by which the steady part of the diffusion follows it",
           [](const Source& s) { return s.scene.gravity.norm() / s.discretisation.sound_speed; }},
          {"steady_limit", "1/s", "of that part", [](const Source& s) {
             const Discretisation& d = s.discretisation;
             return 1.5 * s.scene.numerics.density_diffusion_coefficient * s.scene.gravity.norm() * d.spacing /
                    (d.smoothing_length * d.sound_speed);
           }}};
}

}  // namespace

Method density_diffusion_of(const Case& scene) {
  const DensityDiffusion diffusion = scene.numerics.density_diffusion;
  Method method{"density_diffusion", word_of(diffusion)};
  if (diffusion == DensityDiffusion::none) return method;
  method.fields = steady_part;
  method.parameters = diffusion_numbers();
  method.needs_compression_gradient = diffusion == DensityDiffusion::antuono;
  return method;
}

}  // namespace wavetank
