#pragma once

#include <urdf_model/link.h>

#include <Eigen/Geometry>
#include <string>

#include "wavetank/scene/case.h"

namespace wavetank::scene {

bool has_shape(const urdf::Link& link);

/// The one shape of a link that has one, what collides or else what is seen, with the link placed at `place`. Throws Error beginning with
/// `what` for several, for a mesh that is not package:// or file://, and for one that is not scaled alike in all directions.
MeshSource link_shape(const urdf::Link& link, const Eigen::Isometry3d& place, const std::string& what);

}  // namespace wavetank::scene
