#include "wavetank/rigid/mass_properties.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "number_text.h"
#include "section.h"
#include "wavetank/common/error.h"
#include "wavetank/geometry/solid_surface.h"

namespace wavetank {
namespace {

constexpr double next_to_nothing = 1e-9;     // of the volume of a cube, or the area of a square, as large as the mesh
constexpr double counted_twice = 1e-6;       // of the area: what solids must have in common for it to be found otherwise
constexpr double triangle_tolerance = 1e-3;  // inertias come rounded to a few digits, and a thin plate's fulfil the inequality just so

using Edge = std::pair<int, int>;  // of the mesh, the lesser vertex first

/// Where the plane y = 0 cuts a triangle: from one of its edges to another, the mesh's inside on the right hand seen along +y.
struct BorderSegment {
  Edge from_edge, to_edge;
  Vector3d from, to;
};

/// Vertices count as on one side or the other of the plane, never on it, so that every closed mesh has closed outlines: as the walls that
/// the fluid sees.
std::vector<BorderSegment> segments_at_plane(const TriangleMesh& mesh, bool on_plane_is_above) {
  const auto above = [&](int v) { return on_plane_is_above ? mesh.vertices[v].y() >= 0 : mesh.vertices[v].y() > 0; };
  std::vector<BorderSegment> segments;
  for (const Vector3i& triangle : mesh.triangles) {
    BorderSegment segment;
    bool found = false;
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      if (above(a) == above(b)) continue;
      const Edge edge = std::minmax(a, b);
      const Vector3d &p = mesh.vertices[edge.first], &q = mesh.vertices[edge.second];
      Vector3d point = p + p.y() / (p.y() - q.y()) * (q - p);
      point.y() = 0;
      (above(a) ? segment.from_edge : segment.to_edge) = edge;
      (above(a) ? segment.from : segment.to) = point;
      found = true;
    }
    if (found) segments.push_back(segment);
  }
  return segments;
}

Vector3d middle_of(const TriangleMesh& mesh) {
  const Box box = mesh.bounding_box();
  return 0.5 * (box.min + box.max);
}

double size_of(const TriangleMesh& mesh) {
  const Box box = mesh.bounding_box();
  return (box.max - box.min).norm();
}

double least_area(const TriangleMesh& mesh) { return next_to_nothing * std::pow(size_of(mesh), 2); }

/// Of the section's trapezoids, which count once what several solids have in common.
std::vector<BorderSegment> borders_of_bands(const TriangleMesh& mesh) {
  std::vector<BorderSegment> segments;
  for (const std::vector<Vector3d>& band : section_bands(mesh))
    for (std::size_t k = 0; k < band.size(); ++k) {
      BorderSegment segment;
      segment.from = band[(k + 1) % band.size()];
      segment.to = band[k];
      segments.push_back(segment);
    }
  return segments;
}

/// By Green's theorem: a triangle from the mesh's middle to each segment.
VolumeProperties properties_of(const std::vector<BorderSegment>& segments, const TriangleMesh& mesh) {
  Vector3d middle = middle_of(mesh);
  middle.y() = 0;
  VolumeProperties result;
  Vector3d moment = Vector3d::Zero();
  double second_moment = 0;
  for (const BorderSegment& segment : segments) {
    const Vector3d p = segment.from - middle, q = segment.to - middle;
    const double area = 0.5 * (p.z() * q.x() - p.x() * q.z());
    result.volume += area;
    moment += area / 3.0 * (p + q);
    second_moment += area / 6.0 * (p.squaredNorm() + p.dot(q) + q.squaredNorm());
  }
  if (std::abs(result.volume) <= least_area(mesh)) return {0.0, middle, Eigen::Matrix3d::Zero()};
  const Vector3d centre = moment / result.volume;
  result.centre = middle + centre;
  result.inertia(1, 1) = second_moment - result.volume * centre.squaredNorm();
  return result;
}

/// The section that has an area, if one has; `closed` tells whether its lines are.
std::optional<VolumeProperties> section(const TriangleMesh& mesh, bool& closed) {
  for (const bool on_plane_is_above : {true, false}) {  // a mesh that only touches the plane from one side is cut in one of the two
    const std::vector<BorderSegment> segments = segments_at_plane(mesh, on_plane_is_above);
    const VolumeProperties found = properties_of(segments, mesh);
    if (found.volume == 0) continue;
    std::map<Edge, int> balance;
    for (const BorderSegment& segment : segments) ++balance[segment.from_edge], --balance[segment.to_edge];
    closed = std::all_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second == 0; });
    if (!closed || found.volume < 0) return found;
    const VolumeProperties once = properties_of(borders_of_bands(mesh), mesh);
    return std::abs(once.volume - found.volume) > counted_twice * found.volume ? once : found;
  }
  return std::nullopt;
}

/// Whether every edge is run through as often one way as the other.
bool is_closed(const TriangleMesh& mesh) {
  std::map<Edge, int> balance;
  for (const Vector3i& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = triangle[k], b = triangle[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& entry) { return entry.second == 0; });
}

/// Nothing for a mesh that is not closed, is wound inwards or encloses next to nothing: a single-walled tank, say.
std::optional<VolumeProperties> enclosed_by(const TriangleMesh& mesh, int dimensions) {
  if (dimensions == 2) {
    bool closed = false;
    const std::optional<VolumeProperties> found = section(mesh, closed);
    return found && closed && found->volume > 0 ? found : std::nullopt;
  }
  if (!is_closed(mesh)) return std::nullopt;
  const VolumeProperties found = volume_properties(mesh);
  return found.volume > next_to_nothing * std::pow(size_of(mesh), 3) ? std::optional(found) : std::nullopt;
}

double mass_of(const RigidCase& rigid, double volume, const std::string& what) {
  if (rigid.mass && rigid.density) throw Error(what + " has both a mass and a density; give one of them");
  if (!rigid.mass && !rigid.density) throw Error(what + " has neither a mass nor a density; give one of them");
  const double given = rigid.mass ? *rigid.mass : *rigid.density;
  if (!(given > 0) || !std::isfinite(given))
    throw Error(what + ": the " + (rigid.mass ? "mass" : "density") + " is " + number_text(given) + "; it must be greater than 0");
  return rigid.mass ? given : given * volume;
}

void check_principal_moments(const Eigen::Matrix3d& inertia, const std::string& what) {
  const Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly).eigenvalues();  // ascending
  const std::string list = number_text(moments[0]) + ", " + number_text(moments[1]) + " and " + number_text(moments[2]) + " kg·m²";
  if (!(moments[0] > 0)) throw Error(what + ": the inertia's principal moments are " + list + "; they must all be greater than 0");
  if (moments[2] > (1 + triangle_tolerance) * (moments[0] + moments[1]))
    throw Error(what + ": the inertia's principal moments are " + list +
                "; no distribution of mass has them, as each is at most the sum of the other two");
}

Eigen::Matrix3d given_inertia(const std::array<double, 6>& given, int dimensions, const std::string& what) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  if (dimensions == 2) {
    if (!(given[1] > 0) || !std::isfinite(given[1]))
      throw Error(what + ": the inertia's yy is " + number_text(given[1]) + "; it must be greater than 0 (kg·m)");
    inertia(1, 1) = given[1];
    return inertia;
  }
  for (const double value : given) {
    if (!std::isfinite(value)) throw Error(what + ": the inertia has a value that is not a finite number");
  }
  const auto [xx, yy, zz, xy, xz, yz] = given;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  check_principal_moments(inertia, what);
  return inertia;
}

}  // namespace

VolumeProperties volume_properties(const TriangleMesh& closed) {
  const Vector3d middle = middle_of(closed);
  VolumeProperties result;
  Vector3d moment = Vector3d::Zero();
  Eigen::Matrix3d second_moments = Eigen::Matrix3d::Zero();  // ∫ x xᵀ dV
  const auto add = [&](const Vector3d& first, const Vector3d& second, const Vector3d& third, double share) {
    const Vector3d a = first - middle, b = second - middle, c = third - middle;
    const Vector3d sum = a + b + c;
    const double volume = share * a.dot(b.cross(c)) / 6.0;
    result.volume += volume;
    moment += volume / 4.0 * sum;
    second_moments += volume / 20.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  };
  const std::vector<SurfacePiece> pieces = solid_surface(closed);
  for (const SurfacePiece& piece : pieces)
    for (std::size_t k = 2; k < piece.corners.size(); ++k) add(piece.corners[0], piece.corners[k - 1], piece.corners[k], piece.share);
  if (pieces.empty())
    for (std::size_t t = 0; t < closed.triangles.size(); ++t) add(closed.corner(t, 0), closed.corner(t, 1), closed.corner(t, 2), 1);
  if (std::abs(result.volume) <= next_to_nothing * std::pow(size_of(closed), 3)) return {0.0, middle, Eigen::Matrix3d::Zero()};
  const Vector3d centre = moment / result.volume;
  second_moments -= result.volume * centre * centre.transpose();
  result.centre = middle + centre;
  result.inertia = second_moments.trace() * Eigen::Matrix3d::Identity() - second_moments;
  return result;
}

VolumeProperties area_properties(const TriangleMesh& closed) {
  bool is_section_closed = false;
  const std::optional<VolumeProperties> found = section(closed, is_section_closed);
  if (found) return *found;
  const Box box = closed.bounding_box();
  throw Error("mesh '" + closed.name + "' has no section with the plane y = 0 of a two-dimensional case: its y goes from " +
              number_text(box.min.y()) + " to " + number_text(box.max.y()) + " m");
}

MassProperties mass_properties(const RigidCase& rigid, const TriangleMesh& mesh, int dimensions, const std::string& what, bool free) {
  const std::optional<VolumeProperties> enclosed = enclosed_by(mesh, dimensions);
  MassProperties result;
  result.volume = enclosed ? enclosed->volume : 0.0;
  result.centre = rigid.centre_of_mass.value_or(enclosed ? enclosed->centre : middle_of(mesh));
  if (dimensions == 2) result.centre.y() = 0;
  if (!result.centre.allFinite()) throw Error(what + ": the centre of mass is not a finite place");
  if (!free && !rigid.mass && !rigid.density) return result;

  result.mass = mass_of(rigid, result.volume, what);
  if (free && !enclosed && !(rigid.mass && rigid.centre_of_mass && rigid.inertia)) {
    throw Error(what + ": the mesh '" + mesh.name + "' is not closed, is wound inwards or encloses next to nothing" +
                (dimensions == 2 ? " in the plane y = 0" : "") +
                ", so that its mass, centre of mass and inertia cannot be found; give all three");
  }
  if (rigid.inertia)
    result.inertia = given_inertia(*rigid.inertia, dimensions, what);
  else if (enclosed)
    result.inertia = result.mass / enclosed->volume * enclosed->inertia;
  return result;
}

}  // namespace wavetank
