#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// The tank or a body, as it is at the start.
struct OwnerSize {
  std::string name;                  ///< "tank", or the body's
  Vector3d size = Vector3d::Zero();  ///< m, of its bounding box
  double volume = 0;                 ///< m³ (2-D: m²) enclosed, of a box tank what it holds; 0 where a mesh is open
  double mass = 0;                   ///< kg (2-D: kg/m); 0 where the case gives none
  bool floats_alone = false;         ///< free, with nothing but its weight and the water to place it: it has a draught, or sinks
  std::optional<double> draught;     ///< m, afloat and upright; none = it sinks
};

/// How large the parts of a case are: what shows at a glance that a scale was forgotten or a spacing is too coarse.
struct CaseSize {
  double water_volume = 0;             ///< m³ (2-D: m²)
  double water_mass = 0;               ///< kg (2-D: kg/m)
  double least_depth = 0;              ///< m, of the shallowest of separate waters; a quarter of its surface at least is as shallow
  std::optional<double> least_extent;  ///< m, of the thinnest body's bounding box; none = no bodies
  std::string thinnest_body;           ///< its name
  std::vector<OwnerSize> owners;       ///< 0 the tank, 1 + i body i
};

/// `world` and `layout` are of the case.
CaseSize size_of(const Case& settled_case, const Layout& layout, const RigidWorld& world);

/// Warns through the log of water that has fewer than four particles over its depth.
void tell_of_shallow_water(const Layout& layout);

}  // namespace wavetank
