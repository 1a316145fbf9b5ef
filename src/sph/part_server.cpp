#include "part_server.h"

#include <sched.h>

#include <map>
#include <utility>

#include "sph_solver.h"
#include "wavetank/common/error.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {
namespace {

using parallel::Bytes;
using parallel::Packed;
using parallel::Unpacked;

/// Processors that this process may run on.
int cores_here() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

/// Of what each process has laid out for itself: walls, and what the particles are given at the start. Whatever lies in a third corner of
/// two dimensions is left out.
std::uint64_t digest_of_layout(const Layout& layout, int dimensions) {
  std::uint64_t digest = digest_of("walls");
  const auto add = [&digest](const void* bytes, std::size_t size) { digest = digest_of({static_cast<const char*>(bytes), size}, digest); };
  for (const Facet& facet : layout.facets) {
    for (int k = 0; k < dimensions; ++k) add(facet.corners[k].data(), sizeof(Eigen::Vector3d));
    add(facet.normal.data(), sizeof(Eigen::Vector3d));
    add(&facet.owner, sizeof facet.owner);
  }
  for (const std::vector<double>* values : {&layout.volumes, &layout.levels}) add(values->data(), values->size() * sizeof(double));
  return digest;
}

/// Bodies are with the first part, and walls of all parts go with them.
class TeamMover final : public WallMover {
 public:
  /// `mover`: of the first part; `coupled`: the same of all.
  TeamMover(parallel::Group& group, WallMover* mover, std::vector<int> coupled)
      : group_(group), mover_(mover), coupled_(std::move(coupled)) {}

  std::vector<int> coupled() const override { return coupled_; }
  WallMotions at(double time_step, double fraction) override {
    return group_.rank() == 0 ? told(mover_->at(time_step, fraction)) : heard();
  }
  WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) override {
    last_ = group_.rank() == 0 ? told(mover_->to_end(time_step, wrenches)) : heard();
    return *last_;
  }
  const std::optional<WallMotions>& last() const { return last_; }

 private:
  WallMotions told(const WallMotions& motions) {
    Packed message;
    add_motions(message, motions);
    const Bytes bytes = message.take();
    for (int rank = 1; rank < group_.size(); ++rank) group_.send(rank, bytes);
    return motions;
  }
  WallMotions heard() {
    const Bytes bytes = group_.receive(0);
    Unpacked from(bytes);
    return motions_from(from);
  }

  parallel::Group& group_;
  WallMover* mover_;
  std::vector<int> coupled_;
  std::optional<WallMotions> last_;
};

template <class Real>
class PartServerOf final : public PartServer {
 public:
  PartServerOf(const compute::Device& device, const SolverRows& rows, const Case& scene, const Layout& dry,
               const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres)
      : device_(device),
        group_(*rows.parting->group),
        layout_(digest_of_layout(dry, discretisation.dimensions)),
        solver_(rows, device, scene, dry, discretisation, centres) {}

  Bytes obey(const Bytes& order) override {
    Unpacked from(order);
    switch (from.value<PartOrder>()) {
      case PartOrder::advance:
        advance(from);
        return {};
      case PartOrder::pack:
        packing_ = solver_.pack(from.value<int>(), progress_);
        return {};
      case PartOrder::start:
        report_ = solver_.start();
        return {};
      case PartOrder::settle:
        report_ = solver_.settle(from.value<double>(), progress_);
        return {};
      case PartOrder::walls:
        solver_.set_wall_motions(motions_from(from));
        return {};
      case PartOrder::shorten:
        time_step_ = solver_.shorten_step(from.value<double>());
        return {};
      case PartOrder::limit:
        solver_.limit_time_step(from.value<double>());
        return {};
      case PartOrder::film:
        solver_.set_film(lumps_of(from.values<double>()));
        return {};
      case PartOrder::open:
        solver_.open();
        return {};
      case PartOrder::save:
        return solver_.save();
      case PartOrder::cut: {
        const auto cuts = from.values<int>();
        solver_.set_cuts(cuts);
        ++cuts_;
        solver_.restore(from.values<char>());
        return {};
      }
      case PartOrder::evaluate:
        for (const int number : from.values<int>()) points_.erase(number);
        return evaluate(points_from(from));
      case PartOrder::let_in:
        solver_.let_in(new_particles_from(from));
        return {};
      case PartOrder::drains:
        solver_.set_drains(drains_from(from));
        return {};
      case PartOrder::zones:
        solver_.set_zones(zones_from(from));
        return {};
      case PartOrder::wrenches:
        wrenches_ = solver_.wrenches();
        return {};
      case PartOrder::energies:
        energies_ = solver_.energies();
        return {};
      case PartOrder::download:
        return packed(solver_.download());
      case PartOrder::surface: {
        const FluidSurface surface = solver_.find_surface();
        return packed(solver_.own_ids(), surface);
      }
      case PartOrder::crowding:
        return packed(solver_.crowding());
      case PartOrder::pairs:
        return Packed().value(solver_.count_pairs()).take();
      case PartOrder::memory:
        return Packed().value(solver_.device_memory()).take();
      case PartOrder::begin:
        break;
    }
    throw Error("a part of the water was asked for what it does not know");
  }
  PartFacts facts() const override {
    const compute::DeviceInfo& info = device_.info();
    return {solver_.digest() ^ layout_, info.describe(), info.name + " (" + info.platform_name + ", driver " + info.driver + ")",
            cores_here(), info.is_gpu ? 0 : static_cast<int>(info.compute_units)};
  }
  Bytes laid_out_state(const Layout& layout) const override { return solver_.laid_out_state(layout); }
  void check_state(const Bytes& state) const override { solver_.check_state(state); }
  std::vector<std::int64_t> particles_in_blocks(const Bytes& state) const override { return solver_.particles_in_blocks(state); }
  std::vector<std::int64_t> particles_in_places(const Bytes& state) const override { return solver_.particles_in_places(state); }
  std::size_t memory_for(const std::vector<int>& cuts, const Bytes& state) override { return solver_.memory_for(cuts, state); }
  Bytes joined(const std::vector<Bytes>& parts) const override { return solver_.joined(parts); }
  std::optional<ThinWall> thinnest_wall() const override { return solver_.thinnest_wall(); }
  const StepReport& report() const override { return report_; }
  const PackingReport& packing() const override { return packing_; }
  double time_step() const override { return time_step_; }
  double imbalance() const override { return solver_.imbalance(); }
  const Exchanged& exchanged() const override { return solver_.exchanged(); }
  std::size_t particles() const override { return solver_.particles_of_all(); }
  void lead(WallMover* mover) override { leading_ = mover; }
  void tell(const std::function<void(double)>& progress) override { progress_ = progress; }
  const std::optional<WallMotions>& motions() const override { return motions_; }
  const std::vector<WallWrench>& wrenches() const override { return wrenches_; }
  const FluidEnergies& energies() const override { return energies_; }

 private:
  void advance(Unpacked& order) {
    const bool moves = order.value<char>() != 0;
    TeamMover mover(group_, leading_, order.values<int>());
    motions_.reset();
    report_ = solver_.advance(moves ? &mover : nullptr);
    motions_ = mover.last();
  }

  /// A set of points, and those of it that lie in the part.
  struct PointsInPart {
    PointValues wanted = PointValues::pressure;
    std::vector<Eigen::Vector3d> places;
    int cuts = -1;  ///< for which these were found
    std::vector<int> own;
    std::unique_ptr<PointSet> on_device;
  };

  PointsInPart& points_from(Unpacked& from) {
    PointsInPart& points = points_[from.value<int>()];
    if (!from.value<bool>()) return points;
    points = PointsInPart();
    points.wanted = from.value<PointValues>();
    points.places = vectors_of(from.values<double>());
    return points;
  }

  Bytes evaluate(PointsInPart& points) {
    if (points.cuts != cuts_) {
      points.cuts = cuts_;
      points.own = solver_.own_points(points.places);
      std::vector<Eigen::Vector3d> own;
      for (const int k : points.own) own.push_back(points.places[k]);
      points.on_device = own.empty() ? nullptr : solver_.make_points(own, points.wanted);
    }
    std::vector<double> numbers;
    if (points.on_device)
      for (const PointValue& value : solver_.evaluate(*points.on_device)) {
        numbers.insert(numbers.end(), {value.pressure, value.filling, value.shepard});
        numbers.insert(numbers.end(), value.velocity.data(), value.velocity.data() + 3);
      }
    return Packed().values(points.own).values(numbers).take();
  }

  compute::Device device_;
  parallel::Group& group_;
  std::uint64_t layout_;
  SphSolver<Real> solver_;
  StepReport report_;
  PackingReport packing_;
  std::function<void(double)> progress_;
  double time_step_ = 0;
  std::vector<WallWrench> wrenches_;
  FluidEnergies energies_;
  int cuts_ = 0;  ///< so far
  std::map<int, PointsInPart> points_;
  WallMover* leading_ = nullptr;
  std::optional<WallMotions> motions_;
};

/// A part that is made when rank 0 has told what it is.
class RemotePart {
 public:
  RemotePart(parallel::Group& member, PartPreparation prepare) : member_(member), prepare_(std::move(prepare)) {}

  Bytes obey(const Bytes& order) {
    Unpacked from(order);
    if (from.value<PartOrder>() != PartOrder::begin) {
      if (!server_) throw Error("a part of the water was asked for steps before it was made");
      return server_->obey(order);
    }
    server_.reset();
    FirstOrder first = first_order(from);
    const PreparedPart prepared = prepare_(first.scene);
    first.parting.group = &member_;
    server_ = make_part_server(prepared.device, first.parting, prepared.scene, prepared.layout, prepared.discretisation, first.centres);
    return packed(server_->facts());
  }

 private:
  parallel::Group& member_;
  PartPreparation prepare_;
  std::unique_ptr<PartServer> server_;
};

}  // namespace

void check_precision(const Case& scene, const compute::Device& device) {
  if (scene.numerics.precision == Precision::double_ && !device.info().has_double)
    throw Error("numerics/precision is double, but the device " + device.info().describe() +
                " has no double precision: choose single or another device.");
}

std::unique_ptr<PartServer> make_part_server(const compute::Device& device, const Parting& parting, const Case& scene, const Layout& layout,
                                             const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres) {
  Layout dry = layout;
  dry.particles.clear();  // the part is given its own
  SolverRows rows = rows_for(scene);
  rows.fields.insert(rows.fields.end(), part_fields().begin(), part_fields().end());
  rows.parameters.insert(rows.parameters.end(), part_parameters().begin(), part_parameters().end());
  rows.parting = parting;
  if (scene.numerics.precision == Precision::single)
    return std::make_unique<PartServerOf<float>>(device, rows, scene, dry, discretisation, centres);
  check_precision(scene, device);
  return std::make_unique<PartServerOf<double>>(device, rows, scene, dry, discretisation, centres);
}

parallel::Team::Work work_of_part(parallel::Group& member, PartPreparation prepare) {
  const auto part = std::make_shared<RemotePart>(member, std::move(prepare));
  return [part](int, const Bytes& order) { return part->obey(order); };
}

}  // namespace wavetank
