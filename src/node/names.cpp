#include "wavetank/node/names.h"

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

namespace {

std::string body_topic(const std::string& body, const std::string& what) { return "bodies/" + graph_name(body) + "/" + what; }

}  // namespace

std::string wrench_topic(const std::string& body) { return body_topic(body, "wrench"); }

std::string odometry_topic(const std::string& body) { return body_topic(body, "odom"); }

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

std::string inertial_frame(const PublishingCase& publishing) { return publishing.world_frame == "world" ? "inertial" : "world"; }

namespace {

void claim(std::map<std::string, std::string>& taken, const std::string& topic, const std::string& what) {
  const auto [holder, is_new] = taken.emplace(topic, what);
  if (!is_new) throw Error(what + " and " + holder->second + " would both publish on '" + topic + "': give one of them another name");
}

}  // namespace

void check_names(const Case& checked) {
  std::map<std::string, std::string> taken;
  claim(taken, wrench_topic(tank_name), "the tank");
  for (const BodyCase& body : checked.bodies) claim(taken, wrench_topic(body.name), "body '" + body.name + "'");
  for (const PressureProbeCase& probe : checked.instruments.pressure_probes)
    claim(taken, probe_topic(probe.name), "pressure probe '" + probe.name + "'");
  for (const OpeningCase& opening : checked.openings) claim(taken, flow_topic(opening.name), "opening '" + opening.name + "'");
}

}  // namespace wavetank
