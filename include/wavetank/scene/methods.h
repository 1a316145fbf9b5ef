#pragma once

#include <string>
#include <vector>

/// What a case chooses its method from by words. The case's keys, docs/case.md, the solver's rows and the tests that run every one of them
/// go by these lists.
namespace wavetank {

enum class Scheme { delta_sph, riemann_parshikov, riemann_ale };
enum class Gradients { sph, mls_corrected, mls };
enum class MlsPressure { automatic, sum, difference, adjoint };
enum class DensityDiffusion { none, fourtakas, antuono };
enum class EquationOfState { linear, cole };
enum class ViscosityModel { monaghan_gingold, morris };
enum class Turbulence { none, smagorinsky };
enum class Shifting { none, monaghan, lind, oger, sun, michel };
enum class Tensile { hybrid, plain, consistent, printed };
enum class Integrator { symplectic, predictor_corrector, runge_kutta_4 };

template <class Choice>
struct MethodWord {
  Choice choice;
  const char* word;
  const char* meaning;  ///< a part of a sentence
};

/// All there are, in the order of the page of keys.
template <class Choice>
const std::vector<MethodWord<Choice>>& method_words();

template <class Choice>
std::string word_of(Choice choice) {
  for (const MethodWord<Choice>& known : method_words<Choice>())
    if (known.choice == choice) return known.word;
  return "";
}

}  // namespace wavetank
