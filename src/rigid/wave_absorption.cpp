#include "wave_absorption.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>

#include "motion_terms.h"
#include "number_text.h"
#include "wave_maker.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double usual_recall = 4;         // periods
constexpr double greatest_of_a_sea = 1.9;  // of a thousand waves, over the significant one
constexpr double farthest_gauge = 0.15;    // of the wavelength: nearer to a quarter what the paddle sends looks like what comes to it
constexpr double least_damping = 0.4, greatest_damping = 1.2, damping_step = 0.05;  // of the low pass, over the critical one
constexpr double first_asked = 0.05, last_asked = 8, asked_step = 0.05;  // of the waves' frequency, where the filter is looked at

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

/// How far the paddle may go from where theory has it, m. `forward` and `back`: how far theory takes it.
double reach_in(const std::string& key, const PaddlePlace& place, double forward, double back, const std::optional<double>& given) {
  struct Room {
    double left;
    std::string what;
  };
  const Room rooms[] = {{place.behind - back, "the tank leaves the paddle " + number_text(place.behind) +
                                                  " m behind it, of which theory takes " + number_text(back) + " m"},
                        {place.ahead - forward, "the tank leaves the paddle " + number_text(place.ahead) +
                                                    " m before it, of which theory takes " + number_text(forward) + " m"},
                        {place.gauge - forward, "the gauge stands " + number_text(place.gauge) +
                                                    " m before the paddle, of which theory takes " + number_text(forward) + " m"}};
  const Room& least = *std::min_element(std::begin(rooms), std::end(rooms), [](const Room& a, const Room& b) { return a.left < b.left; });
  if (!(least.left > 0)) throw Error(key + " has no room: " + least.what);
  if (given && *given > least.left)
    throw Error(key + "/reach is " + number_text(*given) + " m, but " + least.what + "; it must be at most " + number_text(least.left) +
                " m");
  return given.value_or(least.left);
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
  if (!solitary) components_ = wave_components(wave, gravity, record_path, what);
  for (const WaveComponent& component : components_)
    wave_numbers_.push_back(wavetank::wave_number(component.angular_frequency, wave.depth, gravity));
  const double omega = angular_frequency_of(wave, gravity, components_);
  const double farthest = farthest_gauge * 2.0 * M_PI / wavetank::wave_number(omega, wave.depth, gravity);
  if (!(to_gauge_ > forward))
    throw Error(key + "/gauge stands " + number_text(to_gauge_) + " m before the paddle at rest, which theory moves " +
                number_text(forward) + " m that way; it must stand farther before it");
  if (to_gauge_ > farthest)
    throw Error(key + "/gauge stands " + number_text(to_gauge_) + " m before the paddle; it must be within " + number_text(farthest_gauge) +
                " of a wavelength, " + number_text(farthest) + " m");
  reach_ = reach_in(key, place, forward, back, wave.absorption->reach);
  rise_ = wave.rise.value_or(2.0 * M_PI / omega);
  recall_ = wave.absorption->recall.value_or(usual_recall * 2.0 * M_PI / omega);
  if (!choose_filter(omega))
    throw Error(key + "/recall is " + number_text(recall_) +
                " s, with which the paddle would answer to its own waves without end; make it " + "longer: four periods are usual, " +
                number_text(usual_recall * 2.0 * M_PI / omega) + " s");
}

/// Shorter waves take longer to come to the paddle, in their own periods, and the paddle that answers to them too late sends them back
/// enlarged. A low pass of the second order is past its cut there, and lags by more than half a period; its damping is a compromise.
bool WaveAbsorption::choose_filter(double omega) {
  const double k = wavetank::wave_number(omega, wave_.depth, gravity_);
  // the high passes lead, the low pass lags: together they lag by the way from the gauge
  const double lag = k * to_gauge_ + 2.0 * std::atan(1.0 / (omega * recall_));
  if (!(lag < M_PI)) return false;  // more than such a low pass has
  const auto largest_sent = [&] {   // none where what the gauge sees of the paddle's own waves could feed them
    double largest = 0;
    for (double ratio = first_asked; ratio < last_asked; ratio += asked_step) {
      const double asked = ratio * omega, way = wavetank::wave_number(asked, wave_.depth, gravity_) * to_gauge_;
      if (!((1.0 + answer(asked) * std::polar(1.0, -way)).real() > 0)) return std::numeric_limits<double>::infinity();
      if (ratio >= 1) largest = std::max(largest, sent_back(asked));
    }
    return largest;
  };
  double best = 0, least = std::numeric_limits<double>::infinity();
  for (double damping = least_damping; damping < greatest_damping + 0.5 * damping_step; damping += damping_step) {
    set_filter(omega, lag, damping);
    const double sent = largest_sent();
    if (sent < least) least = sent, best = damping;
  }
  if (!(best > 0)) return false;
  set_filter(omega, lag, best);
  return true;
}

void WaveAbsorption::set_filter(double omega, double lag, double damping) {
  damping_ = damping;
  // the lag's tangent is 2ζ ω ω_c / (ω_c² − ω²)
  const double part = damping / std::tan(lag);
  cut_ = omega * (part + std::sqrt(part * part + 1.0));
  gain_ = 1.0;
  gain_ = 1.0 / std::abs(answer(omega));
}

std::complex<double> WaveAbsorption::answer(double omega) const {
  const std::complex<double> s(0.0, omega), high = s * recall_ / (1.0 + s * recall_);
  const std::complex<double> low = cut_ * cut_ / (cut_ * cut_ + s * (2.0 * damping_ * cut_ + s));
  const double k = wavetank::wave_number(omega, wave_.depth, gravity_);
  return gain_ * wave_over_stroke(k, wave_.depth, std::nullopt) / omega * high * high * low;
}

double WaveAbsorption::sent_back(double omega) const {
  const double way = wavetank::wave_number(omega, wave_.depth, gravity_) * to_gauge_;
  const std::complex<double> taken = answer(omega);
  return std::abs(1.0 - taken * std::polar(1.0, way)) / std::abs(1.0 + taken * std::polar(1.0, -way));
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

double WaveAbsorption::acceleration() const { return -gain_ * passed_rate_ - velocity_ / recall_; }

Change WaveAbsorption::at(double time) const {
  const double since = time - time_, acceleration = this->acceleration();
  return within({displacement_ + since * (velocity_ + 0.5 * since * acceleration), velocity_ + since * acceleration, acceleration}, reach_);
}

void WaveAbsorption::advance(double time, double time_step) {
  const double acceleration = this->acceleration(), come = seen_ - mean_;
  displacement_ += time_step * (velocity_ + 0.5 * time_step * acceleration);
  velocity_ += time_step * acceleration;
  passed_rate_ += time_step * cut_ * (cut_ * (come - passed_) - 2.0 * damping_ * passed_rate_);
  passed_ += time_step * passed_rate_;  // by the new rate, so that the low pass rings no longer than it should
  mean_ += time_step * come / recall_;
  time_ = time + time_step;
}

double WaveAbsorption::taken() const { return std::abs(within({displacement_, 0.0, 0.0}, reach_).value) / reach_; }

std::vector<double> WaveAbsorption::settings() const { return {gain_, cut_, damping_, recall_, reach_, to_gauge_}; }

std::vector<double> WaveAbsorption::save() const {
  return {started_ ? 1.0 : 0.0, time_, seen_, mean_, passed_, passed_rate_, displacement_, velocity_};
}

void WaveAbsorption::restore(const double* values) {
  started_ = values[0] != 0;
  double* const state[] = {&time_, &seen_, &mean_, &passed_, &passed_rate_, &displacement_, &velocity_};
  for (double* number : state) *number = *++values;
}

}  // namespace wavetank
