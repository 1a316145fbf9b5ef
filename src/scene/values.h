#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "key_description.h"
#include "setting.h"
#include "wavetank/common/error.h"
#include "wavetank/common/expression.h"

/// The kinds of value that a key of a case can have: each reads a setting into a value of the case, checks it, and writes it back.
namespace wavetank::scene {

using Eigen::Vector3d;

/// The shortest text that reads back to the same number, whatever the process's locale.
std::string number_text(double number);

/// What a value must know of the rest of the case.
struct Context {
  int dimensions;  ///< 2 or 3; set by reading the key `dimensions`, which therefore comes before every position
};

inline constexpr double degree = 3.14159265358979323846 / 180.0;  ///< rad
/// To 12 digits after the point: 90° comes back as 90, not as 89.99999999999999.
double in_degrees(double radians);

/// The key being read, for messages.
struct Item {
  std::string path;
  std::string unit;
};

/// Throws Error: "PLACE: PATH is GIVEN; it must be ALLOWED (UNIT)".
[[noreturn]] void refuse(const Setting& given, const Item& item, const std::string& allowed);

/// Throws Error about a key of a section, given or not: "PLACE: PATH/NAME TEXT".
[[noreturn]] void refuse_key(const Setting& map, const std::string& path, const std::string& name, const std::string& text);

/// Throws Error about a vector of a section, given or by default: "PLACE: PATH/NAME is VALUE; it must be ALLOWED".
[[noreturn]] void refuse_vector(const Setting& map, const std::string& path, const std::string& name, const Vector3d& value,
                                const std::string& allowed);

template <class Value>
struct Codec {
  std::string type;     ///< for the page of keys
  std::string allowed;  ///< likewise; may be empty
  std::function<Value(const Setting&, const Item&, Context&)> read;
  std::function<std::optional<Setting>(const Value&, const Context&)> write;  ///< nothing: the key is left out
  Holds holds = Holds::value;
  std::vector<KeyDescription> children = {};  ///< of a section or a list of sections
};

/// The numbers of a list, `least` to `greatest` of them; refuses everything else as not being `demand`.
std::vector<double> numbers_of(const Setting& setting, const Item& item, std::size_t least, std::size_t greatest,
                               const std::string& demand);
Setting list_of_numbers(const std::vector<double>& numbers);

struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  bool above_least = false;  ///< the least value itself is not allowed
  bool contains(double value) const;
  std::string describe() const;  ///< "greater than 0", "from 2 to 8", ...; empty when nothing is excluded
};
inline Range greater_than(double least) { return {least, std::numeric_limits<double>::infinity(), true}; }
inline Range at_least(double least) { return {least, std::numeric_limits<double>::infinity(), false}; }
inline Range between(double least, double greatest) { return {least, greatest, false}; }
inline Range above_up_to(double least, double greatest) { return {least, greatest, true}; }

Codec<double> number(Range range);
Codec<std::optional<double>> number_or_auto(Range range);
Codec<std::optional<double>> number_or_none(Range range);  ///< none is written as the word, for what has a default
Codec<std::optional<double>> number_if_given(Range range);
Codec<int> whole_number(Range range);
Codec<std::optional<std::size_t>> count_if_given(Range range);
Codec<int> dimension_count();  ///< 2 or 3, and tells the context
Codec<bool> flag();
Codec<std::string> text();  ///< any, also empty
Codec<std::string> nonempty_text();
Codec<std::string> expression(Expression::Of of);  ///< empty: not given
Codec<std::string> name();                         ///< of a body, probe or gauge: part of a topic's name
Codec<std::string> frame();                        ///< of tf
Codec<Vector3d> vector();                          ///< 3 numbers; in 2-D also [x, z]
Codec<Vector3d> position();                        ///< the same, but y is 0 in 2-D whatever is given
Codec<Vector3d> size();                            ///< the same, each greater than 0
Codec<Vector3d> scale();                           ///< a number greater than 0, or three of which none is 0
Codec<Vector3d> gauge_position();                  ///< [x, y] or [x, y, z], in 2-D [x] as well; z is not kept
Codec<std::array<bool, 3>> axes();                 ///< a list of the letters x, y, z; y not in 2-D
Codec<Vector3d> angles();                          ///< three, degrees in the setting, radians in the value

/// One of the listed words.
template <class Enum>
Codec<Enum> choice(std::vector<std::pair<std::string, Enum>> words) {
  std::string allowed;
  for (const auto& word : words) allowed += (allowed.empty() ? "" : ", ") + word.first;
  const std::string demand = words.size() == 1 ? allowed + ", the only one there is" : "one of " + allowed;
  return {"word", allowed,
          [words, demand](const Setting& setting, const Item& item, Context&) {
            for (const auto& [word, value] : words) {
              if (setting.kind == Setting::Kind::scalar && setting.text == word) return value;
            }
            refuse(setting, item, demand);
          },
          [words](const Enum& value, const Context&) -> std::optional<Setting> {
            for (const auto& [word, candidate] : words) {
              if (candidate == value) return Setting::string(word);
            }
            throw Error("a case holds a value that has no name in a case file");
          }};
}

}  // namespace wavetank::scene
