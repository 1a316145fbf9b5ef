#pragma once

#include <map>
#include <string>

#include "wall_arrays.h"
#include "wavetank/scene/case.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

WallKind kind_of(const WallCase& walls);

/// Something that what the guard takes can push: a free body, or a free tank.
bool anything_free(const Case& scene);

/// Axes, a bit each, along which the tank is so long that single precision does not tell places in it well apart.
int long_axes(const Discretisation& discretisation, Precision precision);

/// What of a case the kernels are compiled for.
struct BuildChoice {
  bool use_double = false;
  bool images = false;        ///< the tank is periodic or has ghosts
  bool moving_walls = false;  ///< or belts
  bool moving_frame = false;
  bool thin_walls = false;
  int long_axes = 0;  ///< as long_axes() has them
};

/// Definitions with which kernels are compiled, by name.
using BuildOptions = std::map<std::string, int>;

/// Those that all kernels of a solver share.
BuildOptions build_options(const Case& settled_case, const BuildChoice& choice);

/// As the OpenCL compiler takes them.
std::string text_of(const BuildOptions& options);

}  // namespace wavetank
