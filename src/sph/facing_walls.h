#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "bound_kernels.h"
#include "exact_sums.h"
#include "integrators/integrator.h"
#include "moving_walls.h"
#include "surroundings.h"

namespace wavetank {

/// Those pieces of walls that may come nearer to another owner's walls than the support (m): of owners that stand, what lies about each
/// other; `moving`: of each owner.
std::vector<WallElement> pieces_that_may_face(const std::vector<WallElement>& pieces, const std::vector<bool>& moving, double support);

/// What walls of different owners do to each other through water narrower than the support (facing_walls.cl).
template <class Real>
class FacingWalls {
 public:
  /// `pieces`: all walls at rest, each about a spacing wide. Nothing is done where they have one owner only.
  FacingWalls(const compute::Device& device, const std::vector<WallElement>& pieces, const Discretisation& discretisation);

  /// Where the owners are.
  void set_poses(const std::vector<WallPose>& poses);
  /// `arguments`: of the surroundings, the state of each slot, the owners' regions, their totals, and the quanta of those. This must stay
  /// where it is from then on.
  void bind(const KernelMaker& make, const std::map<Slot, compute::Arguments>& arguments);
  /// Adds to the pressure forces and torques of the owners whose regions are given, as wrench_totals leaves them.
  void add(Slot state, int regions);

 private:
  compute::Device device_;
  Discretisation discretisation_;
  int count_ = 0;
  int owner_count_ = 0;
  int chunks_ = 0, items_ = 0;
  compute::Buffer<Real> spheres_;  ///< about each owner, at rest
  compute::Buffer<Real> rest_;     ///< centres, and areas times normals
  compute::Buffer<int> owners_;    ///< of each piece
  KeptBuffer<Real> poses_;
  compute::Buffer<Real> places_, forces_;
  compute::Buffer<std::int64_t> sums_;
  compute::Buffer<int> others_;
  std::map<Slot, BoundSweep> sweeps_;
  compute::BoundKernel chunk_kernel_, total_kernel_;
};

}  // namespace wavetank
