#include "tank_images.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "tables/device_sizes.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"

namespace wavetank {
namespace {

constexpr double parallel_within = 1e-6;  // of a cosine, and of a sine
constexpr double flat_distance = 1e-3;    // of the spacing: planes nearer together are one
constexpr double flush = 0.25;            // of the spacing: a gap whose edge is so near to another plane reaches up to that

/// One thing that makes an image: a mirror or a shift by a period.
struct Generator {
  bool mirror = false;
  TankPlane plane;                    ///< of the mirror, or of the end near which the shifted particles are seen
  Vector3d shift = Vector3d::Zero();  ///< m
  std::vector<PlaneGap> gaps;         ///< of the mirror
};

double distance_from(const TankPlane& plane, const Vector3d& point) { return plane.normal.dot(point) + plane.offset; }

TankPlane plane_through(const Vector3d& point, const Vector3d& normal) { return {normal, -normal.dot(point)}; }

/// The sides of an opening and of its pocket, with normals out of it; in 2-D the lower and the upper one.
std::vector<TankPlane> sides_of(const Opening& opening) {
  const std::size_t count = opening.outline.size();
  if (count == 2) return {plane_through(opening.outline[0], -opening.up), plane_through(opening.outline[1], opening.up)};
  std::vector<TankPlane> sides;
  for (std::size_t k = 0; k < count; ++k) {
    const Vector3d along = opening.outline[(k + 1) % count] - opening.outline[k];
    sides.push_back(plane_through(opening.outline[k], along.cross(opening.normal).normalized()));
  }
  return sides;
}

/// In an opening's pocket, its sides and its front included.
bool in_pocket(const Opening& opening, const Vector3d& point, double tolerance) {
  const double behind = -opening.normal.dot(point - opening.centre);
  if (behind < -tolerance || behind > opening.pocket + tolerance) return false;
  const std::vector<TankPlane> sides = sides_of(opening);
  return std::all_of(sides.begin(), sides.end(), [&](const TankPlane& side) { return distance_from(side, point) <= tolerance; });
}

bool in_a_pocket(const std::vector<Opening>& openings, const Vector3d& point, double tolerance) {
  return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) { return in_pocket(opening, point, tolerance); });
}

bool is_of_pocket(const std::vector<Opening>& openings, const Facet& facet, double tolerance) {
  return std::any_of(openings.begin(), openings.end(), [&](const Opening& opening) {
    return std::all_of(std::begin(facet.corners), std::end(facet.corners),
                       [&](const Vector3d& corner) { return in_pocket(opening, corner, tolerance); });
  });
}

/// What an opening leaves open of a plane: if it is in the plane, its outline, and if it is in a wall at an angle to it, all that lies
/// behind that wall. `others`: planes, and ends that repeat themselves, beyond which there is no water but that behind openings; those
/// before `own` are mirrored in the plane with all that is behind them, so that one of two openings that meet in an edge fills the corner.
void add_gap(const TankPlane& plane, const Opening& opening, const std::vector<TankPlane>& others, std::size_t own, double spacing,
             std::vector<PlaneGap>& gaps) {
  PlaneGap gap;
  gap.plane = plane;
  const double cosine = plane.normal.dot(opening.normal);
  if (cosine > 1.0 - parallel_within && std::abs(distance_from(plane, opening.centre)) < 10 * flat_distance * spacing) {
    gap.centre = opening.centre;
    if (opening.shape == Opening::Shape::disc) {
      gap.radius = 0.5 * opening.width;
    } else {
      for (TankPlane side : sides_of(opening)) {
        const Vector3d at = -side.offset * side.normal + (opening.centre - side.normal.dot(opening.centre) * side.normal);
        const auto other = std::find_if(others.begin(), others.end(), [&](const TankPlane& candidate) {
          return candidate.normal.dot(side.normal) < -1.0 + parallel_within && std::abs(distance_from(candidate, at)) < flush * spacing;
        });
        if (other != others.end()) side.offset -= 2 * flush * spacing;  // nothing before the other plane is near that edge
        if (other == others.end() || other < others.begin() + static_cast<std::ptrdiff_t>(own)) gap.edges.push_back(side);
      }
    }
    gaps.push_back(gap);
  } else if (std::abs(cosine) > parallel_within && std::abs(cosine) < 1.0 - parallel_within) {
    const Vector3d along = opening.normal - cosine * plane.normal;
    const double size = along.norm();
    // of a point of the plane, x = x∥ − o n: its distance from the opening's plane is n'·x − n'·c
    gap.edges.push_back({along / size, (-cosine * plane.offset - opening.normal.dot(opening.centre)) / size});
    gaps.push_back(gap);
  }
}

/// Water that is free to leave by a hole in a plane that mirrors meets the images beside the hole, whose motion towards it is half wrong
/// where the water slips and where it does not, and whose pressure is that of water which does not flow: it takes many spacings before
/// that is little beside the whole. Throws Error where it is half of it.
void check_width(const OpeningCase& given, const Opening& opening, const PlaneGap& gap, const Layout& layout) {
  constexpr double least = 8, enough = 20;  // spacings: at 4 half as much leaves as should, at 10 from 0.7 to 1.15, at 20 from 0.95 to 1.07
  if (given.kind == OpeningKind::inlet || given.command || given.record || !given.discharge.empty()) return;
  double narrowest = gap.radius > 0 ? opening.width : std::numeric_limits<double>::infinity();
  const double surface =
      layout.levels.empty() ? std::numeric_limits<double>::infinity() : *std::max_element(layout.levels.begin(), layout.levels.end());
  // a side counts that is under water and from which the plane goes on, not one past another plane
  const auto is_free = [&](const Vector3d& side, const Vector3d& outwards) {
    return layout.up.dot(side) < surface && std::any_of(gap.edges.begin(), gap.edges.end(), [&](const TankPlane& edge) {
             return edge.normal.dot(outwards) > 0.5 && std::abs(distance_from(edge, side)) < flush * layout.spacing;
           });
  };
  for (const auto& [direction, size] : {std::pair(opening.across, opening.width), std::pair(opening.up, opening.height)}) {
    if (!(size > 0)) continue;
    int sides = 0;
    for (const double way : {-1.0, 1.0}) sides += is_free(opening.centre + 0.5 * way * size * direction, way * direction) ? 1 : 0;
    if (sides > 0) narrowest = std::min(narrowest, sides == 1 ? 2 * size : size);  // where it ends at a wall, that mirrors it
  }
  const double spacings = narrowest / layout.spacing;
  std::ostringstream width;
  width.precision(3);
  width << "opening '" << opening.name << "' is a hole " << spacings << " spacings wide in a wall, and numerics/walls/method is ghost: ";
  if (spacings < least * (1 - 1e-9))
    throw Error(width.str() +
                "half of what should leaves there; make it at least 8 spacings wide, give its discharge, or choose boundary_integral.");
  if (spacings < enough * (1 - 1e-9))
    log(LogLevel::warning,
        width.str() + "what leaves there is wrong by up to a third below 20 spacings; boundary_integral is better there");
}

std::string text(const Vector3d& v) {
  const auto rounded = [](double value) {
    std::string digits = std::to_string(std::round(value * 1e4) / 1e4);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits == "-0" ? std::string("0") : digits;
  };
  return "(" + rounded(v.x()) + ", " + rounded(v.y()) + ", " + rounded(v.z()) + ")";
}

void add_images(const std::vector<Generator>& generators, std::size_t next, const TankImage& so_far, int depth, Slip slip,
                std::vector<TankImage>& images) {
  for (std::size_t g = next; g < generators.size(); ++g) {
    const Generator& generator = generators[g];
    const Vector3d& n = generator.plane.normal;
    const bool at_right_angles = std::all_of(so_far.seen_near.begin(), so_far.seen_near.begin() + depth,
                                             [&](const TankPlane& other) { return std::abs(other.normal.dot(n)) < 0.5; });
    if (!at_right_angles) continue;  // its opposite: no particle is near both
    TankImage image = so_far;
    if (generator.mirror) {
      const Eigen::Matrix3d reflection = Eigen::Matrix3d::Identity() - 2.0 * n * n.transpose();
      image.offset = reflection * so_far.offset - 2.0 * generator.plane.offset * n;
      image.matrix = reflection * so_far.matrix;
      image.mirrored = true;
      image.gaps.insert(image.gaps.end(), generator.gaps.begin(), generator.gaps.end());
      image.velocity_matrix = slip == Slip::no_slip ? Eigen::Matrix3d(-Eigen::Matrix3d::Identity()) : image.matrix;
    } else {
      image.offset += generator.shift;
    }
    image.seen_near[depth] = generator.plane;
    images.push_back(image);
    if (depth + 1 < 3) add_images(generators, g + 1, image, depth + 1, slip, images);
  }
}

}  // namespace

std::vector<TankPlane> tank_planes(const Layout& layout, const std::vector<Opening>& openings, const std::string& chosen,
                                   const std::string& instead) {
  std::vector<TankPlane> planes;
  const double tolerance = flat_distance * layout.spacing;
  for (const Facet& facet : layout.facets) {
    if (facet.owner != 0 || is_of_pocket(openings, facet, tolerance)) continue;
    const TankPlane plane{-facet.normal, facet.normal.dot(facet.plane_point)};
    const bool known = std::any_of(planes.begin(), planes.end(), [&](const TankPlane& other) {
      return other.normal.dot(plane.normal) > 1.0 - parallel_within && std::abs(distance_from(other, facet.plane_point)) < tolerance;
    });
    if (!known) planes.push_back(plane);
  }
  for (const TankPlane& plane : planes) {
    for (const TankPlane& other : planes) {
      const double cosine = std::abs(plane.normal.dot(other.normal));
      if (cosine > parallel_within && cosine < 1.0 - parallel_within)
        throw Error(chosen + ", which needs walls at right angles, but the tank has walls that face " + text(plane.normal) + " and " +
                    text(other.normal) + ": choose " + instead + ".");
    }
    for (const Facet& facet : layout.facets) {
      for (const Vector3d& corner : facet.corners) {
        if (distance_from(plane, corner) < -10 * tolerance && !in_a_pocket(openings, corner, tolerance))
          throw Error(chosen + ", which needs a convex tank, but the wall at " + text(corner) + " m lies behind another: choose " +
                      instead + ".");
      }
    }
  }
  return planes;
}

std::vector<TankImage> tank_images(const Case& scene, const Layout& layout, const Discretisation& d) {
  std::vector<Generator> generators;
  const auto relative = [&](TankPlane plane) {
    plane.offset += plane.normal.dot(d.origin);
    return plane;
  };
  for (int axis = 0; axis < 3; ++axis) {
    if (!scene.tank.periodic[axis]) continue;
    const double period = layout.domain.max[axis] - layout.domain.min[axis];
    if (period < 2.0 * d.support)
      throw Error("tank/periodic: the tank is only " + std::to_string(period) + " m long along " + "xyz"[axis] +
                  ", less than twice the kernel's support of " + std::to_string(d.support) +
                  " m: make it longer or fluid/spacing smaller.");
    for (const double way : {1.0, -1.0}) {
      Generator end;
      end.plane.normal = way * Vector3d::Unit(axis);
      end.plane.offset = -way * (way > 0 ? layout.domain.min[axis] : layout.domain.max[axis]);
      end.plane = relative(end.plane);
      end.shift = -way * period * Vector3d::Unit(axis);
      generators.push_back(end);
    }
  }
  if (scene.numerics.walls.method == WallMethod::ghost) {
    const std::vector<TankPlane> planes = tank_planes(layout, layout.openings);
    std::vector<TankPlane> borders = planes;
    for (const Generator& end : generators) borders.push_back({end.plane.normal, end.plane.offset - end.plane.normal.dot(d.origin)});
    for (std::size_t own = 0; own < planes.size(); ++own) {
      const TankPlane& plane = planes[own];
      for (const TankPlane& other : planes) {
        if (plane.normal.dot(other.normal) < -0.5 && plane.offset + other.offset < 2.0 * d.support)
          throw Error("numerics/walls/method is ghost, but the tank's walls are only " + std::to_string(plane.offset + other.offset) +
                      " m apart, less than twice the kernel's support of " + std::to_string(d.support) + " m: choose boundary_integral.");
      }
      Generator mirror;
      mirror.mirror = true;
      mirror.plane = relative(plane);
      for (std::size_t o = 0; o < layout.openings.size(); ++o) {
        const Opening& opening = layout.openings[o];
        const std::size_t before = mirror.gaps.size();
        add_gap(plane, opening, borders, own, layout.spacing, mirror.gaps);
        const bool in_plane = mirror.gaps.size() > before && plane.normal.dot(opening.normal) > 1.0 - parallel_within;
        if (in_plane) check_width(scene.openings.at(o), opening, mirror.gaps.back(), layout);
      }
      for (PlaneGap& gap : mirror.gaps) {
        gap.plane = relative(gap.plane);
        gap.centre -= d.origin;
        for (TankPlane& edge : gap.edges) edge = relative(edge);
      }
      generators.push_back(mirror);
    }
  }
  std::vector<TankImage> images;
  add_images(generators, 0, TankImage{}, 0, scene.numerics.walls.slip, images);
  return images;
}

template <class Real>
std::vector<Real> image_values(const std::vector<TankImage>& images) {
  std::vector<Real> values;
  const auto add = [&values](double value) { values.push_back(static_cast<Real>(value)); };
  const auto add_vector = [&add](const Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) add(vector[axis]);
  };
  const auto add_plane = [&](const TankPlane& plane) {
    add_vector(plane.normal);
    add(plane.offset);
  };
  const auto add_matrix = [&add](const Eigen::Matrix3d& matrix) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) add(matrix(row, column));
  };
  for (const TankImage& image : images) {
    add_matrix(image.matrix);
    add_vector(image.offset);
    add_matrix(image.velocity_matrix);
    add_vector(image.velocity_offset);
    for (const TankPlane& plane : image.seen_near) add_plane(plane);
    add(image.mirrored ? 1.0 : 0.0);
  }
  constexpr std::size_t values_of_edge = 4;
  std::size_t begin = values.size() + 2 * images.size();
  for (const TankImage& image : images) {
    add(static_cast<double>(begin));
    add(static_cast<double>(image.gaps.size()));
    for (const PlaneGap& gap : image.gaps) begin += field::gap_edges + values_of_edge * gap.edges.size();
  }
  for (const TankImage& image : images)
    for (const PlaneGap& gap : image.gaps) {
      add_plane(gap.plane);
      add_vector(gap.centre);
      add(gap.radius);
      add(static_cast<double>(gap.edges.size()));
      for (const TankPlane& edge : gap.edges) add_plane(edge);
    }
  if (values.empty()) values.push_back(Real(0));
  return values;
}

template std::vector<float> image_values(const std::vector<TankImage>&);
template std::vector<double> image_values(const std::vector<TankImage>&);

}  // namespace wavetank
