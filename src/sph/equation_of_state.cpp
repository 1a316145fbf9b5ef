#include "equation_of_state.h"

#include <algorithm>
#include <cmath>

namespace wavetank {

double compression_at(double head, const Case& scene) {
  return scene.numerics.equation_of_state == EquationOfState::cole ? std::pow(std::max(1.0 + 7.0 * head, 0.0), 1.0 / 7.0) - 1.0 : head;
}

}  // namespace wavetank
