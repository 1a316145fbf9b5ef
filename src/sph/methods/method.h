#pragma once

#include <string>
#include <vector>

#include "../build_options.h"
#include "../tables/fields.h"
#include "../tables/parameters.h"
#include "../tables/reports.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// A part of the method that a case chooses by a word: its scheme, a term of it, its equation of state. Device code that knows of it only
/// by its kind includes KIND.cl, which stands for KIND/WORD.cl; what it needs beside that it brings.
struct Method {
  std::string kind;                   ///< the case's key: "scheme"
  std::string word;                   ///< and its word: "delta_sph"
  std::vector<FieldRow> fields = {};  ///< beside the common ones, or in the place of one of the same name
  std::vector<ParameterRow> parameters = {};
  std::vector<ReportRow> reports = {};
  int stored_values = 0;                    ///< of a particle, in the place of gradients
  bool needs_compression_gradient = false;  ///< renormalised, at every state of which the compression's rate is found
  bool needs_velocity_gradient = false;     ///< likewise
  bool needs_strain_rate = false;           ///< likewise, where nothing needs the whole of that
  bool needs_shepard_factors = false;       ///< of neighbours, beside the gradients
  bool brings_eddy_viscosity = false;       ///< found with the gradients
  bool accelerates_by_gradients = false;    ///< needs them at every state of which accelerations are found too
  std::string code = {};                    ///< in place of that file's
};

/// Of which a case is made.
using Methods = std::vector<Method>;

/// Those that the case chooses.
Methods methods_of(const Case& scene);

/// The case's scheme, and what goes into it. One file each.
Method scheme_of(const Case& scene);
Method density_diffusion_of(const Case& scene);
Method viscosity_of(const Case& scene);
Method equation_of_state_of(const Case& scene);
Method turbulence_of(const Case& scene);
Method shifting_of(const Case& scene);
Method mls_pressure_of(const Case& scene);

/// The numbers of every method that a case can choose, once each: kernels that know nothing of a method are then the same with it and
/// without.
std::vector<ParameterRow> parameters_of_every_method(const Case& scene);

/// Components of gradients that kernels find for them: none, those of the compression, the rate of strain or the velocity's too, γ,
/// and the eddy viscosity.
int gradient_components(const Methods& methods);

/// Whether accelerations need them.
bool accelerate_by_gradients(const Methods& methods);

/// Whether rates of compression do.
bool compress_by_gradients(const Methods& methods);

/// Sets what kernels are compiled with for them.
void add_options(const Methods& methods, BuildOptions& options);

/// Puts the device code of each in the place of its kind.
void add_sources(const Methods& methods, compute::SourceFiles& files);

}  // namespace wavetank
