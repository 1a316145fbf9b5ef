#include "wavetank/sph/parted_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sph_solver.h"
#include "wavetank/common/error.h"
#include "wavetank/parallel/slabs.h"

namespace wavetank {
namespace {

/// What parts cannot do yet, as the key of the case that asks for it; "" if there is nothing.
std::string refused(const Case& scene, const Layout& layout) {
  const NumericsCase& numerics = scene.numerics;
  if (scene.tank.motion != Motion::fixed) return "the tank moves";
  for (const BodyCase& body : scene.bodies)
    if (body.motion != Motion::fixed) return "body '" + body.name + "' moves";
  if (!layout.openings.empty()) return "the case has openings";
  for (int axis = 0; axis < 3; ++axis)
    if (scene.tank.periodic[axis]) return "the tank is periodic";
  if (numerics.walls.method == WallMethod::ghost) return "numerics/walls/method is ghost";
  if (kind_of(numerics.walls) != WallKind::facets) return "numerics/walls/elements is not facet";
  if (numerics.gradients != Gradients::sph) return "numerics/gradients is " + word_of(numerics.gradients);
  if (numerics.scheme == Scheme::riemann_ale) return "numerics/scheme is " + word_of(numerics.scheme);
  return "";
}

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

/// Kernel supports of a block: fewer in small tanks, so that they have some of them; more where that costs fewer tiles that are not full.
int supports_of_block(const Discretisation& d, int axis) { return std::clamp(d.cells[axis] / 16, 2, 8); }

template <class Real>
class PartedSolver final : public Solver {
 public:
  PartedSolver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout, const Discretisation& discretisation,
               const std::vector<Eigen::Vector3d>& centres, const PartedSolverOptions& options)
      : options_(options),
        group_(static_cast<int>(devices.size()), options.takes_turns),
        whole_(rows_for(scene), devices[0], scene, layout, discretisation, centres),
        parting_(parting_for(discretisation, layout.particles.size())) {
    Layout dry = layout;
    dry.particles.clear();
    dry.volumes.clear();
    dry.levels.clear();
    for (int rank = 0; rank < group_.size(); ++rank) {
      SolverRows rows = rows_for(scene);
      rows.fields.insert(rows.fields.end(), part_fields().begin(), part_fields().end());
      rows.parameters.insert(rows.parameters.end(), part_parameters().begin(), part_parameters().end());
      rows.parting = parting_;
      rows.parting->group = &group_.member(rank);
      parts_.push_back(std::make_unique<SphSolver<Real>>(rows, devices[rank], scene, dry, discretisation, centres));
    }
    check_room();
  }

  PackingReport pack(int iterations, const std::function<void(double)>& progress) override { return changed().pack(iterations, progress); }
  StepReport start() override { return changed().start(); }
  StepReport settle(double periods, const std::function<void(double)>& progress) override { return changed().settle(periods, progress); }

  StepReport advance(WallMover* mover) override {
    if (mover != nullptr) refuse("something moves");
    if (stale_parts_ || is_time_to_cut()) cut();
    std::vector<StepReport> reports(parts_.size());
    stale_whole_ = true;
    group_.run([&](int rank) { reports[rank] = parts_[rank]->advance(nullptr); });
    ++steps_since_cut_;
    note_load();
    for (const StepReport& report : reports)
      if (!report.valid()) return report;
    return reports[0];
  }

  void set_wall_motions(const WallMotions&) override { refuse("something moves"); }
  void set_film(const std::vector<FilmLump>& lumps) override {
    whole_.set_film(lumps);
    for (const auto& part : parts_) part->set_film(lumps);
  }
  void limit_time_step(double limit) override {
    whole_.limit_time_step(limit);
    for (const auto& part : parts_) part->limit_time_step(limit);
  }
  double shorten_step(double longest) override {
    if (stale_parts_) return whole_.shorten_step(longest);
    double step = 0;
    for (const auto& part : parts_) step = part->shorten_step(longest);
    return step;
  }
  std::size_t particle_count() const override { return whole_.particle_count(); }
  void let_in(const NewParticles& particles) override {
    if (!particles.position.empty()) refuse("particles come in");
  }
  void set_drains(const std::vector<Drain>& drains) override {
    if (!drains.empty()) refuse("the case has drains");
  }
  void set_zones(const std::vector<ImposedZone>& zones) override {
    if (!zones.empty()) refuse("the case has openings");
  }
  std::optional<ThinWall> thinnest_wall() const override { return whole_.thinnest_wall(); }
  std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points, PointValues wanted) const override {
    return whole_.make_points(points, wanted);
  }
  std::vector<PointValue> evaluate(const PointSet& points) override { return whole().evaluate(points); }
  std::vector<WallWrench> wrenches() override { return whole().wrenches(); }
  FluidEnergies energies() override { return whole().energies(); }
  LostVolume lost_volume() override { return whole().lost_volume(); }
  FluidState download() override { return whole().download(); }
  FluidSurface find_surface() override { return whole().find_surface(); }
  PairCount count_pairs() override { return whole().count_pairs(); }
  std::vector<char> save() const override { return whole().save(); }
  void restore(const std::vector<char>& bytes) override {
    whole_.restore(bytes);
    stale_whole_ = false;
    stale_parts_ = true;
  }
  std::size_t device_memory() const override {
    std::size_t bytes = whole_.device_memory();  // with that of parts on the same device
    for (const auto& part : parts_)
      if (part != parts_.front()) bytes += part->device_memory();
    return bytes;
  }

 private:
  [[noreturn]] static void refuse(const std::string& why) {
    throw Error(why + ", which several devices cannot do together yet: choose one device.");
  }

  Parting parting_for(const Discretisation& d, std::size_t particles) const {
    Parting parting;
    parting.axis = axis_of_parts(d);
    const GridShape& grid = whole_.grid();
    const double place = parting.axis == 0 ? grid.slot_length : grid.row_side;
    const int places_a_support = static_cast<int>(std::lround(d.support / place));
    // a particle's drift, and that of those it looks for
    const double reach = d.support + 2 * whole_.greatest_drift();
    parting.halo = static_cast<int>(std::floor(reach * (1 + 1e-4) / place)) + 1 - options_.halo_less;
    const int supports = supports_of_block(d, parting.axis);
    parting.block = supports * places_a_support;
    parting.segment = supports_of_block(d, 0) * static_cast<int>(std::lround(d.support / grid.slot_length));
    parting.places = (parting.axis == 0 ? grid.slots_x : parting.axis == 1 ? grid.rows_y : grid.rows_z) - 2;
    parting.particles = particles;
    parting.spoils = options_.spoils;
    return parting;
  }

  /// Of blocks, the least that a part may have: halos are of the parts beside it.
  int least_blocks() const { return (parting_.halo + options_.halo_less + parting_.block - 1) / parting_.block; }

  /// Throws if the water is too short for so many parts.
  void check_room() { cuts_for(whole_.particles_in_blocks(parting_)); }

  std::vector<int> cuts_for(const std::vector<std::int64_t>& weights) const {
    std::vector<int> cuts = parallel::cut_into_slabs(weights, group_.size(), least_blocks());
    if (options_.uneven != 0 && cuts.size() > 2) cuts[1] = std::clamp(cuts[1] + options_.uneven, least_blocks(), cuts[2] - least_blocks());
    return cuts;
  }

  /// All the water, as the parts have it by now.
  SphSolver<Real>& whole() const {
    if (!stale_whole_) return whole_;
    std::vector<std::vector<char>> saved(parts_.size());
    group_.run([&](int rank) { saved[rank] = parts_[rank]->save(); });
    whole_.restore(whole_.joined(saved));
    stale_whole_ = false;
    return whole_;
  }
  /// It is about to change.
  SphSolver<Real>& changed() {
    SphSolver<Real>& all = whole();
    stale_parts_ = true;
    return all;
  }

  void cut() {
    SphSolver<Real>& all = whole();
    const std::vector<int> cuts = cuts_for(all.particles_in_blocks(parting_));
    const std::vector<char> bytes = all.save();
    group_.run([&](int rank) {
      parts_[rank]->set_cuts(cuts);
      parts_[rank]->restore(bytes);
    });
    stale_parts_ = false;
    steps_since_cut_ = 0;
    lost_steps_ = 0;
  }

  /// By how much the step was longer than one of even parts, in steps.
  void note_load() {
    std::int64_t most = 0, all = 0;
    for (const auto& part : parts_) {
      most = std::max(most, part->own_count());
      all += part->own_count();
    }
    const double load = all == 0 ? 1.0 : static_cast<double>(most) * static_cast<double>(parts_.size()) / static_cast<double>(all);
    if (steps_since_cut_ == 1) load_when_cut_ = load;
    lost_steps_ += std::max(load - load_when_cut_, 0.0);
  }
  bool is_time_to_cut() const {
    constexpr double cost_of_cutting = 8;  // steps, on a CPU
    return options_.cut_every > 0 ? steps_since_cut_ >= options_.cut_every : lost_steps_ > cost_of_cutting;
  }

  PartedSolverOptions options_;
  mutable parallel::ThreadGroup group_;
  mutable SphSolver<Real> whole_;
  Parting parting_;
  std::vector<std::unique_ptr<SphSolver<Real>>> parts_;
  mutable bool stale_whole_ = false;
  bool stale_parts_ = true;
  int steps_since_cut_ = 0;
  double lost_steps_ = 0, load_when_cut_ = 1;
};

}  // namespace

std::unique_ptr<Solver> make_parted_solver(const std::vector<compute::Device>& devices, const Case& scene, const Layout& layout,
                                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres,
                                           const PartedSolverOptions& options) {
  const std::string why = refused(scene, layout);
  if (!why.empty())
    throw Error("device names " + std::to_string(devices.size()) + " devices, but " + why +
                ", which several devices cannot do together yet: choose one device.");
  if (scene.numerics.precision == Precision::single)
    return std::make_unique<PartedSolver<float>>(devices, scene, layout, discretisation, centres, options);
  for (const compute::Device& device : devices)
    if (!device.info().has_double)
      throw Error("numerics/precision is double, but the device " + device.info().describe() +
                  " has no double precision: choose single or another device.");
  return std::make_unique<PartedSolver<double>>(devices, scene, layout, discretisation, centres, options);
}

}  // namespace wavetank
