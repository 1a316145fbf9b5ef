#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// Followed by a case's name: prints how long that takes to start. For the benchmark's own use.
constexpr const char* start_up_option = "--start-up-of";

/// What wavetank_bench was asked for.
struct BenchOptions {
  enum class Action { run, parts, list, start_up, nothing };
  Action action = Action::run;
  std::vector<std::string> filters;
  std::string device = "auto";
  std::string json;  ///< file; empty = none
  int repeats = 5;
  bool cold_build = true;
  bool short_set = false;
  std::vector<int> parts;  ///< numbers of parts that steps are measured in
  std::string start_up_of;
};

/// Reads the command line. Help and version are printed here, and leave Action::nothing. Throws Error for what makes no sense.
BenchOptions read_bench_options(int argc, char** argv);

}  // namespace wavetank::bench
