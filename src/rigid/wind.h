#pragma once

#include <vector>

#include "wavetank/scene/case.h"

namespace wavetank {

/// The wind on a body. Gusts are a sum of sines with phases by the case's seed: the same whenever they are asked for, so that a run goes on
/// from anywhere. Their spectrum is that of an exponential autocorrelation, S(f) ∝ 1/(1 + (2π f T)²) of the time scale T, in components of
/// equal energy.
class Wind {
 public:
  explicit Wind(const WindCase& wind);
  /// m/s, in the world's axes.
  Vector3d velocity(double time) const;
  /// N (2-D: N/m) on the body's area, which moves at a velocity (m/s).
  Vector3d force(double time, const Vector3d& of_area) const;

 private:
  struct Component {
    double angular_frequency;  ///< rad/s
    double phase;              ///< rad
  };
  WindCase wind_;
  std::vector<Component> gusts_;
};

}  // namespace wavetank
