#pragma once

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>

#include "wavetank/scene/case.h"

namespace wavetank::scene {

bool has_shape(const urdf::Link& link);

/// The one shape of a link that has one, what collides or else what is seen, with the link placed at `place`. A mesh's file name is
/// package://, file://, an absolute path, or one relative to `directory`, the robot's file's; empty if it has no file. Throws Error
/// beginning with `what` for several shapes, for a relative path without a directory, and for a scale of 0.
MeshSource link_shape(const urdf::Link& link, const Eigen::Isometry3d& place, const std::string& directory, const std::string& what);

}  // namespace wavetank::scene
