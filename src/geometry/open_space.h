#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "triangle_grid.h"
#include "wavetank/scene/upward.h"

namespace wavetank {

/// Water lies below this plane: normal · x < height.
struct FreeSurface {
  Vector3d normal = Vector3d::UnitZ();                      ///< unit, out of the water
  double height = std::numeric_limits<double>::infinity();  ///< m, along the normal

  bool wets(const Vector3d& place) const { return normal.dot(place) < height; }
};

/// The space that the fluid can reach inside the domain: a flood over voxels, where a step between neighbouring voxel centres that meets a
/// wall is barred. It never leaves the domain's bounding box. Throws Error if the domain has too many voxels.
class OpenSpace {
 public:
  OpenSpace(const Box& domain, int dimensions, double spacing, const TriangleGrid& grid, Walls walls, const Top& top = {});

  /// Floods from the points through voxels whose centres lie below the surface.
  void flood(const std::vector<Vector3d>& from, const FreeSurface& surface = {});

  /// Whether the flood passed a voxel near `about` that can be seen from `from`, a place in the domain.
  bool reached(const Vector3d& from, const Vector3d& about) const;

  int dimensions() const { return dimensions_; }
  /// The longest side of a voxel, m.
  double voxel() const { return side_.maxCoeff(); }

  /// Whether a place is in the domain.
  bool holds(const Vector3d& place) const {
    return (place.array() >= domain_.min.array()).all() && (place.array() <= domain_.max.array()).all();
  }

  /// Whether a flood without a surface found the domain's top open.
  bool open_top() const { return open_top_; }

  /// Where the flood found the domain's side or bottom open, or below a surface its top, if it did.
  const std::optional<Vector3d>& escape() const { return escape_; }

 private:
  std::size_t index(const int voxel[3]) const { return (static_cast<std::size_t>(voxel[2]) * count_[1] + voxel[1]) * count_[0] + voxel[0]; }
  Vector3d centre(const int voxel[3]) const;
  void step(const int voxel[3], const Vector3d& position, int axis, int way, const FreeSurface& surface, std::vector<std::size_t>& next);

  const TriangleGrid& grid_;
  Walls walls_;
  int dimensions_;
  Box domain_;
  Top top_;
  int count_[3];
  Vector3d side_;
  std::vector<char> reached_;
  std::optional<Vector3d> escape_;
  bool open_top_ = false;
};

}  // namespace wavetank
