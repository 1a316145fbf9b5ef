// Velocities and pressures that a case gives by expressions.
#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::initial_fields_test {
namespace {

Case vortices() {
  Case scene = box_case(Vector3d(1, 0, 1), 1, 0.05);
  scene.gravity = Vector3d::Zero();
  scene.tank.periodic = {true, false, true};
  scene.fluid.sound_speed = 10;
  scene.numerics.packing.iterations = 0;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.fluid.initial = {"sin(2*pi*x)*cos(2*pi*z)", "", "-cos(2*pi*x)*sin(2*pi*z)", "250*(cos(4*pi*x) + cos(4*pi*z))", "", std::nullopt};
  return scene;
}

TEST(InitialFields, AreThoseOfTheCase) {
  for (const MethodWord<Scheme>& known : method_words<Scheme>()) {
    Case scene = vortices();
    scene.numerics.scheme = known.choice;
    Tank tank(scene);
    const double greatest = tank.solver->start().greatest_speed;
    const FluidState fluid = tank.solver->download();
    ASSERT_EQ(fluid.id.size(), 400u);
    for (std::size_t i = 0; i < fluid.id.size(); ++i) {
      const Vector3d& x = fluid.position[i];
      EXPECT_NEAR(fluid.velocity[i].x(), std::sin(2 * M_PI * x.x()) * std::cos(2 * M_PI * x.z()), 1e-5);
      EXPECT_NEAR(fluid.velocity[i].z(), -std::cos(2 * M_PI * x.x()) * std::sin(2 * M_PI * x.z()), 1e-5);
      EXPECT_NEAR(fluid.pressure[i], 250 * (std::cos(4 * M_PI * x.x()) + std::cos(4 * M_PI * x.z())), 0.1);
      // of water that fills its part of the lattice
      EXPECT_NEAR(fluid.mass[i], 1000 * (1 + fluid.compression[i]) * 0.05 * 0.05, 1e-5);
    }
    EXPECT_NEAR(greatest, 0.975, 0.03) << "the first step knows how fast the water is";
    tank.solver->start();
    EXPECT_NEAR(total(tank.solver->download().mass), total(fluid.mass), 1e-6 * total(fluid.mass)) << "a second start is the same";
  }
}

TEST(InitialFields, ThatAreNotFiniteAreRefusedWithTheirPlace) {
  Case scene = vortices();
  scene.fluid.initial.w = "1/(x - x)";
  Tank tank(scene);
  const std::string message = error_of([&] { tank.solver->start(); });
  EXPECT_EQ(message.find("fluid/initial/w is not finite at ("), 0u) << message;
}

}  // namespace
}  // namespace wavetank::initial_fields_test
