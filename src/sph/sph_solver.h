#pragma once

#include <limits>

#include "case_walls.h"
#include "guard_impulses.h"
#include "kernel_parameters.h"
#include "moving_walls.h"
#include "solver_kernels.h"
#include "surroundings.h"
#include "tank_images.h"
#include "wall_wrenches.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// One stage of a time step; a scheme is a list of them, so that it can be read on one page.
struct Stage {
  const char* name;
  std::function<void()> run;
};

/// Its members are in sph_solver.cpp (steps), sph_solver_start.cpp (what comes before them), sph_solver_readings.cpp and
/// sph_solver_snapshot.cpp.
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
  void set_film(const std::vector<FilmLump>& lumps) override;
  void limit_time_step(double limit) override { time_step_limit_ = limit; }
  double shorten_step(double longest) override;
  std::size_t particle_count() const override { return static_cast<std::size_t>(count_); }
  std::optional<ThinWall> thinnest_wall() const override { return case_walls_.thin().thinnest; }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points) const override;
  std::vector<PointValue> evaluate(const PointSet& points) override;
  std::vector<WallWrench> wrenches() override;
  FluidEnergies energies() override;
  LostVolume lost_volume() override;
  FluidState download() override;
  PairCount count_pairs() override;
  std::vector<char> save() const override;
  void restore(const std::vector<char>& bytes) override;
  std::size_t device_memory() const override { return device_.allocated(); }

 private:
  using Buffer = compute::Buffer<Real>;
  struct DevicePoints;

  WallMotions motions_at_start() const;
  std::vector<WallElement> facing_pieces() const;
  void upload_parameters(const KernelParameters<Real>& values);
  void upload_particles(const Layout& layout);
  void build_kernels();
  /// Queues a kernel that goes over the neighbours of `count` particles, points or walls; `others` are its own arguments. The guard writes
  /// the state.
  template <class... Others>
  void sweep(const SweepKernel& kernel, int count, const Buffer& state, const WallArrays<Real>& walls, const Others&... others) {
    surroundings_.sweep(kernel, count, state, walls, others...);
  }

  /// Gravity's part along which the water is at rest at the start.
  Eigen::Vector3d gravity_at_rest() const { return case_.gravity.dot(up_) * up_; }
  void set_hydrostatic();
  /// Zero velocities, and all that follows from the positions and compressions.
  StepReport start_at_rest();
  WallArrays<Real> make_supported_walls() const;

  std::vector<Stage> symplectic();
  void sort();
  /// For what a particle may move in half a step.
  void widen_reach();
  void place_walls(const WallMotions& motions);
  void place_barriers();
  void load_walls(const Buffer& state);
  void find_accelerations(const Buffer& state);
  void find_compression_rates();
  void guard();
  std::vector<WallWrench> wrenches_at(const Buffer& state, const std::vector<int>& owners);
  /// On the coupled owners in the middle of the step, with what the guard took at the end of the last one.
  std::vector<WallWrench> wrenches_in_step();
  StepReport watch();
  void describe_offender(StepReport& report, int first) const;

  compute::Device device_;
  Case case_;
  Discretisation discretisation_;
  int count_ = 0;
  int stride_ = 0;
  int chunks_ = 0;
  std::string options_;
  compute::SourceFiles sources_;
  KernelParameters<Real> values_;
  std::vector<Eigen::Vector3d> centres_;  ///< of the walls' owners, as the layout has them
  std::vector<Box> boxes_;                ///< about the walls of each owner, likewise
  std::vector<bool> moving_;              ///< owners
  bool moving_frame_ = false;
  bool ghosts_ = false;
  bool elements_ = false;  ///< the walls are elements, with a pressure of their own
  CaseWalls case_walls_;
  Tiling tiling_;
  GridShape grid_shape_;
  WallMover* mover_ = nullptr;  ///< during a step
  double time_step_limit_ = std::numeric_limits<double>::infinity();
  double step_ = 0;             ///< the next step, or the one in progress, s
  double greatest_speed_ = 0;   ///< of a particle at the end of the last step, m/s
  bool load_lost_ = false;      ///< in this step, to values that are not finite
  double fastest_wall_ = 0;     ///< of any point of a body, m/s
  Eigen::Vector3d up_;          ///< along which the start is hydrostatic
  std::vector<double> levels_;  ///< by particle id, for that: heights along `up_`
  Buffer state_, rates_, gradient_;
  Buffer half_;  ///< the middle of the step; then what the state is sorted into
  compute::Buffer<std::uint32_t> id_, spare_id_;
  std::vector<TankImage> images_;
  Surroundings<Real> surroundings_;
  WallArrays<Real> walls_;
  std::optional<MovingWalls<Real>> moving_walls_;  ///< where there are any
  std::vector<WallPose> poses_;
  Buffer loads_;
  WallWrenches<Real> wrenches_;
  GuardImpulses<Real> guarded_;
  Buffer report_, watches_, energy_parts_, energy_total_, fillings_;
  compute::Buffer<int> alarms_;
  SolverKernels kernels_;
  std::vector<Stage> stages_;
};

}  // namespace wavetank
