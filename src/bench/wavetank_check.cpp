// Checks in a few minutes whether this machine's OpenCL device computes what it should: everything but the process's own affairs is in
// check.
#include <cstdio>
#include <exception>

#include "check/check.h"
#include "check/check_options.h"
#include "wavetank/common/log.h"
#include "wavetank/common/standard_output.h"
#include "wavetank/common/whole_file.h"

namespace {

using namespace wavetank;
using namespace wavetank::bench;

constexpr int exit_failed = 1, exit_error = 2;

void log_warnings(LogLevel level, const std::string& line) {
  if (level != LogLevel::info) std::fprintf(stderr, "wavetank_check: warning: %s\n", line.c_str());
}

int run(const CheckOptions& options) {
  const std::vector<CheckPart> parts = chosen_parts(options.parts);
  if (!options.json.empty()) check_writable(options.json, "the report");
  const compute::DeviceInfo device = compute::choose_device(options.device);
  std::fprintf(stderr, "checking %s\n", device.describe().c_str());
  const CheckReport report = run_parts(parts, device, [&](const CheckReport& so_far) {
    if (!options.json.empty()) write_whole(options.json, json_of(so_far), "the report");
  });
  std::printf("%s", table_of(report).c_str());
  finish_printing();
  return report.ok() ? 0 : exit_failed;
}

}  // namespace

int main(int argc, char** argv) {
  let_writing_fail();
  try {
    set_log_sink(log_warnings);
    const CheckOptions options = read_check_options(argc, argv);
    return options.run ? run(options) : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "wavetank_check: %s\n", error.what());
    return exit_error;
  }
}
