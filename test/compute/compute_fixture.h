#pragma once

#include <gtest/gtest.h>

#include <string>

#include "../common/error_of.h"
#include "../common/scratch_directory.h"
#include "wavetank/compute/program.h"

namespace wavetank::compute {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline const char* saxpy_source() {
  return "kernel void saxpy(global float* y, global const float* x, float a, int count) {\n"
         "  int i = get_global_id(0);\n"
         "  if (i < count) y[i] += a * x[i];\n"
         "}\n";
}

}  // namespace wavetank::compute
