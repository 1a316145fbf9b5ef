#pragma once

#include <string>
#include <vector>

#include "natural_spline.h"
#include "wavetank/rigid/wave_theory.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// What a piston that absorbs has about it, along the way of its waves from its front at rest, m.
struct PaddlePlace {
  double gauge = 0;   ///< to the gauge
  double ahead = 0;   ///< to the tank's end
  double behind = 0;  ///< from its back to the tank's other end
};

/// A piston's displacement beside that of theory, by which waves that come back pass through it: it goes with their water. A gauge before
/// it sees them first; what it shows beyond the waves that theory has there goes through filters whose gain and phase at the waves'
/// frequency are a paddle's (Schäffer and Jakobsen, 2003, of the same kind): two low passes for the time that the waves take from the
/// gauge, and two high passes, so that neither a wrong level nor a drift moves the paddle. A step depends on nothing but the state.
class WaveAbsorption {
 public:
  /// `case_directory` and `record_path` as for wave_components. Throws Error where the gauge is not well before the paddle, or the tank
  /// leaves the paddle no room.
  WaveAbsorption(const WaveCase& wave, double gravity, const PaddlePlace& place, const std::string& record_path, const std::string& what);

  /// The gauge's level at the beginning of a step, m; a constant does not count.
  void see(double time, double level);
  /// Displacement along the waves' way from the time of the last step on, m.
  Change at(double time) const;
  void advance(double time, double time_step);
  /// How much of its reach it takes, 0 to 1.
  double taken() const;

  static constexpr std::size_t saved_numbers = 8;
  std::vector<double> save() const;
  void restore(const double* values);

 private:
  double expected(double time) const;
  double acceleration() const;

  std::vector<WaveComponent> components_;
  std::vector<double> wave_numbers_;
  WaveCase wave_;
  double gravity_, to_gauge_, rise_, reach_;
  double gain_ = 0, delay_ = 0, recall_ = 0;  ///< 1/s, s of each low pass, s of each high pass

  bool started_ = false;
  double time_ = 0, seen_ = 0;                ///< s, m
  double mean_ = 0, first_ = 0, second_ = 0;  ///< m, of the filters
  double displacement_ = 0, velocity_ = 0;    ///< m, m/s, were there no limit
};

}  // namespace wavetank
