#include "urdf_text.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <set>

#include "wavetank/common/error.h"

namespace wavetank::scene {
namespace {

/// Keeps the first complaint of the URDF parser, which would print it.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  Complaints(const Complaints&) = delete;
  Complaints& operator=(const Complaints&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (!first_.empty() || level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    first_ = text;
    std::replace(first_.begin(), first_.end(), '\n', ' ');
  }

  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

urdf::ModelInterfaceSharedPtr parse(const std::string& urdf, const std::string& source) {
  if (urdf.find("<xacro:") != std::string::npos)
    throw Error(source +
                ": is a xacro file, not yet URDF; expand it first with pipx run xacro FILE > ROBOT.urdf (apt install pipx; "
                "Debian has no package of xacro itself), or with xacro FILE > ROBOT.urdf where there is one");
  Complaints complaints;
  urdf::ModelInterfaceSharedPtr model;
  std::string reason;
  try {
    model = urdf::parseURDF(urdf);
  } catch (const std::exception& exception) {
    reason = exception.what();
  }
  if (!complaints.first().empty()) reason = complaints.first();
  if (model && model->getRoot()) return model;
  throw Error(source + ": not a URDF description that can be read" + (reason.empty() ? "" : ": " + reason));
}

}  // namespace

std::vector<urdf::LinkConstSharedPtr> read_links(const std::string& urdf, const std::string& source) {
  const urdf::ModelInterfaceSharedPtr model = parse(urdf, source);
  std::vector<urdf::LinkConstSharedPtr> links{model->getRoot()};
  std::set<std::string> met{links.front()->name};
  for (std::size_t next = 0; next < links.size(); ++next) {
    const urdf::LinkConstSharedPtr link = links[next];
    for (const urdf::LinkSharedPtr& child : link->child_links) {
      if (!met.insert(child->name).second)
        throw Error(source + ": link '" + child->name + "' is the child of more than one joint; give each link one");
      links.push_back(child);
    }
  }
  std::vector<urdf::LinkSharedPtr> all;
  model->getLinks(all);
  for (const urdf::LinkSharedPtr& link : all) {
    if (met.count(link->name) == 0)
      throw Error(source + ": link '" + link->name + "' does not hang on the root link, " + links.front()->name + "; join it by a joint");
  }
  return links;
}

Eigen::Isometry3d transform_of(const urdf::Pose& pose) {
  double x = 0, y = 0, z = 0, w = 1;
  pose.rotation.getQuaternion(x, y, z, w);
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) * Eigen::Quaterniond(w, x, y, z).normalized();
}

}  // namespace wavetank::scene
