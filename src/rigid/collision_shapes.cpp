#include "collision_shapes.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>

#include <algorithm>
#include <cmath>

#include "bullet_types.h"
#include "decomposition.h"
#include "number_text.h"
#include "section.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/rigid/mass_properties.h"

namespace wavetank {
namespace {

constexpr double margin_of_spacing = 0.02, margin_of_size = 0.02;
constexpr double nearly_convex = 0.02;        // by which the hull may hold more than the body, for `automatic`
constexpr double of_float = 2.4e-7;           // of a coordinate: two of float32's steps, by which meshes' files are rounded
constexpr std::size_t many_corners = 500;     // every facet of a wall under a hull is compared with all of the hull's corners
constexpr double left_out_of_spacing = 0.02;  // corners of such hulls may stick out by so much

/// The hull's faces as Bullet clips them for contacts.
btConvexPolyhedron polyhedron_of(const ConvexHull& hull, const Vector3d& middle) {
  btConvexPolyhedron polyhedron;
  for (const Vector3d& vertex : hull.vertices) polyhedron.m_vertices.push_back(to_bullet(vertex - middle));
  for (const ConvexHull::Face& face : hull.faces) {
    btFace added;
    for (const int corner : face.loop) added.m_indices.push_back(corner);
    for (int axis = 0; axis < 3; ++axis) added.m_plane[axis] = face.normal[axis];
    added.m_plane[3] = face.normal.dot(middle) - face.offset;
    polyhedron.m_faces.push_back(added);
  }
  // Without btConvexPolyhedron::initialize(), whose time grows with the square of the edges: clipping needs faces and vertices only, what
  // it finds is for Bullet's search for a separating axis, which btDispatcherInfo leaves off.
  return polyhedron;
}

ConvexHull moved(ConvexHull hull, const Vector3d& by) {
  for (Vector3d& vertex : hull.vertices) vertex += by;
  for (ConvexHull::Face& face : hull.faces) face.offset += face.normal.dot(by);
  hull.centre += by;
  return hull;
}

std::vector<Vector3d> prism(const std::vector<Vector3d>& section, double half_width) {
  std::vector<Vector3d> points;
  for (const double y : {-half_width, half_width})
    for (const Vector3d& point : section) points.emplace_back(point.x(), y, point.z());
  return points;
}

/// By how much the vertices may be off. A file's numbers are rounded by their size there, not where the case moves the mesh to.
double rounding_of(const TriangleMesh& mesh, const MeshSource* source) {
  double farthest = 0;
  if (source == nullptr) return farthest;
  for (const Vector3d& vertex : mesh.vertices) farthest = std::max(farthest, (vertex - source->translation).norm());
  return of_float * farthest;
}

double volume_of(const TriangleMesh& mesh, int dimensions) {
  return dimensions == 2 ? area_properties(mesh).volume : volume_properties(mesh).volume;
}

/// A maker of one body's shape.
class Shaper {
 public:
  explicit Shaper(const ShapeRequest& request) : request_(request) {}

  std::vector<ConvexHull> hulls(const std::string& case_directory, const ResourceResolver& resolve) const {
    switch (request_.rigid->collision) {
      case CollisionShape::none:
        return {};
      case CollisionShape::convex_hull:
        return {spoken_of(whole())};
      case CollisionShape::decomposition:
        return decomposed();
      case CollisionShape::parts:
        return listed(case_directory, resolve);
      case CollisionShape::automatic:
        break;
    }
    ConvexHull hull = whole();
    if (request_.is_box()) return {std::move(hull)};
    if (excess(hull) < nearly_convex) return {spoken_of(std::move(hull))};
    return decomposed();
  }

 private:
  bool in_plane() const { return request_.dimensions == 2; }

  ConvexHull hull_of(const TriangleMesh& mesh, const MeshSource* source) const {
    const HullPrecision precision{rounding_of(mesh, source), 0};
    if (in_plane()) return convex_hull(prism(section_points(mesh), request_.half_width), request_.what, precision);
    return thinned(convex_hull(mesh.vertices, request_.what, precision), precision);
  }
  ConvexHull whole() const { return hull_of(*request_.mesh, request_.source); }

  ConvexHull thinned(ConvexHull hull, HullPrecision precision) const {
    if (hull.vertices.size() <= many_corners) return hull;
    precision.left_out = left_out_of_spacing * request_.spacing;
    return convex_hull(hull.vertices, request_.what, precision);
  }

  /// What a hull holds more than the body, of the body's volume.
  double excess(const ConvexHull& hull) const {
    const double held = in_plane() ? hull.volume / (2 * request_.half_width) : hull.volume;
    return held / volume_of(*request_.mesh, request_.dimensions) - 1;
  }

  ConvexHull spoken_of(ConvexHull hull) const {
    const double more = excess(hull);
    if (std::abs(more) > 1e-6)
      log(LogLevel::info, request_.what + " is its convex hull in contacts, which holds " + number_text(100 * std::abs(more)) + " % " +
                              (more > 0 ? "more" : "less") + " than the body.");
    return hull;
  }

  std::vector<ConvexHull> decomposed() const {
    const HullPrecision precision{rounding_of(*request_.mesh, request_.source), 0};
    std::vector<ConvexHull> parts;
    if (in_plane()) {
      for (const std::vector<Vector3d>& polygon : convex_polygons(*request_.mesh))
        parts.push_back(convex_hull(prism(polygon, request_.half_width), request_.what, precision));
    } else {
      parts = decompose(*request_.mesh, request_.spacing, precision, request_.what);
    }
    tell_of(parts, "found automatically");
    return parts;
  }

  std::vector<ConvexHull> listed(const std::string& case_directory, const ResourceResolver& resolve) const {
    std::vector<ConvexHull> parts;
    for (const MeshSource& source : request_.rigid->collision_parts) {
      try {
        parts.push_back(hull_of(read_mesh(source, case_directory, resolve), &source));
      } catch (const Error& error) {
        throw Error(request_.what + ", a part for contacts: " + error.what());
      }
    }
    if (parts.empty()) throw Error(request_.what + " has no parts for contacts: list meshes, or choose another shape for contacts");
    if (request_.is_solid) tell_of(parts, "as listed");
    return parts;
  }

  void tell_of(const std::vector<ConvexHull>& parts, const std::string& whence) const {
    const VolumeDifference difference = volume_difference(*request_.mesh, parts, request_.dimensions);
    if (in_plane() && difference.lacking + difference.added < 1e-6) return;  // a section may fall into convex parts exactly
    log(LogLevel::info, request_.what + " is " + std::to_string(parts.size()) + " convex parts in contacts, " + whence + ": they lack " +
                            number_text(100 * difference.lacking) + " % of its " + (in_plane() ? "area" : "volume") + " and hold " +
                            number_text(100 * difference.added) + " % more.");
  }

  const ShapeRequest& request_;
};

}  // namespace

ConvexPart::ConvexPart(ConvexHull shape_hull, bool is_box, double margin) : hull(std::move(shape_hull)) {
  const Box box = hull.bounding_box();
  middle = is_box ? Vector3d(0.5 * (box.min + box.max)) : hull.centre;
  margin = std::min(margin, margin_of_size * (box.max - box.min).minCoeff());
  if (is_box) {
    shape = std::make_unique<btBoxShape>(to_bullet(0.5 * (box.max - box.min)));
  } else {
    // The search for the nearest points works on a smaller hull and the margin around it, so that it need not look into overlaps.
    auto points = std::make_unique<btConvexHullShape>();
    for (const Vector3d& vertex : shrunk(hull, margin)) points->addPoint(to_bullet(vertex - middle), false);
    points->recalcLocalAabb();
    shape = std::move(points);
  }
  shape->setMargin(margin);
  btConvexPolyhedron polyhedron = polyhedron_of(hull, middle);
  shape->setPolyhedralFeatures(polyhedron);
}

ConvexPart::~ConvexPart() = default;
ConvexPart::ConvexPart(ConvexPart&&) noexcept = default;
ConvexPart& ConvexPart::operator=(ConvexPart&&) noexcept = default;

std::vector<ConvexPart> make_shape(const ShapeRequest& request, const std::string& case_directory, const ResourceResolver& resolve) {
  const bool is_box = request.is_box() && request.rigid->collision == CollisionShape::automatic;
  std::vector<ConvexPart> parts;
  for (ConvexHull& hull : Shaper(request).hulls(case_directory, resolve))
    parts.emplace_back(moved(std::move(hull), -request.reference), is_box, margin_of_spacing * request.spacing);
  return parts;
}

}  // namespace wavetank
