#pragma once

#include "section.h"
#include "values.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of a joint's command, in the case itself or of a robot's joint. `limit` reads the greatest effort and velocity; what is to be
/// said of them besides is appended to their descriptions.
template <class Command>
void add_joint_command_keys(Section<Command>& section, Codec<std::optional<double>> (*limit)(Range), const std::string& of_effort,
                            const std::string& of_velocity) {
  section.key("quantity", &Command::quantity,
              choice<JointQuantity>({{"effort", JointQuantity::effort}, {"velocity", JointQuantity::velocity}}), "",
              "What is commanded: a force or torque, or the joint's velocity, which is held by one.");
  section.key("greatest_effort", &Command::greatest_effort, limit(greater_than(0)), "N or N·m",
              "Limit of the force or torque, of either quantity" + of_effort + ".");
  section.key("greatest_velocity", &Command::greatest_velocity, limit(greater_than(0)), "m/s or rad/s",
              "Limit of a velocity that is commanded" + of_velocity + ".");
  section.key("timeout", &Command::timeout, number(at_least(0)), "s",
              "Of simulated time without a command, after which an effort ends and a velocity is 0; 0 = never.");
  section.rule([](const Command& command, const Setting& map, const std::string& path, const Context&) {
    if (command.greatest_velocity && command.quantity != JointQuantity::velocity)
      refuse_key(map, path, "greatest_velocity",
                 "is of the quantity velocity only; leave it out, or set " + join_path(path, "quantity") + " to that");
  });
}

}  // namespace wavetank::scene
