#pragma once

#include "wavetank/scene/case.h"

namespace wavetank {

/// A case in a box tank from the origin, filled over its whole floor; 2-D where size y is 0. The defaults of every other key.
inline Case box_case(const Vector3d& size, double depth, double spacing) {
  Case result;
  result.title = "a box tank";
  result.dimensions = size.y() == 0 ? 2 : 3;
  result.duration = 1;
  result.fluid.spacing = spacing;
  result.fluid.fill = {Box{Vector3d::Zero(), Vector3d(size.x(), size.y(), depth)}};
  result.tank.shape = BoxTank{size, Vector3d::Zero(), false};
  return result;
}

}  // namespace wavetank
