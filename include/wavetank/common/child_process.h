#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace wavetank {

/// What a child may take.
struct ChildLimits {
  std::uint64_t memory = 0;      ///< bytes, beyond what this process has
  double processor_seconds = 0;  ///< s of processor time
  double seconds = 0;            ///< s of wall time
};

/// How a child ended.
struct ChildResult {
  enum class End {
    done,           ///< `bytes` are what the work returned
    refused,        ///< it threw an exception: `bytes` are its what()
    out_of_memory,  ///< of what it was allowed
    out_of_time,    ///< likewise: `bytes` are the limit that it met, such as "15 s of processor time"
    interrupted,    ///< this process was asked to end (EndingSignals)
    crashed         ///< by a signal, or without a word: `bytes` are which
  };
  End end = End::crashed;
  std::string bytes;
};

/// Does work that may crash, loop or eat memory, such as reading a damaged file by a library that trusts it, in a child process that is a
/// copy of this one. The child's output goes nowhere, and it ends with this process at the latest. `work` must not wait for other threads,
/// which the child does not have, nor use a device. Throws Error if there can be no child.
ChildResult run_in_child(const std::function<std::string()>& work, const ChildLimits& limits);

}  // namespace wavetank
