#include "motion_values.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

namespace wavetank::scene {
namespace {

const std::vector<std::pair<std::string, Direction>>& directions() {
  static const std::vector<std::pair<std::string, Direction>> words{
      {"surge", Direction::surge}, {"sway", Direction::sway}, {"heave", Direction::heave},   {"roll", Direction::roll},
      {"pitch", Direction::pitch}, {"yaw", Direction::yaw},   {"stroke", Direction::stroke}, {"angle", Direction::angle}};
  return words;
}

// Of [low, high], with the start between them; neither further off than `greatest`.
std::string describe_limits(double greatest) {
  const Range low{-greatest, 0}, high{0, greatest};
  return "low " + low.describe() + ", the start, and high " + high.describe();
}

std::array<double, 2> read_limits(const Setting& setting, const Item& item, double greatest) {
  const auto numbers = numbers_of(setting, item, 2, 2, "2 numbers [low, high]");
  const double low = numbers[0], high = numbers[1];
  if (low > 0 || high < 0 || std::max(-low, high) > greatest) refuse(setting, item, "[low, high] with " + describe_limits(greatest));
  return {low, high};
}

bool is_positive_definite(const std::array<double, 6>& inertia) {
  const auto& [xx, yy, zz, xy, xz, yz] = inertia;
  Eigen::Matrix3d matrix;
  matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() > 0;
}

std::array<double, 6> read_inertia(const Setting& setting, const Item& item, Context& context) {
  const std::string six = "6 numbers [xx, yy, zz, xy, xz, yz]";
  if (context.dimensions == 2 && setting.kind == Setting::Kind::scalar) {
    const double yy = number(greater_than(0)).read(setting, item, context);
    return {yy, yy, yy, 0, 0, 0};
  }
  const auto numbers = numbers_of(setting, item, 6, 6, context.dimensions == 2 ? "a number (yy) or " + six : six);
  std::array<double, 6> inertia{};
  std::copy(numbers.begin(), numbers.end(), inertia.begin());
  if (context.dimensions == 2) {
    if (!(inertia[1] > 0)) refuse(setting, item, six + " with yy greater than 0");
  } else if (!is_positive_definite(inertia)) {
    refuse(setting, item, six + " of a positive definite matrix");
  }
  return inertia;
}

}  // namespace

Codec<double> angle() {
  Codec<double> codec = number({});
  codec.read = [read = codec.read](const Setting& setting, const Item& item, Context& context) {
    return read(setting, item, context) * degree;
  };
  codec.write = [write = codec.write](const double& value, const Context& context) { return write(in_degrees(value), context); };
  return codec;
}

Codec<std::array<double, 2>> limits() {
  constexpr double greatest = std::numeric_limits<double>::infinity();
  return {"[low, high]", describe_limits(greatest),
          [](const Setting& setting, const Item& item, Context&) { return read_limits(setting, item, greatest); },
          [](const std::array<double, 2>& value, const Context&) -> std::optional<Setting> {
            return list_of_numbers({value[0], value[1]});
          }};
}

Codec<std::array<double, 2>> angle_limits(double greatest) {
  return {"[low, high]", describe_limits(greatest),
          [greatest](const Setting& setting, const Item& item, Context&) -> std::array<double, 2> {
            const auto degrees = read_limits(setting, item, greatest);
            return {degrees[0] * degree, degrees[1] * degree};
          },
          [](const std::array<double, 2>& value, const Context&) -> std::optional<Setting> {
            return list_of_numbers({in_degrees(value[0]), in_degrees(value[1])});
          }};
}

Codec<Vector3d> vector_in_plane() {
  Codec<Vector3d> codec = vector();
  codec.read = [read = codec.read](const Setting& setting, const Item& item, Context& context) {
    const Vector3d vector = read(setting, item, context);
    if (context.dimensions == 2 && vector.y() != 0) refuse(setting, item, "within the x–z plane of a 2-D case, [x, 0, z] or [x, z]");
    return vector;
  };
  return codec;
}

Codec<Vector3d> vector_about() {
  Codec<Vector3d> codec = vector();
  codec.read = [](const Setting& setting, const Item& item, Context& context) {
    const bool flat = context.dimensions == 2;
    if (flat && setting.kind == Setting::Kind::scalar) return Vector3d(0, number({}).read(setting, item, context), 0);
    const auto numbers = numbers_of(setting, item, 3, 3, flat ? "a number about y, or [0, y, 0]" : "3 numbers [x, y, z]");
    if (flat && (numbers[0] != 0 || numbers[2] != 0)) refuse(setting, item, "about y alone in a 2-D case, a number or [0, y, 0]");
    return Vector3d(numbers[0], numbers[1], numbers[2]);
  };
  return codec;
}

Codec<Vector3d> axis() {
  Codec<Vector3d> codec = vector();
  codec.allowed = "not all 0";
  codec.read = [read = codec.read](const Setting& setting, const Item& item, Context& context) {
    const Vector3d vector = read(setting, item, context);
    if (vector.isZero(0.0)) refuse(setting, item, "of a length greater than 0");
    return vector;
  };
  return codec;
}

Codec<Direction> direction() {
  Codec<Direction> codec = choice<Direction>(directions());
  codec.read = [read = codec.read](const Setting& setting, const Item& item, Context& context) {
    const bool flat = context.dimensions == 2 && setting.kind == Setting::Kind::scalar;
    if (flat && (setting.text == "sway" || setting.text == "roll" || setting.text == "yaw"))
      refuse(setting, item, "one of surge, heave, pitch, stroke, angle in a 2-D case");
    return read(setting, item, context);
  };
  return codec;
}

Codec<std::array<double, 6>> inertia() {
  return {"[xx, yy, zz, xy, xz, yz]", "positive definite", read_inertia,
          [](const std::array<double, 6>& value, const Context&) -> std::optional<Setting> {
            return list_of_numbers({value.begin(), value.end()});
          }};
}

Codec<Motion> motion_word() {
  return choice<Motion>(
      {{"fixed", Motion::fixed}, {"free", Motion::free}, {"prescribed", Motion::prescribed}, {"commanded", Motion::commanded}});
}

std::optional<Direction> direction_named(const std::string& word) {
  for (const auto& [name, value] : directions()) {
    if (name == word) return value;
  }
  return std::nullopt;
}

bool is_rotation(Direction direction) {
  return direction == Direction::roll || direction == Direction::pitch || direction == Direction::yaw || direction == Direction::angle;
}

}  // namespace wavetank::scene
