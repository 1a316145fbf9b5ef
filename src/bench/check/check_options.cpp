#include "check_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "wavetank/common/error.h"
#include "wavetank/common/version.h"

namespace wavetank::bench {
namespace {

const char* const what_is_checked =
    "Parts: still_tank, a tank at rest in 3-D; dam_break, a second of SPHERIC benchmark 2; tiles, what the neighbour loop takes at a time\n"
    "against one by one; kernels, every kernel on small cases. The JSON is written anew after each part.\n"
    "Exit code: 0 all is well, 1 a check failed, 2 an error (one sentence on standard error).\n"
    "What is checked: docs/performance.md.";

}  // namespace

CheckOptions read_check_options(int argc, char** argv) {
  CheckOptions options;
  bool show_version = false;
  CLI::App app("wavetank_check: whether this machine's OpenCL device computes what it should.", "wavetank_check");
  app.footer(what_is_checked);
  app.add_option("--part", options.parts, "this part of the check alone; may be repeated")->type_name("PART");
  app.add_option("--device", options.device, "OpenCL device: auto, cpu, gpu, PLATFORM:DEVICE or a part of its name")->type_name("DEVICE");
  app.add_option("--json", options.json, "write all of it to this file (an older one is replaced)")->type_name("FILE");
  app.add_flag("--version", show_version, "print the version");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    options.run = false;
    return options;
  } catch (const CLI::ParseError& error) {
    throw Error(std::string(error.what()) + " (wavetank_check --help lists the options)");
  }
  if (app.count("--json") > 0 && options.json.empty()) throw Error("--json needs the name of a file");
  if (show_version) std::printf("wavetank %s\n", version());
  options.run = !show_version;
  return options;
}

}  // namespace wavetank::bench
