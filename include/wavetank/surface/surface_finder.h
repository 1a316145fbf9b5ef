#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Whether this build has OpenVDB, without which no surface is found.
bool can_find_surface();
/// What to tell who asks for a surface that cannot be found.
inline constexpr const char* why_no_surface =
    "this build cannot find the water's surface, since OpenVDB was not there when it was made: run scripts/install --surface and build "
    "again";

/// Highest places of the water over a grid, of the tank's two directions across its top's axis (z, unless gravity is along another one).
/// Values lie row by row: a row goes along the second direction, from its greatest coordinate down; rows follow each other along the first,
/// likewise from the greatest down, as grid_map has them. In 2-D there is one column.
struct HeightMap {
  int rows = 0, columns = 0;
  double resolution = 0;                            ///< m, of both directions
  Eigen::Vector3d first = Eigen::Vector3d::Zero();  ///< m, of the first value; of the top's axis 0
  std::vector<float> heights;                       ///< m, coordinate along the top's axis; NaN where there is no water
};

/// The water at one time, as a surface and what is too little for one.
struct WaterSurface {
  double time = 0;                            ///< s
  std::vector<Eigen::Vector3f> vertices;      ///< m, in the case's coordinates
  std::vector<std::array<int, 3>> triangles;  ///< anticlockwise seen from outside of the water; closed
  std::vector<Eigen::Vector3f> spray;         ///< m, particles that are not within it
  HeightMap heights;
};

/// What a surface is found from: taken from a simulation at one time.
struct WaterField {
  double time = 0;                         ///< s
  std::vector<Eigen::Vector3f> particles;  ///< m
  std::vector<std::array<int, 3>> nodes;   ///< of the finder's grid, all where there is water and about it
  std::vector<float> filling;              ///< of each node, see Simulation::filling; 1 deep in the water and within walls
  std::vector<float> walls;                ///< of each node, spacings to the nearest wall; negative within it
};

/// Finds the surface of the water: where the kernel is half full, on a grid of one spacing, closed by the walls of tank and bodies and by
/// the planes of openings. In 2-D it is that of a slab of one spacing.
class SurfaceFinder {
 public:
  /// Takes what it needs of the simulation's case and layout. `most_triangles`: what a surface may have; one of more is made coarser where
  /// it is flat, and then all over. Throws Error where can_find_surface() is false.
  explicit SurfaceFinder(const Simulation& simulation, std::size_t most_triangles = 75000);
  ~SurfaceFinder();
  SurfaceFinder(const SurfaceFinder&) = delete;
  SurfaceFinder& operator=(const SurfaceFinder&) = delete;

  /// To be called by the simulation's thread; changes nothing of it.
  WaterField look_at(const Simulation& simulation) const;
  /// May be called by another thread, one at a time.
  WaterSurface find(const WaterField& field) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wavetank
