#pragma once

#include <functional>
#include <string>
#include <vector>

#include "natural_spline.h"
#include "wavetank/geometry/mesh.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// One of the motions that a prescribed one is the sum of.
struct MotionTerm {
  Direction direction;
  std::function<Change(double time)> at;  ///< time >= 0
  double resolution;                      ///< s: times this close together show all of it
};

/// From 0 to 1 from a time on, s, with no velocity and no acceleration at either end.
Change smooth_rise(double time, double from, double length);

/// Throws Error as PrescribedMotion. `gravity`: m/s², downwards.
std::vector<MotionTerm> motion_terms(const PrescribedCase& prescribed, int dimensions, double gravity, const std::string& case_directory,
                                     const ResourceResolver& resolve, const std::string& what);

}  // namespace wavetank
