#include "parting.h"

#include <algorithm>
#include <cmath>

namespace wavetank {

int slots_of_segment(const Discretisation& discretisation, const GridShape& grid) {
  const int supports = std::clamp(discretisation.cells[0] / 16, 2, 8);
  return supports * std::max(static_cast<int>(std::lround(discretisation.support / grid.slot_length)), 1);
}

const std::vector<FieldRow>& part_fields() {
  static const std::vector<FieldRow> rows{{ParticleArray::state, {"own"}, "", "1 of the part's own particles, 0 of those of its halo"}};
  return rows;
}

const std::vector<ParameterRow>& part_parameters() {
  static const std::vector<ParameterRow> rows = [] {
    std::vector<ParameterRow> made;
    for (const char* name : {"part_axis", "own_begin", "own_end", "halo_begin", "halo_end", "near_begin", "near_end", "halo_width",
                             "part_period", "part_pair"})
      made.push_back({name, "", "of a part of the water", [](const ParameterSource&) { return 0.0; }, ParameterRow::Kind::integer});
    return made;
  }();
  return rows;
}

void set_cuts(ParameterBlock& values, const Parting& parting, const std::vector<int>& cuts) {
  const int rank = parting.group->rank(), last = parting.group->size() - 1;
  const bool wraps = parting.wraps();
  const auto place = [&](int cut) { return 1 + (cuts[cut] == parting.blocks() ? parting.places : cuts[cut] * parting.block); };
  const int begin = place(rank), end = place(rank + 1);
  const bool has_before = rank > 0 || wraps, has_after = rank < last || wraps;
  const int before = rank > 0 ? place(rank - 1) : wraps ? place(last) - parting.places : begin;
  const int after = rank < last ? place(rank + 2) : wraps ? place(1) + parting.places : end;
  values.set("part_axis", parting.axis);
  values.set("own_begin", begin);
  values.set("own_end", end);
  values.set("halo_begin", has_before ? begin - parting.halo : begin);
  values.set("halo_end", has_after ? end + parting.halo : end);
  values.set("near_begin", before);
  values.set("near_end", after);
  values.set("halo_width", parting.halo);
  values.set("part_period", wraps ? parting.places : 0);
  values.set("part_pair", wraps && last == 1 ? 1 : 0);
}

bool has_place(const ParameterBlock& values, int place) {
  const auto is_in = [&](double at) { return at >= values.at("halo_begin") && at < values.at("halo_end"); };
  const double period = values.at("part_period");  // 0: none
  return is_in(place) || is_in(place - period) || is_in(place + period);
}

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
  for (const char byte : bytes) before = (before ^ static_cast<unsigned char>(byte)) * 0x100000001b3;  // Fowler, Noll and Vo's
  return before;
}

}  // namespace wavetank
