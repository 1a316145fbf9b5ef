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
  add(samples.flows, more.flows);
  add(samples.velocities, more.velocities);
  add(samples.sections, more.sections);
  add(samples.imus, more.imus);
  add(samples.moorings, more.moorings);
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
  const auto same_velocity = [](const Vector3d& p, const Vector3d& q) { return (p.hasNaN() && q.hasNaN()) || p == q; };
  const auto same_flow = [](const auto& p, const auto& q) { return p.discharge == q.discharge && p.area == q.area; };
  const auto same_reading = [](const ImuReading& p, const ImuReading& q) {
    return p.orientation.coeffs() == q.orientation.coeffs() && p.angular_velocity == q.angular_velocity &&
           p.specific_force == q.specific_force;
  };
  const auto same_mooring = [](const MooringState& p, const MooringState& q) {
    return p.tension == q.tension && p.anchor_tension == q.anchor_tension && p.lying == q.lying && p.line == q.line;
  };
  return equal(a.velocities, b.velocities,
               [&](const auto& p, const auto& q) { return p.time == q.time && equal(p.velocities, q.velocities, same_velocity); }) &&
         equal(a.sections, b.sections,
               [&](const auto& p, const auto& q) { return p.time == q.time && equal(p.flows, q.flows, same_flow); }) &&
         equal(a.imus, b.imus,
               [&](const auto& p, const auto& q) { return p.time == q.time && equal(p.readings, q.readings, same_reading); }) &&
         equal(a.moorings, b.moorings,
               [&](const auto& p, const auto& q) { return p.time == q.time && equal(p.moorings, q.moorings, same_mooring); }) &&
         equal(a.pressures, b.pressures, [](const auto& p, const auto& q) { return p.time == q.time && p.pressures == q.pressures; }) &&
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
