#pragma once

#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace wavetank::scene {

/// The links of a robot described by URDF text, each after its parent. Throws Error beginning with `source` for text that is no URDF and
/// for links that make no tree.
std::vector<urdf::LinkConstSharedPtr> read_links(const std::string& urdf, const std::string& source);

Eigen::Isometry3d transform_of(const urdf::Pose& pose);

}  // namespace wavetank::scene
