#include "wave_maker.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "wavetank/rigid/wave_theory.h"

namespace wavetank {
namespace {

constexpr double edge = 4.2;             // θ at which the paddle starts for a solitary wave: sech² is 1e-3
constexpr double samples_per_wave = 40;  // of the highest component
constexpr double least_share_of_speed = 1e-9;

/// e sin(ωt + φ), m.
struct Stroke {
  double amplitude = 0, angular_frequency = 0, phase = 0;
};

Change sum_of(const std::vector<Stroke>& strokes, double time) {
  Change sum;
  for (const Stroke& stroke : strokes) {
    const double angle = stroke.angular_frequency * time + stroke.phase, rate = stroke.amplitude * stroke.angular_frequency;
    sum.value += stroke.amplitude * std::sin(angle);
    sum.rate += rate * std::cos(angle);
    sum.acceleration -= rate * stroke.angular_frequency * std::sin(angle);
  }
  return sum;
}

/// The angle of a flap whose place at the still level is so far from upright.
Change angle_of(const Change& place, double arm) {
  const double q = place.value / arm, rate = place.rate / arm, bend = 1.0 + q * q;
  return {std::atan(q), rate / bend, place.acceleration / (arm * bend) - 2.0 * q * rate * rate / (bend * bend)};
}

/// With twice the frequency, of a piston.
Stroke second_order(const WaveCase& wave, const Stroke& first, double k) {
  const double kd = k * wave.depth, over_stroke = wave_over_stroke(k, wave.depth, std::nullopt);
  Stroke second;
  second.amplitude =
      wave.height * wave.height / (32.0 * wave.depth) * (3.0 / (std::tanh(kd) * std::pow(std::sinh(kd), 2)) - 2.0 / over_stroke);
  second.angular_frequency = 2.0 * first.angular_frequency;
  second.phase = 2.0 * first.phase;
  if (wave.reversed) second.amplitude = -second.amplitude;
  return second;
}

}  // namespace

bool is_flap(const WaveCase& wave) { return wave.direction == Direction::pitch || wave.direction == Direction::angle; }

SolitaryWave::SolitaryWave(double height, double depth, double gravity)
    : height_(height),
      depth_(depth),
      outskirts_(solitary_profile(height, depth, gravity).outskirts),
      celerity_(solitary_profile(height, depth, gravity).celerity) {}

double SolitaryWave::duration() const { return (2.0 * edge / outskirts_ + stroke() * std::tanh(edge)) / celerity_; }

/// With θ = β(ct − x), x = H/(βd) tanh θ: cβt = θ + H/d tanh θ, from the middle of the motion on.
Change SolitaryWave::paddle_at(double time) const {
  const double half = 0.5 * stroke(), from_middle = time - 0.5 * duration();
  const double start = -half * std::tanh(edge);
  if (std::abs(from_middle) >= 0.5 * duration()) return {from_middle < 0 ? 0.0 : -2.0 * start, 0.0, 0.0};
  const double ratio = height_ / depth_, target = celerity_ * outskirts_ * from_middle;
  const auto excess = [&](double theta) {
    const double tanh = std::tanh(theta);
    return std::make_tuple(theta + ratio * tanh - target, 1.0 + ratio * (1.0 - tanh * tanh));
  };
  std::uintmax_t iterations = 60;
  const double theta = boost::math::tools::newton_raphson_iterate(excess, target / (1.0 + ratio), -edge, edge, 52, iterations);
  const double tanh = std::tanh(theta), sech2 = 1.0 - tanh * tanh, eta = height_ * sech2;
  const double turning = celerity_ * outskirts_ * depth_ / (depth_ + eta);  // θ̇
  const double eta_rate = -2.0 * eta * tanh * turning;
  return {half * tanh - start, celerity_ * eta / (depth_ + eta), celerity_ * depth_ * eta_rate / std::pow(depth_ + eta, 2)};
}

MotionTerm wave_term(const WaveCase& wave, double gravity, const std::string& record_path, const std::string& what) {
  const double sign = wave.reversed ? -1.0 : 1.0;
  if (wave.kind == WaveKind::solitary) {
    const SolitaryWave solitary(wave.height, wave.depth, gravity);
    const auto at = [solitary, sign](double time) {
      const Change change = solitary.paddle_at(time);
      return Change{sign * change.value, sign * change.rate, sign * change.acceleration};
    };
    return {wave.direction, at, solitary.duration() / (2 * samples_per_wave)};
  }
  const std::optional<double> hinge = is_flap(wave) ? std::optional<double>(wave.hinge) : std::nullopt;
  std::vector<Stroke> strokes;
  double highest = 0, period = wave.kind == WaveKind::regular ? wave.period : wave.peak_period, greatest = 0;
  for (const WaveComponent& component : wave_components(wave, gravity, record_path, what)) {
    const double k = wave_number(component.angular_frequency, wave.depth, gravity);
    const double over_stroke = wave_over_stroke(k, wave.depth, hinge);
    if (over_stroke < least_share_of_speed) continue;  // no paddle makes it
    // where a paddle's velocity is greatest, so is the surface before it
    strokes.push_back({sign * component.amplitude / over_stroke, component.angular_frequency, component.phase});
    if (wave.order == 2) strokes.push_back(second_order(wave, strokes.back(), k));
    highest = std::max(highest, strokes.back().angular_frequency);
    if (wave.kind == WaveKind::record && component.amplitude > greatest) {
      greatest = component.amplitude;
      period = 2.0 * M_PI / component.angular_frequency;
    }
  }
  const double rise = wave.rise.value_or(period);
  const double arm = hinge ? wave.depth - *hinge : 0.0;
  const auto at = [strokes, rise, arm](double time) {
    Change place = sum_of(strokes, time);
    if (time < rise) {
      const Change grown = smooth_rise(time, 0.0, rise);
      place = {place.value * grown.value, place.rate * grown.value + place.value * grown.rate,
               place.acceleration * grown.value + 2.0 * place.rate * grown.rate + place.value * grown.acceleration};
    }
    return arm > 0 ? angle_of(place, arm) : place;
  };
  return {wave.direction, at, std::min(2.0 * M_PI / (samples_per_wave * highest), rise / samples_per_wave)};
}

}  // namespace wavetank
