// What a case costs, before it is run.
#include "simulation_fixture.h"

namespace wavetank {
namespace {

TEST(Estimate, AParticleTakesLessThan400Bytes) {
  const Estimate cost = estimate(box_case(Vector3d(0.6, 0.4, 0.4), 0.3, 0.0125));
  EXPECT_EQ(cost.particles, 48u * 32u * 24u);
  const double bytes = cost.device_memory / static_cast<double>(cost.particles);
  std::printf("%zu particles, %zu wall elements: %.0f bytes a particle\n", cost.particles, cost.wall_elements, bytes);
  EXPECT_LT(bytes, 400);
  EXPECT_GT(bytes, 100) << "state, its copy, rates and grid take more than that";
  EXPECT_GT(cost.wall_seconds, 0);
}

}  // namespace
}  // namespace wavetank
