#include "wave_absorption.h"

#include <algorithm>
#include <cmath>

#include "motion_terms.h"
#include "number_text.h"
#include "wave_maker.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double usual_recall = 4;         // periods
constexpr double greatest_of_a_sea = 1.9;  // of a thousand waves, over the significant one
constexpr double farthest_gauge = 0.25;    // of the wavelength: from there on what the paddle sends looks like what comes to it

/// From the value that a limit at `reach` leaves of a displacement: nearly all up to half of the reach, and never more than that.
Change within(const Change& free, double reach) {
  const double part = std::pow(free.value / reach, 4), grown = 1.0 + part;
  const double slope = std::pow(grown, -1.25);
  const double bend = free.value == 0.0 ? 0.0 : -5.0 * part / free.value * std::pow(grown, -2.25);
  return {free.value * std::pow(grown, -0.25), slope * free.rate, slope * free.acceleration + bend * free.rate * free.rate};
}

double angular_frequency_of(const WaveCase& wave, double gravity, const std::vector<WaveComponent>& components) {
  if (wave.kind == WaveKind::solitary) {
    const SolitaryProfile solitary = solitary_profile(wave.height, wave.depth, gravity);
    return solitary.outskirts * solitary.celerity;
  }
  if (wave.kind == WaveKind::regular) return 2.0 * M_PI / wave.period;
  if (wave.kind != WaveKind::record) return 2.0 * M_PI / wave.peak_period;
  return std::max_element(components.begin(), components.end(),
                          [](const WaveComponent& a, const WaveComponent& b) { return a.amplitude < b.amplitude; })
      ->angular_frequency;
}

}  // namespace

WaveAbsorption::WaveAbsorption(const WaveCase& wave, double gravity, const PaddlePlace& place, const std::string& record_path,
                               const std::string& what)
    : wave_(wave), gravity_(gravity), to_gauge_(place.gauge) {
  const std::string key = what + ": prescribed/waves/absorption";
  const WaveFacts facts = wave_facts(wave, gravity, record_path, what);
  const bool solitary = wave.kind == WaveKind::solitary;
  const double half = 0.5 * facts.stroke * (wave.kind == WaveKind::irregular || wave.kind == WaveKind::record ? greatest_of_a_sea : 1.0);
  const double forward = solitary ? facts.stroke : half, back = solitary ? 0.0 : half;
  if (!(to_gauge_ > forward))
    throw Error(key + "/gauge stands " + number_text(to_gauge_) + " m before the paddle at rest, which theory moves " +
                number_text(forward) + " m that way; it must stand farther before it");
  if (!solitary && to_gauge_ > farthest_gauge * facts.wavelength)
    throw Error(key + "/gauge stands " + number_text(to_gauge_) + " m before the paddle; it must be within a quarter of a wavelength, " +
                number_text(farthest_gauge * facts.wavelength) + " m");
  reach_ = wave.absorption->reach.value_or(std::min({place.behind - back, place.ahead - forward, to_gauge_ - forward}));
  if (!(reach_ > 0) || reach_ > place.behind - back)
    throw Error(key + " has no room: the tank leaves the paddle " + number_text(place.behind) + " m behind it, of which theory takes " +
                number_text(back) + " m" +
                (reach_ > 0 ? " and prescribed/waves/absorption/reach " + number_text(reach_) + " m" : std::string()));
  if (!solitary) components_ = wave_components(wave, gravity, record_path, what);
  for (const WaveComponent& component : components_)
    wave_numbers_.push_back(wavetank::wave_number(component.angular_frequency, wave.depth, gravity));
  const double omega = angular_frequency_of(wave, gravity, components_), k = wavetank::wave_number(omega, wave.depth, gravity);
  rise_ = wave.rise.value_or(2.0 * M_PI / omega);
  recall_ = wave.absorption->recall.value_or(usual_recall * 2.0 * M_PI / omega);
  // the high passes lead, the low passes lag: together they lag by the way from the gauge
  const double lead = std::atan(1.0 / (omega * recall_));
  delay_ = std::tan(std::min(0.5 * k * to_gauge_ + lead, 1.3)) / omega;
  const double passed = std::pow(std::cos(lead), 2) / (1.0 + std::pow(omega * delay_, 2));
  gain_ = omega / wave_over_stroke(k, wave.depth, std::nullopt) / passed;
}

double WaveAbsorption::expected(double time) const {
  if (wave_.kind == WaveKind::solitary) {
    const SolitaryWave solitary(wave_.height, wave_.depth, gravity_);
    const SolitaryProfile profile = solitary_profile(wave_.height, wave_.depth, gravity_);
    // the crest leaves the paddle's place at rest when the paddle, in the middle of its motion, is half a stroke before that
    const double since = time - 0.5 * solitary.duration() + 0.5 * solitary.stroke() / profile.celerity;
    return wave_.height / std::pow(std::cosh(profile.outskirts * (to_gauge_ - profile.celerity * since)), 2);
  }
  double elevation = 0;
  for (std::size_t n = 0; n < components_.size(); ++n) {
    const WaveComponent& component = components_[n];
    const double k = wave_numbers_[n], since = time - k * to_gauge_ / component.angular_frequency;
    if (since <= 0) continue;
    const double grown = smooth_rise(since, 0.0, rise_).value, phase = component.angular_frequency * since + component.phase;
    WaveField field;
    field.depth = wave_.depth;
    field.height = 2.0 * component.amplitude * grown;
    field.wave_number = k;
    field.gravity = gravity_;
    field.second_order = wave_.kind == WaveKind::regular;  // what is bound to it does not come back
    elevation += field.elevation(-phase / k);
  }
  return elevation;
}

void WaveAbsorption::see(double time, double level) {
  seen_ = level - expected(time);
  if (!started_) mean_ = seen_;
  started_ = true;
  time_ = time;
}

double WaveAbsorption::acceleration() const { return -gain_ * (first_ - second_) / delay_ - velocity_ / recall_; }

Change WaveAbsorption::at(double time) const {
  const double since = time - time_, acceleration = this->acceleration();
  return within({displacement_ + since * (velocity_ + 0.5 * since * acceleration), velocity_ + since * acceleration, acceleration}, reach_);
}

void WaveAbsorption::advance(double time, double time_step) {
  const double acceleration = this->acceleration(), passed = seen_ - mean_;
  displacement_ += time_step * (velocity_ + 0.5 * time_step * acceleration);
  velocity_ += time_step * acceleration;
  second_ += time_step * (first_ - second_) / delay_;
  first_ += time_step * (passed - first_) / delay_;
  mean_ += time_step * passed / recall_;
  time_ = time + time_step;
}

double WaveAbsorption::taken() const { return std::abs(within({displacement_, 0.0, 0.0}, reach_).value) / reach_; }

std::vector<double> WaveAbsorption::save() const {
  return {started_ ? 1.0 : 0.0, time_, seen_, mean_, first_, second_, displacement_, velocity_};
}

void WaveAbsorption::restore(const double* values) {
  started_ = values[0] != 0;
  double* const state[] = {&time_, &seen_, &mean_, &first_, &second_, &displacement_, &velocity_};
  for (double* number : state) *number = *++values;
}

}  // namespace wavetank
