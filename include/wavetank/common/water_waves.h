#pragma once

#include <Eigen/Core>
#include <string>

/// Theory of waves over a level floor: numbers alone, all in SI units.
namespace wavetank {

/// Wave number of small waves over a level floor, 1/m: the root of ω² = g k tanh kd. All greater than 0.
double wave_number(double angular_frequency, double depth, double gravity);

/// Why a wave would break, as words that follow its height: McCowan's 0.78 of the depth, Miche's 0.142 L tanh kd; empty: it would not. A
/// `wave_number` of 0 stands for a solitary wave, of which only the first is asked.
std::string why_it_breaks(double height, double depth, double wave_number);

/// The same of waves whose crests meet: `slope`, the sum of their amplitudes times wave numbers, against Miche's π H/L = 0.142 π tanh kd of
/// the peak's `wave_number`, 1/m.
std::string why_focus_breaks(double slope, double depth, double wave_number);

/// A solitary wave: Rayleigh's profile η = H sech²(β(x − ct)), β² = 3H/(4d²(d + H)), c² = g(d + H).
struct SolitaryProfile {
  double height = 0, depth = 0;  ///< m
  double outskirts = 0;          ///< β, 1/m
  double celerity = 0;           ///< m/s
};
SolitaryProfile solitary_profile(double height, double depth, double gravity);

/// A wave field at one instant in a vertical plane: along, the way that it goes, with a crest at 0; and up, from the still level.
struct WaveField {
  enum class Kind {
    progressive,  ///< of linear theory, or with a second harmonic to that of the second order (Stokes)
    standing,     ///< of linear theory, at the instant of rest
    solitary      ///< Rayleigh's, with the vertical structure of the velocity to the second order of the depth over the length
  };
  Kind kind = Kind::progressive;
  bool second_order = false;  ///< of a progressive one
  double depth = 0;           ///< m
  double height = 0;          ///< m, from trough to crest to first order; of a solitary one the crest's
  double wave_number = 0;     ///< 1/m, of waves that repeat themselves
  double gravity = 0;         ///< m/s²

  double celerity() const;               ///< m/s
  double elevation(double along) const;  ///< m
  /// Along and up, m/s; free of divergence.
  Eigen::Vector2d velocity(double along, double up) const;
  /// Over the density, m²/s²: Bernoulli's, 0 at the surface.
  double pressure_over_density(double along, double up) const;
};

}  // namespace wavetank
