#pragma once

#include <array>
#include <string>
#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// An opening where it lies in a wall. Water beyond its plane, in a pocket as deep as the kernel's support and a little more, has an
/// imposed state; it stands on a lattice of rows of about the spacing, one behind the other, of as many columns.
struct Opening {
  enum class Shape { rectangle, disc, polygon };

  std::string name;
  Shape shape = Shape::rectangle;
  int owner = 0;                        ///< of the wall: 0 the tank, 1 + i body i
  Vector3d centre = Vector3d::Zero();   ///< m
  Vector3d normal = Vector3d::UnitX();  ///< unit, into the water
  Vector3d across = Vector3d::UnitY();  ///< unit, along the width
  Vector3d up = Vector3d::UnitZ();      ///< unit, along the height
  double width = 0, height = 0;         ///< m; of a disc both the diameter, of a polygon about it; in 2-D the width is 0
  std::vector<Vector3d> outline;        ///< corners, anticlockwise seen from the water; in 2-D the lower and the upper end
  double area = 0;                      ///< m² (2-D: m), that the columns make up

  int rows = 0;       ///< of the lattice, a spacing apart
  double depth = 0;   ///< m, of all rows together
  double pocket = 0;  ///< m, depth of the hole behind the plane: a spacing more

  /// Cells of the bounding rectangle, across and up, with the least of either first.
  std::array<int, 2> cells{1, 1};
  std::array<double, 2> cell_size{0, 0};   ///< m; in 2-D the width is 0
  std::array<double, 2> first_edge{0, 0};  ///< m from the centre, across and up, of the first cell's outer edges
  std::vector<int> column_of;              ///< of each cell, across fastest; those outside of the outline have their neighbour's

  struct Column {
    Vector3d place = Vector3d::Zero();  ///< m, of its centre on the plane
    double area = 0;                    ///< m² (2-D: m)
    bool wet = false;                   ///< water stands in it at the start
  };
  std::vector<Column> columns;
};

/// The box with the pockets behind openings.
Box with_pockets(Box box, const std::vector<Opening>& openings, int dimensions);

}  // namespace wavetank
