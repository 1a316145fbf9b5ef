#pragma once

#include <memory>
#include <vector>

#include "wavetank/instruments/samples.h"
#include "wavetank/instruments/solid_bodies.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Discharges through plane sections, ∫ n · Σ W V u / γ dS over cells of about a spacing: each cell counts as far as water fills the kernel
/// about its middle, so that the sum ends at a free surface as the kernel smooths that. What lies in a wall or a body is no part of a
/// section; bodies that move are looked for where they are.
class FlowSections {
 public:
  /// `world` is looked at in every reading.
  FlowSections(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world);
  /// One a section.
  std::vector<FlowThroughSection> read(Solver& solver) const;

 private:
  const RigidWorld& world_;
  std::vector<FlowSection> sections_;
  std::vector<Vector3d> places_;  ///< of all
  std::vector<SolidBody> moving_;
  std::unique_ptr<PointSet> points_;
};

}  // namespace wavetank
