#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// What wavetank_check was asked for.
struct CheckOptions {
  bool run = true;  ///< false: help or the version was wanted, and printed
  std::vector<std::string> parts;
  std::string device = "auto";
  std::string json;  ///< file; empty = none
};

/// Reads the command line. Throws Error for what makes no sense.
CheckOptions read_check_options(int argc, char** argv);

}  // namespace wavetank::bench
