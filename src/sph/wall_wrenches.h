#pragma once

#include <vector>

#include "facing_walls.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Sums what the fluid does to owners of walls, over the slots about each.
template <class Real>
class WallWrenches {
 public:
  /// `boxes`: about each owner's walls at rest; `pieces`: those walls, each about a spacing wide; `everywhere`: images bring an owner's
  /// walls to particles far from it; `drift`: how far particles may be from where they were sorted, m.
  WallWrenches(const compute::Device& device, const Discretisation& discretisation, const GridShape& grid, const std::vector<Box>& boxes,
               const std::vector<WallElement>& pieces, bool everywhere, double drift);

  /// Where the owners are.
  void set_poses(const std::vector<WallPose>& poses);
  /// One wrench a listed owner; `loads`: the pressures of wall elements.
  std::vector<WallWrench> find(const SolverKernels& kernels, const Surroundings<Real>& surroundings, const compute::Buffer<Real>& state,
                               const WallArrays<Real>& walls, const compute::Buffer<Real>& loads, const std::vector<int>& owners);

 private:
  void find_regions(const std::vector<int>& owners);

  compute::Device device_;
  Discretisation discretisation_;
  GridShape grid_;
  std::vector<Box> boxes_;
  bool everywhere_ = false;
  double drift_ = 0;
  FacingWalls<Real> facing_;
  std::vector<WallPose> poses_;
  compute::Buffer<Real> parts_, sums_, totals_;
  KeptBuffer<int> regions_;
  std::vector<int> region_owners_;  ///< that the regions were found for, at the present poses; empty: for none
  int region_items_ = 0;
  int chunks_ = 0;  ///< of items, of the largest region
};

}  // namespace wavetank
