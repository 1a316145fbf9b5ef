// Surfaces of the water for who listens or records: of the time that they were begun at, and what becomes of a failure.
#include "wavetank/node/surface_drawer.h"

#include <gtest/gtest.h>

#include <algorithm>
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

/// A node's simulation goes back to time 0 while its drawer's thread finds the surface of what was.
TEST(SurfaceDrawer, AResetMeanwhileChangesNothingOfWhatIsDrawn) {
  if (!can_find_surface()) GTEST_SKIP() << why_no_surface;
  Case scene = small_tank();
  std::get<Box>(scene.fluid.fill[0]).max.x() = 0.2;  // so that it flows
  Simulation simulation(scene);
  while (simulation.state().time < 0.03) simulation.advance();
  const WaterSurface wanted = [&] {
    const SurfaceFinder finder(simulation);
    return finder.find(finder.look_at(simulation));
  }();
  std::vector<WaterSurface> drawn;
  std::vector<ros::Time> stamps;
  SurfaceDrawer drawer([&](const WaterSurface& surface, const ros::Time& stamp) {
    drawn.push_back(surface);
    stamps.push_back(stamp);
  });
  for (int round = 0; round < 5; ++round) {
    drawer.draw(simulation, ros::Time(1));
    simulation.reset();
    while (simulation.state().time < 0.03) simulation.advance();
  }
  drawer.wait();
  ASSERT_EQ(drawn.size(), 5u);
  for (const WaterSurface& surface : drawn) {
    EXPECT_EQ(surface.vertices, wanted.vertices);
    EXPECT_EQ(surface.triangles, wanted.triangles);
    EXPECT_EQ(surface.time, wanted.time);
  }

  drawer.draw(simulation, ros::Time(2));
  drawer.drop();  // as the node does at a reset
  simulation.reset();
  drawer.draw(simulation, ros::Time(3));
  drawer.wait();
  ASSERT_FALSE(drawn.empty());
  EXPECT_EQ(stamps.back(), ros::Time(3));
  EXPECT_EQ(drawn.back().time, 0);
  EXPECT_EQ(std::count(stamps.begin(), stamps.end(), ros::Time(2)), 0) << "the surface of before the reset came after it";
}

}  // namespace
}  // namespace wavetank::surface_drawer_test
