// Still water stays so: no wall feeds sound. Coarse, where the walls' share of the water is largest; and without viscosity, which would
// hide it. What a pair of operators that is not balanced feeds to sound grows by several times a second here, from rounding's and packing's
// to where pressures are clamped.
#include <algorithm>
#include <ostream>

#include "simulation_fixture.h"

namespace wavetank::still_water_test {
namespace {

struct Water {
  const char* name;
  int dimensions = 2;
  int rows = 8;
  WallElements elements = WallElements::facet;
  ShepardFactor shepard = ShepardFactor::geometric;
  DensityDiffusion diffusion = DensityDiffusion::fourtakas;
  double viscosity = 0;  ///< α
  bool renormalise = true;
  WallMethod method = WallMethod::boundary_integral;
  double offset = 0.01;  ///< of the floor's pressure, in ρgH: more only where the start already has it
};

std::ostream& operator<<(std::ostream& out, const Water& water) { return out << water.name; }

constexpr double depth = 0.3, weight = 1000 * 9.81;

/// About as wide as deep.
Case tank_of(const Water& water) {
  const double spacing = depth / water.rows, width = (water.rows + (water.dimensions == 2 ? 4 : 0)) * spacing;
  Case scene = box_case(Vector3d(width, water.dimensions == 2 ? 0.0 : width, 0.8), depth, spacing);
  scene.fluid.sound_speed = 20;
  scene.numerics.packing.settling = 3;
  scene.numerics.walls.elements = water.elements;
  scene.numerics.walls.shepard = water.shepard;
  scene.numerics.walls.method = water.method;
  scene.numerics.walls.renormalise_divergence = water.renormalise;
  scene.numerics.density_diffusion = water.diffusion;
  scene.numerics.artificial_viscosity = water.viscosity;
  scene.instruments.pressure_probes = {{"floor", Vector3d(width / 2, water.dimensions == 2 ? 0.0 : width / 2, 0)}};
  scene.instruments.rate = 200;
  return scene;
}

class StillWater : public ::testing::TestWithParam<Water> {};

TEST_P(StillWater, StaysStill) {
  const double end = 6, first = 4;  // s: two dozen times the sound's slowest period is over long before
  Simulation simulation(tank_of(GetParam()));
  const double potential = simulation.energies().potential;
  run_to(simulation, first);
  double kinetic = 0;
  Samples samples;
  for (double time = first; time < end; time += 0.05) {
    append(samples, run_to(simulation, time));
    kinetic = std::max(kinetic, simulation.energies().kinetic);
  }
  double least = 1e30, most = -1e30;
  for (const PressureSample& sample : samples.pressures) {
    least = std::min(least, sample.pressures[0]);
    most = std::max(most, sample.pressures[0]);
  }
  const double expected = weight * depth;
  std::printf(
      "%s: from %g to %g s the floor's pressure is %.4f to %.4f rho g H, kinetic over potential energy up to %.1e, which has changed by "
      "%+.2f %%\n",
      GetParam().name, first, end, least / expected, most / expected, kinetic / potential,
      100 * (simulation.energies().potential / potential - 1));
  EXPECT_LT(most - least, 0.12 / GetParam().rows * expected);
  EXPECT_NEAR((most + least) / 2, expected, GetParam().offset * expected);
  EXPECT_LT(kinetic, 3e-4 * potential);
  EXPECT_NEAR(simulation.energies().potential, potential, 0.3 / GetParam().rows * potential);
}

constexpr double little = 0.02;  // α

constexpr Water waters[] = {
    {"FourRows", 2, 4, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::fourtakas, little},
    {"EightRows", 2, 8, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::fourtakas, little},
    {"EightRowsWithoutViscosity", 2, 8},
    {"Numerical", 2, 8, WallElements::numerical, ShepardFactor::geometric, DensityDiffusion::fourtakas, little},
    {"SemiAnalytical", 2, 8, WallElements::semi_analytical, ShepardFactor::geometric, DensityDiffusion::fourtakas, little},
    {"Volumetric", 2, 8, WallElements::facet, ShepardFactor::volumetric, DensityDiffusion::fourtakas, little, true,
     WallMethod::boundary_integral, 0.06},
    {"DivergenceAsItIs", 2, 8, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::fourtakas, little, false},
    {"Ghosts", 2, 8, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::fourtakas, little, true, WallMethod::ghost, 0.035},
    {"Antuono", 2, 8, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::antuono, little},
    {"FourRowsIn3D", 3, 4, WallElements::facet, ShepardFactor::geometric, DensityDiffusion::fourtakas, little, true,
     WallMethod::boundary_integral, 0.03},
};

INSTANTIATE_TEST_SUITE_P(Walls, StillWater, ::testing::ValuesIn(waters),
                         [](const ::testing::TestParamInfo<Water>& info) { return info.param.name; });

}  // namespace
}  // namespace wavetank::still_water_test
