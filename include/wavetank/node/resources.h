#pragma once

#include <string>

namespace wavetank {

/// The path of a package:// URI, by ROS_PACKAGE_PATH. Throws Error for an unknown package or another scheme.
std::string resolve_resource(const std::string& uri);

}  // namespace wavetank
