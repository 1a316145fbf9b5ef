#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "../common/box_case.h"
#include "../common/error_of.h"
#include "../common/scratch_directory.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// A small dam break in 2-D: a column of 0.4 m × 0.4 m in a tank of 1.2 m × 0.8 m, with probes and gauges.
inline Case dam_break(double spacing) {
  Case result = box_case(Vector3d(1.2, 0, 0.8), 0.4, spacing);
  result.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.4, 0, 0.4)}};
  result.numerics.artificial_viscosity = 0.05;
  result.numerics.packing.iterations = 100;
  result.instruments.pressure_probes = {{"column", Vector3d(0, 0, 0.05)}, {"far", Vector3d(1.2, 0, 0.05)}, {"floor", Vector3d(0.2, 0, 0)}};
  result.instruments.wave_gauges = {{"column", Vector3d(0.1, 0, 0)}, {"middle", Vector3d(0.6, 0, 0)}};
  return result;
}

inline void append(Samples& samples, Samples more) {
  const auto add = [](auto& to, auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  add(samples.pressures, more.pressures);
  add(samples.levels, more.levels);
  add(samples.wrenches, more.wrenches);
  add(samples.energies, more.energies);
  add(samples.poses, more.poses);
}

/// Advances to `time`; the samples on the way.
inline Samples run_to(Simulation& simulation, double time) {
  Samples samples = simulation.take_samples();
  while (simulation.state().time < time) simulation.advance();
  append(samples, simulation.take_samples());
  return samples;
}

/// Advances by `steps`; the samples on the way.
inline Samples run_steps(Simulation& simulation, int steps) {
  Samples samples = simulation.take_samples();
  for (int k = 0; k < steps; ++k) simulation.advance();
  append(samples, simulation.take_samples());
  return samples;
}

/// Whether every value is the same, to the last bit.
inline bool same(const Samples& a, const Samples& b) {
  const auto equal = [](const auto& left, const auto& right, const auto& each) {
    return left.size() == right.size() && std::equal(left.begin(), left.end(), right.begin(), each);
  };
  const auto same_wrench = [](const Wrench& p, const Wrench& q) {
    return p.pressure_force == q.pressure_force && p.viscous_force == q.viscous_force && p.pressure_torque == q.pressure_torque &&
           p.viscous_torque == q.viscous_torque;
  };
  return equal(a.pressures, b.pressures, [](const auto& p, const auto& q) { return p.time == q.time && p.pressures == q.pressures; }) &&
         equal(a.levels, b.levels, [](const auto& p, const auto& q) { return p.time == q.time && p.levels == q.levels; }) &&
         equal(a.wrenches, b.wrenches,
               [&](const auto& p, const auto& q) { return p.time == q.time && equal(p.wrenches, q.wrenches, same_wrench); }) &&
         equal(a.energies, b.energies, [](const auto& p, const auto& q) {
           return p.time == q.time && p.kinetic == q.kinetic && p.potential == q.potential && p.compression == q.compression &&
                  p.mass == q.mass;
         });
}

/// A test with a directory of its own.
class SimulationTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return scratch.file(name); }

  /// The bytes of the simulation's snapshot.
  std::string snapshot(const Simulation& simulation) const {
    simulation.save(path("bits"));
    return read(path("bits"));
  }
  static std::string read(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
  }
  static void write(const std::string& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

  const ScratchDirectory scratch;
  const std::filesystem::path directory = scratch.path();
};

}  // namespace wavetank
