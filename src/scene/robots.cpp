#include "robots.h"

#include <algorithm>
#include <filesystem>

#include "robot_description.h"
#include "text_file.h"
#include "values.h"
#include "wavetank/common/error.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/scene/file_path.h"

namespace wavetank::scene {
namespace {

struct Description {
  std::string text;
  std::string source;     ///< for messages
  std::string directory;  ///< of its file, if it has one
};

Description find_description(const RobotCase& robot, const Case& read, const Surroundings& surroundings) {
  if (robot.urdf.empty()) {
    if (!surroundings.parameter) {
      throw Error("only a node has ROS parameters such as '" + visible_text(robot.parameter) +
                  "'; give the robot's file as urdf instead, or run the case with wavetank_node");
    }
    return {surroundings.parameter(robot.parameter), "parameter " + robot.parameter, ""};
  }
  const std::string path = file_path("robot description", robot.urdf, read.directory, surroundings.resolve);
  return {read_text_file(path, "robot description", "a robot description is a URDF file"), path,
          std::filesystem::absolute(path).parent_path().string()};
}

template <class Named>
bool has(const std::vector<Named>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Named& item) { return item.name == name; });
}

// The rules for names of the case, which would otherwise point at entries that its file does not have.
void check_name(const std::string& own, const std::string& what, const std::string& source, bool taken, const std::string& rule) {
  Context context{3};
  const Setting setting = Setting::string(own);
  const std::string start = source + ": " + what + " '" + own + "'";
  try {
    name().read(setting, {what, ""}, context);
  } catch (const Error&) {
    throw Error(start + " cannot be called so; its name must be " + name().allowed);
  }
  if (taken) throw Error(start + " has a name that is taken; " + rule);
}

void add_parts(const RobotParts& parts, const std::string& source, Case& read) {
  for (const BodyCase& body : parts.bodies) {
    const bool reserved = body.name == "tank" || body.name == "world" || body.name == read.publishing.world_frame;
    check_name(body.name, "link", source, reserved || has(read.bodies, body.name),
               "every body must have one of its own, which is not tank, world or the world_frame");
    read.bodies.push_back(body);
  }
  for (const JointCase& joint : parts.joints) {
    check_name(joint.name, "joint", source, has(read.joints, joint.name), "every joint must have one of its own");
    read.joints.push_back(joint);
  }
}

/// Each command is of a joint of the robot that can have one, and is the only one of that joint.
void check_commands(const RobotCase& robot, const RobotParts& parts, const Setting& root, const std::string& path) {
  for (std::size_t k = 0; k < robot.commands.size(); ++k) {
    const std::string& wanted = robot.commands[k].joint;
    const std::string place = join_path(join_path(path, k), "joint");
    const auto refuse = [&](const std::string& text) {
      throw Error(nearest_setting(root, place).place.describe() + ": " + place + " is " + wanted + text);
    };
    std::string names;
    bool found = false;
    for (const JointCase& joint : parts.joints) {
      if (joint.type != JointType::hinge && joint.type != JointType::slider) continue;
      names += (names.empty() ? "" : ", ") + joint.name;
      found = found || joint.name == wanted;
    }
    if (!found) refuse("; it must be a hinge or slider of the robot" + (names.empty() ? ", which has none" : ": one of " + names));
    for (std::size_t other = 0; other < k; ++other)
      if (robot.commands[other].joint == wanted) refuse(", as another one before it; a joint has one command");
  }
}

/// What a robot's position and its description place together is what a case can say of a body.
void check_places(const RobotParts& parts, const Setting& root, const std::string& path) {
  constexpr double greatest = 1e15;  // m, of any number of a case
  for (const BodyCase& body : parts.bodies) {
    const auto* mesh = std::get_if<MeshSource>(&body.shape);
    if (mesh == nullptr || mesh->translation.cwiseAbs().maxCoeff() <= greatest) continue;
    throw Error(nearest_setting(root, path).place.describe() + ": " + path + " puts the link '" + body.name +
                "' further than 1e15 m from the origin");
  }
}

}  // namespace

void build_robots(Case& read, const Setting& root, const Surroundings& surroundings) {
  for (std::size_t i = 0; i < read.robots.size(); ++i) {
    const RobotCase& robot = read.robots[i];
    Description description;
    try {
      description = find_description(robot, read, surroundings);
    } catch (const Error& error) {
      const std::string path = join_path(join_path("robots", i), robot.urdf.empty() ? "parameter" : "urdf");
      throw Error(nearest_setting(root, path).place.describe() + ": " + path + ": " + error.what());
    }
    const RobotParts parts = robot_parts(description.text, description.source, description.directory, robot);
    check_commands(robot, parts, root, join_path(join_path("robots", i), "commands"));
    check_places(parts, root, join_path(join_path("robots", i), "position"));
    add_parts(parts, description.source, read);
  }
  read.robots.clear();
}

std::vector<std::string> robot_parameters(const Setting& root) {
  std::vector<std::string> names;
  const auto add = [&names](const Setting& robot) {
    const Setting* parameter = robot.find("parameter");
    if (parameter != nullptr && parameter->kind == Setting::Kind::scalar) names.push_back(parameter->text);
  };
  const Setting* robots = root.find("robots");
  if (robots == nullptr) return names;
  for (const Setting& robot : robots->items) add(robot);
  for (const Setting::Entry& robot : robots->entries) add(robot.second);  // by index, as overrides and ROS parameters can name them
  return names;
}

}  // namespace wavetank::scene
