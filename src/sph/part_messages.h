#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "crowding.h"
#include "parting.h"
#include "wavetank/parallel/group.h"
#include "wavetank/parallel/packed.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// What the parts are asked to do, as the first byte of an order, and what comes after it.
enum class PartOrder : char {
  begin,     ///< a part in another process: FirstOrder; replies with PartFacts
  pack,      ///< so many iterations
  start,     ///< the water as it lies
  settle,    ///< periods
  advance,   ///< a step: whether walls move in it, and the owners whose wrenches move them
  walls,     ///< WallMotions, as they are now
  shorten,   ///< s, of the next step
  limit,     ///< s, of every step
  film,      ///< lumps
  let_in,    ///< NewParticles at the end of the next step, of which each part takes its own
  drains,    ///< Drains
  zones,     ///< ImposedZones
  open,      ///< particles may come and go
  save,      ///< replies with the state of the part's own particles
  cut,       ///< cuts, and a state of all the water, of which the part takes what is its
  download,  ///< replies with the part's own particles
  surface,   ///< replies with their ids, and what a sweep finds of them
  crowding,  ///< replies with Crowding of them
  pairs,     ///< replies with their PairCount
  memory,    ///< replies with the bytes on its device
  evaluate,  ///< numbers of sets of points to forget, one to evaluate, and if that is new what is wanted and where they are; replies with
             ///< which lie in the part, and the water there
  wrenches,  ///< those on all owners by all the water
  energies,  ///< of all the water
};

/// From which a process makes its part: the rest follows from the case.
struct FirstOrder {
  Parting parting;
  std::vector<Eigen::Vector3d> centres;  ///< as make_solver takes them
  std::string scene;                     ///< the settled case as text, which PartPreparation reads
};
parallel::Bytes packed(const FirstOrder& order);

/// What the first checks of a part.
struct PartFacts {
  std::uint64_t digest = 0;  ///< of what its kernels are made of and told, and of the walls
  std::string device;        ///< in words
  std::string kind;          ///< of device: parts on others may have other last bits
  int cores = 0;             ///< that the process may use
  int units = 0;             ///< of its device, where that is a processor, else 0
};
parallel::Bytes packed(const PartFacts& facts);
PartFacts part_facts(const parallel::Bytes& bytes);

parallel::Bytes packed(const FluidState& fluid);
FluidState fluid_state(const parallel::Bytes& bytes);

parallel::Bytes packed(const Crowding& crowding);
Crowding crowding_of(const parallel::Bytes& bytes);

/// Of all parts' particles, in the order of their ids.
FluidState joined(const std::vector<FluidState>& parts);
/// `ids`: of each part's.
FluidSurface joined(const std::vector<FluidSurface>& parts, const std::vector<std::vector<std::uint32_t>>& ids);

parallel::Bytes packed(const std::vector<std::uint32_t>& ids, const FluidSurface& surface);
FluidSurface fluid_surface(const parallel::Bytes& bytes, std::vector<std::uint32_t>& ids);

parallel::Bytes let_in_order(const NewParticles& particles);
parallel::Bytes drains_order(const std::vector<Drain>& drains);
parallel::Bytes zones_order(const std::vector<ImposedZone>& zones);

/// x, y, z of each, one after the other.
std::vector<double> numbers_of(const std::vector<Eigen::Vector3d>& vectors);
void add_motions(parallel::Packed& to, const WallMotions& motions);
WallMotions motions_from(parallel::Unpacked& from);

std::vector<Eigen::Vector3d> vectors_of(const std::vector<double>& numbers);
FirstOrder first_order(parallel::Unpacked& from);
std::vector<FilmLump> lumps_of(const std::vector<double>& numbers);
NewParticles new_particles_from(parallel::Unpacked& from);
std::vector<Drain> drains_from(parallel::Unpacked& from);
std::vector<ImposedZone> zones_from(parallel::Unpacked& from);

}  // namespace wavetank
