#pragma once

#include <Eigen/Core>
#include <string>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Of a body of density 1 kg/m³ that fills a closed, outwards-wound mesh; multiply mass and inertia by the density.
struct VolumeProperties {
  double volume = 0;                                  ///< m³ (2-D: m², the area enclosed in the x–z plane)
  Vector3d centre = Vector3d::Zero();                 ///< m, of volume
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< m⁵ (2-D: m⁴, only yy), about the centre
};

/// By the divergence theorem over tetrahedra about the mesh's middle; exact up to rounding. Where solids of the mesh overlap or touch, what
/// they have in common counts once, exact to some 1e-5.
VolumeProperties volume_properties(const TriangleMesh& closed);
/// Of the mesh's section with the plane y = 0, where what several solids have in common counts once; a face that lies in the plane is the
/// section of a mesh that only touches it. Throws Error if they do not meet.
VolumeProperties area_properties(const TriangleMesh& closed);

/// What rigid-body dynamics needs, with the case's own values in place of those computed.
struct MassProperties {
  double mass = 0;                                    ///< kg (2-D: kg/m)
  Vector3d centre = Vector3d::Zero();                 ///< m, of mass, as the case's geometry has it
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg·m² (2-D: kg·m, only yy), about it, in the case's axes
  double volume = 0;                                  ///< m³ (2-D: m²) enclosed; 0 for a mesh that is not closed
};

/// The inertia, where none is given, is that of uniform density about the centre of volume, and counts about the centre of mass even where
/// that is given elsewhere: ballast that moves the centre changes the inertia in a way that nobody knows but the user. The products of a
/// given inertia are the matrix's elements: xy = −∫ x y dm, as in URDF. A body that is not free needs no mass: without one it has mass and
/// inertia 0, and in any case a centre, that of volume (the middle of its bounding box if it encloses none) unless it is given.
/// `what` opens the messages ("body 'hull'"). Throws Error where mass and density are both or, of a free body, neither given or not greater
/// than 0; where a free body's are to be found from a mesh that is not closed or encloses next to nothing; and where the inertia
/// is not positive definite or breaks the triangle inequality of its principal moments (each at most the sum of the other two).
MassProperties mass_properties(const RigidCase& rigid, const TriangleMesh& mesh, int dimensions, const std::string& what, bool free = true);

}  // namespace wavetank
