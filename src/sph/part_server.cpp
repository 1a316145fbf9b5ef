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

std::vector<Eigen::Vector3d> vectors_of(const std::vector<double>& numbers) {
  std::vector<Eigen::Vector3d> vectors;
  for (std::size_t k = 0; k + 2 < numbers.size(); k += 3) vectors.emplace_back(numbers[k], numbers[k + 1], numbers[k + 2]);
  return vectors;
}

FirstOrder first_order(Unpacked& from) {
  FirstOrder order;
  order.parting = from.value<Parting>();
  order.centres = vectors_of(from.values<double>());
  order.scene = from.text();
  return order;
}

std::vector<FilmLump> lumps_of(const std::vector<double>& numbers) {
  std::vector<FilmLump> lumps;
  for (std::size_t k = 0; k + 4 < numbers.size(); k += 5)
    lumps.push_back({Eigen::Vector3d(numbers[k], numbers[k + 1], numbers[k + 2]), numbers[k + 3], numbers[k + 4]});
  return lumps;
}

/// Processors that this process may run on.
int cores_here() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof set, &set) == 0 ? CPU_COUNT(&set) : 0;
}

/// Whatever lies in a third corner of two dimensions is left out.
std::uint64_t digest_of_walls(const std::vector<Facet>& facets, int dimensions) {
  std::uint64_t digest = digest_of("walls");
  const auto add = [&digest](const void* bytes, std::size_t size) { digest = digest_of({static_cast<const char*>(bytes), size}, digest); };
  for (const Facet& facet : facets) {
    for (int k = 0; k < dimensions; ++k) add(facet.corners[k].data(), sizeof(Eigen::Vector3d));
    add(facet.normal.data(), sizeof(Eigen::Vector3d));
    add(&facet.owner, sizeof facet.owner);
  }
  return digest;
}

Packed& add(Packed& to, const Eigen::Vector3d& vector) { return to.value(vector.x()).value(vector.y()).value(vector.z()); }

Eigen::Vector3d vector_from(Unpacked& from) {
  Eigen::Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = from.value<double>();
  return vector;
}

NewParticles new_particles_from(Unpacked& from) {
  NewParticles particles;
  particles.position = vectors_of(from.values<double>());
  particles.velocity = vectors_of(from.values<double>());
  particles.volume = from.values<double>();
  particles.pressure = from.values<double>();
  return particles;
}

std::vector<Drain> drains_from(Unpacked& from) {
  std::vector<Drain> drains(from.value<std::size_t>());
  for (Drain& drain : drains) {
    drain.centre = vector_from(from);
    for (int k = 0; k < 3; ++k) drain.half_edges.col(k) = vector_from(from);
  }
  return drains;
}

std::vector<ImposedZone> zones_from(Unpacked& from) {
  std::vector<ImposedZone> zones(from.value<std::size_t>());
  for (ImposedZone& zone : zones) {
    for (Eigen::Vector3d* vector : {&zone.centre, &zone.normal, &zone.across, &zone.up, &zone.drift, &zone.heading})
      *vector = vector_from(from);
    for (int k = 0; k < 3; ++k) zone.turning.col(k) = vector_from(from);
    zone.depth = from.value<double>();
    zone.cells = from.value<std::array<int, 2>>();
    zone.cell_size = from.value<std::array<double, 2>>();
    zone.first_edge = from.value<std::array<double, 2>>();
    zone.layers = from.value<int>();
    zone.speed = from.values<double>();
    zone.pressure = from.values<double>();
    zone.is_free = from.values<char>();
  }
  return zones;
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
        walls_(digest_of_walls(dry.facets, discretisation.dimensions)),
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
    return {solver_.digest() ^ walls_, info.describe(), info.name + " (" + info.platform_name + ", driver " + info.driver + ")",
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
  std::uint64_t walls_;
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

std::vector<double> numbers_of(const std::vector<Eigen::Vector3d>& vectors) {
  std::vector<double> numbers;
  for (const Eigen::Vector3d& vector : vectors) numbers.insert(numbers.end(), vector.data(), vector.data() + 3);
  return numbers;
}

parallel::Bytes packed(const FirstOrder& order) {
  return Packed().value(PartOrder::begin).value(order.parting).values(numbers_of(order.centres)).text(order.scene).take();
}

parallel::Bytes packed(const FluidState& fluid) {
  Packed bytes;
  bytes.values(fluid.id).values(numbers_of(fluid.position)).values(numbers_of(fluid.velocity));
  return bytes.values(fluid.pressure).values(fluid.compression).values(fluid.mass).take();
}

FluidState fluid_state(const parallel::Bytes& bytes) {
  Unpacked from(bytes);
  FluidState fluid;
  fluid.id = from.values<std::uint32_t>();
  fluid.position = vectors_of(from.values<double>());
  fluid.velocity = vectors_of(from.values<double>());
  fluid.pressure = from.values<double>();
  fluid.compression = from.values<double>();
  fluid.mass = from.values<double>();
  return fluid;
}

parallel::Bytes packed(const std::vector<std::uint32_t>& ids, const FluidSurface& surface) {
  return Packed().values(ids).values(surface.shepard).values(surface.on_surface).values(surface.eigenvalue).take();
}

FluidSurface fluid_surface(const parallel::Bytes& bytes, std::vector<std::uint32_t>& ids) {
  Unpacked from(bytes);
  ids = from.values<std::uint32_t>();
  FluidSurface surface;
  surface.shepard = from.values<double>();
  surface.on_surface = from.values<std::uint8_t>();
  surface.eigenvalue = from.values<double>();
  return surface;
}

parallel::Bytes packed(const Crowding& crowding) {
  Packed bytes;
  bytes.value(crowding.lost).value(crowding.whole).value(crowding.greatest).value(crowding.id);
  return add(bytes, crowding.place).take();
}

Crowding crowding_of(const parallel::Bytes& bytes) {
  Unpacked from(bytes);
  Crowding crowding;
  crowding.lost = from.value<std::int64_t>();
  crowding.whole = from.value<std::int64_t>();
  crowding.greatest = from.value<double>();
  crowding.id = from.value<std::uint32_t>();
  crowding.place = vector_from(from);
  return crowding;
}

FluidState joined(const std::vector<FluidState>& parts) {
  std::vector<std::vector<std::uint32_t>> ids;
  for (const FluidState& part : parts) ids.push_back(part.id);
  FluidState all;
  for (const auto& [part, k] : by_id(ids)) {
    all.id.push_back(parts[part].id[k]);
    all.position.push_back(parts[part].position[k]);
    all.velocity.push_back(parts[part].velocity[k]);
    all.pressure.push_back(parts[part].pressure[k]);
    all.compression.push_back(parts[part].compression[k]);
    all.mass.push_back(parts[part].mass[k]);
  }
  return all;
}

FluidSurface joined(const std::vector<FluidSurface>& parts, const std::vector<std::vector<std::uint32_t>>& ids) {
  FluidSurface all;
  for (const auto& [part, k] : by_id(ids)) {
    all.shepard.push_back(parts[part].shepard[k]);
    all.on_surface.push_back(parts[part].on_surface[k]);
    all.eigenvalue.push_back(parts[part].eigenvalue[k]);
  }
  return all;
}

Bytes let_in_order(const NewParticles& particles) {
  Packed order;
  order.value(PartOrder::let_in).values(numbers_of(particles.position)).values(numbers_of(particles.velocity));
  return order.values(particles.volume).values(particles.pressure).take();
}

Bytes drains_order(const std::vector<Drain>& drains) {
  Packed order;
  order.value(PartOrder::drains).value(drains.size());
  for (const Drain& drain : drains) {
    add(order, drain.centre);
    for (int k = 0; k < 3; ++k) add(order, drain.half_edges.col(k));
  }
  return order.take();
}

Bytes zones_order(const std::vector<ImposedZone>& zones) {
  Packed order;
  order.value(PartOrder::zones).value(zones.size());
  for (const ImposedZone& zone : zones) {
    for (const Eigen::Vector3d& vector : {zone.centre, zone.normal, zone.across, zone.up, zone.drift, zone.heading}) add(order, vector);
    for (int k = 0; k < 3; ++k) add(order, zone.turning.col(k));
    order.value(zone.depth).value(zone.cells).value(zone.cell_size).value(zone.first_edge).value(zone.layers);
    order.values(zone.speed).values(zone.pressure).values(zone.is_free);
  }
  return order.take();
}

void add_motions(Packed& to, const WallMotions& motions) {
  to.value(motions.owners.size());
  for (const WallMotion& motion : motions.owners) {
    for (const Eigen::Vector3d& vector : {motion.velocity, motion.angular_velocity, motion.acceleration, motion.angular_acceleration,
                                          motion.surface_velocity, motion.displacement})
      add(to, vector);
    const Eigen::Quaterniond& q = motion.orientation;
    to.value(q.w()).value(q.x()).value(q.y()).value(q.z());
  }
  to.value(motions.frame.has_value());
  if (!motions.frame) return;
  for (const Eigen::Vector3d& vector :
       {motions.frame->gravity, motions.frame->origin, motions.frame->angular_velocity, motions.frame->angular_acceleration})
    add(to, vector);
}

WallMotions motions_from(Unpacked& from) {
  WallMotions motions;
  motions.owners.resize(from.value<std::size_t>());
  for (WallMotion& motion : motions.owners) {
    for (Eigen::Vector3d* vector : {&motion.velocity, &motion.angular_velocity, &motion.acceleration, &motion.angular_acceleration,
                                    &motion.surface_velocity, &motion.displacement})
      *vector = vector_from(from);
    Eigen::Quaterniond& q = motion.orientation;
    for (double* number : {&q.w(), &q.x(), &q.y(), &q.z()}) *number = from.value<double>();
  }
  if (!from.value<bool>()) return motions;
  FrameMotion& frame = motions.frame.emplace();
  for (Eigen::Vector3d* vector : {&frame.gravity, &frame.origin, &frame.angular_velocity, &frame.angular_acceleration})
    *vector = vector_from(from);
  return motions;
}

parallel::Bytes packed(const PartFacts& facts) {
  return Packed().value(facts.digest).text(facts.device).text(facts.kind).value(facts.cores).value(facts.units).take();
}

PartFacts part_facts(const parallel::Bytes& bytes) {
  Unpacked from(bytes);
  PartFacts facts;
  facts.digest = from.value<std::uint64_t>();
  facts.device = from.text();
  facts.kind = from.text();
  facts.cores = from.value<int>();
  facts.units = from.value<int>();
  return facts;
}

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
