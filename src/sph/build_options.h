#pragma once

#include <map>
#include <string>

#include "wall_arrays.h"
#include "wavetank/scene/case.h"

namespace wavetank {

WallKind kind_of(const WallCase& walls);

/// Something that what the guard takes can push: a free body, or a free tank.
bool anything_free(const Case& scene);

/// What of a case the kernels are compiled for.
struct BuildChoice {
  bool use_double = false;
  bool images = false;        ///< the tank is periodic or has ghosts
  bool moving_walls = false;  ///< or belts
  bool moving_frame = false;
  bool thin_walls = false;
};

/// Definitions with which kernels are compiled, by name.
using BuildOptions = std::map<std::string, int>;

/// Those that all kernels of a solver share.
BuildOptions build_options(const Case& settled_case, const BuildChoice& choice);

/// As the OpenCL compiler takes them.
std::string text_of(const BuildOptions& options);

}  // namespace wavetank
