#include <algorithm>

#include "method.h"

namespace wavetank {

Methods methods_of(const Case& scene) {
  return {scheme_of(scene),     density_diffusion_of(scene), viscosity_of(scene),   equation_of_state_of(scene),
          turbulence_of(scene), shifting_of(scene),          mls_pressure_of(scene)};
}

namespace {

bool any_has(const Methods& methods, bool Method::*flag) {
  return std::any_of(methods.begin(), methods.end(), [flag](const Method& method) { return method.*flag; });
}

}  // namespace

namespace {

void add_once(const std::vector<ParameterRow>& rows, std::vector<ParameterRow>& all) {
  for (const ParameterRow& row : rows)
    if (std::none_of(all.begin(), all.end(), [&](const ParameterRow& other) { return other.name == row.name; })) all.push_back(row);
}

template <class Choice>
void add_of_each(Case scene, Choice NumericsCase::*key, Method (*method_of)(const Case&), std::vector<ParameterRow>& all) {
  for (const MethodWord<Choice>& known : method_words<Choice>()) {
    scene.numerics.*key = known.choice;
    add_once(method_of(scene).parameters, all);
  }
}

}  // namespace

std::vector<ParameterRow> parameters_of_every_method(const Case& scene) {
  std::vector<ParameterRow> all;
  add_of_each(scene, &NumericsCase::scheme, scheme_of, all);
  add_of_each(scene, &NumericsCase::density_diffusion, density_diffusion_of, all);
  add_of_each(scene, &NumericsCase::viscosity_model, viscosity_of, all);
  add_of_each(scene, &NumericsCase::equation_of_state, equation_of_state_of, all);
  add_of_each(scene, &NumericsCase::turbulence, turbulence_of, all);
  add_of_each(scene, &NumericsCase::shifting, shifting_of, all);
  add_of_each(scene, &NumericsCase::gradients, mls_pressure_of, all);
  return all;
}

int gradient_components(const Methods& methods) {
  for (const Method& method : methods)
    if (method.stored_values > 0) return method.stored_values;
  const bool eddies = any_has(methods, &Method::brings_eddy_viscosity);
  if (eddies && any_has(methods, &Method::needs_velocity_gradient)) return 14;
  if (eddies) return 10;
  if (any_has(methods, &Method::needs_shepard_factors)) return 13;
  if (any_has(methods, &Method::needs_velocity_gradient)) return 12;
  if (any_has(methods, &Method::needs_strain_rate)) return 9;
  return any_has(methods, &Method::needs_compression_gradient) ? 3 : 0;
}

bool accelerate_by_gradients(const Methods& methods) { return any_has(methods, &Method::accelerates_by_gradients); }

bool compress_by_gradients(const Methods& methods) { return any_has(methods, &Method::needs_compression_gradient); }

void add_options(const Methods& methods, BuildOptions& options) {
  const bool velocity = any_has(methods, &Method::needs_velocity_gradient);
  options["GRADIENT_OF_VELOCITY"] = velocity;
  options["GRADIENT_OF_STRAIN"] = !velocity && any_has(methods, &Method::needs_strain_rate);
  options["GRADIENTS_AND_SHEPARD"] = any_has(methods, &Method::needs_shepard_factors);
}

void add_sources(const Methods& methods, compute::SourceFiles& files) {
  for (const Method& method : methods) {
    const std::string file = method.kind + "/" + method.word + ".cl";
    if (!method.code.empty()) files[file] = method.code;
    files[method.kind + ".cl"] = "#include \"" + file + "\"\n";
  }
}

}  // namespace wavetank
