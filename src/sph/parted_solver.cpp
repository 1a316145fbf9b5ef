#include "wavetank/sph/parted_solver.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "part_server.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/parallel/packed.h"
#include "wavetank/parallel/slabs.h"

namespace wavetank {
namespace {

using parallel::Bytes;
using parallel::Packed;
using parallel::Unpacked;

/// Across the longer level axis of the tank.
int axis_of_parts(const Discretisation& d) {
  int axis = -1;
  for (int k = 0; k < 3; ++k) {
    if (k == d.top.axis || (k == 1 && d.dimensions == 2)) continue;
    const double length = d.tank.max[k] - d.tank.min[k];
    if (axis < 0 || length > d.tank.max[axis] - d.tank.min[axis]) axis = k;
  }
  return axis;
}

/// pocl keeps 128 kernels of a process loaded; two threads that ask at once for one that it has let go load it twice, and it ends the
/// process when the second is done (an assertion in pocl_release_dlhandle_cache, up to version 5 at least).
bool need_turns(const std::vector<compute::Device>& devices) {
  const auto is_pocl = [](const compute::Device& device) { return device.info().platform_name == "Portable Computing Language"; };
  return std::count_if(devices.begin(), devices.end(), is_pocl) > 1;
}

/// Which parts have other last bits.
void tell_of_kinds(const parallel::Team& team, const std::vector<PartFacts>& parts) {
  for (std::size_t k = 1; k < parts.size(); ++k)
    if (parts[k].kind != parts[0].kind)
      log(LogLevel::warning, team.name_of(static_cast<int>(k)) + " is on " + parts[k].kind + ", the first on " + parts[0].kind +
                                 ": the last bits of the water depend on where it is cut.");
}

/// Which processes have fewer cores than their devices have threads.
void tell_of_cores(const parallel::Team& team, const std::vector<PartFacts>& parts) {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].cores >= parts[k].units || parts[k].cores == 0) continue;
    log(LogLevel::warning, team.name_of(static_cast<int>(k)) + " may use " + std::to_string(parts[k].cores) +
                               (parts[k].cores == 1 ? " core" : " cores") + ", but its device " + parts[k].device + " starts " +
                               std::to_string(parts[k].units) + " threads: mpirun --bind-to none gives it all cores.");
    break;  // once says it
  }
}

/// Points that the parts know by a number, each those that lie in it; and the solver of all the water, once it is asked.
class PointsOfAll final : public PointSet {
 public:
  /// `dropped`: to which its number is added when it is gone.
  PointsOfAll(int number_of_set, std::vector<Eigen::Vector3d> points, PointValues values, std::shared_ptr<std::vector<int>> dropped)
      : number(number_of_set), wanted(values), places(std::move(points)), dropped_(std::move(dropped)) {}
  ~PointsOfAll() override { dropped_->push_back(number); }
  PointsOfAll(const PointsOfAll&) = delete;
  PointsOfAll& operator=(const PointsOfAll&) = delete;

  void set(const std::vector<Eigen::Vector3d>& points) override {
    places = points;
    told = of_whole_is_new_ = false;
  }
  const PointSet& of(const Solver& whole) const {
    if (!of_whole_)
      of_whole_ = whole.make_points(places, wanted);
    else if (!of_whole_is_new_)
      of_whole_->set(places);
    of_whole_is_new_ = true;
    return *of_whole_;
  }

  int number;
  PointValues wanted;
  std::vector<Eigen::Vector3d> places;
  mutable bool told = false;  ///< to the parts

 private:
  mutable std::unique_ptr<PointSet> of_whole_;
  mutable bool of_whole_is_new_ = false;
  std::shared_ptr<std::vector<int>> dropped_;
};

template <class Real>
class PartedSolver final : public Solver {
 public:
  /// Parts in this process, one a device.
  PartedSolver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout, const Discretisation& discretisation,
               const std::vector<Eigen::Vector3d>& centres, const PartedSolverOptions& options)
      : options_(options),
        threads_(std::make_unique<parallel::ThreadGroup>(static_cast<int>(devices.size()), options.takes_turns || need_turns(devices))),
        team_(*threads_),
        whole_(rows_for(scene), devices[0], scene, layout, discretisation, centres),
        is_open_(!layout.openings.empty()),
        parting_(parting_for(scene, discretisation)) {
    for (int rank = 0; rank < team_.size(); ++rank) {
      add_part(rank, devices[rank], scene, layout, discretisation, centres);
      threads_->at_end_of_turn(rank, [device = devices[rank]] { device.finish(); });
      devices[rank].finish();  // before another's kernels are loaded
    }
    check_devices();
    check_room();
  }

  /// One in each process.
  PartedSolver(parallel::Team& team, const compute::Device& device, const std::string& scene_text, const Case& scene, const Layout& layout,
               const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres)
      : team_(team),
        whole_(rows_for(scene), device, scene, layout, discretisation, centres),
        is_open_(!layout.openings.empty()),
        parting_(parting_for(scene, discretisation)) {
    check_room();
    const std::vector<Bytes> replies = team_.ask(packed(FirstOrder{parting_, centres, scene_text}), [&](int rank, const Bytes&) {
      add_part(rank, device, scene, layout, discretisation, centres);
      return packed(parts_.back()->facts());
    });
    std::vector<PartFacts> facts;
    for (const Bytes& reply : replies) facts.push_back(part_facts(reply));
    for (int rank = 1; rank < team_.size(); ++rank)
      if (facts[rank].digest != facts[0].digest)
        throw Error(
            team_.name_of(rank) +
            " has made another tank of this case than the first: its program must be the same, and so must the meshes that the case "
            "names.");
    tell_of_kinds(team_, facts);
    tell_of_cores(team_, facts);
  }

  PackingReport pack(int iterations, const std::function<void(double)>& progress) override { return changed().pack(iterations, progress); }
  StepReport start() override {
    const StepReport report = changed().start();
    has_started_ = true;
    return report;
  }
  StepReport settle(double periods, const std::function<void(double)>& progress) override {
    const StepReport report = changed().settle(periods, progress);
    has_started_ = true;
    return report;
  }

  StepReport advance(WallMover* mover) override {
    if (stale_parts_ || is_time_to_cut()) cut();
    for (const Bytes& order : std::exchange(coming_, {})) ask(order);
    stale_whole_ = true;
    parts_[0]->lead(mover);
    const std::vector<int> coupled = mover != nullptr ? mover->coupled() : std::vector<int>();
    ask(Packed().value(PartOrder::advance).value<char>(mover != nullptr ? 1 : 0).values(coupled));
    if (parts_[0]->motions()) motions_ = parts_[0]->motions();
    ++steps_since_cut_;
    note_load();
    return parts_[0]->report();
  }

  void set_wall_motions(const WallMotions& motions) override {
    whole_.set_wall_motions(motions);
    motions_ = motions;
    tell_motions();
  }
  void set_film(const std::vector<FilmLump>& lumps) override {
    whole_.set_film(lumps);
    std::vector<double> numbers;
    for (const FilmLump& lump : lumps)
      numbers.insert(numbers.end(), {lump.place.x(), lump.place.y(), lump.place.z(), lump.volume, lump.pressure});
    if (numbers == film_) return;
    film_ = numbers;
    ask(Packed().value(PartOrder::film).values(numbers));
  }
  void limit_time_step(double limit) override {
    whole_.limit_time_step(limit);
    ask(Packed().value(PartOrder::limit).value(limit));
  }
  double shorten_step(double longest) override {
    if (!stale_whole_) whole_.shorten_step(longest);  // of which the water may be cut anew before that step
    if (stale_parts_) return whole_.time_step();
    ask(Packed().value(PartOrder::shorten).value(longest));
    return parts_[0]->time_step();
  }
  std::size_t particle_count() const override { return stale_whole_ ? parts_[0]->particles() : whole_.particle_count(); }
  PartsState parts() const override { return {team_.size(), steps_since_cut_ > 0 ? parts_[0]->imbalance() : 1.0, cuts_}; }
  void let_in(const NewParticles& particles) override {
    check_new_particles(particles);
    whole_.open();
    coming_.push_back(let_in_order(particles));
  }
  void set_drains(const std::vector<Drain>& drains) override {
    whole_.set_drains(drains);
    ask(drains_order(drains));
  }
  void set_zones(const std::vector<ImposedZone>& zones) override {
    whole_.set_zones(zones);
    ask(zones_order(zones));
  }
  std::optional<ThinWall> thinnest_wall() const override { return whole_.thinnest_wall(); }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points, PointValues wanted) const override {
    return std::make_unique<PointsOfAll>(next_points_++, points, wanted, dropped_points_);
  }
  std::vector<PointValue> evaluate(const PointSet& set) override {
    const auto& points = dynamic_cast<const PointsOfAll&>(set);
    if (!parts_have_it()) return whole_.evaluate(points.of(whole_));
    Packed order;
    order.value(PartOrder::evaluate).values(std::exchange(*dropped_points_, {})).value(points.number).value(!points.told);
    if (!std::exchange(points.told, true)) order.value(points.wanted).values(numbers_of(points.places));
    std::vector<PointValue> values(points.places.size());
    for (const Bytes& reply : ask(order)) {
      Unpacked from(reply);
      const auto own = from.values<int>();
      const auto numbers = from.values<double>();
      for (std::size_t k = 0; k < own.size(); ++k) {
        const double* const of_point = &numbers.at(6 * k);
        values.at(own[k]) = {of_point[0], of_point[1], of_point[2], Eigen::Vector3d(of_point + 3)};
      }
    }
    return values;
  }
  std::vector<WallWrench> wrenches() override {
    if (!parts_have_it()) return whole_.wrenches();
    ask(PartOrder::wrenches);
    return parts_[0]->wrenches();
  }
  FluidEnergies energies() override {
    if (!parts_have_it()) return whole_.energies();
    ask(PartOrder::energies);
    return parts_[0]->energies();
  }
  LostVolume lost_volume() override { return whole().lost_volume(); }
  FluidState download() override { return whole().download(); }
  FluidSurface find_surface() override { return whole().find_surface(); }
  PairCount count_pairs() override { return whole().count_pairs(); }
  std::vector<char> save() const override { return whole().save(); }
  void restore(const std::vector<char>& bytes) override {
    whole_.restore(bytes);
    stale_whole_ = false;
    stale_parts_ = true;
    has_started_ = true;
    coming_.clear();
  }
  std::size_t device_memory() const override {
    const std::vector<Bytes> replies = ask(PartOrder::memory);
    std::size_t bytes = whole_.device_memory();  // with that of the first part, on the same device
    for (std::size_t rank = 1; rank < replies.size(); ++rank) bytes += Unpacked(replies[rank]).value<std::size_t>();
    return bytes;
  }

 private:
  void add_part(int rank, const compute::Device& device, const Case& scene, const Layout& layout, const Discretisation& discretisation,
                const std::vector<Eigen::Vector3d>& centres) {
    Parting parting = parting_;
    parting.group = &team_.member(rank);
    parts_.push_back(make_part_server(device, parting, scene, layout, discretisation, centres));
  }

  std::vector<Bytes> ask(const Bytes& order) const {
    if (threads_) whole_.finish();  // whose device a part may have too
    return team_.ask(order, [this](int rank, const Bytes& given) { return parts_.at(rank)->obey(given); });
  }
  std::vector<Bytes> ask(Packed& order) const { return ask(order.take()); }
  std::vector<Bytes> ask(PartOrder order) const { return ask(Packed().value(order)); }

  Parting parting_for(const Case& scene, const Discretisation& d) {
    Parting parting;
    parting.axis = axis_of_parts(d);
    const GridShape& grid = whole_.grid();
    const double place = place_ = parting.axis == 0 ? grid.slot_length : grid.row_side;
    parting.segment = slots_of_segment(d, grid);
    parting.block = parting.axis == 0 ? parting.segment : 1;  // no tile has particles of two rows
    parting.places = (parting.axis == 0 ? grid.slots_x : parting.axis == 1 ? grid.rows_y : grid.rows_z) - 2;
    parting.periodic = scene.tank.periodic[parting.axis];
    // a particle's drift, and that of those it looks for; and places beyond the end of a periodic tank, where nobody is
    const double empty = parting.periodic ? parting.places * place - (d.tank.max[parting.axis] - d.tank.min[parting.axis]) : 0;
    const double reach = whole_.greatest_reach() + 2 * whole_.greatest_drift() + std::max(empty, 0.0);
    parting.halo = static_cast<int>(std::floor(reach * (1 + 1e-4) / place)) + 1 - options_.halo_less;
    parting.room = whole_.room();
    parting.spoils = options_.spoils;
    return parting;
  }

  /// The parts know them from the steps that they make; what is restored has them told.
  void tell_motions() {
    if (!motions_) return;
    Packed order;
    add_motions(order.value(PartOrder::walls), *motions_);
    ask(order);
  }

  /// Of blocks, the least that a part may have: halos are of the parts beside it, and none may be in that of the one beyond when it comes
  /// into it.
  int least_blocks() const {
    const int way = team_.size() > 2 ? static_cast<int>(std::ceil(2 * whole_.greatest_drift() / place_)) : 0;
    return (parting_.halo + options_.halo_less + way + parting_.block - 1) / parting_.block;
  }

  /// Of one kind, or at least with the same grid.
  void check_devices() const {
    std::vector<PartFacts> facts;
    for (const auto& part : parts_) facts.push_back(part->facts());
    for (const PartFacts& other : facts)
      if (other.digest != facts[0].digest)
        throw Error(other.kind + " makes another grid of this case than " + facts[0].kind + ": choose devices of one kind.");
    tell_of_kinds(team_, facts);
  }

  /// Throws if the water is too short for so many parts.
  void check_room() { cuts_for(whole_.particles_in_blocks(parting_)); }

  std::vector<int> cuts_for(std::vector<std::int64_t> weights) const {
    // where water comes in, there may be none yet: empty blocks count for something
    for (std::int64_t& weight : weights) weight = is_open_ ? 1000 * weight + 1 : weight;
    std::vector<int> cuts = parallel::cut_into_slabs(weights, team_.size(), least_blocks());
    if (options_.uneven != 0 && cuts.size() > 2) cuts[1] = std::clamp(cuts[1] + options_.uneven, least_blocks(), cuts[2] - least_blocks());
    return cuts;
  }

  /// All the water, as the parts have it by now.
  SphSolver<Real>& whole() const {
    if (!stale_whole_) return whole_;
    whole_.restore(whole_.joined(ask(PartOrder::save)));
    if (motions_) whole_.set_wall_motions(*motions_);
    stale_whole_ = false;
    return whole_;
  }
  /// It is about to change.
  SphSolver<Real>& changed() {
    if (!coming_.empty()) throw Error("a case was to be started, settled or packed when particles had come in already");
    SphSolver<Real>& all = whole();
    stale_parts_ = true;
    return all;
  }

  /// So that they read it, as they do between steps, or after a start or a restore: other sums in another order have other last bits.
  bool parts_have_it() {
    if (stale_parts_ && has_started_) cut();
    return !stale_parts_;
  }

  void cut() {
    SphSolver<Real>& all = whole();
    const std::vector<std::int64_t> weights = all.particles_in_blocks(parting_);
    std::vector<int> cuts;
    try {
      cuts = cuts_for(weights);
    } catch (const Error&) {  // the water has drawn together: those that there are do still
      if (stale_parts_) throw;
      lost_steps_ = 0;
      return;
    }
    ask(Packed().value(PartOrder::cut).values(cuts).values(all.save()));
    tell_motions();
    stale_parts_ = false;
    ++cuts_;
    steps_since_cut_ = 0;
    lost_steps_ = 0;
  }

  /// By how much the step was longer than one of even parts, in steps.
  void note_load() {
    const double load = parts_[0]->imbalance();
    if (steps_since_cut_ == 1) load_when_cut_ = load;
    lost_steps_ += std::max(load - load_when_cut_, 0.0);
  }
  bool is_time_to_cut() const {
    constexpr double cost_of_cutting = 8;  // steps, on a CPU
    return options_.cut_every > 0 ? steps_since_cut_ >= options_.cut_every : lost_steps_ > cost_of_cutting;
  }

  PartedSolverOptions options_;
  std::unique_ptr<parallel::ThreadGroup> threads_;  ///< of parts in this process
  parallel::Team& team_;
  mutable SphSolver<Real> whole_;
  bool is_open_;      ///< water may come in
  double place_ = 0;  ///< m, of a place along the axis of the parts
  Parting parting_;
  std::vector<std::unique_ptr<PartServer>> parts_;  ///< those in this process, from the first on
  std::vector<Bytes> coming_;                       ///< orders to let particles in
  std::vector<double> film_;                        ///< that the parts know of
  mutable int next_points_ = 0;
  std::shared_ptr<std::vector<int>> dropped_points_ = std::make_shared<std::vector<int>>();  ///< that parts may still have
  std::optional<WallMotions> motions_;                                                       ///< of walls that have moved, now
  mutable bool stale_whole_ = false;
  bool stale_parts_ = true;
  bool has_started_ = false;  ///< or was restored: before that there is nothing that parts could have
  int steps_since_cut_ = 0;
  std::uint64_t cuts_ = 0;
  double lost_steps_ = 0, load_when_cut_ = 1;
};

}  // namespace

std::unique_ptr<Solver> make_parted_solver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout,
                                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres,
                                           const PartedSolverOptions& options) {
  for (const compute::Device& device : devices) check_precision(scene, device);
  if (scene.numerics.precision == Precision::single)
    return std::make_unique<PartedSolver<float>>(devices, scene, layout, discretisation, centres, options);
  return std::make_unique<PartedSolver<double>>(devices, scene, layout, discretisation, centres, options);
}

std::unique_ptr<Solver> make_parted_solver(parallel::Team& team, const compute::Device& device, const std::string& scene_text,
                                           const Case& scene, const Layout& layout, const Discretisation& discretisation,
                                           const std::vector<Eigen::Vector3d>& centres) {
  check_precision(scene, device);
  if (scene.numerics.precision == Precision::single)
    return std::make_unique<PartedSolver<float>>(team, device, scene_text, scene, layout, discretisation, centres);
  return std::make_unique<PartedSolver<double>>(team, device, scene_text, scene, layout, discretisation, centres);
}

}  // namespace wavetank
