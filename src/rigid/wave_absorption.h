#pragma once

#include <complex>
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
/// frequency are a paddle's (Schäffer and Jakobsen, 2003, of the same kind): a low pass of the second order for the time that the waves
/// take from the gauge, and two high passes, so that neither a wrong level nor a drift moves the paddle. The low pass has the damping with
/// which shorter waves are sent back least enlarged. A step depends on nothing but the state.
class WaveAbsorption {
 public:
  /// `case_directory` and `record_path` as for wave_components. Throws Error where the gauge is not well before the paddle, or the tank
  /// leaves the paddle no room, or not the given reach, or no low pass is stable (where the recall is far too short).
  WaveAbsorption(const WaveCase& wave, double gravity, const PaddlePlace& place, const std::string& record_path, const std::string& what);

  /// The gauge's level at the beginning of a step, m; a constant does not count.
  void see(double time, double level);
  /// Displacement along the waves' way from the time of the last step on, m.
  Change at(double time) const;
  void advance(double time, double time_step);
  /// How much of its reach it takes, 0 to 1.
  double taken() const;

  /// By linear theory, what the paddle sends over what comes back to it, for small waves of an angular frequency, rad/s.
  double sent_back(double angular_frequency) const;
  /// What decides how it moves beside its state: two that agree go on alike from the same state.
  std::vector<double> settings() const;

  static constexpr std::size_t saved_numbers = 8;
  std::vector<double> save() const;
  void restore(const double* values);

 private:
  /// Gain, cut and damping for the waves' frequency, rad/s; false where no damping gives a stable paddle.
  bool choose_filter(double angular_frequency);
  void set_filter(double angular_frequency, double lag, double damping);
  /// Of the level that a gauge shows, the amplitude that the paddle sends, at a frequency of small waves.
  std::complex<double> answer(double angular_frequency) const;
  double expected(double time) const;
  double acceleration() const;

  std::vector<WaveComponent> components_;
  std::vector<double> wave_numbers_;
  WaveCase wave_;
  double gravity_, to_gauge_, rise_, reach_;
  double gain_ = 0;               ///< 1/s
  double cut_ = 0, damping_ = 0;  ///< of the low pass: rad/s, over the critical one
  double recall_ = 0;             ///< s, of each high pass

  bool started_ = false;
  double time_ = 0, seen_ = 0;              ///< s, m
  double mean_ = 0;                         ///< m, of the first high pass
  double passed_ = 0, passed_rate_ = 0;     ///< m, m/s, of the low pass
  double displacement_ = 0, velocity_ = 0;  ///< m, m/s, were there no limit
};

}  // namespace wavetank
