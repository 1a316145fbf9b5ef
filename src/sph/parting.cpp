#include "parting.h"

#include <algorithm>
#include <cmath>
#include <utility>

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
    const std::pair<const char*, const char*> meanings[] = {
        {"part_axis", "across which the water is cut"},
        {"own_begin", "the part's first place"},
        {"own_end", "and that after its last"},
        {"halo_begin", "the first place of its halo; in a ring beyond the tank's end"},
        {"halo_end", "and that after its last"},
        {"near_begin", "where the part before it begins, likewise"},
        {"near_end", "where the part after it ends"},
        {"halo_width", "places"},
        {"window_begin", "the place that is the first in memory, an empty one, as is the last"},
        {"window_size", "places in memory"},
        {"window_slots", "slots in memory, of all rows"},
        {"part_period", "places of the tank where the parts form a ring, else 0"},
        {"part_pair", "1: a ring of two, where all that the other needs goes out once"}};
    for (const auto& [name, meaning] : meanings)
      made.push_back({name, "", meaning, [](const ParameterSource&) { return 0.0; }, ParameterRow::Kind::integer});
    return made;
  }();
  return rows;
}

void set_cuts(ParameterBlock& values, const Parting& parting, const std::vector<int>& cuts) {
  const int rank = parting.group->rank(), last = parting.group->size() - 1;
  const bool wraps = parting.wraps();
  const auto place = [&](int cut) { return parting.begin_of(cuts[cut]); };
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
  const int width = static_cast<int>(values.at("halo_end") - values.at("halo_begin")) + 2;
  // all places, where in a ring there is next to nothing between the ends of the window
  const bool whole = wraps && width + 2 * parting.halo > parting.places;
  const int size = whole ? parting.places + 2 : width;
  values.set("window_begin", whole ? 0 : values.at("halo_begin") - 1);
  values.set("window_size", size);
  const double others[] = {values.at("slots_x"), values.at("rows_y"), values.at("rows_z")};
  double slots = size;
  for (int axis = 0; axis < 3; ++axis)
    if (axis != parting.axis) slots *= others[axis];
  values.set("window_slots", slots);
  values.set("part_period", wraps ? parting.places : 0);
  values.set("part_pair", wraps && last == 1 ? 1 : 0);
}

std::vector<char> places_had(const ParameterBlock& values, const Parting& parting) {
  const int begin = static_cast<int>(values.at("halo_begin")), end = static_cast<int>(values.at("halo_end"));
  std::vector<char> has(parting.places + 1, 0);
  for (int place = begin; place < end; ++place) has[parting.in_ring(place, parting.wraps())] = 1;
  has[0] = 0;
  return has;
}

std::vector<PlaceInPart> by_id(const std::vector<std::vector<std::uint32_t>>& ids) {
  std::vector<PlaceInPart> order;
  for (std::size_t part = 0; part < ids.size(); ++part)
    for (std::size_t k = 0; k < ids[part].size(); ++k) order.push_back({part, k});
  std::sort(order.begin(), order.end(),
            [&ids](const PlaceInPart& a, const PlaceInPart& b) { return ids[a.part][a.place] < ids[b.part][b.place]; });
  return order;
}

std::uint64_t digest_of(std::string_view bytes, std::uint64_t before) {
  for (const char byte : bytes) before = (before ^ static_cast<unsigned char>(byte)) * 0x100000001b3;  // Fowler, Noll and Vo's
  return before;
}

}  // namespace wavetank
