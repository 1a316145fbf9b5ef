#include "bench_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "wavetank/common/error.h"
#include "wavetank/common/version.h"

namespace wavetank::bench {
namespace {

const char* const what_is_measured =
    "Without --filter: every size of the dam breaks in 2-D and 3-D, at 100k in 3-D each support, density diffusion and wall treatment by\n"
    "itself, and spheric2_45. Nothing else should run meanwhile. A case that the device's memory cannot hold is skipped.\n"
    "Ctrl-C ends it after the step in progress with what has been measured.\n"
    "Exit code: 0 done, 2 an error (one sentence on standard error), 130 ended by Ctrl-C, 143 by SIGTERM.\n"
    "How to read the table: docs/performance.md.";

}  // namespace

BenchOptions read_bench_options(int argc, char** argv) {
  BenchOptions options;
  bool list = false, no_cold_build = false, show_version = false;
  CLI::App app("wavetank_bench: measures what this machine does with stock cases.", "wavetank_bench");
  app.footer(what_is_measured);
  app.add_option("--filter", options.filters,
                 "of all cases, those whose names contain this text; may be repeated: a name must contain each")
      ->type_name("TEXT");
  app.add_option("--device", options.device, "OpenCL device: auto, cpu, gpu, PLATFORM:DEVICE or a part of its name")->type_name("DEVICE");
  app.add_option("--repeat", options.repeats, "measurements of each case, of 5 steps and 0.5 s at the least; 5 unless given")
      ->type_name("N");
  app.add_option("--json", options.json, "write all of it to this file, each repeat's value too (an older one is replaced)")
      ->type_name("FILE");
  app.add_flag("--short", options.short_set,
               "100k and 1M in 3-D in place of the usual set, for a machine that is at hand for minutes only");
  app.add_option("--parts", options.parts,
                 "measure one case, 100k in 3-D unless --filter leaves another, in so many parts that take turns, beside a model of them")
      ->delimiter(',')
      ->type_name("N,...");
  app.add_flag("--no-cold-build", no_cold_build, "leave out how long the kernels take to build with empty caches");
  app.add_flag("--list", list, "print the names of all cases, or of those that --filter leaves");
  app.add_flag("--version", show_version, "print the version");
  app.add_option(start_up_option, options.start_up_of)->group("");  // hidden

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    options.action = BenchOptions::Action::nothing;
    return options;
  } catch (const CLI::ParseError& error) {
    throw Error(std::string(error.what()) + " (wavetank_bench --help lists the options)");
  }
  if (show_version) {
    std::printf("wavetank %s\n", version());
    options.action = BenchOptions::Action::nothing;
    return options;
  }
  if (options.repeats < 1) throw Error("--repeat " + std::to_string(options.repeats) + " is not a number of measurements, at least 1");
  if (app.count("--json") > 0 && options.json.empty()) throw Error("--json needs the name of a file");
  if (options.short_set && !options.filters.empty()) throw Error("--short and --filter are two choices of cases; give one of them");
  if (!options.parts.empty() && (options.short_set || !options.json.empty())) throw Error("--parts goes with neither --short nor --json");
  for (const int count : options.parts)
    if (count < 2 || count > 1000) throw Error("--parts must be from 2 to 1000, not " + std::to_string(count));
  options.cold_build = !no_cold_build;
  if (!options.parts.empty()) options.action = BenchOptions::Action::parts;
  if (list) options.action = BenchOptions::Action::list;
  if (!options.start_up_of.empty()) options.action = BenchOptions::Action::start_up;
  return options;
}

}  // namespace wavetank::bench
