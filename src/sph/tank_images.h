#pragma once

#include <array>
#include <string>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// A plane, with its normal into the fluid: normal · x + offset is the distance from it, m.
struct TankPlane {
  Vector3d normal = Vector3d::Zero();
  double offset = 0;
};

/// A part of a mirroring plane that is open. Where it reaches up to another plane it has an edge past that, or none.
struct PlaneGap {
  TankPlane plane;
  Vector3d centre = Vector3d::Zero();  ///< m, of a disc
  double radius = 0;                   ///< m, of a disc; 0: it has edges
  std::vector<TankPlane> edges;        ///< at right angles to the plane, with normals out of the gap
};

/// An image x' = matrix x + offset of the tank's particles: a shift by periods, or a reflection in planes at right angles (a ghost).
struct TankImage {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  Vector3d offset = Vector3d::Zero();  ///< m
  Eigen::Matrix3d velocity_matrix = Eigen::Matrix3d::Identity();
  Vector3d velocity_offset = Vector3d::Zero();  ///< m/s
  std::array<TankPlane, 3> seen_near;  ///< by particles nearer than the support to all of these; a plane without a normal is always near
  bool mirrored = false;
  std::vector<PlaneGap> gaps;  ///< of the planes that it is mirrored in
};

/// The planes of a tank's own walls, each once; walls of the pockets behind `openings` are none. Throws Error unless the tank is convex and
/// its planes are parallel or at right angles, which `chosen`, a key and its value, needs and `instead` does not.
std::vector<TankPlane> tank_planes(const Layout& layout, const std::vector<Opening>& openings,
                                   const std::string& chosen = "numerics/walls/method is ghost",
                                   const std::string& instead = "boundary_integral");

/// All images that a case's particles can see; none for a case that is neither periodic nor walled by ghosts. Coordinates are the device's.
/// Throws Error for what ghosts cannot do, and for a tank narrower than the kernel's support between images.
std::vector<TankImage> tank_images(const Case& settled_case, const Layout& layout, const Discretisation& discretisation);

/// The images, and the gaps in their planes, as neighbours.cl reads them.
template <class Real>
std::vector<Real> image_values(const std::vector<TankImage>& images);

}  // namespace wavetank
