#pragma once

#include <cstdio>
#include <string>

namespace wavetank {

/// Six significant digits, for messages.
inline std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace wavetank
