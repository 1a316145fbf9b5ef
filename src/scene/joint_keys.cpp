#include "joint_keys.h"

#include <algorithm>
#include <map>

#include "joint_command_keys.h"
#include "motion_values.h"

namespace wavetank::scene {
namespace {

using SixLimits = std::array<std::optional<std::array<double, 2>>, 6>;

// Keys that not every type of joint has: written, and allowed, with these only.
struct JointKey {
  const char* name;
  std::vector<JointType> types;
};
const std::vector<JointKey>& joint_keys() {
  static const std::vector<JointKey> keys{{"parent_point", {JointType::spring}},
                                          {"axis", {JointType::hinge, JointType::slider}},
                                          {"limits", {JointType::hinge, JointType::slider}},
                                          {"six_limits", {JointType::six_dof}},
                                          {"stiffness", {JointType::hinge, JointType::slider, JointType::spring}},
                                          {"damping", {JointType::hinge, JointType::slider, JointType::spring}},
                                          {"length", {JointType::spring}},
                                          {"command", {JointType::hinge, JointType::slider}}};
  return keys;
}

bool has(const std::vector<JointType>& types, JointType type) { return std::find(types.begin(), types.end(), type) != types.end(); }

Codec<JointType> type_word() {
  return choice<JointType>({{"fixed", JointType::fixed},
                            {"hinge", JointType::hinge},
                            {"slider", JointType::slider},
                            {"ball", JointType::ball},
                            {"spring", JointType::spring},
                            {"six_dof", JointType::six_dof}});
}

Section<SixLimits> six_limits_section() {
  Section<SixLimits> section;
  const auto add = [&](const std::string& name, std::size_t direction, const Codec<std::array<double, 2>>& codec, bool in_plane,
                       const std::string& unit, const std::string& description) {
    const auto limits = if_given(codec);
    section.key(
        name, [direction](auto& target) -> auto& { return target[direction]; }, in_plane ? limits : only_in_3d(limits), unit, description);
  };
  const std::string free = " from the start; left out = free, both 0 = locked.";
  add("surge", 0, limits(), true, "m", "Along x" + free);
  add("sway", 1, limits(), false, "m", "Along y" + free);
  add("heave", 2, limits(), true, "m", "Along z" + free);
  // The angles are found within these, so that a limit beyond them would never act.
  constexpr double half_turn = 180, upright = 90;
  add("roll", 3, angle_limits(half_turn), false, "°", "About x" + free);
  add("pitch", 4, angle_limits(upright), true, "°", "About y" + free);
  add("yaw", 5, angle_limits(half_turn), false, "°", "About z" + free);
  return section;
}

Section<JointCommandCase> joint_command_section() {
  Section<JointCommandCase> section;
  add_joint_command_keys(section, number_or_none, "; in 2-D a metre of width", "");
  return section;
}

void check_type(const JointCase& joint, const Setting& map, const std::string& path, const Context& context) {
  const auto word = [&](JointType type) { return type_word().write(type, context)->text; };
  for (const JointKey& key : joint_keys()) {
    if (has(key.types, joint.type) || map.find(key.name) == nullptr) continue;
    std::string words;
    for (const JointType type : key.types) words += (words.empty() ? "" : ", ") + word(type);
    refuse_key(map, path, key.name, "does not belong to a joint of type " + word(joint.type) + ", but to " + words + " only; leave it out");
  }
  const auto demand = [&](const std::string& name, const std::string& unit) {
    if (map.find(name) == nullptr)
      refuse_key(map, path, name, "is missing; a joint of type " + word(joint.type) + " needs it (" + unit + ")");
  };
  if (joint.type != JointType::fixed && joint.type != JointType::slider) demand("point", "[x, y, z], m");
  if (joint.type != JointType::spring) return;
  demand("parent_point", "[x, y, z], m");
  demand("stiffness", "number, N/m");
}

void check_joint_plane(const JointCase& joint, const Setting& map, const std::string& path, const Context& context) {
  if (context.dimensions != 2) return;
  const Vector3d& axis = joint.axis;
  if (joint.type == JointType::hinge && (axis.x() != 0 || axis.z() != 0))
    refuse_vector(map, path, "axis", axis, "[0, 1, 0] or [0, -1, 0] for a hinge in a 2-D case");
  if (joint.type == JointType::slider && axis.y() != 0)
    refuse_vector(map, path, "axis", axis, "within the x–z plane for a slider in a 2-D case, [x, z]");
}

/// Where a joint can end, and whether that end moves freely.
std::map<std::string, bool> ends_of(const Case& read) {
  std::map<std::string, bool> ends{{"tank", read.tank.motion == Motion::free}, {"world", false}};
  for (const BodyCase& body : read.bodies) ends[body.name] = body.motion == Motion::free;
  return ends;
}

void check_end(const std::string& end, const std::map<std::string, bool>& ends, const Setting& root, const std::string& path) {
  if (ends.count(end) > 0) return;
  std::string names;
  for (const auto& known : ends) names += (names.empty() ? "" : ", ") + known.first;
  throw Error(nearest_setting(root, path).place.describe() + ": " + path + " is " + end + "; it must be the name of a body, or tank" +
              (ends.count("world") > 0 ? " or world" : "") + ": one of " + names);
}

}  // namespace

Section<JointCase> joint_section() {
  Section<JointCase> section;
  section.key("name", &JointCase::name, name(), "", "The joint's name, its own among joints.").required = true;
  section
      .key("type", &JointCase::type, type_word(), "",
           "`hinge` turns about the axis, `slider` slides along it, `ball` turns about the point, `spring` is a spring and a damper along "
           "the "
           "line between two points, `six_dof` has limits along and about x, y, z, and `fixed` lets nothing move.")
      .required = true;
  section.key("parent", &JointCase::parent, name(), "", "A body, `tank` or `world`.");
  section.key("child", &JointCase::child, name(), "", "A body, or `tank`; it or the parent, or both, must be free.").required = true;
  section.key("point", &JointCase::point, position(), "m",
              "Where the joint is at the start, a spring's end on the child; a fixed joint and a slider can do without it.");
  const auto add = [&](const std::string& name, auto member, const auto& codec, const std::string& unit,
                       const std::string& description) -> KeyDescription& {
    const auto key =
        std::find_if(joint_keys().begin(), joint_keys().end(), [&](const JointKey& candidate) { return name == candidate.name; });
    return section.key_where([types = key->types](const JointCase& joint) { return has(types, joint.type); }, name, member, codec, unit,
                             description);
  };
  add("parent_point", &JointCase::parent_point, if_given(position()), "m", "A spring's end on the parent at the start, required for it.");
  add("axis", &JointCase::axis, axis(), "", "Of hinge and slider; in 2-D along y for a hinge and [x, z] for a slider.");
  add("limits", &JointCase::limits, if_given(limits()), "m or °",
      "Of a hinge in degrees, of a slider in metres, from the start; left out = free.");
  add("six_limits", &JointCase::six_limits, section_of(six_limits_section()), "", "Of six_dof.");
  add("stiffness", &JointCase::stiffness, number(at_least(0)), "N/m or N·m/rad",
      "Of spring (required), slider and hinge, towards the start; in 2-D a metre of width.");
  add("damping", &JointCase::damping, number(at_least(0)), "N·s/m or N·m·s/rad", "Of spring, slider and hinge; in 2-D a metre of width.");
  add("length", &JointCase::length, number_if_given(at_least(0)), "m",
      "Of a spring, unstretched; if it is left out, the distance of its ends at the start.");
  add("command", &JointCase::command, section_if_given(joint_command_section()), "",
      "Of hinge and slider: its effort or velocity is commanded while it runs, and 0 before; what is commanded and its limits, or {}.");
  section.converts(
      [](JointCase& joint) {
        if (joint.type == JointType::hinge && joint.limits) joint.limits = {(*joint.limits)[0] * degree, (*joint.limits)[1] * degree};
      },
      [](JointCase& joint) {
        if (joint.type == JointType::hinge && joint.limits) joint.limits = {in_degrees((*joint.limits)[0]), in_degrees((*joint.limits)[1])};
      });
  section.rule(check_type);
  section.rule(check_joint_plane);
  return section;
}

void check_joints(const Case& read, const Setting& root) {
  const std::map<std::string, bool> ends = ends_of(read);
  std::map<std::string, bool> child_ends = ends;
  child_ends.erase("world");
  std::map<std::string, std::string> paths;  // by name
  for (std::size_t i = 0; i < read.joints.size(); ++i) {
    const JointCase& joint = read.joints[i];
    const std::string path = join_path("joints", i);
    const auto refuse_joint = [&](const std::string& key, const std::string& text) {
      throw Error(nearest_setting(root, join_path(path, key)).place.describe() + ": " + join_path(path, key) + " is " + text);
    };
    const auto [earlier, is_new] = paths.emplace(joint.name, join_path(path, "name"));
    if (!is_new) refuse_joint("name", joint.name + ", as is " + earlier->second + "; every joint must have a name of its own");
    check_end(joint.parent, ends, root, join_path(path, "parent"));
    check_end(joint.child, child_ends, root, join_path(path, "child"));
    if (joint.parent == joint.child) refuse_joint("child", joint.child + ", as is its parent; a joint must be between two different ends");
    if (!ends.at(joint.parent) && !ends.at(joint.child))
      refuse_joint("child", joint.child + ", which is not free, and nor is its parent, " + joint.parent +
                                "; the motion of at least one of them must be free");
  }
}

}  // namespace wavetank::scene
