#include "reports.h"

#include <algorithm>
#include <utility>

#include "macro_names.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

using ReportKind = ReportRow::Kind;

std::string define(const std::string& name, int value, const ReportRow& row) {
  return "#define " + name + " " + std::to_string(value) + "  // " + row.meaning + (row.unit.empty() ? "" : ", " + row.unit) + "\n";
}

}  // namespace

ReportTable::ReportTable(std::vector<ReportRow> rows) : rows_(std::move(rows)) {
  const auto is = [](const std::string& name) {
    return [name](const std::string& other) { return macro_name(other) == macro_name(name); };
  };
  for (const ReportRow& row : rows_) {
    for (const auto* names : {&greatest_, &integers_})
      if (std::any_of(names->begin(), names->end(), is(row.name)))
        throw Error("two values of a step's report are called \"" + row.name + "\"");
    if (is("count")(row.name)) throw Error("no value of a step's report may be called \"" + row.name + "\": it is how many there are");
    (row.kind == ReportKind::greatest ? greatest_ : integers_).push_back(row.name);
  }
}

int ReportTable::place(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("no value of a step's report is called \"" + name + "\"");
  return static_cast<int>(found - names.begin());
}

std::string ReportTable::header() const {
  std::string places, least, watch, end;
  for (const ReportRow& row : rows_) {
    if (row.kind == ReportKind::greatest) {
      const std::string name = "GREATEST_" + macro_name(row.name);
      places += define(name, place(greatest_, row.name), row);
      watch += "  greatest[" + name + "] = fmax(greatest[" + name + "], " + row.value + ");\n";
      end += "  if (k == " + name + ") return " + row.end + ";\n";
    } else {
      const std::string name = "COUNTED_" + macro_name(row.name);
      places += define(name, place(integers_, row.name), row);
      if (row.kind == ReportKind::count) watch += "  counted[" + name + "] += " + row.value + ";\n";
      if (row.kind == ReportKind::first) {
        least += " || k == " + name;
        watch += "  if (counted[" + name + "] == NOBODY && (" + row.value + ")) counted[" + name + "] = i;\n";
      }
    }
  }
  return places + "#define GREATEST_COUNT " + std::to_string(greatest_count()) + "\n#define COUNTED_COUNT " +
         std::to_string(integer_count()) +
         "\n#define REPORT_STEP 0  // Δt of the next step\n#define REPORT_GREATEST 1\n#define REPORT_COUNTED " +
         std::to_string(integers()) + "\n#define NOBODY " + std::to_string(nobody) +
         "\n// Of which integers the least counts, and not the sum.\nINLINE bool is_first(int k) { return false" + least +
         "; }\nINLINE void watch_particle(const watched_t* w, __constant const parameters_t* p, __global const real* state, __global const "
         "real* rates, long "
         "stride, int i,\n                           real* greatest, int* counted) {\n" +
         watch + "}\n// What is reported of a greatest value.\nINLINE real end_of(int k, real greatest) {\n" + end +
         "  return greatest;\n}\n";
}

const std::vector<ReportRow>& common_reports() {
  static const std::vector<ReportRow> rows{
      {"particles", ReportKind::count, "", "in the water", "w->here"},
      {"speed", ReportKind::greatest, "m/s", "greatest |u|", "w->sound ? w->speed2 : R(0.0)", "sqrt(greatest)"},
      // from before the sorting, so of another particle: one that is not finite shows in its own particle's velocity
      {"acceleration", ReportKind::greatest, "m/s²", "greatest |du/dt|", "not_finite(w->acceleration2) ? R(0.0) : w->acceleration2",
       "sqrt(greatest)"},
      {"not_finite", ReportKind::count, "", "with a place or a velocity that is not finite", "w->broken"},
      {"outside", ReportKind::count, "", "outside the watchdog's box", "w->outside"},
      {"fast", ReportKind::count, "", "faster than c₀/2", "w->fast"},
      {"offender", ReportKind::first, "", "the first of those", "w->broken || w->outside || w->fast"},
      {"guarded", ReportKind::count, "", "guard hits of this step", "w->guarded"},
      {"bounded", ReportKind::count, "", "whose γ is bounded", "w->shepard > R(1.005) || w->shepard < R(0.05) ? 1 : 0"},
      {"infected", ReportKind::count, "", "not finite in the compression alone, which follows from that of others", "w->infected"},
      {"first_infected", ReportKind::first, "", "the first of those", "w->infected"},
  };
  return rows;
}

}  // namespace wavetank
