#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wavetank/common/water_waves.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// Amplitude of the waves far from a paddle over that of its displacement at the still level (Biésel and Suquet 1951; Dean and Dalrymple,
/// Water Wave Mechanics, ch. 6). `hinge`: height over the floor that a flap turns about, m, also below it (negative); none = a piston.
double wave_over_stroke(double wave_number, double depth, const std::optional<double>& hinge);

/// Spectrum of the surface, m²/Hz (Hasselmann et al. 1973), before it is scaled to a height: f⁻⁵ exp(−1.25 (f_p/f)⁴) γ^…; γ = 1 is that of
/// Pierson and Moskowitz. Frequencies in Hz.
double jonswap_shape(double frequency, double peak_frequency, double peak_enhancement);

/// One of the small waves that a sea is the sum of: η = a cos(ωt − kx + φ) at a distance x from the paddle at rest.
struct WaveComponent {
  double amplitude = 0;          ///< m
  double angular_frequency = 0;  ///< rad/s
  double phase = 0;              ///< rad
};

/// Those of regular, irregular and focused waves and of a record, whose file is at `path`. Throws Error for numbers that make no waves and,
/// as PrescribedMotion, for a record that cannot be read. What is random in them follows from the seed alone, whatever compiled this.
std::vector<WaveComponent> wave_components(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what);

/// What to expect of waves, by linear theory; of a sea, of a wave of its significant height and peak period.
struct WaveFacts {
  double height = 0, period = 0;  ///< m, s; a solitary wave has no period: 0
  double wavelength = 0;          ///< m; of a solitary wave that within which it is higher than a hundredth of its height
  double celerity = 0;            ///< m/s
  double stroke = 0;              ///< m, of the paddle at the still level, from one end to the other
  double ursell = 0;              ///< H L²/d³
  double steepness = 0;           ///< H/L
  std::string regime;             ///< shallow (kd < π/10), intermediate or deep (kd > π) water
  std::string breaking;           ///< why it would break; empty = it would not
};

/// The waves of a paddle in its tank.
struct ExpectedWaves {
  std::string body;
  WaveFacts facts;
  double to_end = 0;  ///< m, from the paddle's front to the end of the tank's bounding box
  double behind = 0;  ///< m, likewise from its back
};

WaveFacts wave_facts(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what);

}  // namespace wavetank
