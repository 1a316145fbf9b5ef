#include "part_messages.h"

namespace wavetank {
namespace {

using parallel::Bytes;
using parallel::Packed;
using parallel::Unpacked;

Packed& add(Packed& to, const Eigen::Vector3d& vector) { return to.value(vector.x()).value(vector.y()).value(vector.z()); }

Eigen::Vector3d vector_from(Unpacked& from) {
  Eigen::Vector3d vector;
  for (int axis = 0; axis < 3; ++axis) vector[axis] = from.value<double>();
  return vector;
}

}  // namespace

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
  for (std::size_t k = 0; k + 5 < numbers.size(); k += 6)
    lumps.push_back({Eigen::Vector3d(numbers[k], numbers[k + 1], numbers[k + 2]), numbers[k + 3], numbers[k + 4], numbers[k + 5]});
  return lumps;
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

}  // namespace wavetank
