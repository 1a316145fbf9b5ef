#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "../common/box_case.h"
#include "state_bytes.h"
#include "wavetank/common/error.h"
#include "wavetank/compute/device.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

inline const compute::Device& test_device() {
  static const compute::Device device(compute::choose_device("auto"));
  return device;
}

inline bool has_precision(Precision precision) { return precision == Precision::single || test_device().info().has_double; }

/// A solver with all that it was made from.
struct Tank {
  explicit Tank(const Case& checked) : Tank(checked, lay_out(checked)) {}
  Tank(const Case& checked, const Layout& made) : layout(made), scene(settled(checked, layout)), discretisation(discretise(scene, layout)) {
    const std::vector<Vector3d> centres(1 + scene.bodies.size(), Vector3d::Zero());
    solver = make_solver(test_device(), scene, layout, discretisation, centres);
  }
  void pack_and_start(int iterations) {
    solver->pack(iterations, {});
    solver->start();
  }

  Layout layout;
  Case scene;
  Discretisation discretisation;
  std::unique_ptr<Solver> solver;
};

/// A layout without walls: particles of one volume in a box.
inline Layout loose_particles(const Box& domain, double spacing, const std::vector<Vector3d>& particles, int dimensions) {
  Layout layout;
  layout.spacing = spacing;
  layout.domain = domain;
  layout.particles = particles;
  layout.volumes.assign(particles.size(), std::pow(spacing, dimensions));
  layout.levels.assign(particles.size(), domain.max.z());
  return layout;
}

inline bool all_finite(const FluidState& fluid) {
  for (std::size_t i = 0; i < fluid.id.size(); ++i)
    if (!fluid.position[i].allFinite() || !fluid.velocity[i].allFinite() || !std::isfinite(fluid.pressure[i]) ||
        !std::isfinite(fluid.compression[i]))
      return false;
  return true;
}

inline double total(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

}  // namespace wavetank
