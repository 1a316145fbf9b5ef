#include "wavetank/scene/methods.h"

namespace wavetank {

template <>
const std::vector<MethodWord<Scheme>>& method_words() {
  static const std::vector<MethodWord<Scheme>> words{
      {Scheme::delta_sph, "delta_sph", "weakly compressible SPH with density diffusion and artificial viscosity"},
      {Scheme::riemann_parshikov, "riemann_parshikov", "Parshikov and Medin's, with a Riemann problem between particles of constant mass"},
      {Scheme::riemann_ale, "riemann_ale",
       "Vila's, with a Riemann problem between particles that exchange mass, and whose volumes evolve"}};
  return words;
}

template <>
const std::vector<MethodWord<Gradients>>& method_words() {
  static const std::vector<MethodWord<Gradients>> words{
      {Gradients::sph, "sph", "sums of the kernel's gradients"},
      {Gradients::mls_corrected, "mls_corrected",
       "the same sums with the kernel's gradients corrected by second-order moving least squares, and viscosity by their Laplacian"},
      {Gradients::mls, "mls", "all derivatives, those of the artificial viscosity too, straight from moving least squares"}};
  return words;
}

template <>
const std::vector<MethodWord<MlsPressure>>& method_words() {
  static const std::vector<MethodWord<MlsPressure>> words{
      {MlsPressure::automatic, "auto", "`adjoint` with `mls` between ghosts, else `sum`"},
      {MlsPressure::sum, "sum", "of p_i + p_j, which holds particles apart as SPH does"},
      {MlsPressure::difference, "difference", "of p_j − p_i, exact for quadratics but blind to free surfaces: for tanks without any"},
      {MlsPressure::adjoint, "adjoint", "minus the adjoint of the divergence, which conserves momentum and energy"}};
  return words;
}

template <>
const std::vector<MethodWord<DensityDiffusion>>& method_words() {
  static const std::vector<MethodWord<DensityDiffusion>> words{
      {DensityDiffusion::none, "none", "with which water at rest does not stay so"},
      {DensityDiffusion::fourtakas, "fourtakas", "of the dynamic density"},
      {DensityDiffusion::antuono, "antuono", "with renormalised gradients"}};
  return words;
}

template <>
const std::vector<MethodWord<EquationOfState>>& method_words() {
  static const std::vector<MethodWord<EquationOfState>> words{{EquationOfState::linear, "linear", "proportional to s = ρ/ρ₀ − 1"},
                                                              {EquationOfState::cole, "cole", "Cole's with exponent 7"}};
  return words;
}

template <>
const std::vector<MethodWord<ViscosityModel>>& method_words() {
  static const std::vector<MethodWord<ViscosityModel>> words{
      {ViscosityModel::monaghan_gingold, "monaghan_gingold", "along the line of centres"}, {ViscosityModel::morris, "morris", "isotropic"}};
  return words;
}

template <>
const std::vector<MethodWord<Turbulence>>& method_words() {
  static const std::vector<MethodWord<Turbulence>> words{
      {Turbulence::none, "none", "nothing beside the viscosities above"},
      {Turbulence::smagorinsky, "smagorinsky",
       "Smagorinsky's eddy viscosity l² |S|, with l the lesser of C_s Δx and 0.41 times the distance of the nearest wall"}};
  return words;
}

template <>
const std::vector<MethodWord<Shifting>>& method_words() {
  static const std::vector<MethodWord<Shifting>> words{
      {Shifting::none, "none", "particles move with the water"},
      {Shifting::monaghan, "monaghan", "by smoothed velocities"},
      {Shifting::lind, "lind", "down the concentration's gradient, by the time step"},
      {Shifting::oger, "oger", "by `expected_speed`, up to a quarter of a particle's own speed"},
      {Shifting::sun, "sun", "by `expected_speed`, up to half of it"},
      {Shifting::michel, "michel",
       "by how fast neighbours approach each other: it vanishes with the resolution, and where water moves as a solid"}};
  return words;
}

template <>
const std::vector<MethodWord<Tensile>>& method_words() {
  static const std::vector<MethodWord<Tensile>> words{
      {Tensile::hybrid, "hybrid", "farther from walls than the support, so that water rests at walls"},
      {Tensile::plain, "plain", "nowhere"},
      {Tensile::consistent, "consistent", "everywhere, with the walls' part that balances the water's"},
      {Tensile::printed, "printed", "everywhere, with the walls' part as the particle shifting paper prints it, which presses on walls"}};
  return words;
}

template <>
const std::vector<MethodWord<Integrator>>& method_words() {
  static const std::vector<MethodWord<Integrator>> words{
      {Integrator::symplectic, "symplectic", "drift, kick, drift: second order, one evaluation of the rates a step"},
      {Integrator::predictor_corrector, "predictor_corrector", "that of the moving-least-squares paper: second order, two"},
      {Integrator::runge_kutta_4, "runge_kutta_4", "the classical one: fourth order, four"}};
  return words;
}

}  // namespace wavetank
