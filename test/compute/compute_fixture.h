#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <string>

#include "wavetank/common/error.h"
#include "wavetank/compute/program.h"

namespace wavetank::compute {

/// What the Error says that `action` throws; empty, and a failed test, if it throws none.
template <class Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A directory that goes with the object.
class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "wavetank_compute_XXXXXX").string();
    if (mkdtemp(&pattern[0]) == nullptr) throw Error("no scratch directory could be made");
    path_ = pattern;
  }
  ~ScratchDirectory() { std::filesystem::remove_all(path_); }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline const char* saxpy_source() {
  return "kernel void saxpy(global float* y, global const float* x, float a, int count) {\n"
         "  int i = get_global_id(0);\n"
         "  if (i < count) y[i] += a * x[i];\n"
         "}\n";
}

}  // namespace wavetank::compute
