#pragma once

#include <string>
#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank::bench {

/// How a benchmark's walls act, under the name that its cases have.
struct WallTreatment {
  std::string name;
  WallMethod method = WallMethod::boundary_integral;
  WallElements elements = WallElements::facet;
  ShepardFactor shepard = ShepardFactor::geometric;
};

/// A stock case: a dam break in the tank of SPHERIC benchmark 2, or in its mid-plane.
struct BenchCase {
  std::string name;  ///< "dam_break_3d/100k/h1.73/fourtakas/facet", "methods_3d/100k/riemann_ale/michel/symplectic", or one of its own
  int dimensions = 3;
  double spacing = 0;    ///< Δx, m
  double smoothing = 0;  ///< h/Δx
  DensityDiffusion diffusion = DensityDiffusion::fourtakas;
  WallTreatment walls;
  Scheme scheme = Scheme::delta_sph;
  Shifting shifting = Shifting::none;
  Integrator integrator = Integrator::symplectic;
  std::string small_twin;  ///< name of a case of at most 30k particles that is built from the very same kernels; may be its own
};

const std::vector<BenchCase>& all_cases();
/// What is measured unless something else is asked for: every size, and at 100k in 3-D each other choice by itself.
std::vector<BenchCase> default_cases();
/// Two of them, of the same kernels: 100 thousand and a million particles in 3-D.
std::vector<BenchCase> short_cases();
/// Those whose names contain every one of the filters; the default ones without any. Throws Error if there are none.
std::vector<BenchCase> chosen_cases(const std::vector<std::string>& filters);
/// Throws Error for a name that no case has.
const BenchCase& case_named(const std::string& name);

/// From the lattice, without instruments. `device`: as the case's key `device`.
Case make_case(const BenchCase& bench_case, const std::string& device);
/// Particles that the water's box takes at a spacing of `spacing` m.
std::size_t particles_at(int dimensions, double spacing);
/// Of the water's box along the tank.
double water_length_in_spacings(const BenchCase& bench_case);

}  // namespace wavetank::bench
