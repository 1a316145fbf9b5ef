#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank::validation {

/// KEY=VALUE arguments as overrides of a case.
inline std::vector<Override> overrides_of(int count, char** arguments) {
  std::vector<Override> overrides;
  for (int k = 0; k < count; ++k) {
    const std::string text = arguments[k];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) throw Error("'" + text + "' is no KEY=VALUE.");
    overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return overrides;
}

/// The simulation of a case file; meshes of this package are found in its source.
inline std::unique_ptr<Simulation> make_simulation(const std::string& case_file, const std::vector<Override>& overrides) {
  SimulationOptions options;
  options.resolve = [](const std::string& uri) -> std::string {
    const std::string package = "package://wavetank/";
    if (uri.rfind(package, 0) != 0) throw Error("a mesh is given as " + uri + ", but only package://wavetank is known here.");
    return std::string(WAVETANK_SOURCE_DIRECTORY) + "/" + uri.substr(package.size());
  };
  return std::make_unique<Simulation>(read_case_file(case_file, overrides), options);
}

}  // namespace wavetank::validation
