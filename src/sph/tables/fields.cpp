#include "fields.h"

#include <algorithm>
#include <utility>

#include "macro_names.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr const char* array_names[] = {"state", "rates", "sums"};
constexpr const char* device_prefixes[] = {"FIELD_", "RATE_", "SUM_"};

std::vector<FieldRow> with_rates(std::vector<FieldRow> rows) {
  const std::size_t given = rows.size();
  for (std::size_t k = 0; k < given; ++k) {
    const FieldRow of = rows[k];
    if (of.evolution == FieldRow::Evolution::none) continue;
    const std::string unit = of.unit.empty() ? "1/s" : of.unit == "1/s" ? "1/s²" : of.unit + "/s";
    // a step may begin with the rates of the last one's end
    rows.push_back({ParticleArray::rates, of.components, unit, "of change", of.evolution == FieldRow::Evolution::conjugate});
    rows.push_back({ParticleArray::sums, of.components, unit, "of weighted rates of change"});
  }
  return rows;
}

}  // namespace

FieldTable::FieldTable(std::vector<FieldRow> rows) : rows_(with_rates(std::move(rows))) {
  for (const FieldRow& row : rows_)
    for (const std::string& component : row.components) {
      std::vector<std::string>& names = names_[static_cast<int>(row.array)];
      if (std::find(names.begin(), names.end(), component) != names.end())
        throw Error("two fields of the particles' " + std::string(array_names[static_cast<int>(row.array)]) + " are called \"" + component +
                    "\"");
      names.push_back(component);
    }
}

bool FieldTable::has(ParticleArray array, const std::string& component) const {
  const std::vector<std::string>& all = names(array);
  return std::find(all.begin(), all.end(), component) != all.end();
}

int FieldTable::at(ParticleArray array, const std::string& component) const {
  const std::vector<std::string>& all = names(array);
  const auto found = std::find(all.begin(), all.end(), component);
  if (found == all.end())
    throw Error("no field of the particles' " + std::string(array_names[static_cast<int>(array)]) + " is called \"" + component + "\"");
  return static_cast<int>(found - all.begin());
}

std::string FieldTable::header() const {
  std::string text;
  for (int array = 0; array < 3; ++array) {
    int place = 0;
    for (const FieldRow& row : rows_) {
      if (static_cast<int>(row.array) != array) continue;
      for (const std::string& component : row.components)
        text += "#define " + (device_prefixes[array] + macro_name(component)) + " " + std::to_string(place++) + "  // " + row.meaning +
                (row.unit.empty() ? "" : ", " + row.unit) + "\n";
    }
    text += "#define " + std::string(device_prefixes[array]) + "COUNT " + std::to_string(place) + "\n";
  }
  return text + each_of(FieldRow::Evolution::conjugate, "EACH_CONJUGATE") + each_of(FieldRow::Evolution::follower, "EACH_FOLLOWER");
}

std::string FieldTable::each_of(FieldRow::Evolution evolution, const std::string& macro) const {
  std::string text = "#define " + macro + "(DO)";
  for (const FieldRow& row : rows_)
    if (row.evolution == evolution)
      for (const std::string& component : row.components) text += " DO(" + macro_name(component) + ")";
  return text + "\n";
}

const std::vector<FieldRow>& common_fields() {
  constexpr ParticleArray state = ParticleArray::state, rates = ParticleArray::rates, sums = ParticleArray::sums;
  static const std::vector<FieldRow> rows{
      {state, {"x", "y", "z"}, "m", "position, from the grid's origin", true},
      {state, {"u", "v", "w"}, "m/s", "velocity", true},
      {state, {"compression"}, "", "ρ/ρ₀ − 1", true, FieldRow::Evolution::conjugate},
      {state, {"pressure"}, "Pa", "gauge pressure", true},
      {state, {"volume"}, "m³", "m/ρ", true},
      {state, {"mass"}, "kg", "mass", true},
      {state, {"rest_x", "rest_y", "rest_z"}, "m", "what rounding took from the position so far (compensated sum)", true},
      {rates, {"u", "v", "w"}, "m/s²", "acceleration"},
      {rates, {"shepard"}, "", "γ"},
      {rates, {"clearance"}, "m", "distance to the nearest wall element, at the least"},
      {sums, {"x", "y", "z"}, "m/s", "of weighted velocities"},
      {sums, {"u", "v", "w"}, "m/s²", "of weighted accelerations"},
  };
  return rows;
}

}  // namespace wavetank
