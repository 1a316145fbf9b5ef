#include "wavetank/sph/parted_solver.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "part_plan.h"
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

/// Points that the parts know by a number, each those that lie in it.
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
    told = false;
  }

  int number;
  PointValues wanted;
  std::vector<Eigen::Vector3d> places;
  mutable bool told = false;  ///< to the parts

 private:
  std::shared_ptr<std::vector<int>> dropped_;
};

class PartedSolver final : public Solver {
 public:
  /// Parts in this process, one a device.
  PartedSolver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout, const Discretisation& discretisation,
               const std::vector<Eigen::Vector3d>& centres, const PartedSolverOptions& options)
      : options_(options),
        threads_(std::make_unique<parallel::ThreadGroup>(static_cast<int>(devices.size()), options.takes_turns || need_turns(devices))),
        team_(*threads_),
        discretisation_(discretisation),
        is_open_(!layout.openings.empty()),
        parting_(parting_for(scene, layout, discretisation, devices[0].info(), options)) {
    for (int rank = 0; rank < team_.size(); ++rank) {
      add_part(rank, devices[rank], scene, layout, discretisation, centres);
      threads_->at_end_of_turn(rank, [device = devices[rank]] { device.finish(); });
      devices[rank].finish();  // before another's kernels are loaded
    }
    check_devices();
    begin(layout);
  }

  /// One in each process.
  PartedSolver(parallel::Team& team, const compute::Device& device, const std::string& scene_text, const Case& scene, const Layout& layout,
               const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres)
      : team_(team),
        discretisation_(discretisation),
        is_open_(!layout.openings.empty()),
        parting_(parting_for(scene, layout, discretisation, device.info(), options_)) {
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
    begin(layout);
  }

  PackingReport pack(int iterations, const std::function<void(double)>& progress) override {
    prepare(Packed().value(PartOrder::pack).value(iterations), progress);
    return parts_[0]->packing();
  }
  StepReport start() override {
    prepare(Packed().value(PartOrder::start), {});
    return parts_[0]->report();
  }
  StepReport settle(double periods, const std::function<void(double)>& progress) override {
    prepare(Packed().value(PartOrder::settle).value(periods), progress);
    return parts_[0]->report();
  }

  StepReport advance(WallMover* mover) override {
    if (is_time_to_cut()) cut();
    for (const Bytes& order : std::exchange(coming_, {})) ask(order);
    parts_[0]->lead(mover);
    const std::vector<int> coupled = mover != nullptr ? mover->coupled() : std::vector<int>();
    const auto begin = std::chrono::steady_clock::now();
    const Exchanged before = parts_[0]->exchanged();  // with that of readings
    ask(Packed().value(PartOrder::advance).value<char>(mover != nullptr ? 1 : 0).values(coupled));
    seconds_of_steps_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const Exchanged& after = parts_[0]->exchanged();
    exchanged_in_steps_.seconds += after.seconds - before.seconds;
    exchanged_in_steps_.messages += after.messages - before.messages;
    exchanged_in_steps_.bytes += after.bytes - before.bytes;
    if (parts_[0]->motions()) motions_ = parts_[0]->motions();
    ++steps_since_cut_;
    note_load();
    return parts_[0]->report();
  }

  void set_wall_motions(const WallMotions& motions) override {
    motions_ = motions;
    tell_motions();
  }
  void set_film(const std::vector<FilmLump>& lumps) override {
    std::vector<double> numbers;
    for (const FilmLump& lump : lumps)
      numbers.insert(numbers.end(), {lump.place.x(), lump.place.y(), lump.place.z(), lump.volume, lump.pressure, lump.closed});
    if (numbers == film_) return;
    film_ = numbers;
    ask(Packed().value(PartOrder::film).values(numbers));
  }
  void limit_time_step(double limit) override { ask(Packed().value(PartOrder::limit).value(limit)); }
  double shorten_step(double longest) override {
    ask(Packed().value(PartOrder::shorten).value(longest));
    return parts_[0]->time_step();
  }
  std::size_t particle_count() const override { return parts_[0]->particles(); }
  PartsState parts() const override {
    PartsState state;
    state.count = team_.size();
    state.cuts = cuts_;
    if (steps_since_cut_ == 0) return state;
    state.imbalance = parts_[0]->imbalance();
    if (seconds_of_steps_ > 0) state.exchange_share = exchanged_in_steps_.seconds / seconds_of_steps_;
    state.messages = static_cast<double>(exchanged_in_steps_.messages) / steps_since_cut_;
    state.bytes = static_cast<double>(exchanged_in_steps_.bytes) / steps_since_cut_;
    return state;
  }
  void let_in(const NewParticles& particles) override {
    check_new_particles(particles);
    if (!std::exchange(is_told_to_be_open_, true)) ask(PartOrder::open);
    coming_.push_back(let_in_order(particles));
  }
  void set_drains(const std::vector<Drain>& drains) override { ask(drains_order(drains)); }
  void set_zones(const std::vector<ImposedZone>& zones) override { ask(zones_order(zones)); }
  std::optional<ThinWall> thinnest_wall() const override { return parts_[0]->thinnest_wall(); }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points, PointValues wanted) const override {
    return std::make_unique<PointsOfAll>(next_points_++, points, wanted, dropped_points_);
  }
  std::vector<PointValue> evaluate(const PointSet& set) override {
    const auto& points = dynamic_cast<const PointsOfAll&>(set);
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
    ask(PartOrder::wrenches);
    return parts_[0]->wrenches();
  }
  FluidEnergies energies() override {
    ask(PartOrder::energies);
    return parts_[0]->energies();
  }
  LostVolume lost_volume() override {
    Crowding all;
    for (const Bytes& reply : ask(PartOrder::crowding)) all.add(crowding_of(reply));
    return all.volume(discretisation_);
  }
  FluidState download() override {
    std::vector<FluidState> parts;
    for (const Bytes& reply : ask(PartOrder::download)) parts.push_back(fluid_state(reply));
    return joined(parts);
  }
  FluidSurface find_surface() override {
    std::vector<FluidSurface> parts;
    std::vector<std::vector<std::uint32_t>> ids;
    for (const Bytes& reply : ask(PartOrder::surface)) parts.push_back(fluid_surface(reply, ids.emplace_back()));
    return joined(parts, ids);
  }
  PairCount count_pairs() override {
    PairCount all;
    for (const Bytes& reply : ask(PartOrder::pairs)) {
      const auto own = Unpacked(reply).value<PairCount>();
      all.pairs += own.pairs;
      all.candidates += own.candidates;
    }
    return all;
  }
  std::vector<char> save() const override { return parts_[0]->joined(ask(PartOrder::save)); }
  void restore(const std::vector<char>& bytes) override {
    parts_[0]->check_state(bytes);
    const std::vector<int> cuts = cuts_for_or_present(bytes);
    motions_.reset();  // they are of another time, and told anew by whom that concerns
    coming_.clear();
    cut(bytes, cuts);
  }
  std::size_t device_memory() const override {
    std::size_t bytes = 0;
    for (const Bytes& reply : ask(PartOrder::memory)) bytes += Unpacked(reply).value<std::size_t>();
    return bytes;
  }

 private:
  void add_part(int rank, const compute::Device& device, const Case& scene, const Layout& layout, const Discretisation& discretisation,
                const std::vector<Eigen::Vector3d>& centres) {
    Parting parting = parting_;
    parting.group = &team_.member(rank);
    parts_.push_back(make_part_server(device, parting, scene, layout, discretisation, centres));
  }

  /// The parts are given the water as it is laid out.
  void begin(const Layout& layout) {
    const Bytes state = parts_[0]->laid_out_state(layout);
    cut(state, cuts_for(state));
  }

  std::vector<Bytes> ask(const Bytes& order) const {
    return team_.ask(order, [this](int rank, const Bytes& given) { return parts_.at(rank)->obey(given); });
  }
  std::vector<Bytes> ask(Packed& order) const { return ask(order.take()); }
  std::vector<Bytes> ask(PartOrder order) const { return ask(Packed().value(order)); }

  /// What comes before the first step.
  void prepare(Packed& order, const std::function<void(double)>& progress) {
    if (!coming_.empty()) throw Error("a case was to be started, settled or packed when particles had come in already");
    const struct Teller {
      Teller(PartServer& part, const std::function<void(double)>& progress) : first(part) { first.tell(progress); }
      ~Teller() { first.tell({}); }
      PartServer& first;
    } teller(*parts_[0], progress);
    ask(order);
    count_steps_anew();
  }

  /// The parts know them from the steps that they make; what is restored has them told.
  void tell_motions() {
    if (!motions_) return;
    Packed order;
    add_motions(order.value(PartOrder::walls), *motions_);
    ask(order);
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
  std::vector<int> cuts_for(const Bytes& state) const {
    return wavetank::cuts_for(parts_[0]->particles_in_blocks(state), parting_, team_.size(), is_open_, options_);
  }
  /// Where it has drawn together: the cuts that there are do still.
  std::vector<int> cuts_for_or_present(const Bytes& state) const {
    try {
      return cuts_for(state);
    } catch (const Error&) {
      return present_cuts_;
    }
  }

  /// The water as it is, anew, unless that is no other cut.
  void cut() {
    const Bytes state = save();
    const std::vector<int> cuts = cuts_for_or_present(state);
    lost_steps_ = 0;
    load_when_cut_ = parts_[0]->imbalance();  // that is as even as it gets
    if (cuts != present_cuts_ || options_.cut_every > 0) cut(state, cuts);
  }
  void cut(const Bytes& state, const std::vector<int>& cuts) {
    ask(Packed().value(PartOrder::cut).values(cuts).values(state));
    tell_motions();
    present_cuts_ = cuts;
    ++cuts_;
    count_steps_anew();
    lost_steps_ = 0;
  }

  void count_steps_anew() {
    steps_since_cut_ = 0;
    seconds_of_steps_ = 0;
    exchanged_in_steps_ = Exchanged();
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
  Discretisation discretisation_;
  bool is_open_;  ///< water may come in
  Parting parting_;
  std::vector<std::unique_ptr<PartServer>> parts_;  ///< those in this process, from the first on
  std::vector<Bytes> coming_;                       ///< orders to let particles in
  bool is_told_to_be_open_ = false;                 ///< the parts
  std::vector<double> film_;                        ///< that the parts know of
  mutable int next_points_ = 0;
  std::shared_ptr<std::vector<int>> dropped_points_ = std::make_shared<std::vector<int>>();  ///< that parts may still have
  std::optional<WallMotions> motions_;                                                       ///< of walls that have moved, now
  int steps_since_cut_ = 0;
  double seconds_of_steps_ = 0;   ///< likewise
  Exchanged exchanged_in_steps_;  ///< likewise
  std::uint64_t cuts_ = 0;
  std::vector<int> present_cuts_;
  double lost_steps_ = 0, load_when_cut_ = 1;
};

}  // namespace

std::unique_ptr<Solver> make_parted_solver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout,
                                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres,
                                           const PartedSolverOptions& options) {
  for (const compute::Device& device : devices) check_precision(scene, device);
  return std::make_unique<PartedSolver>(devices, scene, layout, discretisation, centres, options);
}

std::unique_ptr<Solver> make_parted_solver(parallel::Team& team, const compute::Device& device, const std::string& scene_text,
                                           const Case& scene, const Layout& layout, const Discretisation& discretisation,
                                           const std::vector<Eigen::Vector3d>& centres) {
  check_precision(scene, device);
  return std::make_unique<PartedSolver>(team, device, scene_text, scene, layout, discretisation, centres);
}

}  // namespace wavetank
