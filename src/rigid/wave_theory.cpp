#include "wavetank/rigid/wave_theory.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <unsupported/Eigen/FFT>

#include "uniform_numbers.h"
#include "wave_maker.h"
#include "wavetank/common/error.h"
#include "wavetank/common/record_file.h"

namespace wavetank {
namespace {

constexpr double lowest_frequency = 0.5, highest_frequency = 3.0;  // of a spectrum's peak: some 1 % of the energy lies beyond
constexpr double least_share = 1e-3;                               // of the greatest amplitude: less of a record's is left out,
constexpr double highest_recorded = 5.0;                           // and what is beyond so many times its frequency
constexpr std::size_t fewest_lines = 8;                            // of a record

std::vector<WaveComponent> spectral_components(const WaveCase& wave) {
  const double peak = 1.0 / wave.peak_period, enhancement = wave.spectrum == WaveSpectrum::jonswap ? wave.peak_enhancement : 1.0;
  const double width = (highest_frequency - lowest_frequency) * peak / wave.components;
  const bool focused = wave.kind == WaveKind::focused;
  std::mt19937_64 generator(static_cast<std::uint64_t>(wave.seed));
  std::vector<WaveComponent> components;
  double sum = 0;
  for (int i = 0; i < wave.components; ++i) {
    // somewhere in its band, so that the sea does not repeat itself after 1/Δf
    const double within = focused ? 0.5 : uniform(generator);
    const double frequency = lowest_frequency * peak + (i + within) * width, energy = jonswap_shape(frequency, peak, enhancement);
    WaveComponent component;
    component.amplitude = focused ? energy : std::sqrt(energy);
    component.angular_frequency = 2.0 * M_PI * frequency;
    component.phase = focused ? 0.0 : 2.0 * M_PI * uniform(generator);
    sum += focused ? component.amplitude : 0.5 * component.amplitude * component.amplitude;
    components.push_back(component);
  }
  // a focused wave's crest is the sum of the amplitudes; the significant height is four times the root of the variance
  const double scale = focused ? wave.height / sum : 0.25 * wave.significant_height / std::sqrt(sum);
  for (WaveComponent& component : components) component.amplitude *= scale;
  return components;
}

/// So that all crests meet at the distance and the time.
void focus(const WaveCase& wave, double gravity, std::vector<WaveComponent>& components) {
  for (WaveComponent& component : components) {
    const double k = wave_number(component.angular_frequency, wave.depth, gravity);
    component.phase = k * wave.focus.distance - component.angular_frequency * wave.focus.time;
  }
}

/// The discrete Fourier transform of the record's straight lines between its lines, about their mean.
std::vector<WaveComponent> recorded_components(const WaveCase& wave, double gravity, const std::string& path, const std::string& what) {
  const RecordFile file(path, what, "wave");
  const std::vector<double> times = file.times(wave.record.time_column);
  const std::vector<double> values = file.numbers(wave.record.column);
  const double duration = times.back() - times.front();
  const std::size_t count = times.size();
  if (count < fewest_lines)
    throw Error(file.place(0) + ": it has " + std::to_string(count) + " lines of elevations; it must have " + std::to_string(fewest_lines) +
                " at least");
  std::vector<double> even(count);
  std::size_t k = 1;
  double mean = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = times.front() + duration * static_cast<double>(i) / static_cast<double>(count);
    while (times[k] < time) ++k;
    const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
    even[i] = wave.record.factor * (values[k - 1] + share * (values[k] - values[k - 1]));
    mean += even[i] / static_cast<double>(count);
  }
  // the sum repeats itself: a jump from the end to the beginning would be of all frequencies
  const double rise = wave.record.factor * (values.back() - values.front());
  for (std::size_t i = 0; i < count; ++i) even[i] -= mean + rise * (static_cast<double>(i) / static_cast<double>(count) - 0.5);
  std::vector<std::complex<double>> transform;
  Eigen::FFT<double>().fwd(transform, even);
  std::vector<WaveComponent> all;
  double greatest = 0;
  for (std::size_t n = 1; n <= (count - 1) / 2; ++n) {
    const double in_phase = 2.0 * transform[n].real() / static_cast<double>(count),
                 quadrature = -2.0 * transform[n].imag() / static_cast<double>(count);
    WaveComponent component;
    component.amplitude = std::hypot(in_phase, quadrature);
    component.angular_frequency = 2.0 * M_PI * static_cast<double>(n) / duration;
    // of what was seen at a distance and from another time on
    component.phase = std::atan2(-quadrature, in_phase) - component.angular_frequency * (times.front() + wave.record.delay) +
                      wave_number(component.angular_frequency, wave.depth, gravity) * wave.record.distance;
    greatest = std::max(greatest, component.amplitude);
    all.push_back(component);
  }
  if (!(greatest > 0)) throw Error(file.place(0) + ": the surface does not move in it");
  const WaveComponent& peak =
      *std::max_element(all.begin(), all.end(), [](const WaveComponent& a, const WaveComponent& b) { return a.amplitude < b.amplitude; });
  std::vector<WaveComponent> components;
  std::copy_if(all.begin(), all.end(), std::back_inserter(components), [&](const WaveComponent& component) {
    return component.amplitude >= least_share * greatest && component.angular_frequency <= highest_recorded * peak.angular_frequency;
  });
  return components;
}

}  // namespace

double wave_over_stroke(double wave_number, double depth, const std::optional<double>& hinge) {
  // all times e^−kd, so that nothing overflows in deep water
  const double kd = wave_number * depth, once = std::exp(-2.0 * kd), sinh = 0.5 * (1.0 - once);
  const auto cosh = [&](double height) {  // of k times a height over the floor
    return 0.5 * (std::exp(wave_number * (height - depth)) + std::exp(-wave_number * (height + depth)));
  };
  double paddle = sinh;  // ∫ k f cosh ks ds over the depth, of the paddle's displacement f, 1 at the still level
  if (hinge) paddle -= (cosh(depth) - cosh(std::max(*hinge, 0.0))) / (wave_number * (depth - *hinge));
  return 4.0 * sinh * paddle / (0.5 * (1.0 - once * once) + 2.0 * kd * once);
}

double jonswap_shape(double frequency, double peak_frequency, double peak_enhancement) {
  const double ratio = frequency / peak_frequency, width = ratio <= 1 ? 0.07 : 0.09;
  const double peak = std::exp(-0.5 * std::pow((ratio - 1.0) / width, 2));
  return std::pow(ratio, -5) * std::exp(-1.25 * std::pow(ratio, -4)) * std::pow(peak_enhancement, peak);
}

std::vector<WaveComponent> wave_components(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what) {
  std::vector<WaveComponent> components;
  if (wave.kind == WaveKind::regular) components = {{0.5 * wave.height, 2.0 * M_PI / wave.period, 0.0}};
  if (wave.kind == WaveKind::irregular || wave.kind == WaveKind::focused) components = spectral_components(wave);
  if (wave.kind == WaveKind::focused) focus(wave, gravity, components);
  if (wave.kind == WaveKind::record) components = recorded_components(wave, gravity, record_path, what);
  return components;
}

WaveFacts wave_facts(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what) {
  WaveFacts facts;
  facts.height = wave.kind == WaveKind::irregular ? wave.significant_height : wave.height;
  facts.period = wave.kind == WaveKind::regular ? wave.period : wave.peak_period;
  if (wave.kind == WaveKind::solitary) {
    const SolitaryWave solitary(wave.height, wave.depth, gravity);
    facts.period = 0;
    facts.celerity = solitary.celerity();
    facts.wavelength = 2.0 * std::acosh(10.0) / solitary.outskirts();
    facts.stroke = solitary.stroke();
    facts.regime = "shallow";
    facts.breaking = why_it_breaks(wave.height, wave.depth, 0);
  } else {
    const std::vector<WaveComponent> components = wave_components(wave, gravity, record_path, what);
    double variance = 0, strokes = 0, slope = 0;
    const WaveComponent* greatest = &components.front();
    const std::optional<double> hinge = is_flap(wave) ? std::optional<double>(wave.hinge) : std::nullopt;
    for (const WaveComponent& component : components) {
      variance += 0.5 * component.amplitude * component.amplitude;
      if (component.amplitude > greatest->amplitude) greatest = &component;
      const double component_number = wave_number(component.angular_frequency, wave.depth, gravity);
      slope += component.amplitude * component_number;
      const double stroke = component.amplitude / wave_over_stroke(component_number, wave.depth, hinge);
      strokes += wave.kind == WaveKind::focused ? stroke : stroke * stroke;
    }
    if (wave.kind == WaveKind::record) {
      facts.height = 4.0 * std::sqrt(variance);
      facts.period = 2.0 * M_PI / greatest->angular_frequency;
    }
    // of a sea that which it is significantly: twice the root of the sum of squares is 4 standard deviations over √2
    facts.stroke = wave.kind == WaveKind::regular   ? 2.0 * std::sqrt(strokes)
                   : wave.kind == WaveKind::focused ? 2.0 * strokes
                                                    : 4.0 * std::sqrt(0.5 * strokes);
    const double k = wave_number(2.0 * M_PI / facts.period, wave.depth, gravity), kd = k * wave.depth;
    facts.wavelength = 2.0 * M_PI / k;
    facts.celerity = facts.wavelength / facts.period;
    facts.regime = kd < M_PI / 10 ? "shallow" : kd > M_PI ? "deep" : "intermediate";
    // a focused wave's height is that of its crest, to which Miche's law of trough to crest does not apply
    const bool focused = wave.kind == WaveKind::focused;
    facts.breaking = why_it_breaks(facts.height, wave.depth, focused ? 0.0 : k);
    if (focused && facts.breaking.empty()) facts.breaking = why_focus_breaks(slope, wave.depth, k);
  }
  facts.ursell = facts.height * facts.wavelength * facts.wavelength / std::pow(wave.depth, 3);
  facts.steepness = facts.height / facts.wavelength;
  return facts;
}

}  // namespace wavetank
