#pragma once

#include <limits>

#include "kernel_parameters.h"
#include "moving_walls.h"
#include "particle_grid.h"
#include "wall_arrays.h"
#include "wavetank/compute/program.h"
#include "wavetank/geometry/thin_walls.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// One stage of a time step; a scheme is a list of them, so that it can be read on one page.
struct Stage {
  const char* name;
  std::function<void()> run;
};

template <class Real>
class SphSolver final : public Solver {
 public:
  SphSolver(const compute::Device& device, const Case& scene, const Layout& layout, const Discretisation& discretisation,
            const std::vector<Eigen::Vector3d>& centres);

  PackingReport pack(int iterations, const std::function<void(double)>& progress) override;
  StepReport start() override;
  StepReport settle(double periods, const std::function<void(double)>& progress) override;
  StepReport advance(WallMover* mover) override;
  void set_wall_motions(const WallMotions& motions) override;
  void limit_time_step(double limit) override { time_step_limit_ = limit; }
  std::size_t particle_count() const override { return static_cast<std::size_t>(count_); }
  std::optional<ThinWall> thinnest_wall() const override { return thin_.thinnest; }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points) const override;
  std::vector<PointValue> evaluate(const PointSet& points) override;
  std::vector<WallWrench> wrenches() override;
  FluidEnergies energies() override;
  FluidState download() override;
  std::vector<char> save() const override;
  void restore(const std::vector<char>& bytes) override;
  std::size_t device_memory() const override { return device_.allocated(); }

 private:
  using Buffer = compute::Buffer<Real>;
  struct DevicePoints;

  void build_kernels();
  /// The walls, and of the lid what holds the water up or to the side, as settling needs them.
  WallArrays<Real> make_supported_walls() const;
  /// With or without the case's own walls.
  WallArrays<Real> make_walls(bool own, const std::vector<WallElement>& lid) const;
  void upload_parameters(const KernelParameters<Real>& values);
  /// Queues a kernel that goes over the neighbours of `count` particles, points or walls; `others` are its own arguments. The guard writes
  /// the state.
  template <class... Others>
  void sweep(const compute::Kernel& kernel, int count, const Buffer& state, const WallArrays<Real>& walls, const Others&... others);
  void set_hydrostatic();
  /// Zero velocities, and all that follows from the positions and compressions.
  StepReport start_at_rest();
  void upload_particles(const Layout& layout);
  std::vector<Stage> symplectic();
  void sort();
  void find_boxes(const Layout& layout);
  void place_walls(const WallMotions& motions);
  void place_barriers();
  void find_fastest_wall(const WallMotions& motions);
  std::vector<WallWrench> wrenches_at(const Buffer& state, const std::vector<int>& owners);
  void find_regions(const std::vector<int>& owners);
  void load_walls(const Buffer& state);
  void find_accelerations(const Buffer& state);
  void find_compression_rates();
  void guard();
  /// What the guard has just taken from the particles for the owners of walls.
  void gather_guard_impulses();
  /// On the coupled owners in the middle of the step, with what the guard took at the end of the last one.
  std::vector<WallWrench> wrenches_in_step();
  StepReport watch();

  compute::Device device_;
  Case case_;
  Discretisation discretisation_;
  int count_ = 0;
  int stride_ = 0;
  int chunks_ = 0;
  std::string options_;
  compute::SourceFiles sources_;
  KernelParameters<Real> values_;
  compute::Buffer<char> parameters_;
  std::vector<Eigen::Vector3d> centres_;  ///< of the walls' owners, as the layout has them
  std::vector<Box> boxes_;                ///< about the walls of each owner, likewise
  std::vector<bool> moving_;              ///< owners
  bool moving_frame_ = false;
  WallMover* mover_ = nullptr;  ///< during a step
  double time_step_limit_ = std::numeric_limits<double>::infinity();
  double step_ = 0;          ///< of the step in progress, s
  bool load_lost_ = false;   ///< in this step, to values that are not finite
  double fastest_wall_ = 0;  ///< of any point of a body, m/s
  bool ghosts_ = false;
  bool guard_gives_ = false;            ///< bodies, or the tank, get what the guard takes
  std::vector<double> guard_impulses_;  ///< impulse_count each owner, of the last step
  bool elements_ = false;               ///< the walls are elements, with a pressure of their own
  std::vector<double> levels_;          ///< by particle id, for the hydrostatic start
  Buffer state_, spare_, half_, rates_, gradient_;
  compute::Buffer<std::uint32_t> id_, spare_id_;
  ParticleGrid grid_;
  WallKind kind_;
  ThinParts thin_;
  std::vector<Facet> thin_facets_;
  Layout closed_;  ///< the walls and the lid alone
  WallArrays<Real> walls_;
  std::optional<MovingWalls<Real>> moving_walls_;  ///< where there are any
  std::vector<WallPose> poses_;
  Barriers<Real> barriers_;
  Buffer motions_, motion_centres_, images_;
  Buffer loads_;
  Buffer wrench_parts_, wrench_totals_;
  compute::Buffer<int> regions_;
  std::vector<int> region_owners_;  ///< that the regions were found for, at the present poses; empty: for none
  int region_items_ = 0;
  Buffer time_step_, watches_, energy_parts_, energy_total_;
  compute::Buffer<int> guard_hits_, guard_takers_, alarms_, alarm_;
  Buffer guard_lost_, guard_parts_, guard_totals_;
  compute::Kernel continuity_kernel_, momentum_kernel_, gradient_kernel_, loads_kernel_, packing_kernel_, points_kernel_, surface_kernel_,
      guard_kernel_, guard_chunks_, guard_sums_, forces_kernel_;
  compute::Kernel derive_, predict_, correct_, compress_, move_packed_, watch_chunks_, watch_total_, energy_chunks_, energy_sum_,
      packing_total_;
  compute::Kernel wrench_sums_;
  std::vector<Stage> stages_;
};

}  // namespace wavetank
