#pragma once

#include <cstdio>
#include <string>

#include "wavetank/scene/case.h"

namespace wavetank {

/// A number in a message.
inline std::string number(double value, const char* format = "%.6g") {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A place in a message, in the unit that it has.
inline std::string point(const Vector3d& p) { return "(" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ")"; }

}  // namespace wavetank
