// Operations of add_particle and of the neighbour loop about it, as src/sph/kernels has them; whoever changes these counts anew. Products
// that do not change within the loop are the compiler's to take out, and are not counted; nor are conversions, comparisons and addresses.
// Of the cases of the benchmark: single precision, walls that stand, no mirror images. In 2-D what y has is left out.
#include "sweep_cost.h"

namespace wavetank::bench {
namespace {

constexpr double bytes_of_real = 4;

struct Counter {
  bool flat;
  /// The 3-D count, or the 2-D one.
  double of(double in_3d, double in_2d) const { return flat ? in_2d : in_3d; }
};

}  // namespace

std::vector<SweepCost> sweep_costs(const BenchCase& bench_case) {
  if (bench_case.scheme != Scheme::delta_sph || bench_case.integrator != Integrator::symplectic) return {};
  const Counter count{bench_case.dimensions == 2};
  const bool fourtakas = bench_case.diffusion == DensityDiffusion::fourtakas, antuono = bench_case.diffusion == DensityDiffusion::antuono;
  const bool volumetric = bench_case.walls.method != WallMethod::ghost && bench_case.walls.shepard == ShepardFactor::volumetric;

  const double distance = count.of(3 + 5, 2 + 3) + 1 + 1;     // r, r², what puts it away beyond a run's end, √
  const double slope = 3 + 2 + 1;                             // t = max(0, 1 − r/R): 3; its cube: 2; times V: 1
  const double velocity = count.of(3 + 5, 2 + 3);             // u_j − u_i, · r
  const double own_shepard = volumetric ? 3 + 2 + 1 + 2 : 0;  // W: t⁴ times the scale, 1 + 2q, their product; times V, sum

  const double inverse = 2;                                                                       // 1/(r² + …)
  const double central = 5;                                                                       // F V (p_i + p_j − ν u·r/r²)
  const double force = count.of(6, 4);                                                            // Σ … r
  const double momentum = distance + slope + own_shepard + velocity + inverse + central + force;  // near walls the fit comes on top

  double continuity = distance + slope + own_shepard + velocity + 2;  // Σ u·r F V
  if (fourtakas) continuity += 1 + count.of(5, 3) + 3;                // s_j − s_i; hydrostatics · r; Σ F V (… − …)
  if (antuono) continuity += 1 + count.of(3 + 5, 2 + 3) + 4;          // the same with the mean of two gradients

  const double gradient = distance + slope + 2 + count.of(6 + 15, 4 + 8);  // (s_j − s_i) F V; Σ … r; Σ F V r ⊗ r, symmetric

  const double place = count.of(3, 2), volume = 1;
  const double momentum_fields = 2 * place + volume + 1;                                                         // x, u, V, p
  const double continuity_fields = 2 * place + volume + (fourtakas || antuono ? 1 : 0) + (antuono ? place : 0);  // x, u, V, s, ∇s
  const double gradient_fields = place + volume + 1;                                                             // x, V, s
  std::vector<SweepCost> costs = {{"momentum", momentum, bytes_of_real * momentum_fields},
                                  {"continuity", continuity, bytes_of_real * continuity_fields}};
  if (antuono) costs.push_back({"gradients", gradient, bytes_of_real * gradient_fields});
  return costs;
}

}  // namespace wavetank::bench
