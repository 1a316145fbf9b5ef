#include "wavetank/scene/names.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "wavetank/common/error.h"

namespace wavetank {

std::string graph_name(const std::string& name) {
  std::string result = name;
  std::replace_if(
      result.begin(), result.end(), [](unsigned char c) { return c > 127 || (!std::isalnum(c) && c != '_'); }, '_');
  return result;
}

std::string probe_topic(const std::string& probe) { return "probes/" + graph_name(probe); }

std::string gauge_topic(const std::string& gauge) { return "gauges/" + graph_name(gauge); }

std::string velocity_topic(const std::string& probe) { return "velocities/" + graph_name(probe); }

std::string section_topic(const std::string& section) { return "sections/" + graph_name(section); }

std::string joint_command_topic(const std::string& joint) { return "joints/" + graph_name(joint) + "/command"; }

namespace {

std::string body_topic(const std::string& body, const std::string& what) { return "bodies/" + graph_name(body) + "/" + what; }

}  // namespace

std::string wrench_topic(const std::string& body) { return body_topic(body, "wrench"); }

std::string odometry_topic(const std::string& body) { return body_topic(body, "odom"); }

std::string imu_topic(const std::string& body) { return body_topic(body, "imu"); }

std::string mooring_topic(const std::string& body, const std::string& mooring) {
  return body_topic(body, "moorings/" + graph_name(mooring) + "/tension");
}

std::string inertia_topic(const std::string& body) { return body_topic(body, "inertia"); }

std::string outside_wrench_topic(const std::string& body) { return body_topic(body, "external_wrench"); }

std::string command_topic(const std::string& body) { return body_topic(body, "cmd_vel"); }

std::string flow_topic(const std::string& opening) { return "openings/" + graph_name(opening) + "/flow"; }

std::string discharge_topic(const std::string& opening) { return "openings/" + graph_name(opening) + "/discharge"; }

std::string probe_frame(const PublishingCase& publishing, const std::string& probe) {
  return publishing.world_frame + "/probes/" + graph_name(probe);
}

std::string body_frame(const PublishingCase& publishing, const std::string& body) {
  return publishing.world_frame + "/bodies/" + graph_name(body);
}

std::string imu_frame(const PublishingCase& publishing, const std::string& body) { return body_frame(publishing, body) + "/imu"; }

std::string inertial_frame(const PublishingCase& publishing) { return publishing.world_frame == "world" ? "inertial" : "world"; }

std::string name_of(const RigidCase& rigid, std::size_t mooring) {
  const std::string& name = rigid.moorings.at(mooring).name;
  return name.empty() ? std::to_string(mooring) : name;
}

namespace {

void claim(std::map<std::string, std::string>& taken, const std::string& topic, const std::string& what,
           const std::string& does = "publish on") {
  const auto [holder, is_new] = taken.emplace(topic, what);
  if (!is_new) throw Error(what + " and " + holder->second + " would both " + does + " '" + topic + "': give one of them another name");
}

void claim_moorings(std::map<std::string, std::string>& taken, const RigidCase& rigid, const std::string& body) {
  for (std::size_t m = 0; m < rigid.moorings.size(); ++m)
    claim(taken, mooring_topic(body, name_of(rigid, m)), "mooring '" + name_of(rigid, m) + "' of '" + body + "'");
}

}  // namespace

void check_names(const Case& checked) {
  std::map<std::string, std::string> taken;
  claim(taken, wrench_topic(tank_name), "the tank");
  for (const BodyCase& body : checked.bodies) claim(taken, wrench_topic(body.name), "body '" + body.name + "'");
  for (const PressureProbeCase& probe : checked.instruments.pressure_probes)
    claim(taken, probe_topic(probe.name), "pressure probe '" + probe.name + "'");
  for (const WaveGaugeCase& gauge : checked.instruments.wave_gauges)
    claim(taken, gauge_topic(gauge.name), "wave gauge '" + gauge.name + "'");
  for (const VelocityProbeCase& probe : checked.instruments.velocity_probes)
    claim(taken, velocity_topic(probe.name), "velocity probe '" + probe.name + "'");
  for (const FlowSectionCase& section : checked.instruments.sections)
    claim(taken, section_topic(section.name), "section '" + section.name + "'");
  for (const JointCase& joint : checked.joints)
    if (joint.command) claim(taken, joint_command_topic(joint.name), "joint '" + joint.name + "'", "listen to");
  claim_moorings(taken, checked.tank.rigid, tank_name);
  for (const BodyCase& body : checked.bodies) claim_moorings(taken, body.rigid, body.name);
  for (const OpeningCase& opening : checked.openings) claim(taken, flow_topic(opening.name), "opening '" + opening.name + "'");
}

}  // namespace wavetank
