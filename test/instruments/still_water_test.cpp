// Instruments in water at rest, whose readings are known.
#include <algorithm>

#include "../common/error_of.h"
#include "../sph/sph_fixture.h"
#include "wavetank/instruments/recorder.h"

namespace wavetank {
namespace {

constexpr double gravity = 9.81;
constexpr double density = 1000;

/// Moves tank and water.
Case moved(Case scene, const Vector3d& by) {
  std::get<BoxTank>(scene.tank.shape).origin += by;
  for (FillRegion& region : scene.fluid.fill) {
    std::get<Box>(region).min += by;
    std::get<Box>(region).max += by;
  }
  for (BodyCase& body : scene.bodies) {
    std::get<Box>(body.shape).min += by;
    std::get<Box>(body.shape).max += by;
  }
  return scene;
}

/// All instruments, at the start and on average over a time in which the start's sound waves pass many times.
struct Readings {
  Samples start;
  Samples average;  ///< one of each
};

template <class Sample, class Part>
void average(std::vector<Sample>& samples, Part part) {
  Sample mean = samples.front();
  for (std::size_t k = 1; k < samples.size(); ++k)
    for (std::size_t n = 0; n < part(mean).size(); ++n) part(mean)[n] += part(samples[k])[n];
  for (double& value : part(mean)) value /= static_cast<double>(samples.size());
  samples.assign(1, mean);
}

Readings read_still_water(const Case& scene, int steps) {
  Tank tank(scene);
  tank.pack_and_start(200);
  const RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  recorder.start(*tank.solver);
  Readings readings;
  readings.start = recorder.take();
  for (int step = 0; step < steps; ++step) {
    tank.solver->advance();
    if (step >= steps / 4 && step % 10 == 0) recorder.start(*tank.solver);
  }
  readings.average = recorder.take();
  average(readings.average.pressures, [](PressureSample& sample) -> std::vector<double>& { return sample.pressures; });
  average(readings.average.levels, [](LevelSample& sample) -> std::vector<double>& { return sample.levels; });
  Samples& mean = readings.average;
  Vector3d force = Vector3d::Zero(), torque = Vector3d::Zero();
  for (const WrenchSample& sample : mean.wrenches) {
    force += sample.wrenches[0].pressure_force + sample.wrenches[0].viscous_force;
    torque += sample.wrenches[0].pressure_torque + sample.wrenches[0].viscous_torque;
  }
  const double count = static_cast<double>(mean.wrenches.size());
  mean.wrenches.resize(1);
  mean.wrenches[0].wrenches[0] = {force / count, Vector3d::Zero(), torque / count, Vector3d::Zero()};
  return readings;
}

Case tank_2d() { return box_case(Vector3d(0.6, 0, 0.5), 0.3, 0.015); }
Case tank_3d() { return box_case(Vector3d(0.4, 0.3, 0.4), 0.24, 0.02); }

/// A gauge on each line reads the level within `tolerance` spacings.
void expect_level(Case scene, const std::vector<Vector3d>& lines, double level, double tolerance = 0.25) {
  for (const Vector3d& line : lines) scene.instruments.wave_gauges.push_back({"gauge", line});
  const Readings readings = read_still_water(scene, 60);
  ASSERT_EQ(readings.start.levels.size(), 1u);
  ASSERT_EQ(readings.start.levels[0].levels.size(), lines.size());
  const double spacing = *scene.fluid.spacing;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double at_start = (readings.start.levels[0].levels[k] - level) / spacing;
    const double average = (readings.average.levels[0].levels[k] - level) / spacing;
    std::printf("%d-D gauge at (%.3f, %.3f): level off by %+.3f spacings at the start, %+.3f on average\n", scene.dimensions, lines[k].x(),
                lines[k].y(), at_start, average);
    EXPECT_LT(std::abs(at_start), tolerance) << "gauge at " << lines[k].transpose();
    EXPECT_LT(std::abs(average), tolerance) << "gauge at " << lines[k].transpose();
  }
}

TEST(WaveGauge, ReadsTheLevelIn2D) { expect_level(tank_2d(), {Vector3d(0.3, 0, 0), Vector3d(0.1037, 0, 0), Vector3d(0.594, 0, 0)}, 0.3); }

TEST(WaveGauge, ReadsTheLevelIn3D) { expect_level(tank_3d(), {Vector3d(0.2, 0.15, 0), Vector3d(0.1037, 0.0711, 0)}, 0.24); }

TEST(WaveGauge, ReadsTheLevelAlsoOnAWallAndInACorner) {
  expect_level(tank_2d(), {Vector3d(0, 0, 0), Vector3d(0.6, 0, 0)}, 0.3, 0.5);
  expect_level(tank_3d(), {Vector3d(0, 0.15, 0), Vector3d(0.395, 0.295, 0)}, 0.24, 0.5);
}

TEST(WaveGauge, ReadsTheLevelOverAnyFloor) {
  const Vector3d by(3.2, 0, -7.1);
  expect_level(moved(tank_2d(), by), {by + Vector3d(0.3, 0, 0)}, 0.3 - 7.1);
}

TEST(WaveGauge, ReadsTheLevelBesideABody) {
  Case scene = tank_2d();
  scene.bodies.push_back({"box", Box{Vector3d(0.24, 0, 0.12), Vector3d(0.36, 0, 0.45)}, Motion::fixed});  // pierces the surface
  expect_level(scene, {Vector3d(0.225, 0, 0), Vector3d(0.37, 0, 0), Vector3d(0.5, 0, 0)}, 0.3);
  scene = tank_3d();
  scene.bodies.push_back({"box", Box{Vector3d(0.16, 0.1, 0), Vector3d(0.26, 0.2, 0.4)}, Motion::fixed});  // stands on the floor
  expect_level(scene, {Vector3d(0.15, 0.15, 0), Vector3d(0.27, 0.15, 0)}, 0.24);
}

TEST(WaveGauge, ReadsTheLevelOverABody) {
  Case scene = tank_2d();
  scene.bodies.push_back({"box", Box{Vector3d(0.12, 0, 0.06), Vector3d(0.24, 0, 0.18)}, Motion::fixed});  // under water
  scene.bodies.push_back({"step", Box{Vector3d(0.36, 0, 0), Vector3d(0.48, 0, 0.12)}, Motion::fixed});    // on the floor
  expect_level(scene, {Vector3d(0.18, 0, 0), Vector3d(0.42, 0, 0)}, 0.3);
}

/// What a gauge at x = 0.5 m reads while the water stands in the first 0.15 m of the tank.
double dry_level(Case scene) {
  std::get<Box>(scene.fluid.fill[0]).max.x() = 0.15;
  scene.instruments.wave_gauges = {{"dry", Vector3d(0.5, 0, 0)}};
  Tank tank(scene);
  tank.pack_and_start(20);
  const RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  recorder.start(*tank.solver);
  return recorder.take().levels[0].levels[0];
}

TEST(WaveGauge, ReadsTheFloorWhereItIsDry) {
  EXPECT_EQ(dry_level(moved(tank_2d(), Vector3d(0, 0, 2))), 2.0);
  Case scene = tank_2d();
  scene.bodies.push_back({"box", Box{Vector3d(0.42, 0, 0), Vector3d(0.54, 0, 0.12)}, Motion::fixed});
  EXPECT_EQ(dry_level(scene), 0.0) << "a body that stands in the dry";
}

/// Probes read ρ g (level − z) within 1 % of ρ g H, at the start and on average.
void expect_pressures(Case scene, const std::vector<Vector3d>& points, double level, double depth) {
  scene.fluid.density = density;
  for (const Vector3d& point : points) scene.instruments.pressure_probes.push_back({"probe", point});
  const Readings readings = read_still_water(scene, 300);
  for (const auto& [when, samples] : {std::pair{"at the start", &readings.start}, std::pair{"on average", &readings.average}}) {
    double greatest = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double read = samples->pressures[0].pressures[k];
      const double error = (read - density * gravity * (level - points[k].z())) / (density * gravity * depth);
      greatest = std::max(greatest, std::abs(error));
      EXPECT_LT(std::abs(error), 0.01) << when << ", probe at " << points[k].transpose() << " reads " << read;
    }
    std::printf("%d-D: %zu probes %s, greatest error %.4f rho g H\n", scene.dimensions, points.size(), when, greatest);
  }
}

TEST(PressureProbe, ReadsHydrostaticPressureIn2D) {
  expect_pressures(tank_2d(),
                   {Vector3d(0, 0, 0.15), Vector3d(0.6, 0, 0.02), Vector3d(0.3, 0, 0), Vector3d(0, 0, 0), Vector3d(0.6, 0, 0),
                    Vector3d(0.3, 0, 0.15), Vector3d(0.123, 0, 0.234), Vector3d(0.0005, 0, 0.1)},
                   0.3, 0.3);
}

TEST(PressureProbe, ReadsHydrostaticPressureIn3D) {
  expect_pressures(tank_3d(),
                   {Vector3d(0, 0.15, 0.12), Vector3d(0.2, 0.3, 0.05), Vector3d(0.2, 0.15, 0), Vector3d(0, 0, 0), Vector3d(0.4, 0, 0.1),
                    Vector3d(0.2, 0.15, 0.12), Vector3d(0.123, 0.071, 0.163)},
                   0.24, 0.24);
}

TEST(PressureProbe, ReadsNothingInTheAir) {
  Case scene = tank_2d();
  scene.instruments.pressure_probes = {{"air", Vector3d(0.3, 0, 0.45)}, {"wall", Vector3d(0, 0, 0.45)}};
  const Samples samples = read_still_water(scene, 20).start;
  EXPECT_EQ(samples.pressures[0].pressures, std::vector<double>({0.0, 0.0}));
}

/// What a disc of 0.2 m at mid-height of the wall x = 0 reads more than a point there, of p = 1e4 z² Pa.
double disc_over_point(Case scene) {
  const Vector3d place(0, 0.5 * std::get<BoxTank>(scene.tank.shape).size.y(), 0.3);
  scene.gravity = Vector3d::Zero();
  scene.fluid.sound_speed = 20;
  scene.fluid.initial.pressure = "1e4*z*z";
  scene.instruments.pressure_probes = {{"point", place}, {"disc", place}};
  scene.instruments.pressure_probes[1].diameter = 0.2;
  Tank tank(scene);
  tank.solver->start();
  const RigidWorld world(tank.scene, tank.layout);
  Recorder recorder(tank.scene, tank.layout, *tank.solver, world);
  recorder.start(*tank.solver);
  const std::vector<double> read = recorder.take().pressures.front().pressures;
  return read[1] - read[0];
}

TEST(PressureProbe, WithADiameterReadsTheMeanOverItsDisc) {
  // the mean of z² over a strip of length d is d²/12 more than in its middle, over a disc d²/16; what the kernel smooths is in both
  const double strip = disc_over_point(box_case(Vector3d(0.6, 0, 0.8), 0.6, 0.02)) / (1e4 * 0.04 / 12);
  const double disc = disc_over_point(box_case(Vector3d(0.3, 0.6, 0.8), 0.6, 0.03)) / (1e4 * 0.04 / 16);
  std::printf("mean over the sensor less its middle, of the exact one: strip %.4f, disc %.4f\n", strip, disc);
  EXPECT_NEAR(strip, 1, 0.03);
  EXPECT_NEAR(disc, 1, 0.03);
}

TEST(PressureProbe, DiscThatIsNotOnOneWallIsRefused) {
  Case scene = box_case(Vector3d(0.3, 0.6, 0.8), 0.6, 0.03);
  const auto said = [&scene](const Vector3d& place, double diameter) {
    scene.instruments.pressure_probes = {{"P", place}};
    scene.instruments.pressure_probes[0].diameter = diameter;
    return error_of([&scene] { lay_out(scene); });
  };
  EXPECT_EQ(said(Vector3d(0, 0.05, 0.3), 0.2),
            "pressure probe 'P' at (0, 0.05, 0.3) m has a disc that reaches beyond its wall at (0, -0.05, 0.3) m; "
            "make its diameter less, or move it");
  EXPECT_EQ(said(Vector3d(0.15, 0.3, 0.3), 0.1),
            "pressure probe 'P' at (0.15, 0.3, 0.3) m has a disc and lies on no wall; leave out its diameter, "
            "or put it on a wall");
  // by as little as a hundredth of its diameter, where another wall of the same body is near
  scene.bodies = {{"step", Box{Vector3d(0.1, 0.1, 0), Vector3d(0.3, 0.5, 0.2)}}};
  scene.instruments.pressure_probes = {{"P", Vector3d(0.2, 0.2, 0.2)}};
  scene.instruments.pressure_probes[0].diameter = 0.2;
  EXPECT_NO_THROW(lay_out(scene)) << "up to the edge";
  EXPECT_NE(said(Vector3d(0.2, 0.2, 0.2), 0.204).find("has a disc that reaches beyond its wall at"), std::string::npos);
}

TEST(PressureProbe, DiscThatReachesOverAnOpeningIsRefused) {
  Case scene = box_case(Vector3d(0.6, 0.6, 0.8), 0.6, 0.03);
  OpeningCase hole;
  hole.name = "hole";
  hole.kind = OpeningKind::outlet;
  hole.centre = Vector3d(0, 0.3, 0.3);
  hole.normal = Vector3d::UnitX();
  hole.diameter = 0.1;
  scene.openings = {hole};
  scene.instruments.pressure_probes = {{"P", Vector3d(0, 0.3, 0.42)}};
  scene.instruments.pressure_probes[0].diameter = 0.12;
  EXPECT_NO_THROW(lay_out(scene));
  scene.instruments.pressure_probes[0].diameter = 0.2;
  EXPECT_NE(error_of([&scene] { lay_out(scene); }).find("has a disc that reaches over opening 'hole' at"), std::string::npos);
}

TEST(PressureProbe, DiscMayLieOnACurvedWall) {
  // round a pile of 0.2 m radius a disc of 0.04 m is off it by 1 mm at its rim, and half a millimetre more by the tilt of the facet
  Case scene = box_case(Vector3d(1.2, 1.2, 0.8), 0.6, 0.06);
  MeshSource pile;
  pile.uri = "shape://cylinder?radius=0.2&length=0.4&facets=128";
  pile.translation = Vector3d(0.6, 0.6, 0.2);
  scene.bodies = {{"pile", pile}};
  scene.instruments.pressure_probes = {{"P", Vector3d(0.8, 0.6, 0.2)}};
  scene.instruments.pressure_probes[0].diameter = 0.04;
  EXPECT_NO_THROW(lay_out(scene));
  scene.instruments.pressure_probes[0].diameter = 0.2;
  EXPECT_NE(error_of([&scene] { lay_out(scene); }).find("has a disc that reaches beyond its wall at"), std::string::npos);
}

void expect_weight_on_tank(Case scene, double volume) {
  scene.fluid.density = density;
  const Samples samples = read_still_water(scene, 300).average;
  const Wrench& tank = samples.wrenches[0].wrenches[0];
  const double weight = density * gravity * volume;
  const Vector3d force = tank.pressure_force + tank.viscous_force;
  std::printf("%d-D: force on the tank (%.3f, %.3f, %.3f) N, weight of the water %.3f N: %+.2f %%\n", scene.dimensions, force.x(),
              force.y(), force.z(), weight, 100 * (-force.z() / weight - 1));
  EXPECT_NEAR(force.z(), -weight, 0.02 * weight);
  EXPECT_NEAR(force.x(), 0, 0.005 * weight);
  EXPECT_NEAR(force.y(), 0, 0.005 * weight);
}

TEST(Wrench, OfTheTankIsTheWatersWeight) {
  expect_weight_on_tank(tank_2d(), 0.6 * 0.3);
  expect_weight_on_tank(tank_3d(), 0.4 * 0.3 * 0.24);
}

TEST(Wrench, HasTheTorqueOfTheWatersWeightAboutTheOrigin) {
  Case scene = tank_2d();
  scene.fluid.density = density;
  const Wrench tank = read_still_water(scene, 300).average.wrenches[0].wrenches[0];
  // r × F with the weight at the middle: τ_y = z F_x − x F_z, the side walls' forces cancel
  const double expected = 0.3 * density * gravity * 0.6 * 0.3;
  std::printf("torque (%.3f, %.3f, %.3f) N m, expected (0, %.3f, 0)\n", tank.pressure_torque.x(), tank.pressure_torque.y(),
              tank.pressure_torque.z(), expected);
  EXPECT_NEAR(tank.pressure_torque.y(), expected, 0.02 * expected);
  EXPECT_EQ(tank.pressure_torque.x(), 0);
  EXPECT_EQ(tank.pressure_torque.z(), 0);
}

TEST(Energies, OfWaterAtRest) {
  for (const Vector3d& by : {Vector3d(0, 0, 0), Vector3d(50, 0, -20)}) {
    Case scene = moved(tank_2d(), by);
    scene.fluid.density = density;
    const EnergySample energies = read_still_water(scene, 60).average.energies.back();
    const double mass = density * 0.6 * 0.3, potential = mass * gravity * 0.15;
    std::printf("potential energy %.3f J/m, expected %.3f: %+.2f %%; compression %.4g, kinetic %.2g J/m\n", energies.potential, potential,
                100 * (energies.potential / potential - 1), energies.compression, energies.kinetic);
    EXPECT_NEAR(energies.mass, mass, 1e-6 * mass);
    EXPECT_NEAR(energies.potential, potential, 0.01 * potential);
    // ∫ p²/(2 ρ c²) dV = ρ g² H³ L/(6 c²)
    const double c = 10 * std::sqrt(2 * gravity * 0.3);
    const double compression = density * gravity * gravity * 0.027 * 0.6 / (6 * c * c);
    EXPECT_NEAR(energies.compression, compression, 0.1 * compression);
    EXPECT_GE(energies.kinetic, 0);
    EXPECT_LT(energies.kinetic, 1e-3 * potential);
  }
}

}  // namespace
}  // namespace wavetank
