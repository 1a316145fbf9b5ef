#pragma once

#include <memory>
#include <vector>

#include "convex_hull.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_state.h"

namespace wavetank {

/// A convex hull where it is now.
struct PlacedHull {
  PlacedHull(const ConvexHull& shape, const Quaterniond& turn, const Vector3d& place);

  const ConvexHull* hull;
  std::vector<Vector3d> vertices, normals;  ///< of the hull's vertices and faces
  Vector3d centre;
  Box box;
};

/// Where a hull touches, or nearly touches, a wall.
struct WallContact {
  Vector3d point = Vector3d::Zero();   ///< m
  Vector3d normal = Vector3d::Zero();  ///< unit, out of the wall
  double gap = 0;                      ///< m, negative where they overlap
  int owner = 0;                       ///< of the wall's facet
};

/// Walls that move together, as the layout's facets, which know on which side the fluid is. They stop what comes from there and nothing
/// else: a facet acts on a hull whose centre is before it. At the edge between facets that lie in a plane, or that form a hollow, no hull
/// can be caught; at a salient edge or a free one it is pushed off in the direction in which it overlaps least.
class WallSurface {
 public:
  /// Of the owners given; in 2-D segments become strips, `half_width` to either side of y = 0.
  WallSurface(const Layout& layout, const std::vector<int>& owners, int dimensions, double half_width);
  ~WallSurface();
  WallSurface(WallSurface&&) noexcept;

  bool empty() const { return facets_.empty(); }
  /// Adds the contacts of a hull that is given in the walls' own coordinates, up to a gap of `reach`.
  void find(const PlacedHull& hull, double reach, std::vector<WallContact>& contacts) const;

 private:
  struct Side {
    Vector3d outwards;                           ///< unit, in the facet's plane
    bool salient = true;                         ///< a hull can lie against the side itself
    bool joined = false;                         ///< with another facet
    Vector3d other_outwards = Vector3d::Zero();  ///< of that facet
    bool faces(const Vector3d& direction) const;
  };
  struct WallFacet {
    std::vector<Vector3d> corners;  ///< anticlockwise seen from the fluid
    Vector3d normal;                ///< unit, into the fluid
    double offset = 0;
    int owner = 0;
    std::vector<Side> sides;  ///< from corner k to corner k + 1
    bool any_salient = false;
  };
  struct Axis;
  struct Tree;

  void add(const Facet& facet, int dimensions, double half_width);
  void join_sides(double tolerance);
  std::vector<int> overlapping(const Box& box) const;
  void find_at(const WallFacet& facet, const PlacedHull& hull, double reach, std::vector<WallContact>& contacts) const;
  bool search_faces(const WallFacet& facet, const PlacedHull& hull, double reach, Axis& best) const;
  bool search_edges(const WallFacet& facet, const PlacedHull& hull, double reach, Axis& best) const;

  int dimensions_;
  double shallow_;  ///< m: overlap up to which a facet's own normal is taken unquestioned
  std::vector<WallFacet> facets_;
  std::unique_ptr<Tree> tree_;
};

/// Cuts a plane polygon, keeping what lies at outwards · x ≤ offset.
std::vector<Vector3d> cut_off(const std::vector<Vector3d>& polygon, const Vector3d& outwards, double offset);

}  // namespace wavetank
