#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace wavetank {

/// What a restart needs, exactly.
struct Snapshot {
  std::string version;  ///< of wavetank, that wrote it
  std::string device;
  std::string scene;     ///< the case, as YAML, less what does not change the flow
  double time = 0;       ///< s
  double time_step = 0;  ///< s, of the next step
  std::uint64_t step = 0;
  std::uint64_t guard_hits = 0;
  std::array<std::uint64_t, 10> clocks{};
  std::vector<double> instruments;  ///< what they remember
  std::vector<char> bodies;
  std::vector<char> openings;
  std::vector<char> fluid;
};

/// Writes it whole or not at all. Throws Error if the disk does not take it, or something other than a plain file lies there.
void write_snapshot(const std::string& path, const Snapshot& snapshot);

/// Throws Error for a missing, truncated, damaged or foreign file.
Snapshot read_snapshot(const std::string& path);

}  // namespace wavetank
