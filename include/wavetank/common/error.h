#pragma once

#include <stdexcept>
#include <string>

namespace wavetank {

/// A failure that a user can act on. what() is one clear sentence: what is wrong, where (file, line, key, device, particle, time),
/// and what is allowed. Programs print it and exit non-zero; libraries never print or exit.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace wavetank
