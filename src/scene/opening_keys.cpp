#include "opening_keys.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "motion_values.h"
#include "wavetank/common/expression.h"
#include "wavetank/scene/upward.h"

namespace wavetank::scene {
namespace {

Codec<std::array<double, 2>> rectangle_size() {
  return {"[width, height]", "each greater than 0; in 2-D the width is not used",
          [](const Setting& setting, const Item& item, Context& context) {
            const std::vector<double> numbers = numbers_of(setting, item, 2, 2, "2 numbers [width, height]");
            const bool flat = context.dimensions == 2;
            if (!(numbers[1] > 0) || (!flat && !(numbers[0] > 0))) refuse(setting, item, "greater than 0 in either direction");
            return std::array<double, 2>{numbers[0], numbers[1]};
          },
          [](const std::array<double, 2>& value, const Context&) -> std::optional<Setting> {
            return list_of_numbers({value[0], value[1]});
          }};
}

Section<FlowRecordCase> flow_record_section() {
  Section<FlowRecordCase> section;
  section
      .key("file", &FlowRecordCase::file, nonempty_text(), "",
           "Comma-separated values below one line of column names: package://, file://, an absolute path, or one relative to the case "
           "file. Followed in straight lines, held before its first time and after its last.")
      .required = true;
  section.key(
      "quantity", &FlowRecordCase::quantity,
      choice<FlowQuantity>({{"discharge", FlowQuantity::discharge}, {"velocity", FlowQuantity::velocity}, {"head", FlowQuantity::head}}),
      "", "What the column is of: of an inlet `discharge` or `velocity`, of an outlet `discharge`, of a pressure `head`.");
  section.key("time_column", &FlowRecordCase::time_column, nonempty_text(), "", "Name of the column of times (s), which increase.");
  section.key("column", &FlowRecordCase::column, text(), "", "Name of the column that is followed; empty: that named as the quantity.");
  section.key("factor", &FlowRecordCase::factor, number({}), "m³/s, m/s or m", "By which the column is multiplied.");
  section.key("delay", &FlowRecordCase::delay, number({}), "s", "Added to the file's times.");
  return section;
}

Section<FlowCommandCase> flow_command_section() {
  Section<FlowCommandCase> section;
  section.key("greatest_discharge", &FlowCommandCase::greatest_discharge, number_or_none(greater_than(0)), "m³/s",
              "Limit of the discharge; in 2-D a metre of width (m²/s).");
  section.key("greatest_rate", &FlowCommandCase::greatest_rate, number_or_none(greater_than(0)), "m³/s²",
              "At which the discharge goes over to the one commanded; `none`: at once.");
  section.key("timeout", &FlowCommandCase::timeout, number(at_least(0)), "s",
              "Of simulated time without a command, after which the discharge goes to zero; 0 = never.");
  return section;
}

/// Of a part of the velocity's profile: a word, or an expression of a place.
Codec<std::string> profile() {
  Codec<std::string> codec = expression(Expression::Of::place);
  codec.type = "uniform, parabolic or expression";
  const auto read_expression = codec.read;
  codec.read = [read_expression](const Setting& setting, const Item& item, Context& context) {
    if (setting.kind == Setting::Kind::scalar && (setting.text == "uniform" || setting.text == "parabolic")) return setting.text;
    return read_expression(setting, item, context);
  };
  return codec;
}

std::string word_of(OpeningKind kind) { return kind == OpeningKind::inlet ? "inlet" : kind == OpeningKind::outlet ? "outlet" : "pressure"; }

std::string word_of(FlowQuantity quantity) {
  return quantity == FlowQuantity::discharge ? "discharge" : quantity == FlowQuantity::velocity ? "velocity" : "head";
}

/// Which of the laws are given, of which a kind has its own.
void check_law(const OpeningCase& opening, const Setting& map, const std::string& path) {
  struct Law {
    const char* key;
    bool given;
    std::vector<OpeningKind> kinds;
  };
  const std::vector<Law> laws{{"velocity", !opening.velocity.empty(), {OpeningKind::inlet}},
                              {"discharge", !opening.discharge.empty(), {OpeningKind::inlet, OpeningKind::outlet}},
                              {"head", !opening.head.empty(), {OpeningKind::pressure}},
                              {"record", opening.record.has_value(), {OpeningKind::inlet, OpeningKind::outlet, OpeningKind::pressure}},
                              {"command", opening.command.has_value(), {OpeningKind::inlet, OpeningKind::outlet}},
                              {"level", opening.level && opening.kind == OpeningKind::outlet, {OpeningKind::outlet}}};
  const std::string kind = word_of(opening.kind);
  std::string allowed, first;
  for (const Law& law : laws)
    if (std::find(law.kinds.begin(), law.kinds.end(), opening.kind) != law.kinds.end())
      allowed += (allowed.empty() ? "" : ", ") + std::string(law.key);
  for (const Law& law : laws) {
    if (!law.given) continue;
    if (std::find(law.kinds.begin(), law.kinds.end(), opening.kind) == law.kinds.end())
      refuse_key(map, path, law.key, "is not for an opening of kind " + kind + ", which has " + allowed + "; leave it out");
    if (!first.empty()) refuse_key(map, path, law.key, "is given as well as " + first + "; give one of " + allowed);
    first = law.key;
  }
  if (first.empty() && opening.kind == OpeningKind::pressure)
    throw Error(map.place.describe() + ": " + path + " is an opening of kind " + kind + " without a law; give one of " + allowed);
  if (!opening.returns_to.empty() && opening.kind != OpeningKind::outlet)
    refuse_key(map, path, "returns_to", "is for outlets, and this one's kind is " + kind + "; leave it out");
  if (opening.level && opening.kind == OpeningKind::pressure)
    refuse_key(map, path, "level", "is not for an opening of kind pressure; give head");
  if (opening.record) {
    const FlowQuantity quantity = opening.record->quantity;
    const bool fits = opening.kind == OpeningKind::pressure ? quantity == FlowQuantity::head
                                                            : quantity == FlowQuantity::discharge || (quantity == FlowQuantity::velocity &&
                                                                                                      opening.kind == OpeningKind::inlet);
    if (!fits)
      refuse_key(map, path, "record/quantity",
                 "is " + word_of(quantity) + ", which an opening of kind " + kind + " does not follow; it must be " +
                     (opening.kind == OpeningKind::pressure ? "head"
                      : opening.kind == OpeningKind::inlet  ? "discharge or velocity"
                                                            : "discharge"));
  }
}

/// What an expression gives at the start, where a sign that is not allowed is seen before anything is made of the case.
void check_start(const std::string& text, const std::string& key, const std::string& unit, const Setting& map, const std::string& path,
                 bool may_be_negative) {
  if (text.empty()) return;
  const double value = Expression(text, Expression::Of::time).at(0.0);
  const Item item{join_path(path, key), unit};
  if (!std::isfinite(value)) refuse(*map.find(key), item, "finite at t = 0");
  if (value < 0 && !may_be_negative) refuse(*map.find(key), item, "at least 0, also as an expression of t");
}

/// Of the plane that an opening or a section lies in; `what`: which of them, `way`: of its normal, for messages.
template <class Plane>
void check_plane(const Plane& plane, const std::string& what, const std::string& way, const Setting& map, const std::string& path,
                 const Context& context) {
  if (plane.normal.isZero(0.0) && map.find("normal") != nullptr)
    refuse_vector(map, path, "normal", plane.normal, "a direction " + way + ", not all 0");
  if (context.dimensions == 2 && plane.normal.y() != 0)
    refuse_vector(map, path, "normal", plane.normal, "within the x–z plane of a 2-D case, [x, z]");
  if (context.dimensions == 2 && plane.diameter)
    refuse_key(map, path, "diameter",
               "is for 3-D cases; in 2-D " + std::string(what == "opening" ? "an " : "a ") + what +
                   " is a slot: give size: [width, height], whose width is not used");
  if (plane.diameter && plane.up) refuse_key(map, path, "up", "is for rectangles; leave it out of a disc");
  if (plane.up && !plane.normal.isZero(0.0) && plane.up->cross(plane.normal).norm() <= 1e-6 * plane.up->norm() * plane.normal.norm())
    refuse_key(map, path, "up", "is along " + join_path(path, "normal") + "; it must be a direction within the " + what);
}

void check_shape(const OpeningCase& opening, const Setting& map, const std::string& path, const Context& context) {
  if (opening.part.empty()) {
    for (const char* key : {"centre", "normal"})
      if (map.find(key) == nullptr) refuse_key(map, path, key, "is missing; it must be given ([x, y, z]), or part instead of it");
  } else if (map.find("centre") != nullptr) {
    refuse_key(map, path, "centre", "is given as well as part, which is where it is; give one of them");
  }
  check_plane(opening, "opening", "into the water", map, path, context);
  const bool given_flow = !opening.discharge.empty() || opening.record || opening.command || opening.kind == OpeningKind::inlet;
  if (opening.profile != "uniform" && (opening.kind == OpeningKind::pressure || !given_flow))
    refuse_key(map, path, "profile", "is for inlets, and for outlets of a given discharge; leave it out");
  if (opening.profile != "uniform" && !opening.velocity.empty() &&
      Expression(opening.velocity, Expression::Of::time_and_place).depends_on_place())
    refuse_key(map, path, "profile",
               "is given, and " + join_path(path, "velocity") + " depends on the place already; leave one of them out");
  if (opening.profile == "parabolic" && opening.level)
    refuse_key(map, path, "profile", "is parabolic, which is for inlets and outlets that are full; leave it out, or give an expression");
}

}  // namespace

Section<OpeningCase> opening_section() {
  Section<OpeningCase> section;
  section.key("name", &OpeningCase::name, name(), "", "Part of the names of the opening's topics; its own among all that have names.")
      .required = true;
  section
      .key("kind", &OpeningCase::kind,
           choice<OpeningKind>({{"inlet", OpeningKind::inlet}, {"outlet", OpeningKind::outlet}, {"pressure", OpeningKind::pressure}}), "",
           "`inlet`: water comes in by `velocity`, `discharge`, `record` or `command`, or what outlets return. `outlet`: it leaves, freely "
           "unless there is a "
           "`level`, `discharge`, `record` or `command`. `pressure`: it stands under `head` or `record` beyond, and flows either way.")
      .required = true;
  section.key("body", &OpeningCase::body, text(), "",
              "The body in whose wall the opening is, which must not be free; of one that moves the opening has no level or head. Empty: "
              "the tank.");
  section.key_where([](const OpeningCase& opening) { return opening.part.empty(); }, "centre", &OpeningCase::centre, position(), "m",
                    "On the wall; it must be given unless `part` is.");
  section.key_where([](const OpeningCase& opening) { return !opening.normal.isZero(0.0); }, "normal", &OpeningCase::normal, vector(), "",
                    "Direction at right angles to the wall, into the water; of any length. It must be given unless `part` is.");
  section.key("size", &OpeningCase::size, if_given(rectangle_size()), "m", "Of a rectangle.").required = true;
  section.key("diameter", &OpeningCase::diameter, number_if_given(greater_than(0)), "m", "Of a disc, in 3-D.").required = true;
  section
      .key_where([](const OpeningCase& opening) { return !opening.part.empty(); }, "part", &OpeningCase::part, nonempty_text(), "",
                 "Name of a node, a mesh or a material in the mesh file of the wall: the opening is that part, which must be flat, convex "
                 "and without holes.")
      .required = true;
  section.exactly_one_of({{"size"}, {"diameter"}, {"part"}});
  section.key("up", &OpeningCase::up, if_given(vector()), "",
              "Direction of the height of `size`; if it is left out, against gravity, or along x where that is the normal's.");
  section.key(
      "velocity", &OpeningCase::velocity, expression(Expression::Of::time_and_place), "m/s",
      "Of an inlet: the mean over the water that comes in, a number or an expression of t (s); or, with x, y or z (m) in it, that at "
      "each place (of a body that moves, where that is at the start).");
  section.key("discharge", &OpeningCase::discharge, expression(Expression::Of::time), "m³/s",
              "Into the tank of an inlet, out of it of an outlet, a number or an expression of t (s); in 2-D a metre of width (m²/s).");
  section.key("head", &OpeningCase::head, expression(Expression::Of::time), "m",
              "Of a pressure: the height (z) that water beyond the opening would stand to, a number or an expression of t (s).");
  section.key("record", &OpeningCase::record, section_if_given(flow_record_section()), "", "Discharge, velocity or head from a file.");
  section.key("command", &OpeningCase::command, section_if_given(flow_command_section()), "",
              "The discharge is commanded while it runs, and nothing flows before; limits on it, or {}.");
  section.key(
      "profile", &OpeningCase::profile, profile(), "",
      "Of the velocity, where velocity or discharge is given: even, as in a pipe, zero at the opening's edges, or by an expression of "
      "the place (x, y, z, m), of which only the shape counts.");
  section.key("returns_to", &OpeningCase::returns_to, text(), "",
              "Of an outlet: the name of an inlet without a law of its own, by which what leaves here comes in again.");
  section.key("level", &OpeningCase::level, number_if_given({}), "m",
              "Height (z) of a free surface: of an inlet, that of the water that comes in, which is less than full; beyond an outlet, "
              "against which water leaves or comes back.");
  section.rule([](const OpeningCase& opening, const Setting& map, const std::string& path, const Context& context) {
    check_shape(opening, map, path, context);
    check_law(opening, map, path);
    if (!Expression(opening.velocity.empty() ? "0" : opening.velocity, Expression::Of::time_and_place).depends_on_place())
      check_start(opening.velocity, "velocity", "m/s", map, path, false);
    check_start(opening.discharge, "discharge", context.dimensions == 2 ? "m²/s" : "m³/s", map, path, false);
    check_start(opening.head, "head", "m", map, path, true);
  });
  return section;
}

Section<FlowSectionCase> flow_section() {
  Section<FlowSectionCase> section;
  section.key("name", &FlowSectionCase::name, name(), "", "Part of the name of the section's topic.").required = true;
  section.key("centre", &FlowSectionCase::centre, position(), "m", "Its middle; in 2-D also [x, z].").required = true;
  section.key("normal", &FlowSectionCase::normal, vector(), "", "Direction that counts as positive; of any length.").required = true;
  section
      .key("size", &FlowSectionCase::size, if_given(rectangle_size()), "m",
           "Of a rectangle. What of it lies in walls or bodies does not count, so that it may be larger than the channel.")
      .required = true;
  section.key("diameter", &FlowSectionCase::diameter, number_if_given(greater_than(0)), "m", "Of a disc, in 3-D.").required = true;
  section.exactly_one_of({{"size"}, {"diameter"}});
  section.key("up", &FlowSectionCase::up, if_given(vector()), "",
              "Direction of the height of `size`; if it is left out, against gravity, or along x where that is the normal's.");
  section.rule([](const FlowSectionCase& given, const Setting& map, const std::string& path, const Context& context) {
    check_plane(given, "section", "through it", map, path, context);
  });
  return section;
}

namespace {

bool has_law(const OpeningCase& opening) {
  return !opening.velocity.empty() || !opening.discharge.empty() || !opening.head.empty() || opening.record || opening.command;
}

using Clash = std::function<void(const std::string& key, const std::string& text)>;

/// What leaves at one opening comes in at another.
void check_return(const Case& read, const OpeningCase& opening, const Clash& clash) {
  const auto feeds = [&](const OpeningCase& other) { return other.returns_to == opening.name; };
  const bool fed = std::any_of(read.openings.begin(), read.openings.end(), feeds);
  if (opening.kind == OpeningKind::inlet && !has_law(opening) && !fed)
    clash("kind", "inlet without a law; give one of velocity, discharge, record, command, or an outlet that returns_to it");
  if (opening.returns_to.empty()) return;
  const auto found =
      std::find_if(read.openings.begin(), read.openings.end(), [&](const OpeningCase& other) { return other.name == opening.returns_to; });
  if (found == read.openings.end()) clash("returns_to", opening.returns_to + ", which is no opening of the case");
  if (found->kind != OpeningKind::inlet) clash("returns_to", opening.returns_to + ", which is no inlet");
  if (has_law(*found)) clash("returns_to", opening.returns_to + ", which has a law of its own; leave that out");
}

void check_wall(const Case& read, const OpeningCase& opening, const Clash& clash) {
  const bool of_tank = opening.body.empty();
  const auto found = std::find_if(read.bodies.begin(), read.bodies.end(), [&](const BodyCase& body) { return body.name == opening.body; });
  if (!of_tank && found == read.bodies.end()) clash("body", opening.body + ", which is no body of the case; leave it out for the tank");
  if (!of_tank && found->motion == Motion::free)
    clash("body", opening.body + ", which moves freely; openings are for bodies that are fixed, prescribed or commanded");
  if (!of_tank && found->motion != Motion::fixed && (opening.level || opening.kind == OpeningKind::pressure))
    clash("body", opening.body + ", which moves, but the opening has a level or a head; those are for walls that stand");
  const bool is_mesh = of_tank ? std::holds_alternative<MeshSource>(read.tank.shape) : std::holds_alternative<MeshSource>(found->shape);
  if (!opening.part.empty() && !is_mesh)
    clash("part", opening.part + ", but " + (of_tank ? "the tank" : "body " + opening.body) +
                      " is no mesh and has no parts; give centre, normal and size");
}

/// Of what was computed: without the digits of rounding.
std::string figure(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string place_text(const Vector3d& place) {
  return "(" + figure(place.x()) + ", " + figure(place.y()) + ", " + figure(place.z()) + ") m";
}

/// Middles of cells of about a spacing over an opening that is a rectangle or a disc: of an inlet those below its level, since its
/// expressions count nowhere else.
std::vector<Vector3d> places_of_flow(const Case& read, const OpeningCase& opening) {
  constexpr int usual = 20;  // cells, where the spacing is not known yet
  const Vector3d normal = opening.normal.normalized();
  Vector3d up = opening.up.value_or(upward(read));
  if (up.cross(normal).norm() < 1e-3 * up.norm())
    up = read.dimensions == 2 || std::abs(normal.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  up = (up - up.dot(normal) * normal).normalized();
  const Vector3d across = up.cross(normal);
  const double height = opening.diameter ? *opening.diameter : (*opening.size)[1];
  const double width = read.dimensions == 2 ? 0 : opening.diameter ? *opening.diameter : (*opening.size)[0];
  const auto cells = [&](double length) {
    if (length == 0) return 1;
    return read.fluid.spacing ? std::clamp(static_cast<int>(std::lround(length / *read.fluid.spacing)), 1, 1000) : usual;
  };
  const Top top = top_of(read);
  std::vector<Vector3d> places;
  for (int i = 0; i < cells(width); ++i)
    for (int j = 0; j < cells(height); ++j) {
      const double x = ((i + 0.5) / cells(width) - 0.5) * width, y = ((j + 0.5) / cells(height) - 0.5) * height;
      if (opening.diameter && std::hypot(x, y) > 0.5 * *opening.diameter) continue;
      places.push_back(opening.centre + x * across + y * up);
      if (opening.kind == OpeningKind::inlet && opening.level && top.way * places.back()[top.axis] >= top.way * *opening.level)
        places.pop_back();
    }
  return places;
}

/// What an expression gives where water passes, and while the run lasts: the run would find it out too, but no longer knows the line.
void check_expressions(const Case& read, const OpeningCase& opening, const Clash& clash) {
  const auto check = [&](const std::string& key, const std::string& text, double value, const std::string& at, bool may_be_negative) {
    if (std::isfinite(value) && (may_be_negative || value >= 0)) return;
    clash(key, text + ", which is " + figure(value) + " at " + at + "; it must be finite" + (may_be_negative ? "" : " and at least 0"));
  };
  constexpr int looks = 1000;
  const auto check_times = [&](const std::string& key, const std::string& text, bool may_be_negative) {
    if (text.empty()) return;
    const Expression expression(text, Expression::Of::time);
    for (int k = 0; k <= looks; ++k) {
      const double time = read.duration * k / looks;
      check(key, text, expression.at(time), "t = " + figure(time) + " s", may_be_negative);
    }
  };
  check_times("discharge", opening.discharge, false);
  check_times("head", opening.head, true);
  const bool by_place = !opening.velocity.empty() && Expression(opening.velocity, Expression::Of::time_and_place).depends_on_place();
  if (!by_place) check_times("velocity", opening.velocity, false);
  if (!opening.part.empty()) return;  // its place is known when the mesh is read
  const std::vector<Vector3d> places = places_of_flow(read, opening);
  if (by_place) {
    const Expression expression(opening.velocity, Expression::Of::time_and_place);
    for (const Vector3d& place : places)
      check("velocity", opening.velocity, expression.at(0.0, place), place_text(place) + " and t = 0", false);
  }
  if (opening.profile == "uniform" || opening.profile == "parabolic") return;
  const Expression expression(opening.profile);
  double greatest = 0;
  for (const Vector3d& place : places) {
    check("profile", opening.profile, expression.at(place), place_text(place), false);
    greatest = std::max(greatest, expression.at(place));
  }
  if (!places.empty() && greatest == 0) clash("profile", opening.profile + ", which is 0 wherever water passes");
}

}  // namespace

void check_openings(const Case& read, const Setting& root) {
  for (std::size_t i = 0; i < read.openings.size(); ++i) {
    const OpeningCase& opening = read.openings[i];
    const std::string path = join_path("openings", i);
    const Clash clash = [&](const std::string& key, const std::string& text) {
      throw Error(nearest_setting(root, join_path(path, key)).place.describe() + ": " + join_path(path, key) + " is " + text);
    };
    if (read.tank.motion != Motion::fixed)
      clash("kind", word_of(opening.kind) + ", and tank/motion is not fixed; openings are for tanks that stand");
    check_return(read, opening, clash);
    check_wall(read, opening, clash);
    check_expressions(read, opening, clash);
  }
}

}  // namespace wavetank::scene
