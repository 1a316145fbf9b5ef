#include "wavetank/node/run_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "wavetank/common/error.h"
#include "wavetank/common/version.h"
#include "wavetank/node/parameters.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank {

namespace {

const char* const footer =
    "Ctrl-C, SIGTERM and SIGHUP end the run after the step in progress; the bag is whole and readable then, and --save still writes.\n"
    "A second Ctrl-C ends it at once, and leaves BAG.active, which rosbag reindex makes readable.\n"
    "Exit code: 0 done, 2 an error (one sentence on standard error; where the disk is full it says where bag and snapshot\n"
    "are, with all until then), 3 the simulation was stopped by its watchdog\n"
    "(a snapshot of it is written beside the bag), 130 ended by Ctrl-C, 143 by SIGTERM, 129 by SIGHUP.\n"
    "Case keys: docs/case.md. Topics in the bag: docs/topics.md.";

Override read_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw Error("--set '" + text + "' is not KEY=VALUE, as in --set fluid/spacing=0.02");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Takes every --set out of the arguments: CLI11's own lists would swallow the case behind it, and older ones cannot be told not to.
std::vector<Override> take_overrides(std::vector<std::string>& arguments) {
  const std::string flag = "--set";
  std::vector<Override> overrides;
  std::vector<std::string> others;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == flag) {
      if (i + 1 == arguments.size()) throw Error("--set needs KEY=VALUE, as in --set fluid/spacing=0.02");
      overrides.push_back(read_override(arguments[++i]));
    } else if (arguments[i].rfind(flag + "=", 0) == 0) {
      overrides.push_back(read_override(arguments[i].substr(flag.size() + 1)));
    } else {
      others.push_back(arguments[i]);
    }
  }
  arguments = others;
  return overrides;
}

}  // namespace

RunOptions read_command_line(int argc, char** argv) {
  RunOptions options;
  std::vector<std::string> arguments(argv + 1, argv + argc);
  options.overrides = take_overrides(arguments);
  std::string shown_only, duration, device;
  bool check = false, schedule = false, list_devices = false, show_version = false;

  CLI::App app("wavetank_run: simulates a case without a ROS master and writes a bag.", "wavetank_run");
  app.footer(footer);
  app.add_option("CASE", options.case_file, "the case, a YAML file");
  app.add_option("--bag,-b", options.bag, "write the samples to this bag (an older plain file is replaced)")->type_name("FILE");
  app.add_flag("--clouds", options.clouds, "with the free surface's particles in the bag, at rate rates/cloud_bag");
  app.add_flag("--particles", options.particles, "with all particles in the bag, at the same rate");
  const CLI::Option* const vtk =
      app.add_option("--vtk", options.vtk, "write files for ParaView into this folder, which must be new or empty, while the run goes on")
          ->type_name("DIR");
  const CLI::Option* const vtk_rate =
      app.add_option("--vtk-rate", options.vtk_rate, "frames a second of simulated time for --vtk, if not 20")->type_name("HZ");
  app.add_flag("--surface", options.surface,
               "with the water's surface as a mesh: in the bag, with a height map, at rate rates/surface_bag; in files for ParaView");
  app.add_option("--duration", duration, "simulated time instead of the case's duration, s")->type_name("S");
  app.add_option("--set", shown_only, "replace a key of the case: --set fluid/spacing=0.02; may be repeated")->type_name("KEY=VALUE");
  app.add_option("--device", device,
                 "OpenCL device: auto, cpu, gpu, PLATFORM:DEVICE or a part of its name; several with commas between them, DEVICE/N for N "
                 "pieces of one, or all: the water in as many parts")
      ->type_name("DEVICE");
  app.add_option("--restore", options.restore, "go on from this snapshot of the same case")->type_name("FILE");
  app.add_option("--save", options.save, "write a snapshot when the run ends")->type_name("FILE");
  const CLI::Option* const save_every =
      app.add_option("--save-every", options.save_every, "write it each time that so much more is simulated, too, s")->type_name("S");
  app.add_flag("--profile", options.profile, "time each kernel and print a table at the end");
  app.add_flag("--quiet,-q", options.quiet, "print nothing but warnings and errors");
  app.add_flag("--check", check, "read and lay out the case, report sizes, masses, draughts and the estimated time, run nothing");
  const CLI::Option* const parts =
      app.add_option("--parts", options.parts, "with --check: report what the water in so many parts would need, and no time")
          ->type_name("N");
  app.add_flag("--schedule", schedule, "print the stages of the case's time step, and what each reads and writes; run nothing");
  app.add_flag("--list-devices", list_devices, "print the OpenCL devices of this machine");
  app.add_flag("--version", show_version, "print the version");

  try {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
    app.parse(arguments);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    options.action = RunOptions::Action::nothing;
    return options;
  } catch (const CLI::ParseError& error) {
    throw Error(std::string(error.what()) + " (wavetank_run --help lists the options)");
  }
  if (show_version) {
    std::printf("wavetank %s\n", version());
    options.action = RunOptions::Action::nothing;
    return options;
  }
  if (list_devices) {
    options.action = RunOptions::Action::list_devices;
    return options;
  }
  if (options.case_file.empty()) throw Error("give the case, a YAML file: wavetank_run CASE.yaml --bag out.bag");
  if (options.clouds && options.bag.empty()) throw Error("--clouds needs --bag FILE to write them to");
  if (options.particles && options.bag.empty()) throw Error("--particles needs --bag FILE to write them to");
  if (vtk->count() > 0 && options.vtk.empty()) throw Error("--vtk: the folder has no name");
  if (vtk_rate->count() > 0 && options.vtk.empty()) throw Error("--vtk-rate needs --vtk DIR, whose frames it is the rate of");
  if (!(options.vtk_rate > 0 && options.vtk_rate <= 1e6)) throw Error("--vtk-rate must be greater than 0 and at most 1000000 Hz");
  if (save_every->count() > 0 && options.save.empty()) throw Error("--save-every needs --save FILE, the snapshot that it writes");
  if (save_every->count() > 0 && !(options.save_every >= 1e-6 && options.save_every <= 1e15))
    throw Error("--save-every must be from 0.000001 to 1e15 s of simulated time");
  if (options.surface && options.bag.empty() && options.vtk.empty()) throw Error("--surface needs --bag FILE or --vtk DIR to write it to");
  if (options.surface && !can_find_surface()) throw Error(std::string("--surface: ") + why_no_surface);
  if (parts->count() > 0 && !check)
    throw Error("--parts needs --check, which tells what so many parts would need; a run has as many as --device names, or mpirun starts");
  if (parts->count() > 0 && !(options.parts >= 1 && options.parts <= 100000)) throw Error("--parts must be from 1 to 100000");
  if (!duration.empty()) options.overrides.push_back({"duration", duration});
  if (!device.empty()) options.overrides.push_back({"device", yaml_of(device)});  // quoted: 0:1 is a number to some YAML
  if (check && schedule) throw Error("--check and --schedule are asked for, but each prints a page of its own: give one of them");
  if (check) options.action = RunOptions::Action::check;
  if (schedule) options.action = RunOptions::Action::schedule;
  return options;
}

}  // namespace wavetank
