// Surfaces of the water for who listens or records: of the time that they were begun at, and what becomes of a failure.
#include "wavetank/node/surface_drawer.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "../common/box_case.h"

namespace wavetank {
namespace {

Case small_tank() {
  Case scene = box_case(Vector3d(0.4, 0.3, 0.3), 0.15, 0.025);
  scene.numerics.packing.iterations = 0;
  return scene;
}

TEST(SurfaceDrawer, TellsOfAFailureAndDrawsNoMore) {
  const Simulation simulation(small_tank());
  int calls = 0;
  SurfaceDrawer drawer([&](const WaterSurface&) {
    ++calls;
    throw std::runtime_error("no room");
  });
  EXPECT_EQ(drawer.failure(), "");
  for (int k = 0; k < 3; ++k) EXPECT_NO_THROW(drawer.draw(simulation));
  drawer.wait();
  EXPECT_EQ(drawer.failure(), can_find_surface() ? "no room" : why_no_surface);
  EXPECT_EQ(calls, can_find_surface() ? 1 : 0);
}

}  // namespace
}  // namespace wavetank
