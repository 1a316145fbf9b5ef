// Tanks at rest stay at rest, under hydrostatic pressure; and the place of a tank does not matter.
#include <algorithm>

#include "simulation_fixture.h"

namespace wavetank::still_tank_test {
namespace {

/// √(Σ V (p − ρ g (H − z))² / Σ V) / ρ g H over the particles.
double pressure_error(const ParticleCloud& cloud, double density, double gravity, double depth) {
  double sum = 0;
  for (std::size_t i = 0; i < cloud.id.size(); ++i) {
    const double difference = cloud.pressure[i] - density * gravity * (depth - cloud.position[i].z());
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(cloud.id.size())) / (density * gravity * depth);
}

/// The tank at rest of the geometric Shepard paper, narrower: 20 rows of particles over H = 0.092 m.
Case paper_tank() {
  Case scene = box_case(Vector3d(0.3036, 0, 0.3), 0.092, 0.0046);
  scene.fluid.density = 998;
  scene.fluid.viscosity = 8.94e-4;
  scene.numerics.support = 4;
  scene.numerics.artificial_viscosity = 0.02;
  scene.instruments.rate = 100;
  return scene;
}

void stays_at_rest(const Case& scene, double end) {
  const double depth = 0.092, gravity = 9.81, density = scene.fluid.density, time_scale = std::sqrt(depth / gravity);
  const BoxTank tank = std::get<BoxTank>(scene.tank.shape);
  Simulation simulation(scene);
  const std::size_t particles = simulation.state().particles;
  EXPECT_EQ(particles, 20u * 66u);
  const double mass = density * depth * tank.size.x();

  double worst_pressure = 0, worst_kinetic = 0;
  for (double time = 0; time <= end; time += 0.25) {
    run_to(simulation, time * time_scale);
    const ParticleCloud cloud = simulation.particles();
    ASSERT_EQ(cloud.id.size(), particles);
    worst_pressure = std::max(worst_pressure, pressure_error(cloud, density, gravity, depth));
    const EnergySample energies = simulation.energies();
    worst_kinetic = std::max(worst_kinetic, energies.kinetic / energies.potential);
    EXPECT_NEAR(energies.mass, mass, 1e-6 * mass);
    for (const Eigen::Vector3f& position : cloud.position) {
      EXPECT_GE(position.x(), 0.0f);
      EXPECT_LE(position.x(), static_cast<float>(tank.size.x()));
      EXPECT_GE(position.z(), 0.0f);
      EXPECT_LE(position.z(), static_cast<float>(depth + *scene.fluid.spacing)) << "above the free surface";
    }
  }
  std::printf(
      "to t sqrt(g/H) = %.2f, %llu steps: worst L2 pressure error %.4f rho g H, worst kinetic/potential energy %.1e, %llu guard hits\n",
      simulation.state().time / time_scale, static_cast<unsigned long long>(simulation.state().step), worst_pressure, worst_kinetic,
      static_cast<unsigned long long>(simulation.state().guard_hits));
  EXPECT_LT(worst_pressure, 0.02);
  EXPECT_LT(worst_kinetic, 2e-5);
}

TEST(StillTank, StaysAtRestIn2D) { stays_at_rest(paper_tank(), 20.0); }

TEST(StillTank, StaysAtRestWithAntuonosDiffusion) {
  Case scene = paper_tank();
  scene.numerics.density_diffusion = DensityDiffusion::antuono;
  stays_at_rest(scene, 1.5);
}

TEST(StillTank, PushesASubmergedBoxUpIn3D) {
  const double density = 1000, gravity = 9.81, side = 0.12;
  Case scene = box_case(Vector3d(0.4, 0.4, 0.4), 0.3, 0.02);
  scene.fluid.density = density;
  scene.bodies.push_back({"box", Box{Vector3d(0.14, 0.14, 0.09), Vector3d(0.26, 0.26, 0.21)}, Motion::fixed});
  scene.instruments.rate = 200;
  Simulation simulation(scene);
  const Samples samples = run_to(simulation, 0.3);
  Vector3d force = Vector3d::Zero();
  int count = 0;
  for (const WrenchSample& sample : samples.wrenches) {
    if (sample.time < 0.15) continue;
    force += sample.wrenches[1].pressure_force;
    ++count;
  }
  force /= count;
  const double archimedes = density * gravity * side * side * side;
  std::printf("mean pressure force on the box (%.3f, %.3f, %.3f) N over %d samples; Archimedes' force %.3f N: %+.2f %%\n", force.x(),
              force.y(), force.z(), count, archimedes, 100 * (force.z() / archimedes - 1));
  EXPECT_NEAR(force.z(), archimedes, 0.03 * archimedes);
  EXPECT_NEAR(force.x(), 0, 0.03 * archimedes);
  EXPECT_NEAR(force.y(), 0, 0.03 * archimedes);
  const double mass = density * (0.4 * 0.4 * 0.3 - side * side * side);
  EXPECT_NEAR(simulation.energies().mass, mass, 1e-6 * mass);
}

/// The dam break with everything of it moved.
Case moved(Case scene, const Vector3d& by) {
  std::get<BoxTank>(scene.tank.shape).origin += by;
  for (FillRegion& region : scene.fluid.fill) {
    std::get<Box>(region).min += by;
    std::get<Box>(region).max += by;
  }
  for (PressureProbeCase& probe : scene.instruments.pressure_probes) probe.position += by;
  for (WaveGaugeCase& gauge : scene.instruments.wave_gauges) gauge.position += by;
  return scene;
}

TEST(FarTank, HasTheSameProbes) {
  const double end = 0.6;
  const Case scene = dam_break(0.025);
  Simulation here(scene), there(moved(scene, Vector3d(1000, 0, -1000)));
  const Samples a = run_to(here, end), b = run_to(there, end);
  const std::size_t count = std::min(a.pressures.size(), b.pressures.size());
  ASSERT_GT(count, 590u);
  for (std::size_t probe = 0; probe < 3; ++probe) {
    double impulse_a = 0, impulse_b = 0, difference = 0, peak = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const double p = a.pressures[k].pressures[probe], q = b.pressures[k].pressures[probe];
      impulse_a += p / 1000;
      impulse_b += q / 1000;
      difference += (p - q) * (p - q);
      peak = std::max(peak, std::abs(p));
    }
    difference = std::sqrt(difference / static_cast<double>(count));
    std::printf("probe %-6s: impulse %.3f Pa s here, %.3f 1000 m away; series differ by %.2g of the peak of %.0f Pa\n",
                scene.instruments.pressure_probes[probe].name.c_str(), impulse_a, impulse_b, difference / peak, peak);
    EXPECT_GT(impulse_a, 0);
    EXPECT_NEAR(impulse_b, impulse_a, 0.01 * impulse_a);
    EXPECT_LT(difference, 0.01 * peak);
  }
  for (std::size_t gauge = 0; gauge < 2; ++gauge)
    EXPECT_NEAR(b.levels.back().levels[gauge] + 1000, a.levels.back().levels[gauge], 0.01 * 0.4);
}

}  // namespace
}  // namespace wavetank::still_tank_test
