#include "wavetank/node/parameters.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <cstdio>
#include <optional>
#include <regex>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/node/resources.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank {

namespace {

using XmlRpc::XmlRpcValue;

std::string number_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  char text[40];
  for (const int digits : {15, 17}) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  const std::string result = text;
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

bool is_exponential_number(const std::string& text) {
  static const std::regex pattern(R"([-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+)");
  return std::regex_match(text, pattern);
}

void emit(YAML::Emitter& out, const XmlRpcValue& constant) {
  XmlRpcValue value = constant;  // whose accessors are not const
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      out << static_cast<bool>(value);
      break;
    case XmlRpcValue::TypeInt:
      out << static_cast<int>(value);
      break;
    case XmlRpcValue::TypeDouble:
      out << number_text(static_cast<double>(value));
      break;
    case XmlRpcValue::TypeString: {
      const auto text = static_cast<std::string>(value);
      if (!is_exponential_number(text)) out << YAML::DoubleQuoted;
      out << text;
      break;
    }
    case XmlRpcValue::TypeArray:
      out << YAML::BeginSeq;
      for (int i = 0; i < value.size(); ++i) emit(out, value[i]);
      out << YAML::EndSeq;
      break;
    case XmlRpcValue::TypeStruct:
      out << YAML::BeginMap;
      for (auto& [key, member] : value) {
        out << YAML::Key << key << YAML::Value;
        emit(out, member);
      }
      out << YAML::EndMap;
      break;
    default:
      throw Error("a parameter holds a date or binary data: a case has only numbers, true and false, text, lists and groups");
  }
}

/// Takes `key` out of the parameters, so that what stays is the case.
std::optional<XmlRpcValue> take(XmlRpcValue& parameters, const std::string& key) {
  if (!parameters.hasMember(key)) return std::nullopt;
  XmlRpcValue others, taken = parameters[key];
  others.begin();  // makes it a struct, even if nothing is left to put into it
  for (auto& [name, value] : parameters)
    if (name != key) others[name] = value;
  parameters = others;
  return taken;
}

/// The same of what lies deeper, at a path of keys; groups that are left empty go too.
void take_path(XmlRpcValue& group, const std::string& path) {
  const std::size_t slash = path.find('/');
  const std::string key = path.substr(0, slash);
  std::optional<XmlRpcValue> taken = take(group, key);
  if (slash == std::string::npos || !taken) return;
  if (taken->getType() == XmlRpcValue::TypeStruct) take_path(*taken, path.substr(slash + 1));
  if (taken->getType() != XmlRpcValue::TypeStruct || taken->size() > 0) group[key] = *taken;
}

class ParameterReader {
 public:
  ParameterReader(XmlRpcValue& parameters, std::string source) : parameters_(parameters), source_(std::move(source)) {}

  void read(const std::string& key, std::string& to) {
    if (auto value = take(parameters_, key)) {
      if (value->getType() != XmlRpcValue::TypeString) refuse(key, "text", *value);
      to = static_cast<std::string>(*value);
    }
  }
  void read(const std::string& key, bool& to) {
    if (auto value = take(parameters_, key)) {
      if (value->getType() != XmlRpcValue::TypeBoolean) refuse(key, "true or false", *value);
      to = static_cast<bool>(*value);
    }
  }
  void read(const std::string& key, double& to) {
    if (auto value = take(parameters_, key)) {
      if (value->getType() == XmlRpcValue::TypeInt)
        to = static_cast<int>(*value);
      else if (value->getType() == XmlRpcValue::TypeDouble)
        to = static_cast<double>(*value);
      else
        refuse(key, "a number of seconds", *value);
      if (!(to >= 0.0)) refuse(key, "at least 0", *value);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& key, const std::string& allowed, const XmlRpcValue& given) const {
    throw Error("parameter " + source_ + "/" + key + " must be " + allowed + ", not " + yaml_of(given));
  }
  XmlRpcValue& parameters_;
  std::string source_;
};

/// Every leaf (lists are leaves) of the parameters as a key of the case.
void flatten(XmlRpcValue& group, const std::string& path, std::vector<Override>& overrides) {
  const std::string prefix = path.empty() ? "" : path + "/";
  for (auto& [name, value] : group) {
    const std::string key = prefix + name;
    if (value.getType() == XmlRpcValue::TypeStruct)
      flatten(value, key, overrides);
    else
      overrides.push_back({key, yaml_of(value), "parameter ~"});
  }
}

/// Takes out what the parameters hold for the case's robots, which robots of its file or of the parameters themselves name.
void take_robot_descriptions(XmlRpcValue& parameters, const std::string& source, const std::string& case_file) {
  std::vector<std::string> names;
  if (!case_file.empty()) names = robot_parameters_of_file(case_file);
  if (parameters.hasMember("robots")) {
    XmlRpcValue robots;
    robots["robots"] = parameters["robots"];
    for (const std::string& name : robot_parameters_of_text(yaml_of(robots), source)) names.push_back(name);
  }
  const std::string own = source + "/";
  for (const std::string& name : names) take_path(parameters, name.compare(0, own.size(), own) == 0 ? name.substr(own.size()) : name);
}

/// What a case of the node can name: packages, and text parameters of the node's namespace or one above it.
Surroundings surroundings_of(const ros::NodeHandle& private_handle) {
  const auto parameter = [private_handle](const std::string& name) {
    std::string path, text;
    if (!private_handle.searchParam(name, path))
      throw Error("there is no ROS parameter '" + name + "' in " + private_handle.getNamespace() + " or a namespace above it");
    if (!private_handle.getParam(path, text)) throw Error("the ROS parameter " + path + " is not text");
    return text;
  };
  return {resolve_resource, parameter};
}

}  // namespace

std::string yaml_of(const XmlRpcValue& value) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  emit(out, value);
  return out.c_str();
}

NodeSetup read_setup(const ros::NodeHandle& private_handle) {
  const std::string& source = private_handle.getNamespace();
  XmlRpcValue parameters;
  parameters.begin();
  private_handle.getParam("", parameters);
  if (parameters.getType() != XmlRpcValue::TypeStruct) throw Error("parameter " + source + " is a single value, not the keys of a case");

  NodeSetup setup;
  ParameterReader reader(parameters, source);
  reader.read("case_file", setup.parameters.case_file);
  reader.read("restore", setup.parameters.restore);
  reader.read("snapshot_directory", setup.parameters.snapshot_directory);
  reader.read("bag", setup.parameters.bag);
  reader.read("bag_clouds", setup.parameters.bag_clouds);
  reader.read("bag_surface", setup.parameters.bag_surface);
  if (setup.parameters.bag_surface && !can_find_surface()) throw Error("parameter " + source + "/bag_surface: " + why_no_surface);
  reader.read("paused", setup.parameters.paused);
  reader.read("exit_at_end", setup.parameters.exit_at_end);
  reader.read("wait_for_subscribers", setup.parameters.wait_for_subscribers);
  reader.read("external_wrench_timeout", setup.parameters.external_wrench_timeout);
  take(parameters, "diagnostic_period");  // diagnostic_updater's own
  take(parameters, clock_reached);        // the node's own note

  take_robot_descriptions(parameters, source, setup.parameters.case_file);
  const Surroundings surroundings = surroundings_of(private_handle);
  if (!setup.parameters.case_file.empty()) {
    std::vector<Override> overrides;
    flatten(parameters, "", overrides);
    setup.scene = read_case_file(setup.parameters.case_file, overrides, surroundings);
    return setup;
  }
  if (parameters.size() == 0)
    throw Error("there is no case under " + source + ": load one there with rosparam, or set " + source + "/case_file to its file");
  setup.scene = read_case_text(yaml_of(parameters), source, {}, surroundings);
  return setup;
}

}  // namespace wavetank
