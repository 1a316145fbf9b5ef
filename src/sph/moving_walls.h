#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "bound_kernels.h"
#include "kept_buffer.h"
#include "wall_arrays.h"
#include "wall_cells.h"

namespace wavetank {

/// Where an owner of walls is, from where the case's geometry has it: x' = rotation (x − rest) + place.
struct WallPose {
  Vector3d rest = Vector3d::Zero();   ///< m, a point of the owner
  Vector3d place = Vector3d::Zero();  ///< m, where it has moved to
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();

  Vector3d of(const Vector3d& point) const { return rotation * (point - rest) + place; }
  bool operator==(const WallPose& other) const { return rest == other.rest && place == other.place && rotation == other.rotation; }
};

/// Of each owner a rotation, row by row, and a shift, which take places relative to the grid's origin to where they are now.
template <class Real>
std::vector<Real> pose_values(const std::vector<WallPose>& poses, const Discretisation& discretisation);

class HiddenWalls;

/// Keeps the walls on the device where their owners are. Fields are turned and moved on the device; the cells' lists are made
/// anew on the host, but only once a wall has moved by a part of the spacing since, by which the lists reach too far.
template <class Real>
class MovingWalls {
 public:
  /// `walls` as at rest; of each owner, whether it moves, and the point that its poses are about.
  MovingWalls(const compute::Device& device, const WallArrays<Real>& walls, const std::vector<bool>& moving,
              const std::vector<Vector3d>& centres, const Layout& layout, const Discretisation& discretisation);

  /// `walls` are those that place() moves. This must stay where it is from then on.
  void bind(const KernelMaker& make, const compute::Arguments& arguments, WallArrays<Real>& walls);

  /// Moves the walls that were given to the constructor; one pose an owner.
  void place(WallArrays<Real>& walls, const std::vector<WallPose>& poses);

  /// The poses that the lists were made for, which the order of sums depends on, as numbers; and back.
  std::vector<double> listed() const;
  void list_for(WallArrays<Real>& walls, const std::vector<double>& listed);

 private:
  void list(WallArrays<Real>& walls, const std::vector<WallPose>& poses);
  void move(WallArrays<Real>& walls, const std::vector<WallPose>& poses, bool resorted);
  bool lists_hold(const std::vector<WallPose>& poses) const;
  void list_facets(WallArrays<Real>& walls, const std::vector<WallPose>& poses);
  void sort_elements(WallArrays<Real>& walls, const std::vector<WallPose>& poses);
  Facet moved(const Facet& facet, const std::vector<WallPose>& poses) const;

  compute::Device device_;
  Discretisation discretisation_;
  std::shared_ptr<const HiddenWalls> hidden_;
  std::vector<int> moving_;       ///< walls of owners that move
  std::vector<int> listed_anew_;  ///< facets of owners that move, and are in sight always
  std::vector<double> radius_;    ///< of each owner: of its farthest corner from that point, m
  std::vector<char> owner_moves_;
  CellPairs still_;               ///< cells of the facets that stand, and are in sight whatever moves
  std::vector<WallPose> listed_;  ///< the poses that the lists were made for
  int field_count_ = 0;
  compute::Buffer<Real> rest_;
  KeptBuffer<Real> poses_;
  compute::Buffer<int> kinds_, slots_, from_, all_;
  Stride from_field_ = 0, from_wall_ = 0;  ///< steps in the fields
  int moving_count_ = 0, all_count_ = 0;
  compute::BoundKernel place_moving_, place_all_;
};

}  // namespace wavetank
