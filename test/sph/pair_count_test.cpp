// The pairs that the device counts against all pairs on the host.
#include <random>

#include "sph_fixture.h"

namespace wavetank::pair_count_test {
namespace {

constexpr unsigned seed = 4711;

/// |x_j − x_i| < R, each pair seen from both ends.
std::uint64_t pairs_within(const std::vector<Vector3d>& positions, double support) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (std::size_t j = 0; j < positions.size(); ++j) count += i != j && (positions[j] - positions[i]).norm() < support;
  return count;
}

void compare_with_all_pairs(int dimensions, Precision precision, double rounding) {
  if (!has_precision(precision)) GTEST_SKIP() << "the device has no double precision";
  std::mt19937 random(seed);
  const Box domain{Vector3d(-0.3, dimensions == 3 ? 0.2 : 0.0, 0.4), Vector3d(0.6, dimensions == 3 ? 0.8 : 0.0, 1.1)};
  std::vector<Vector3d> particles(dimensions == 2 ? 250 : 1800, Vector3d::Zero());
  for (Vector3d& particle : particles)
    for (int axis = 0; axis < 3; ++axis)
      if (axis != 1 || dimensions == 3) particle[axis] = std::uniform_real_distribution<double>(domain.min[axis], domain.max[axis])(random);
  Case scene;
  scene.dimensions = dimensions;
  scene.fluid.sound_speed = 12;
  scene.numerics.precision = precision;
  scene.numerics.support = 3;
  Tank tank(scene, loose_particles(domain, 0.05, particles, dimensions));
  tank.solver->start();

  const PairCount counted = tank.solver->count_pairs();
  const double support = tank.discretisation.support;
  const std::uint64_t least = pairs_within(particles, support * (1 - rounding)), most = pairs_within(particles, support * (1 + rounding));
  std::printf("%d-D, %s, seed %u: %llu pairs among %llu candidates of %zu particles\n", dimensions,
              precision == Precision::single ? "single" : "double", seed, static_cast<unsigned long long>(counted.pairs),
              static_cast<unsigned long long>(counted.candidates), particles.size());
  EXPECT_GT(least, particles.size());
  EXPECT_GE(counted.pairs, least);
  EXPECT_LE(counted.pairs, most);
  EXPECT_LT(most - least, least / 1000);  // few are so near the support's end that rounding decides
  EXPECT_GE(counted.candidates, counted.pairs + particles.size());
  EXPECT_LE(counted.candidates, particles.size() * particles.size());
}

TEST(PairCount, IsThatOfAllPairsIn2D) {
  compare_with_all_pairs(2, Precision::single, 1e-6);
  compare_with_all_pairs(2, Precision::double_, 1e-13);
}

TEST(PairCount, IsThatOfAllPairsIn3D) {
  compare_with_all_pairs(3, Precision::single, 1e-6);
  compare_with_all_pairs(3, Precision::double_, 1e-13);
}

}  // namespace
}  // namespace wavetank::pair_count_test
