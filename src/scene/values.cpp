#include "values.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <regex>
#include <sstream>

namespace wavetank::scene {
namespace {

enum class Reading { number, not_finite, not_a_number };

// Beyond these no length, mass, time or stiffness in SI units makes sense, and single precision, which the device computes in, soon ends.
constexpr double greatest_number = 1e15, least_above_zero = 1e-20;
constexpr double least_mass = 1e-35;  // kg or kg·m²: the inertia of a grain of 10 µm is 1e-22

Reading read_number(const Setting& setting, double& number) {
  if (setting.kind != Setting::Kind::scalar) return Reading::not_a_number;
  static const std::regex infinite(R"(\s*[-+]?\.?(inf|infinity|nan)\s*)", std::regex::icase);
  static const std::regex decimal(R"(\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*)");
  if (setting.text.size() > 100) return Reading::not_a_number;  // std::regex recurses once a character
  if (std::regex_match(setting.text, infinite)) return Reading::not_finite;
  if (!std::regex_match(setting.text, decimal)) return Reading::not_a_number;
  std::istringstream in(setting.text);
  in.imbue(std::locale::classic());
  in >> number;
  return in.fail() || !std::isfinite(number) ? Reading::not_finite : Reading::number;
}

double finite_number(const Setting& setting, const Item& item, const std::string& demand) {
  double number = 0;
  switch (read_number(setting, number)) {
    case Reading::number:
      if (std::abs(number) > greatest_number) refuse(setting, item, "a number from -1e15 to 1e15");
      return number;
    case Reading::not_finite:
      refuse(setting, item, "a finite number");
    case Reading::not_a_number:
      break;
  }
  refuse(setting, item, demand);
}

// A number that was read.
void check_range(double number, const Setting& setting, const Item& item, const Range& range, const std::string& or_word = "") {
  const std::string end = or_word.empty() ? "" : ", " + or_word;
  if (!range.contains(number)) refuse(setting, item, range.describe() + end);
  const double least = item.unit == "kg" || item.unit == "kg·m²" ? least_mass : least_above_zero;
  if (range.above_least && range.least == 0 && number < least) refuse(setting, item, "at least " + number_text(least) + end);
}

std::string number_demand(const Range& range, const std::string& kind) {
  return range.describe().empty() ? kind : kind + " " + range.describe();
}

double number_in_range(const Setting& setting, const Item& item, const Range& range) {
  const double number = finite_number(setting, item, number_demand(range, "a number"));
  check_range(number, setting, item, range);
  return number;
}

double whole_number_in_range(const Setting& setting, const Item& item, const Range& range) {
  const double number = finite_number(setting, item, number_demand(range, "a whole number"));
  if (number != std::floor(number)) refuse(setting, item, number_demand(range, "a whole number"));
  if (!range.contains(number)) refuse(setting, item, range.describe());
  return number;
}

Setting number_setting(double number) { return Setting::scalar(number_text(number)); }

Setting vector_setting(const Vector3d& vector, int count = 3) { return list_of_numbers({vector.data(), vector.data() + count}); }

Vector3d read_vector(const Setting& setting, const Item& item, const Context& context) {
  const bool flat = context.dimensions == 2;
  const auto numbers = numbers_of(setting, item, flat ? 2 : 3, 3, flat ? "numbers [x, z] or [x, y, z]" : "3 numbers [x, y, z]");
  return numbers.size() == 2 ? Vector3d(numbers[0], 0.0, numbers[1]) : Vector3d(numbers[0], numbers[1], numbers[2]);
}

Vector3d read_position(const Setting& setting, const Item& item, const Context& context) {
  Vector3d position = read_vector(setting, item, context);
  if (context.dimensions == 2) position.y() = 0.0;
  return position;
}

std::optional<Setting> write_vector(const Vector3d& vector, const Context&) { return vector_setting(vector); }

Codec<std::string> matching_text(const std::string& type, const std::string& pattern, const std::string& demand) {
  return {type, demand,
          [expression = std::regex(pattern), demand](const Setting& setting, const Item& item, Context&) {
            const bool fits =
                setting.kind == Setting::Kind::scalar && setting.text.size() <= 200 && std::regex_match(setting.text, expression);
            if (!fits) refuse(setting, item, demand);
            return setting.text;
          },
          [](const std::string& value, const Context&) -> std::optional<Setting> { return Setting::string(value); }};
}

// A number, or a word that stands for none.
Codec<std::optional<double>> number_or(const std::string& word, Range range) {
  const std::string or_word = "or " + word;
  return {"number " + or_word, range.describe() + "; " + or_word,
          [range, word, or_word](const Setting& setting, const Item& item, Context&) -> std::optional<double> {
            if (setting.kind == Setting::Kind::scalar && setting.text == word) return std::nullopt;
            double number = 0;
            const std::string demand = number_demand(range, "a number") + ", " + or_word;
            if (read_number(setting, number) == Reading::not_a_number) refuse(setting, item, demand);
            number = finite_number(setting, item, demand);
            check_range(number, setting, item, range, or_word);
            return number;
          },
          [word](const std::optional<double>& value, const Context&) -> std::optional<Setting> {
            return value ? number_setting(*value) : Setting::string(word);
          }};
}

}  // namespace

std::string number_text(double number) {
  for (int digits = 15;; ++digits) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out.precision(digits);
    out << number;
    if (digits == 17) return out.str();
    std::istringstream in(out.str());
    in.imbue(std::locale::classic());
    double back = 0;
    in >> back;
    if (back == number) return out.str();
  }
}

double in_degrees(double radians) {
  const double degrees = radians / degree;
  return std::abs(degrees) < 1e3 ? std::round(degrees * 1e12) / 1e12 : degrees;
}

void refuse(const Setting& given, const Item& item, const std::string& allowed) {
  const std::string unit = item.unit.empty() ? "" : " (" + item.unit + ")";
  throw Error(given.place.describe() + ": " + item.path + " is " + given.brief() + "; it must be " + allowed + unit);
}

void refuse_key(const Setting& map, const std::string& path, const std::string& name, const std::string& text) {
  const Setting* given = map.find(name);
  throw Error((given != nullptr ? *given : map).place.describe() + ": " + join_path(path, name) + " " + text);
}

void refuse_vector(const Setting& map, const std::string& path, const std::string& name, const Vector3d& value,
                   const std::string& allowed) {
  refuse_key(map, path, name,
             "is " + vector_setting(value).brief() + (map.find(name) == nullptr ? ", the default" : "") + "; it must be " + allowed);
}

std::vector<double> numbers_of(const Setting& setting, const Item& item, std::size_t least, std::size_t greatest,
                               const std::string& demand) {
  if (setting.kind != Setting::Kind::list || setting.items.size() < least || setting.items.size() > greatest) refuse(setting, item, demand);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < setting.items.size(); ++i) {
    numbers.push_back(finite_number(setting.items[i], {join_path(item.path, i), item.unit}, "a number"));
  }
  return numbers;
}

Setting list_of_numbers(const std::vector<double>& numbers) {
  std::vector<Setting> settings;
  settings.reserve(numbers.size());
  for (const double number : numbers) settings.push_back(number_setting(number));
  return Setting::list(std::move(settings));
}

bool Range::contains(double value) const { return (above_least ? value > least : value >= least) && value <= greatest; }

std::string Range::describe() const {
  const bool below = std::isfinite(least), above = std::isfinite(greatest);
  if (below && above) {
    return above_least ? "greater than " + number_text(least) + " and at most " + number_text(greatest)
                       : "from " + number_text(least) + " to " + number_text(greatest);
  }
  if (below) return (above_least ? "greater than " : "at least ") + number_text(least);
  return above ? "at most " + number_text(greatest) : "";
}

Codec<double> number(Range range) {
  return {"number", range.describe(),
          [range](const Setting& setting, const Item& item, Context&) { return number_in_range(setting, item, range); },
          [](const double& value, const Context&) -> std::optional<Setting> { return number_setting(value); }};
}

Codec<std::optional<double>> number_or_auto(Range range) { return number_or("auto", range); }

Codec<std::optional<double>> number_or_none(Range range) { return number_or("none", range); }

Codec<std::optional<double>> number_if_given(Range range) {
  return {"number", range.describe(),
          [range](const Setting& setting, const Item& item, Context&) -> std::optional<double> {
            return number_in_range(setting, item, range);
          },
          [](const std::optional<double>& value, const Context&) -> std::optional<Setting> {
            if (!value) return std::nullopt;
            return number_setting(*value);
          }};
}

Codec<int> whole_number(Range range) {
  return {
      "whole number", range.describe(),
      [range](const Setting& setting, const Item& item, Context&) { return static_cast<int>(whole_number_in_range(setting, item, range)); },
      [](const int& value, const Context&) -> std::optional<Setting> { return Setting::scalar(std::to_string(value)); }};
}

Codec<std::optional<std::size_t>> count_if_given(Range range) {
  return {"whole number", range.describe(),
          [range](const Setting& setting, const Item& item, Context&) -> std::optional<std::size_t> {
            return static_cast<std::size_t>(whole_number_in_range(setting, item, range));
          },
          [](const std::optional<std::size_t>& value, const Context&) -> std::optional<Setting> {
            if (!value) return std::nullopt;
            return Setting::scalar(std::to_string(*value));
          }};
}

Codec<int> dimension_count() {
  return {"whole number", "2 or 3",
          [](const Setting& setting, const Item& item, Context& context) {
            const double number = finite_number(setting, item, "2 or 3");
            if (number != 2 && number != 3) refuse(setting, item, "2 or 3");
            return context.dimensions = static_cast<int>(number);
          },
          [](const int& value, const Context&) -> std::optional<Setting> { return Setting::scalar(std::to_string(value)); }};
}

Codec<bool> flag() {
  return {"true or false", "",
          [](const Setting& setting, const Item& item, Context&) {
            const bool scalar = setting.kind == Setting::Kind::scalar;
            if (scalar && (setting.text == "true" || setting.text == "True")) return true;
            if (scalar && (setting.text == "false" || setting.text == "False")) return false;
            refuse(setting, item, "true or false");
          },
          [](const bool& value, const Context&) -> std::optional<Setting> { return Setting::scalar(value ? "true" : "false"); }};
}

Codec<std::string> text() {
  return {"text", "",
          [](const Setting& setting, const Item& item, Context&) {
            if (setting.kind != Setting::Kind::scalar) refuse(setting, item, "text");
            return setting.text;
          },
          [](const std::string& value, const Context&) -> std::optional<Setting> { return Setting::string(value); }};
}

Codec<std::string> nonempty_text() {
  Codec<std::string> codec = text();
  codec.read = [](const Setting& setting, const Item& item, Context&) {
    if (setting.kind != Setting::Kind::scalar || setting.text.empty()) refuse(setting, item, "text that is not empty");
    return setting.text;
  };
  return codec;
}

Codec<std::string> expression(Expression::Of of) {
  Codec<std::string> codec = text();
  codec.type = "expression";
  codec.read = [of](const Setting& setting, const Item& item, Context&) {
    if (setting.kind != Setting::Kind::scalar || setting.text.empty())
      refuse(setting, item, std::string("an expression of ") + Expression::variables(of));
    try {
      Expression(setting.text, of);
    } catch (const Error& wrong) {
      throw Error(setting.place.describe() + ": " + item.path + ": " + wrong.what());
    }
    return setting.text;
  };
  codec.write = [](const std::string& value, const Context&) {
    return value.empty() ? std::nullopt : std::optional<Setting>(Setting::string(value));
  };
  return codec;
}

Codec<std::string> name() {
  return matching_text("name", "[A-Za-z][A-Za-z0-9_]*",
                       "a letter followed by letters, digits and underscores (it becomes part of a topic's name)");
}

Codec<std::string> frame() {
  return matching_text("name", "[A-Za-z][A-Za-z0-9_]*(/[A-Za-z0-9_]+)*",
                       "a tf frame: a letter followed by letters, digits, underscores and single slashes");
}

Codec<Vector3d> vector() { return {"[x, y, z]", "", read_vector, write_vector}; }

Codec<Vector3d> position() { return {"[x, y, z]", "", read_position, write_vector}; }

Codec<Vector3d> size() {
  return {"[x, y, z]", "each greater than 0",
          [](const Setting& setting, const Item& item, Context& context) {
            const Vector3d size = read_position(setting, item, context);
            const bool flat = context.dimensions == 2;
            if (!(size.x() > 0 && size.z() > 0 && (flat || size.y() > 0))) refuse(setting, item, "greater than 0 in every direction");
            return size;
          },
          write_vector};
}

Codec<Vector3d> scale() {
  const std::string each = "each other than 0";
  return {"number or [x, y, z]", "greater than 0; or " + each,
          [each](const Setting& setting, const Item& item, Context&) -> Vector3d {
            const std::string demand = "a number greater than 0, or three along x, y and z, " + each;
            if (setting.kind != Setting::Kind::list) return Vector3d::Constant(number_in_range(setting, item, greater_than(0)));
            const std::vector<double> numbers = numbers_of(setting, item, 3, 3, demand);
            const Vector3d scale(numbers[0], numbers[1], numbers[2]);
            if ((scale.array() == 0).any()) refuse(setting, item, demand);
            return scale;
          },
          [](const Vector3d& value, const Context&) -> std::optional<Setting> {
            const bool even = value.x() > 0 && value == Vector3d::Constant(value.x());
            return even ? number_setting(value.x()) : vector_setting(value);
          }};
}

Codec<Vector3d> gauge_position() {
  return {"[x, y]", "",
          [](const Setting& setting, const Item& item, Context& context) {
            const bool flat = context.dimensions == 2;
            const auto numbers =
                numbers_of(setting, item, flat ? 1 : 2, 3, flat ? "numbers [x], [x, z] or [x, y, z]" : "numbers [x, y] or [x, y, z]");
            return Vector3d(numbers[0], flat ? 0.0 : numbers[1], 0.0);  // place_gauges sets those of other axes
          },
          [](const Vector3d& value, const Context& context) -> std::optional<Setting> {
            const bool short_form = value.z() == 0 && (value.x() != 0 || value.y() == 0);  // with gravity along x, two numbers are y and z
            return vector_setting(value, !short_form ? 3 : context.dimensions == 2 ? 1 : 2);
          }};
}

Codec<std::array<bool, 3>> axes() {
  return {"list of x, y, z", "",
          [](const Setting& setting, const Item& item, Context& context) {
            const std::string demand = context.dimensions == 2 ? "a list of the letters x and z" : "a list of the letters x, y and z";
            if (setting.kind != Setting::Kind::list) refuse(setting, item, demand);
            std::array<bool, 3> chosen{};
            for (const Setting& letter : setting.items) {
              const bool known =
                  letter.kind == Setting::Kind::scalar && letter.text.size() == 1 && letter.text[0] >= 'x' && letter.text[0] <= 'z';
              if (!known || (context.dimensions == 2 && letter.text == "y")) refuse(setting, item, demand);
              chosen[letter.text[0] - 'x'] = true;
            }
            return chosen;
          },
          [](const std::array<bool, 3>& value, const Context&) -> std::optional<Setting> {
            std::vector<Setting> letters;
            for (int axis = 0; axis < 3; ++axis) {
              if (value[axis]) letters.push_back(Setting::string(std::string(1, static_cast<char>('x' + axis))));
            }
            return Setting::list(letters);
          }};
}

Codec<Vector3d> angles() {
  return {"[roll, pitch, yaw]", "",
          [](const Setting& setting, const Item& item, Context&) {
            const auto numbers = numbers_of(setting, item, 3, 3, "3 numbers [roll, pitch, yaw]");
            return Vector3d(Vector3d(numbers[0], numbers[1], numbers[2]) * degree);
          },
          [](const Vector3d& value, const Context&) -> std::optional<Setting> {
            return vector_setting(value.unaryExpr([](double angle) { return in_degrees(angle); }));
          }};
}

}  // namespace wavetank::scene
