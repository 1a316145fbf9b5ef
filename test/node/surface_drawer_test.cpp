// Surfaces of the water for who listens or records: of the time that they were begun at, and what becomes of a failure.
#include "wavetank/node/surface_drawer.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "../common/box_case.h"
#include "wavetank/node/stamps.h"
#include "wavetank/node/surface_messages.h"

namespace wavetank::surface_drawer_test {
namespace {

Case small_tank() {
  Case scene = box_case(Vector3d(0.4, 0.3, 0.3), 0.15, 0.025);
  scene.numerics.packing.iterations = 0;
  return scene;
}

TEST(SurfaceDrawer, TellsOfAFailureAndDrawsNoMore) {
  const Simulation simulation(small_tank());
  int calls = 0;
  SurfaceDrawer drawer([&](const WaterSurface&, const ros::Time&) {
    ++calls;
    throw std::runtime_error("no room");
  });
  EXPECT_EQ(drawer.failure(), "");
  for (int k = 0; k < 3; ++k) EXPECT_NO_THROW(drawer.draw(simulation, ros::Time(1)));
  drawer.wait();
  EXPECT_EQ(drawer.failure(), can_find_surface() ? "no room" : why_no_surface);
  EXPECT_EQ(calls, can_find_surface() ? 1 : 0);
}

TEST(SurfaceDrawer, ASurfaceHasTheStampThatItWasBegunWith) {
  if (!can_find_surface()) GTEST_SKIP() << why_no_surface;
  const Simulation simulation(small_tank());
  StampClock clock;
  std::vector<ros::Time> stamps;
  SurfaceDrawer drawer([&](const WaterSurface& surface, const ros::Time& stamp) {
    while (clock.at(0) < ros::Time(1)) std::this_thread::yield();
    stamps.push_back(surface_messages(surface, 10, "world", stamp).surface.header.stamp);
  });
  drawer.draw(simulation, clock.at(simulation.state().time));
  clock.restart_after(7.5);  // before it is done
  drawer.wait();
  EXPECT_EQ(stamps, std::vector<ros::Time>{ros::Time(0)});
}

}  // namespace
}  // namespace wavetank::surface_drawer_test
