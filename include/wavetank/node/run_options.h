#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wavetank/scene/case_reader.h"

namespace wavetank {

/// What wavetank_run was asked for.
struct RunOptions {
  enum class Action { run, check, schedule, list_devices, nothing };
  Action action = Action::run;
  std::string case_file;
  std::vector<Override> overrides;  ///< of --set, --duration and --device, in this order
  std::string bag;                  ///< empty = none
  bool clouds = false;              ///< the free surface's particles into the bag
  bool particles = false;           ///< all particles into the bag
  bool surface = false;             ///< the water's surface into the bag and the files for ParaView
  std::string vtk;                  ///< a folder for files for ParaView; empty = none
  double vtk_rate = 20;             ///< Hz of simulated time, of those files
  std::string restore;              ///< empty = start at time 0
  std::string save;                 ///< empty = no snapshot at the end
  double save_every = 0;            ///< s of simulated time between snapshots on the way; 0 = none
  int parts = 0;                    ///< for which the water's need is to be told; 0 = the case is to be checked as it is
  bool profile = false;
  bool quiet = false;
};

/// Reads the command line. Help and version are printed here, and leave Action::nothing. Throws Error for an unknown or incomplete option.
RunOptions read_command_line(int argc, char** argv);

}  // namespace wavetank
