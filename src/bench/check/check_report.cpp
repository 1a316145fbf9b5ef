#include <cmath>

#include "../json.h"
#include "../text_table.h"
#include "check.h"
#include "wavetank/common/version.h"

namespace wavetank::bench {
namespace {

/// In digits enough for errors of rounding too.
std::string value_text(double value) {
  if (!std::isfinite(value)) return "not a number";
  char text[40];
  std::snprintf(text, sizeof text, "%.5g", value);
  return text;
}

std::string allowed_text(const Check& check) {
  const bool below = std::isfinite(check.least), above = std::isfinite(check.most);
  if (below && above && check.least == check.most) return value_text(check.least);
  if (below && above) return value_text(check.least) + " to " + value_text(check.most);
  return above ? "at most " + value_text(check.most) : "at least " + value_text(check.least);
}

std::string verdict(bool ok) { return ok ? "ok" : "FAILED"; }

Json json_of(const PartResult& part) {
  std::vector<Json> checks;
  for (const Check& check : part.checks)
    checks.push_back(Json::object({{"what", check.what},
                                   {"value", check.value},
                                   {"unit", check.unit},
                                   {"least", check.least},
                                   {"most", check.most},
                                   {"ok", check.ok()}}));
  return Json::object(
      {{"name", part.name}, {"ok", part.ok()}, {"seconds", part.seconds}, {"failure", part.failure}, {"checks", Json::list(checks)}});
}

}  // namespace

std::string table_of(const CheckReport& report) {
  TextTable table({"part", "what", "value", "allowed", "unit", ""});
  std::string times, failures;
  for (const PartResult& part : report.parts) {
    for (const Check& check : part.checks)
      table.add({part.name, check.what, value_text(check.value), allowed_text(check), check.unit, verdict(check.ok())});
    if (!part.failure.empty()) {
      table.add({part.name, "ran to its end", "no", "yes", "", verdict(false)});
      failures += part.name + ": " + part.failure + "\n";
    }
    times += (times.empty() ? "seconds: " : ", ") + part.name + " " + figure(part.seconds);
  }
  std::string text = report.device + "\n";
  text += "\n" + table.text() + "\n" + times + "\n" + failures;
  return text + (report.ok() ? "self-check: all is well\n" : "self-check: FAILED\n");
}

std::string json_of(const CheckReport& report) {
  std::vector<Json> parts;
  for (const PartResult& part : report.parts) parts.push_back(json_of(part));
  return Json::object({{"wavetank", version()},
                       {"device", report.device},
                       {"whole", report.parts.size() == report.planned},
                       {"ok", report.ok()},
                       {"parts", Json::list(parts)}})
             .text() +
         "\n";
}

}  // namespace wavetank::bench
