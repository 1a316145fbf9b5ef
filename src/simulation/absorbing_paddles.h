#pragma once

#include <memory>
#include <vector>

#include "wavetank/instruments/wave_gauges.h"

namespace wavetank {

/// Shows paddles that absorb what their gauges see, step by step.
class AbsorbingPaddles {
 public:
  AbsorbingPaddles(const Case& settled_case, const Layout& layout, const Solver& solver, RigidWorld& world);
  /// Before the step from `time`. Says once of each paddle that it is near the end of its way.
  void look(Solver& solver, double time);
  /// From here on it says so again.
  void reset();

 private:
  RigidWorld& world_;
  std::vector<std::size_t> owners_;
  std::vector<std::string> names_;
  std::vector<bool> told_;
  std::unique_ptr<WaveGauges> gauges_;  ///< one an owner
};

}  // namespace wavetank
