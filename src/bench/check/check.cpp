#include "check.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "dam_break.h"
#include "every_kernel.h"
#include "still_tank.h"
#include "tiles.h"
#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

PartResult result_of(const CheckPart& part, const compute::DeviceInfo& device) {
  using Clock = std::chrono::steady_clock;
  PartResult result;
  result.name = part.name;
  const Clock::time_point begin = Clock::now();
  try {
    result.checks = part.checks(device);
  } catch (const std::exception& error) {  // of a driver's compiler too: the other parts may work
    result.failure = error.what();
  }
  result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return result;
}

}  // namespace

bool PartResult::ok() const {
  return failure.empty() && !checks.empty() && std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.ok(); });
}

bool CheckReport::ok() const {
  return !parts.empty() && parts.size() == planned &&
         std::all_of(parts.begin(), parts.end(), [](const PartResult& part) { return part.ok(); });
}

const std::vector<CheckPart>& all_parts() {
  // what is soonest done first, for whoever has minutes only
  static const std::vector<CheckPart> parts = {
      {"still_tank", check_still_tank}, {"dam_break", check_dam_break}, {"tiles", check_tiles}, {"kernels", check_every_kernel}};
  return parts;
}

std::vector<CheckPart> chosen_parts(const std::vector<std::string>& names) {
  if (names.empty()) return all_parts();
  std::vector<CheckPart> chosen;
  for (const std::string& name : names) {
    const auto known = std::find_if(all_parts().begin(), all_parts().end(), [&](const CheckPart& part) { return part.name == name; });
    if (known == all_parts().end()) {
      std::string there;
      for (const CheckPart& part : all_parts()) there += (there.empty() ? "" : ", ") + part.name;
      throw Error("there is no part '" + name + "' of the self-check; there are: " + there);
    }
    chosen.push_back(*known);
  }
  return chosen;
}

CheckReport run_parts(const std::vector<CheckPart>& parts, const compute::DeviceInfo& device,
                      const std::function<void(const CheckReport&)>& each) {
  CheckReport report;
  report.device = device.describe();
  report.planned = parts.size();
  for (const CheckPart& part : parts) {
    std::fprintf(stderr, "%zu of %zu: %s\n", report.parts.size() + 1, parts.size(), part.name.c_str());
    report.parts.push_back(result_of(part, device));
    each(report);
  }
  return report;
}

}  // namespace wavetank::bench
