#include "robot_keys.h"

#include "joint_command_keys.h"
#include "section.h"

namespace wavetank::scene {
namespace {

Section<RobotCommandCase> robot_command_section() {
  Section<RobotCommandCase> section;
  section.key("joint", &RobotCommandCase::joint, name(), "", "A hinge or slider of the robot, by its name in the URDF.").required = true;
  const std::string left_out = "; if it is left out, that of the URDF's `limit`, if there is one";
  add_joint_command_keys(section, number_if_given, left_out, left_out);
  return section;
}

Section<RobotCase> robot_section() {
  Section<RobotCase> section;
  section
      .key("urdf", &RobotCase::urdf, nonempty_text(), "",
           "URDF file: package://, file://, an absolute path, or one relative to the case file.")
      .required = true;
  section
      .key("parameter", &RobotCase::parameter, nonempty_text(), "",
           "Name of a ROS parameter that holds the URDF text (`robot_description`), looked for in the node's namespace and those above it; "
           "`wavetank_run` has none.")
      .required = true;
  section.exactly_one_of({{"urdf"}, {"parameter"}});
  section.key("position", &RobotCase::position, vector(), "m", "Of the root link's origin.");
  section.key("rotation", &RobotCase::rotation, angles(), "°", "Of the root link: roll, pitch and yaw about the fixed axes x, y, z.");
  section.key("motion", &RobotCase::motion, choice<Motion>({{"free", Motion::free}, {"fixed", Motion::fixed}}), "",
              "Of the root link; `fixed` welds it to the tank, as does a root link named world. All other links are free.");
  section.key("commands", &RobotCase::commands, list_of(robot_command_section()), "",
              "Joints whose effort or velocity is commanded while it runs, over `~joints/<name>/command`; all others move freely.");
  section.rule([](const RobotCase&, const Setting& map, const std::string& path, const Context& context) {
    if (context.dimensions != 2) return;
    throw Error(
        map.place.describe() + ": " + path +
        " is in a 2-D case, for which a robot's masses would have to be those of a metre of width; set dimensions to 3, or give its "
        "bodies and joints themselves");
  });
  return section;
}

}  // namespace

Codec<std::vector<RobotCase>> robot_list() {
  Codec<std::vector<RobotCase>> codec = list_of(robot_section());
  codec.write = [](const std::vector<RobotCase>&, const Context&) { return std::nullopt; };
  return codec;
}

}  // namespace wavetank::scene
