#pragma once

#include <array>
#include <string>
#include <vector>

#include "open_space.h"
#include "outline.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/scene/initial_state.h"

namespace wavetank {

/// A closed body, for the question what lies inside it.
struct Solid {
  std::string name;
  const TriangleMesh* mesh = nullptr;
  Outline outline;  ///< in 2-D
  int dimensions = 3;
  bool is_free = false;

  bool contains(const Vector3d& point) const { return dimensions == 2 ? inside(outline, point) : inside(*mesh, point); }
  Box bounds() const { return dimensions == 2 ? bounding_box(outline) : mesh->bounding_box(); }
};

/// What the fluid is filled into.
struct Basin {
  int dimensions = 3;
  Box domain;                          ///< bounding box of the tank's walls; 2-D: y = 0
  const TriangleGrid* grid = nullptr;  ///< all walls
  std::vector<Solid> solids;           ///< closed bodies
  Vector3d up = Vector3d::UnitZ();     ///< unit, against gravity
  Top top;                             ///< of the tank
  std::array<bool, 3> periodic{};      ///< along x, y, z: the domain repeats itself
  bool has_films = true;               ///< whether particles feel water in gaps too narrow for them
};

/// A free surface that is not level, by columns of a lattice (x fastest): their cells below it are stretched so that they end at it.
struct CurvedSurface {
  std::vector<double> height;  ///< m, of the surface over each column
  std::vector<int> top;        ///< of each column, the uppermost cell below the surface; −1: there is no water at it
  std::vector<float> stretch;  ///< of each cell of the lattice, its height over that of a cell
  std::vector<double> middle;  ///< m, of each cell, the height of its middle
};

/// One region of the case, filled: a regular lattice and which of its cells hold a particle.
struct FilledRegion {
  std::string key;       ///< of the case, for messages: fluid/fill/0
  Vector3d first, step;  ///< centre of cell (0, 0, 0) and the cells' sides, m (2-D: step y = 0)
  Vector3i count;
  std::vector<char> filled;        ///< x fastest
  std::vector<Vector3d> position;  ///< of each cell's particle: its centre unless a wall was too near
  std::vector<char> taken;   ///< cells without a particle of their own whose room particles beside them have: on a wall, or in a narrow gap
  std::vector<float> share;  ///< of each cell's volume, what its particle has, where walls cut cells and in narrow gaps
  FreeSurface surface;       ///< that it was filled up to
  double volume = 0;         ///< of a cell, m³ (2-D: m²)
  CurvedSurface curved;      ///< empty where it is level

  std::size_t column(int i, int j) const { return static_cast<std::size_t>(j) * count[0] + i; }
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * count[1] + j) * count[0] + i; }
  Vector3d centre(int i, int j, int k) const { return first + step.cwiseProduct(Vector3d(i, j, k)); }
};

/// A box: a lattice fitted to it, so that its volume is exact. Cells inside bodies stay empty; throws Error where the box sticks out of the
/// tank.
FilledRegion fill_box(const Basin& basin, const Box& box, double spacing, const std::string& key);

/// From the seed to everywhere below the level that can be reached without crossing a wall. The free surface is at right angles to gravity,
/// and has the level as its coordinate along the axis of the tank's top there where it lies over the seed. The lattice is fitted to the
/// reached space: for a box-shaped one the volume is exact, cells then being a little off the spacing. Throws Error for a seed in the wrong
/// place and for a leak.
FilledRegion fill_flood(const Basin& basin, const FloodFill& flood, double spacing, const std::string& key);

/// Of the region's lattice with so many rows of cells above each other. Throws Error where they are more than a lattice may have.
std::size_t checked_cells(const FilledRegion& region, int rows, const std::string& key);

/// Gives a region that is filled to a level a surface that is `initial`'s elevation over it: in each column the water below the surface has
/// as many cells as fit best, all of one height. For gravity along −z. Throws Error where the surface is over the tank's rim or at its
/// floor, where it does not fit together over the ends of a periodic tank, and for too many cells.
void raise_surface(const Basin& basin, const InitialState& initial, FilledRegion& region);

/// Particles nearer to a wall than 0.05 of the spacing are pushed off to a quarter of it, or left out if they are on it or there is no
/// room.
void keep_off_walls(const Basin& basin, double spacing, FilledRegion& region);

/// Whether a place is in a gap between walls that no particle fits into.
bool is_too_narrow_for_particles(const Basin& basin, const FilledRegion& region, const Vector3d& place);

/// Where walls cut cells, gives each particle the volume of its cell's water that it sees, and of the water beside it that no particle has
/// for which it is the nearest that sees it: so that the particles together have the volume of the region's water, wherever its walls are
/// between the lattice's planes. Not so in gaps too narrow for particles, for water farther off than a cell, and for corners that are left
/// with less than the least share. After keep_off_walls.
void share_cells(const Basin& basin, FilledRegion& region);

/// In gaps between walls that face each other, empties cells whose particle would not fit: all of a gap narrower than a cell, and so many
/// of one narrower than two that those left stand apart. These are put at least half a cell off either wall, or in the middle. After
/// share_cells.
void keep_out_of_gaps(const Basin& basin, FilledRegion& region);

/// Whether a place is in a gap beside a body that is too narrow for particles, but for a film that they feel: none at a free body at rest.
bool is_filled_by_film(const Basin& basin, const FilledRegion& region, const Vector3d& place);

/// Throws Error if the fluid can flow out of the tank's sides or bottom below the region's surface.
void check_watertight(const Basin& basin, double spacing, const FilledRegion& region);

/// Warns of each body that parts water of a box from the rest of that box's, as an open boat does whose inside a box fills too.
void tell_of_parted_water(const Case& checked, const Basin& basin, double spacing, const std::vector<FilledRegion>& regions);

/// Throws Error if particles of two regions are nearer than half the spacing.
void check_overlap(const std::vector<FilledRegion>& regions, double spacing);

/// Elements on every face of a filled cell towards a cell that is open but not filled, here or by another region.
std::vector<WallElement> make_lid(const Basin& basin, double spacing, const std::vector<FilledRegion>& regions);

}  // namespace wavetank
