#pragma once

#include "values.h"
#include "wavetank/scene/case.h"

/// The kinds of value that motions and joints need besides those of values.h.
namespace wavetank::scene {

Codec<double> angle();  ///< degrees in the setting, radians in the value
/// [low, high] about the start, which is 0 and lies within.
Codec<std::array<double, 2>> limits();
/// The same, degrees in the setting, radians in the value; neither end is further off than `greatest` (°).
Codec<std::array<double, 2>> angle_limits(double greatest);
Codec<Vector3d> vector_in_plane();       ///< 3 numbers; in 2-D also [x, z], and no y
Codec<Vector3d> vector_about();          ///< 3 numbers about the axes; in 2-D also one about y, and none about x and z
Codec<Vector3d> axis();                  ///< 3 numbers, not all 0; in 2-D also [x, z]
Codec<Direction> direction();            ///< in 2-D only those that exist there
Codec<std::array<double, 6>> inertia();  ///< xx yy zz xy xz yz, positive definite; in 2-D also one number, yy, which alone is checked
Codec<Motion> motion_word();

/// The direction of that name, if there is one.
std::optional<Direction> direction_named(const std::string& word);
/// Whether it is measured in degrees (in a file), not in metres.
bool is_rotation(Direction direction);

/// A value that may be left out and then has no default: nothing is written for it.
template <class Value>
Codec<std::optional<Value>> if_given(const Codec<Value>& codec) {
  return {codec.type, codec.allowed,
          [codec](const Setting& setting, const Item& item, Context& context) -> std::optional<Value> {
            return codec.read(setting, item, context);
          },
          [codec](const std::optional<Value>& value, const Context& context) -> std::optional<Setting> {
            if (!value) return std::nullopt;
            return codec.write(*value, context);
          }};
}

/// A value that has no meaning in 2-D.
template <class Value>
Codec<Value> only_in_3d(Codec<Value> codec) {
  codec.read = [read = codec.read](const Setting& setting, const Item& item, Context& context) {
    if (context.dimensions == 2) refuse(setting, item, "left out of a 2-D case, where there is no such motion");
    return read(setting, item, context);
  };
  return codec;
}

}  // namespace wavetank::scene
