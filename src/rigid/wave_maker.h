#pragma once

#include <string>

#include "motion_terms.h"
#include "natural_spline.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// Whether its direction turns the paddle.
bool is_flap(const WaveCase& wave);

/// A solitary wave and the paddle that makes it: Rayleigh's profile η = H sech²(β(ct − x)), β² = 3H/(4d²(d + H)), c² = g(d + H), and a
/// piston that goes with the water's mean velocity at its face, ẋ = cη/(d + η) (Guizien and Barthélemy, J. Hydraul. Res. 40, 2002).
class SolitaryWave {
 public:
  /// m, m, m/s².
  SolitaryWave(double height, double depth, double gravity);
  double outskirts() const { return outskirts_; }                          ///< β, 1/m
  double celerity() const { return celerity_; }                            ///< m/s
  double stroke() const { return 2.0 * height_ / (outskirts_ * depth_); }  ///< m
  double duration() const;                                                 ///< s, of the paddle's motion
  /// Of the paddle, which begins at 0 at rest and stays at the stroke.
  Change paddle_at(double time) const;

 private:
  double height_, depth_, outskirts_, celerity_;
};

/// The paddle's motion: of linear theory, of a regular wave's piston also to second order (Madsen, J. Geophys. Res. 76, 1971), that makes
/// no free wave of twice the frequency.
MotionTerm wave_term(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what);

}  // namespace wavetank
