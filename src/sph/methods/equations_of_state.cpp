#include "method.h"

namespace wavetank {

Method equation_of_state_of(const Case& scene) { return {"equation_of_state", word_of(scene.numerics.equation_of_state)}; }

}  // namespace wavetank
