#include "wavetank/node/resources.h"

#include <ros/package.h>

#include <algorithm>
#include <vector>

#include "wavetank/common/error.h"

namespace wavetank {

std::string resolve_resource(const std::string& uri) {
  const std::string scheme = "package://";
  if (uri.rfind(scheme, 0) != 0) throw Error("'" + uri + "': of such addresses only package://PACKAGE/FILE and file:///FILE can be read");
  const std::size_t slash = uri.find('/', scheme.size());
  const std::string package = uri.substr(scheme.size(), slash - scheme.size());
  if (package.empty() || slash == std::string::npos) throw Error("'" + uri + "' is no address: write package://PACKAGE/FILE");
  std::vector<std::string> known;  // asked first, since getPath prints a complaint of its own about an unknown package
  ros::package::getAll(known);
  if (std::find(known.begin(), known.end(), package) == known.end())
    throw Error("'" + uri + "': no ROS package '" + package + "' is known here; source the setup.bash of the workspace that has it");
  return ros::package::getPath(package) + uri.substr(slash);
}

}  // namespace wavetank
