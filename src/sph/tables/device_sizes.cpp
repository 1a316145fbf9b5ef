#include "device_sizes.h"

#include "macro_names.h"

namespace wavetank {
namespace {

std::string definition(const std::string& name, const std::string& value, const std::string& meaning) {
  return "#define " + macro_name(name) + " " + value + "  // " + meaning + "\n";
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
