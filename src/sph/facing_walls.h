#pragma once

#include <vector>

#include "moving_walls.h"
#include "solver_kernels.h"
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
  /// Adds to the pressure forces and torques of the owners whose regions are given, `totals` as wrench_totals leaves them.
  void add(const SolverKernels& kernels, const Surroundings<Real>& surroundings, const compute::Buffer<Real>& state,
           const WallArrays<Real>& walls, int regions, const compute::Buffer<int>& region_values, compute::Buffer<Real>& totals);

 private:
  compute::Device device_;
  Discretisation discretisation_;
  int count_ = 0;
  compute::Buffer<Real> spheres_;  ///< about each owner, at rest
  compute::Buffer<Real> rest_;     ///< centres, and areas times normals
  compute::Buffer<int> owners_;    ///< of each piece
  KeptBuffer<Real> poses_;
  compute::Buffer<Real> places_, forces_, sums_;
  compute::Buffer<int> others_;
};

}  // namespace wavetank
