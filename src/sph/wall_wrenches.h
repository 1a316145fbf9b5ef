#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "exact_sums.h"
#include "facing_walls.h"
#include "grid_shape.h"
#include "integrators/integrator.h"
#include "parting.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Sums what the fluid does to owners of walls, over the slots about each. Runs of slots are those of a whole tank, wherever it is cut into
/// parts, and sums of them have no order: so the wrenches are the same of any number of parts.
template <class Real>
class WallWrenches {
 public:
  /// `boxes`: about each owner's walls at rest; `pieces`: those walls, each about a spacing wide; `everywhere`: images bring an owner's
  /// walls to particles far from it; `drift`: how far particles may be from where they were sorted, m; `scale`: of a particle's forces.
  WallWrenches(const compute::Device& device, const Discretisation& discretisation, const GridShape& grid, const std::vector<Box>& boxes,
               const std::vector<WallElement>& pieces, bool everywhere, double drift, const ExactScale& scale);

  /// `arguments`: of the surroundings, and for each slot of a state that wrenches are found of. This must stay where it is from then on.
  /// `file`: that has the forces on walls by the case's gradients.
  void bind(const KernelMaker& make, const std::string& file, const std::map<Slot, compute::Arguments>& arguments);
  /// Where the owners are.
  void set_poses(const std::vector<WallPose>& poses);
  /// Of a part of the water: that has the slots or rows from `begin` to before `end` along the axis of the parts, to which others add
  /// theirs. All must find() the wrenches of the same owners.
  void set_part(const Parting& parting, int begin, int end);
  /// One wrench a listed owner.
  std::vector<WallWrench> find(Slot state, const std::vector<int>& owners);

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
  ExactScale scale_;
  Real per_force_, per_moment_;
  parallel::Group* group_ = nullptr;  ///< of parts
  int part_axis_ = 0, part_begin_ = 0, part_end_ = 0;
  compute::Buffer<Real> parts_;
  compute::Buffer<std::int64_t> sums_, totals_;
  KeptBuffer<int> regions_;
  std::vector<int> region_owners_;  ///< that the regions were found for, at the present poses; empty: for none
  int region_count_ = 0;
  int region_items_ = 0;
  int chunks_ = 0;     ///< of items, of the largest region
  int sum_count_ = 0;  ///< chunks of all regions
  std::map<Slot, BoundSweep> forces_;
  compute::BoundKernel chunk_kernel_, total_kernel_;
};

}  // namespace wavetank
