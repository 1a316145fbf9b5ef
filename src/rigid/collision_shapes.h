#pragma once

#include <memory>
#include <string>
#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/mesh.h"
#include "wavetank/scene/case.h"

class btPolyhedralConvexShape;

namespace wavetank {

/// One convex part of what stands for a body in contacts.
struct ConvexPart {
  ConvexPart(ConvexHull hull, bool is_box, double margin);
  ~ConvexPart();
  ConvexPart(ConvexPart&&) noexcept;
  ConvexPart& operator=(ConvexPart&&) noexcept;

  ConvexHull hull;                                 ///< about the body's reference point, in the body's axes
  Vector3d middle = Vector3d::Zero();              ///< that the shape is about, likewise
  std::unique_ptr<btPolyhedralConvexShape> shape;  ///< Bullet's; its faces are those of the hull whatever its margin
};

/// What a shape is made from and how fine it has to be.
struct ShapeRequest {
  const RigidCase* rigid = nullptr;
  const TriangleMesh* mesh = nullptr;
  const MeshSource* source = nullptr;  ///< of the mesh; none of a box
  bool is_solid = true;                ///< the mesh encloses what the shape stands for, and is not a tank's walls
  int dimensions = 3;
  Vector3d reference = Vector3d::Zero();  ///< m, that the shape will be about
  double spacing = 0;                     ///< m
  double half_width = 0;                  ///< m, in y, of what stands for a section in 2-D
  std::string what;                       ///< opens messages ("body 'hull'")
  bool is_box() const { return source == nullptr; }
};

/// The parts of a body's shape; none if it passes through everything. In 2-D they are prisms over the mesh's section with y = 0; in 3-D
/// hulls of more than 500 corners are thinned, to 0.02 of the spacing. Says once, through the log, where they are an approximation. Throws
/// Error for a body that cannot be a shape, and for parts that cannot be read.
std::vector<ConvexPart> make_shape(const ShapeRequest& request, const std::string& case_directory, const ResourceResolver& resolve);

}  // namespace wavetank
