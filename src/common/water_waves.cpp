#include "wavetank/common/water_waves.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <tuple>

namespace wavetank {
namespace {

constexpr double mccowan = 0.78, miche = 0.142;

std::string metres(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g m", value);
  return text;
}

/// η and its first three derivatives.
struct Slopes {
  double value, first, second, third;
};

Slopes profile_of(const SolitaryProfile& wave, double along) {
  const double b = wave.outskirts, h = wave.height, tanh = std::tanh(b * along), sech2 = 1.0 - tanh * tanh;
  return {h * sech2, -2.0 * b * h * sech2 * tanh, b * b * h * sech2 * (4.0 - 6.0 * sech2),
          b * b * b * h * tanh * sech2 * (24.0 * sech2 - 8.0)};
}

/// Of the stream function (d + z) U + ((d + η)² (d + z) − (d + z)³)/6 U″ with the mean velocity U = cη/(d + η): the surface is a streamline
/// of what travels with the wave.
Eigen::Vector2d solitary_velocity(const WaveField& field, double along, double up) {
  const SolitaryProfile wave = solitary_profile(field.height, field.depth, field.gravity);
  const Slopes eta = profile_of(wave, along);
  const double total = wave.depth + eta.value, over_floor = wave.depth + up, flow = wave.celerity * wave.depth;
  const double mean = wave.celerity * eta.value / total, first = flow * eta.first / (total * total);
  const double second = flow * (eta.second / std::pow(total, 2) - 2.0 * eta.first * eta.first / std::pow(total, 3));
  const double third = flow * (eta.third / std::pow(total, 2) - 6.0 * eta.first * eta.second / std::pow(total, 3) +
                               6.0 * std::pow(eta.first, 3) / std::pow(total, 4));
  return {mean + (total * total / 6.0 - 0.5 * over_floor * over_floor) * second,
          -over_floor * (first + total * eta.first / 3.0 * second + (total * total - over_floor * over_floor) / 6.0 * third)};
}

}  // namespace

double wave_number(double angular_frequency, double depth, double gravity) {
  const double deep = angular_frequency * angular_frequency * depth / gravity;  // kd of deep water
  const auto excess = [deep](double kd) {
    const double tanh = std::tanh(kd);
    return std::make_tuple(kd * tanh - deep, tanh + kd * (1.0 - tanh * tanh));
  };
  // between deep and shallow water, both of which are too small for the other
  const double least = std::max(deep, std::sqrt(deep)) * (1 - 1e-12), most = least + 1.0;
  std::uintmax_t iterations = 60;
  return boost::math::tools::newton_raphson_iterate(excess, least, 0.0, most, 52, iterations) / depth;
}

std::string why_it_breaks(double height, double depth, double wave_number) {
  if (height > mccowan * depth) return "higher than McCowan's 0.78 of the depth, " + metres(mccowan * depth);
  if (!(wave_number > 0)) return "";
  const double steepest = miche * 2.0 * M_PI / wave_number * std::tanh(wave_number * depth);
  return height > steepest ? "higher than Miche's 0.142 L tanh kd, " + metres(steepest) : "";
}

std::string why_focus_breaks(double slope, double depth, double wave_number) {
  const double steepest = miche * M_PI * std::tanh(wave_number * depth);
  if (!(slope > steepest)) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "where they meet steeper than Miche has it: amplitudes times wave numbers are %.2f together, beyond %.2f, 0.142 π tanh kd",
                slope, steepest);
  return text;
}

SolitaryProfile solitary_profile(double height, double depth, double gravity) {
  return {height, depth, std::sqrt(3.0 * height / (4.0 * depth * depth * (depth + height))), std::sqrt(gravity * (depth + height))};
}

double WaveField::celerity() const {
  if (kind == Kind::solitary) return solitary_profile(height, depth, gravity).celerity;
  return std::sqrt(gravity / wave_number * std::tanh(wave_number * depth));
}

double WaveField::elevation(double along) const {
  if (kind == Kind::solitary) return profile_of(solitary_profile(height, depth, gravity), along).value;
  const double kd = wave_number * depth, angle = wave_number * along;
  double elevation = 0.5 * height * std::cos(angle);
  if (second_order)
    elevation += wave_number * height * height / 16.0 * std::cosh(kd) * (2.0 + std::cosh(2.0 * kd)) / std::pow(std::sinh(kd), 3) *
                 std::cos(2.0 * angle);
  return elevation;
}

Eigen::Vector2d WaveField::velocity(double along, double up) const {
  if (kind == Kind::standing) return Eigen::Vector2d::Zero();
  if (kind == Kind::solitary) return solitary_velocity(*this, along, up);
  const double k = wave_number, kd = k * depth, ks = k * (depth + up), angle = k * along, omega = k * celerity();
  const double first = 0.5 * height * omega / std::sinh(kd);
  Eigen::Vector2d velocity(first * std::cosh(ks) * std::cos(angle), first * std::sinh(ks) * std::sin(angle));
  if (second_order) {
    const double second = 3.0 / 16.0 * height * height * omega * k / std::pow(std::sinh(kd), 4);
    velocity += second * Eigen::Vector2d(std::cosh(2.0 * ks) * std::cos(2.0 * angle), std::sinh(2.0 * ks) * std::sin(2.0 * angle));
  }
  return velocity;
}

double WaveField::pressure_over_density(double along, double up) const {
  const double surface = elevation(along), hydrostatic = gravity * (surface - up);
  if (kind == Kind::standing) {
    const double k = wave_number;
    return hydrostatic + gravity * surface * (std::cosh(k * (depth + up)) - std::cosh(k * (depth + surface))) / std::cosh(k * depth);
  }
  const Eigen::Vector2d here = velocity(along, up), there = velocity(along, surface);
  return hydrostatic + celerity() * (here.x() - there.x()) - 0.5 * (here.squaredNorm() - there.squaredNorm());
}

}  // namespace wavetank
