#include "method.h"

namespace wavetank {
namespace {

Method riemann_parshikov() {
  Method method{"scheme", word_of(Scheme::riemann_parshikov)};
  method.needs_compression_gradient = true;
  method.needs_strain_rate = true;
  method.accelerates_by_gradients = true;
  return method;
}

Method riemann_ale() {
  Method method = riemann_parshikov();
  method.word = word_of(Scheme::riemann_ale);
  method.needs_strain_rate = false;
  method.needs_velocity_gradient = true;
  method.needs_shepard_factors = true;
  method.fields = {
      {ParticleArray::state, {"volume"}, "m³", "that evolves; the mass follows from it", true, FieldRow::Evolution::conjugate}};
  return method;
}

}  // namespace

Method scheme_of(const Case& scene) {
  switch (scene.numerics.scheme) {
    case Scheme::riemann_parshikov:
      return riemann_parshikov();
    case Scheme::riemann_ale:
      return riemann_ale();
    case Scheme::delta_sph:
      break;
  }
  return {"scheme", word_of(Scheme::delta_sph)};
}

}  // namespace wavetank
