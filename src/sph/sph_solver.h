#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "bound_kernels.h"
#include "build_options.h"
#include "case_walls.h"
#include "crowding.h"
#include "damping_zones.h"
#include "drains.h"
#include "exact_sums.h"
#include "guard_impulses.h"
#include "integrators/integrator.h"
#include "moving_walls.h"
#include "row_sums.h"
#include "surroundings.h"
#include "tables/device_sizes.h"
#include "tables/rows.h"
#include "tank_images.h"
#include "wall_wrenches.h"
#include "water_part.h"
#include "wavetank/sph/solver.h"
#include "zones.h"

namespace wavetank {

/// Throws Error as Solver::let_in does.
void check_new_particles(const NewParticles& particles);

/// Its members are in sph_solver.cpp (steps), sph_solver_start.cpp (what comes before them), sph_solver_population.cpp (how many particles
/// there are), sph_solver_parts.cpp (one part of the water among others), sph_solver_readings.cpp and sph_solver_snapshot.cpp.
template <class Real>
class SphSolver final : public Solver, private StepEngine {
 public:
  SphSolver(const SolverRows& rows, const compute::Device& device, const Case& scene, const Layout& layout,
            const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres);

  PackingReport pack(int iterations, const std::function<void(double)>& progress) override;
  StepReport start() override;
  StepReport settle(double periods, const std::function<void(double)>& progress) override;
  StepReport advance(WallMover* mover) override;
  void set_wall_motions(const WallMotions& motions) override;
  void set_film(const std::vector<FilmLump>& lumps) override;
  void limit_time_step(double limit) override { time_step_limit_ = limit; }
  double shorten_step(double longest) override;
  std::size_t particle_count() const override { return static_cast<std::size_t>(count_); }
  void let_in(const NewParticles& particles) override;
  void set_drains(const std::vector<Drain>& drains) override;
  void set_zones(const std::vector<ImposedZone>& zones) override;
  /// Of ghosts none: their tanks are convex, and what stands between two pockets hides nothing.
  std::optional<ThinWall> thinnest_wall() const override { return ghosts_ ? std::nullopt : case_walls_.thin().thinnest; }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points, PointValues wanted) const override;
  std::vector<PointValue> evaluate(const PointSet& points) override;
  std::vector<WallWrench> wrenches() override;
  FluidEnergies energies() override;
  LostVolume lost_volume() override { return crowding().volume(discretisation_); }
  FluidState download() override;
  FluidSurface find_surface() override;
  PairCount count_pairs() override;
  Crowding crowding();
  std::vector<char> save() const override;
  void restore(const std::vector<char>& bytes) override;
  std::size_t device_memory() const override { return device_.allocated(); }

  // of a part of the water, whose solver knows its Parting: what it reads is of its own particles
  /// As save() has it, of all the water as it is laid out.
  std::vector<char> laid_out_state(const Layout& layout) const;
  /// Throws Error as restore() does.
  void check_state(const std::vector<char>& bytes) const { read_state(bytes); }
  /// Of a state, its particles by the blocks that Parting has; and by its places, the first of which is 1.
  std::vector<std::int64_t> particles_in_blocks(const std::vector<char>& bytes) const;
  std::vector<std::int64_t> particles_in_places(const std::vector<char>& bytes) const;
  /// Bytes on the device of the part between these cuts, of this state of all the water, as they are after a step. Such a part is good for
  /// nothing else.
  std::size_t memory_for(const std::vector<int>& cuts, const std::vector<char>& state);
  /// In the order of download().
  std::vector<std::uint32_t> own_ids() const;
  /// The next restore() takes of a state of all the water what lies between these cuts, and the halo.
  void set_cuts(const std::vector<int>& cuts);
  /// What the parts have saved of their own particles, as one would save it that had them all.
  std::vector<char> joined(const std::vector<std::vector<char>>& parts) const;
  /// Of all the water, wherever it is cut.
  std::size_t particles_of_all() const { return static_cast<std::size_t>(part_->all); }
  const Exchanged& exchanged() const { return part_->exchanged(); }
  double time_step() const { return step_; }
  /// Particles may come and go: snapshots of any number of them are taken.
  void open() { open_ = true; }
  /// Particles of the part that has the most, over those of the mean; after a step the same on all parts.
  double imbalance() const;
  /// Which of these points lie where the part has its own particles: every point does in one part.
  std::vector<int> own_points(const std::vector<Eigen::Vector3d>& points) const;
  /// Of what kernels are made of and are told: other solvers of the same case have the same, whatever their part.
  std::uint64_t digest() const;

 private:
  using Buffer = compute::Buffer<Real>;
  struct DevicePoints;

  WallMotions motions_at_start() const;
  std::vector<WallElement> facing_pieces() const;
  void upload_parameters(const ParameterBlock& values);
  std::size_t index_of(const char* component, int particle, ParticleArray array = ParticleArray::state) const {
    return static_cast<std::size_t>(fields_.at(array, component)) * stride_ + particle;
  }
  Buffer make_array(ParticleArray array) const { return Buffer(device_, static_cast<std::size_t>(fields_.count(array)) * stride_); }
  /// Of a downloaded array, a component.
  const Real* component(const std::vector<Real>& values, const char* name) const { return &values[index_of(name, 0)]; }
  Real* component(std::vector<Real>& values, const char* name) const { return &values[index_of(name, 0)]; }
  /// Of particle i of a state on the host, m and m/s; its components may be another stride apart than on the device.
  void set_place(std::vector<Real>& state, Stride stride, int i, const Eigen::Vector3d& place) const;
  Eigen::Vector3d place_of(const std::vector<Real>& state, int i) const;
  Eigen::Vector3d velocity_of(const std::vector<Real>& state, int i) const;
  void upload_particles(const Layout& layout);
  /// The place, mass and volume of particle i.
  void put_laid_out(std::vector<Real>& state, Stride stride, int i, const Layout& layout) const;
  void set_count(int count);
  /// Room for so many particles at least.
  void reserve(int count);
  /// Those that wait to come in take the next places; of a part those that are its own, but ids and masses are those of all.
  void add_waiting();
  void check_nobody_came() const;
  /// All stay in the water, wherever drains are.
  void sort_all();
  /// Without the other parts, which all have what they need.
  void sort_all_alone();
  /// Those of a downloaded state that are no part's halo, in their order.
  std::vector<int> own_particles(const std::vector<Real>& state) const;
  std::vector<int> order_by_id(const std::vector<std::uint32_t>& id) const;
  /// As Parting counts them, of coordinates along its axis.
  std::vector<int> places_in_parts(const std::vector<Real>& coordinates) const;
  /// Which of these the part has, as its own or in its halo.
  std::vector<int> in_part(const std::vector<Real>& coordinates) const;
  void sort_alone();
  enum class SavedArray { state, rates, gradients, surroundings };
  struct SavedComponent {
    std::string block;
    SavedArray array;
    std::size_t place;  ///< in the array
  };
  std::vector<SavedComponent> saved_components(bool gradients) const;
  /// A snapshot as it was read.
  struct ReadState {
    std::vector<std::uint32_t> id;
    std::int64_t next_id = 0;
    bool with_gradients = false;
    std::vector<SavedComponent> components;
    std::vector<std::vector<Real>> values;  ///< of each, by particle
    std::vector<double> step, listed, impulses;
  };
  ReadState read_state(const std::vector<char>& bytes) const;
  /// Leaves what is neither the part's own nor in its halo; returns how many are in that.
  int keep_own(ReadState& read) const;
  void upload_by_id(Buffer& array, int components, const std::vector<Real>& by_id);
  int gradient_count() const { return static_cast<int>(gradient_.size() / static_cast<std::size_t>(stride_)); }
  compute::Arguments arguments() const;
  compute::Arguments arguments_of(Slot state) const;
  /// With the present options.
  void bind_kernels();
  void bind_sweeps();
  void bind_time_step();
  void bind_shifts();
  void bind_zones();
  void bind_reductions();
  void bind_part();
  /// Every sweep goes over own particles alone.
  void over_own(const BoundSweep& sweep) const;
  /// A step of a part: as the schedule has it, with the exchanges that follow from it.
  void run_with_exchanges();
  void refresh(const char* name);
  void spoil(const char* name);
  void sort_part();
  double sum_of_parts(double own) const;
  /// Root mean square of h|E|, of all parts.
  double packing_error();
  StepReport watch_parts(const std::vector<Real>& values, const std::vector<int>& counted);
  void bind(const DevicePoints& points) const;

  /// Gravity's part along which the water is at rest at the start.
  Eigen::Vector3d gravity_at_rest() const { return case_.gravity.dot(up_) * up_; }
  void set_hydrostatic();
  /// Zero velocities, and all that follows from the positions and compressions.
  StepReport start_at_rest();
  /// With the velocities and pressures that the case gives, if any.
  StepReport start_as_given();
  /// What follows from the state.
  StepReport start_from_state();
  WallArrays<Real> make_supported_walls() const;

  void walls_at(double fraction) override;
  void find_accelerations(Slot state) override;
  void find_compression_rates(Slot state) override;
  void find_rates(Slot state) override;
  void add_wrenches(Slot state, double weight) override;
  void walls_to_end() override;
  void guard() override;
  void sort() override;
  void find_shifts() override;
  void impose_zones() override;
  void damp_velocities() override;
  void drift_to_middle() override;
  void kick_and_drift_to_end() override;
  void compress_to_end() override;
  void go_on_trial(Slot state, bool first, double weight, double part) override;
  void take_sum(double weight) override;
  void predict_end() override;
  void correct_end() override;
  bool shifts() const { return fields_.has(ParticleArray::state, "shift_x"); }
  const Buffer& buffer_of(Slot state) const { return state == Slot::now ? state_ : half_; }
  /// For what a particle may move in a part of the step, at `speed`, m/s.
  void widen_reach(double part, double speed);
  /// Of any particle in this step, as far as the last one tells, m/s; the watchdog ends a run at half the speed of sound.
  double speed_in_step() const {
    return std::max(greatest_speed_, std::min(greatest_speed_ + 2 * step_ * greatest_acceleration_, 0.5 * discretisation_.sound_speed));
  }
  void place_walls(const WallMotions& motions);
  void place_barriers();
  void load_walls(Slot state);
  void sweep_surface();
  void reserve_surroundings();
  void find_gradients(Slot state);
  void find_gradients(Slot state, bool with_surface);
  /// Without the other parts.
  void sweep_gradients(Slot state, bool with_surface);
  /// What shifts go by is found at the end of the step before.
  bool ends_with_surface() const { return joins_surface_ && holds_gradients_ && !begins_with_gradients_; }
  /// A snapshot has gradients, and what was found with them.
  bool saves_gradients() const { return gradients_are_held_ && !begins_with_gradients_; }
  /// They are of another state, or order, of the particles.
  void forget_gradients();
  /// Tiles that sweeps go over.
  int tiles() const { return part_ ? part_->tiles() : (count_ + tiling_.particles.own - 1) / tiling_.particles.own; }
  /// Room for the blocks of candidates of each, where gradients list them.
  void reserve_blocks();
  /// After what has found rates.
  void hold_zones(Slot state);
  StepReport watch();
  /// Those that have left in this step, which lie after all others; there are `before` with them.
  std::vector<LeftParticle> find_left(int before) const;
  /// Those of all parts, at the first; none at the others.
  std::vector<LeftParticle> gather_left();
  std::vector<LeftParticle> left_of(const typename WaterPart<Real>::Arrived& gone) const;
  void describe_offender(StepReport& report, int first) const;

  struct Kernels {
    std::map<Slot, compute::BoundKernel> hold_rates;
    std::map<Slot, BoundSweep> continuity, momentum, rates, gradients, loads;
    BoundSweep packing, surroundings, normals, cone, shifts, crowding, pairs, guard;
    compute::BoundKernel derive, predict, correct, compress, move_packed, go_on_trial, take_sum, predict_end, correct_end, impose,
        hold_shifts, damp, mark_surface;
    compute::BoundKernel watch_chunks, watch_groups, watch_total, energy_pieces, packing_chunks;
  };
  /// Of the state's vectors, where their first components are.
  struct FirstFields {
    Stride place = 0, rest = 0, velocity = 0;
  };
  /// What go_on_trial and its like are told.
  struct Trial {
    int first = 0;
    Real weight = 0, part = 0;
  };

  compute::Device device_;
  Case case_;
  Discretisation discretisation_;
  int count_ = 0;  ///< of particles; those that leave in a step are left out when it has been watched
  int given_ = 0;  ///< at the start
  std::size_t room_ = 0;
  std::int64_t next_id_ = 0;
  NewParticles waiting_;  ///< to come in
  Drains<Real> drains_;
  Zones<Real> zones_;
  DampingZones<Real> damping_;
  std::vector<double> masses_let_in_;  ///< kg, in the present step
  std::vector<LeftParticle> left_;     ///< likewise, of a part
  bool open_ = false;                  ///< particles may come or go
  Stride stride_ = 0;                  ///< at least that many particles have room
  int chunks_ = 0;
  int groups_ = 0;  ///< chunks of chunks
  BuildOptions options_;
  compute::SourceFiles sources_;
  FieldTable fields_;
  ReportTable reports_;
  FirstFields first_;
  std::optional<ParameterBlock> values_;
  std::vector<Eigen::Vector3d> centres_;  ///< of the walls' owners, as the layout has them
  std::vector<Box> boxes_;                ///< about the walls of each owner, likewise
  std::vector<bool> moving_;              ///< owners
  bool moving_frame_ = false;
  bool ghosts_ = false;
  bool elements_ = false;  ///< the walls are elements, with a pressure of their own
  bool accelerates_by_gradients_ = false;
  bool compresses_by_gradients_ = false;
  int listed_blocks_ = 0;       ///< of candidates of a tile, at the most
  bool joins_surface_ = false;  ///< what shifting laws go by is found with the gradients of a step's start
  /// Where volumes follow what moves the particles, a step must begin with rates by its own shifts, and with gradients after the last one's
  /// end.
  bool begins_with_gradients_ = false;
  bool gradients_are_of_now_ = false;  ///< and not of another state, or order, of the particles
  bool gradients_are_ahead_ = false;   ///< and the stage that needs them is still to come
  bool holds_gradients_ = false;       ///< the middle of a step goes by those of its start
  bool gradients_are_held_ = false;    ///< those are there
  bool surface_is_of_now_ = false;     ///< likewise, what was found with them
  int long_axes_ = 0;                  ///< along which a particle's place is known in two parts
  CaseWalls case_walls_;
  Tiling tiling_;
  GridShape grid_shape_;
  WallMover* mover_ = nullptr;  ///< during a step
  double time_step_limit_ = std::numeric_limits<double>::infinity();
  double step_ = 0;                        ///< the next step, or the one in progress, s
  double greatest_speed_ = 0;              ///< of a particle at the end of the last step, m/s
  double greatest_acceleration_ = 0;       ///< likewise, m/s²
  std::vector<WallWrench> step_wrenches_;  ///< on the coupled owners, as far as they were added up
  bool load_lost_ = false;                 ///< in this step, to values that are not finite
  double fastest_wall_ = 0;                ///< of any point of a body, m/s
  Eigen::Vector3d up_;                     ///< along which the start is hydrostatic
  std::vector<double> levels_;             ///< by particle id, for that: heights along `up_`
  std::vector<double> volumes_;            ///< likewise: what each was given of the water's volume, m³
  Buffer state_, rates_, gradient_;
  compute::Buffer<int> blocks_;         ///< of candidates, with a pair each, of the tiles for whose state gradients were found last
  compute::Buffer<int> surface_cells_;  ///< 1: a particle of the free surface is in it; of cells of the support's size
  Buffer half_;                         ///< the trial state of the step, its middle or end; then what the state is sorted into
  Buffer sum_;                          ///< of weighted rates, for integrators that have one
  compute::Buffer<std::uint32_t> id_, spare_id_;
  std::vector<TankImage> images_;
  Surroundings<Real> surroundings_;
  WallArrays<Real> walls_;
  std::optional<MovingWalls<Real>> moving_walls_;  ///< where there are any
  std::vector<WallPose> poses_;
  Buffer loads_;
  WallWrenches<Real> wrenches_;
  GuardImpulses<Real> guarded_;
  Buffer report_, watches_, fillings_;
  Buffer around_;         ///< of the free surface and what shifting laws go by; on the device only while it is needed
  Buffer packing_parts_;  ///< likewise
  Buffer group_watches_;
  compute::Buffer<int> alarms_, group_alarms_, pair_counts_;
  int energy_rows_, energy_pieces_, energy_segment_;  ///< of the grid; as which a row is summed; slots of a segment of one
  compute::Buffer<std::int64_t> energy_parts_;
  RowSums<std::int64_t> energy_sums_;
  std::vector<double> energy_quanta_;  ///< of each of these sums, a unit
  Buffer energy_quanta_on_device_;
  RowSums<Real> packing_sums_;
  Real longest_step_ = 0;  ///< bound on Δt from what moves besides the fluid, s
  Trial trial_;
  std::optional<KernelMaker> make_;
  int bindings_ = 0;                       ///< how often kernels were bound
  std::unique_ptr<WaterPart<Real>> part_;  ///< of a solver of a part of the water
  Kernels kernels_;
  Schedule schedule_;
};

}  // namespace wavetank
