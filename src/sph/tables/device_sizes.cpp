#include "device_sizes.h"

#include <algorithm>
#include <cctype>

namespace wavetank {
namespace {

std::string definition(std::string name, const std::string& value, const std::string& meaning) {
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return "#define " + name + " " + value + "  // " + meaning + "\n";
}

}  // namespace

std::string sizes_header() {
  std::string text;
#define WAVETANK_SIZE(name, value, meaning) text += definition(#name, std::to_string(value), meaning);
  WAVETANK_DEVICE_SIZES(WAVETANK_SIZE)
#undef WAVETANK_SIZE
  return text + definition("shift_most", "R(" + std::to_string(field::shift_most) + ")", "of the spacing, in a step");
}

}  // namespace wavetank
