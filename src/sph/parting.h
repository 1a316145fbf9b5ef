#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "grid_shape.h"
#include "tables/fields.h"
#include "tables/parameters.h"
#include "wavetank/parallel/group.h"

namespace wavetank {

/// How the water of a case is cut into parts: the same for all of them, and for any number of them. Places along the axis are counted in
/// the slots of the particles' grid along x, or in its rows; the first is 1, since the grid has an empty border.
struct Parting {
  parallel::Group* group = nullptr;  ///< the part and those beside it; the rest is the same for all
  int axis = 0;                      ///< across which the water is cut
  int halo = 0;                      ///< places beside its own of which a part has the particles of others
  int way = 0;                       ///< places that a particle goes, at the most, before its neighbours are gone over
  int block = 0;                     ///< places; cuts lie between blocks, of which the last may be longer
  int segment = 0;                   ///< slots, of which tiles have particles together
  int places = 0;                    ///< in all
  std::size_t given = 0;             ///< particles of all parts together at the start
  std::size_t room = 0;              ///< for those that there may be, by which the grid is as fine as it is
  bool periodic = false;             ///< the tank is so along the axis: beyond its last place the first follows
  bool spoils = false;               ///< for tests: what others have not sent yet is not a number

  int blocks() const { return std::max(places / block, 1); }
  /// Where a block begins, or, of the number of blocks, the place after the last.
  int begin_of(int of_block) const { return 1 + (of_block == blocks() ? places : of_block * block); }
  /// The place in the tank that this is, where places go on beyond the ends of a ring; 0 if there is none.
  int in_ring(int place, bool ring) const {
    const int there = !ring ? place : place < 1 ? place + places : place > places ? place - places : place;
    return there >= 1 && there <= places ? there : 0;
  }
  /// The first and the last part lie beside each other; of two parts either is on both sides of the other.
  bool wraps() const { return periodic && group->size() > 1; }
};

/// Slots, of which tiles have particles together where the water is cut into parts, and whose forces on walls are found together: fewer in
/// small tanks, so that they have some of them; more where that costs fewer tiles that are not full.
int slots_of_segment(const Discretisation& discretisation, const GridShape& grid);

/// What a solver of a part has besides: which particles are its own, and where parts end.
const std::vector<FieldRow>& part_fields();
const std::vector<ParameterRow>& part_parameters();

/// Sets those of the part of this rank, where the parts begin and end at these blocks. `values`: with the grid's.
void set_cuts(ParameterBlock& values, const Parting& parting, const std::vector<int>& cuts);

/// Of each place, 1 if the part whose numbers these are has its particles, as its own or in its halo.
std::vector<char> places_had(const ParameterBlock& values, const Parting& parting);

/// Of all these particles, in the order of their ids, where they are. `ids`: of each part's.
struct PlaceInPart {
  std::size_t part = 0, place = 0;
};
std::vector<PlaceInPart> by_id(const std::vector<std::vector<std::uint32_t>>& ids);

/// To tell whether two processes have the same: of the bytes, after those of which `before` is.
std::uint64_t digest_of(std::string_view bytes, std::uint64_t before = 0xcbf29ce484222325);

}  // namespace wavetank
