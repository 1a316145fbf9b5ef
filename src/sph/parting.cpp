#include "parting.h"

#include <algorithm>
#include <cmath>

namespace wavetank {

int supports_of_block(const Discretisation& discretisation, int axis) { return std::clamp(discretisation.cells[axis] / 16, 2, 8); }

int slots_of_segment(const Discretisation& discretisation, const GridShape& grid) {
  return supports_of_block(discretisation, 0) * std::max(static_cast<int>(std::lround(discretisation.support / grid.slot_length)), 1);
}

const std::vector<FieldRow>& part_fields() {
  static const std::vector<FieldRow> rows{{ParticleArray::state, {"own"}, "", "1 of the part's own particles, 0 of those of its halo"}};
  return rows;
}

const std::vector<ParameterRow>& part_parameters() {
  static const std::vector<ParameterRow> rows = [] {
    std::vector<ParameterRow> made;
    for (const char* name : {"part_axis", "own_begin", "own_end", "halo_begin", "halo_end", "near_begin", "near_end", "halo_width"})
      made.push_back({name, "", "of a part of the water", [](const ParameterSource&) { return 0.0; }, ParameterRow::Kind::integer});
    return made;
  }();
  return rows;
}

void set_cuts(ParameterBlock& values, const Parting& parting, const std::vector<int>& cuts) {
  const int rank = parting.group->rank(), last = parting.group->size() - 1;
  const auto place = [&](int cut) { return 1 + std::min(cuts[cut] * parting.block, parting.places); };
  const int begin = place(rank), end = place(rank + 1);
  values.set("part_axis", parting.axis);
  values.set("own_begin", begin);
  values.set("own_end", end);
  values.set("halo_begin", rank > 0 ? begin - parting.halo : begin);
  values.set("halo_end", rank < last ? end + parting.halo : end);
  values.set("near_begin", place(std::max(rank - 1, 0)));
  values.set("near_end", place(std::min(rank + 2, last + 1)));
  values.set("halo_width", parting.halo);
}

bool has_place(const ParameterBlock& values, int place) { return place >= values.at("halo_begin") && place < values.at("halo_end"); }

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
  for (const char byte : bytes) before = (before ^ static_cast<unsigned char>(byte)) * 0x100000001b3;  // Fowler, Noll and Vo's
  return before;
}

}  // namespace wavetank
