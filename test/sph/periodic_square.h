#pragma once

#include "sph_fixture.h"

namespace wavetank {

/// Water in a square that is periodic both ways, from the lattice, without gravity, artificial viscosity and density diffusion, in which
/// sound goes on for ever.
struct PeriodicSquare {
  static constexpr double side = 1.0, sound_speed = 10;

  /// `given`: what a case of it chooses besides.
  PeriodicSquare(double spacing, const NumericsCase& given) {
    scene = box_case(Vector3d(side, 0, side), side, spacing);
    scene.gravity = Vector3d::Zero();
    scene.tank.periodic = {true, false, true};
    scene.fluid.sound_speed = sound_speed;
    scene.numerics = given;
    scene.numerics.density_diffusion = DensityDiffusion::none;
    scene.numerics.negative_pressure = NegativePressure::allowed;
    scene.numerics.artificial_viscosity = 0;
    std::vector<Vector3d> particles;
    for (double x = 0.5 * spacing; x < side; x += spacing)
      for (double z = 0.5 * spacing; z < side; z += spacing) particles.emplace_back(x, 0, z);
    layout = loose_particles({Vector3d::Zero(), Vector3d(side, 0, side)}, spacing, particles, 2);
    layout.open_top = false;
    scene = settled(scene, layout);
    discretisation = discretise(scene, layout);
    solver = make_solver(test_device(), scene, layout, discretisation, {Vector3d::Zero()});
    solver->start();
  }

  Layout layout;
  Case scene;
  Discretisation discretisation;
  std::unique_ptr<Solver> solver;
};

}  // namespace wavetank
