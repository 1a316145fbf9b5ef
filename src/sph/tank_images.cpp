#include "tank_images.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double parallel = 1e-6;       // of a cosine, and of a sine
constexpr double flat_distance = 1e-3;  // of the spacing: planes nearer together are one

/// One thing that makes an image: a mirror or a shift by a period.
struct Generator {
  bool mirror = false;
  TankPlane plane;                    ///< of the mirror, or of the end near which the shifted particles are seen
  Vector3d shift = Vector3d::Zero();  ///< m
};

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

std::vector<TankPlane> tank_planes(const Layout& layout, const std::string& chosen, const std::string& instead) {
  std::vector<TankPlane> planes;
  const double tolerance = flat_distance * layout.spacing;
  for (const Facet& facet : layout.facets) {
    if (facet.owner != 0) continue;
    const TankPlane plane{-facet.normal, facet.normal.dot(facet.plane_point)};
    const bool known = std::any_of(planes.begin(), planes.end(), [&](const TankPlane& other) {
      return other.normal.dot(plane.normal) > 1.0 - parallel && std::abs(other.normal.dot(facet.plane_point) + other.offset) < tolerance;
    });
    if (!known) planes.push_back(plane);
  }
  for (const TankPlane& plane : planes) {
    for (const TankPlane& other : planes) {
      const double cosine = std::abs(plane.normal.dot(other.normal));
      if (cosine > parallel && cosine < 1.0 - parallel)
        throw Error(chosen + ", which needs walls at right angles, but the tank has walls that face " + text(plane.normal) + " and " +
                    text(other.normal) + ": choose " + instead + ".");
    }
    for (const Facet& facet : layout.facets) {
      for (const Vector3d& corner : facet.corners) {
        if (plane.normal.dot(corner) + plane.offset < -10 * tolerance)
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
    const std::vector<TankPlane> planes = tank_planes(layout);
    for (const TankPlane& plane : planes) {
      for (const TankPlane& other : planes) {
        if (plane.normal.dot(other.normal) < -0.5 && plane.offset + other.offset < 2.0 * d.support)
          throw Error("numerics/walls/method is ghost, but the tank's walls are only " + std::to_string(plane.offset + other.offset) +
                      " m apart, less than twice the kernel's support of " + std::to_string(d.support) + " m: choose boundary_integral.");
      }
      Generator mirror;
      mirror.mirror = true;
      mirror.plane = relative(plane);
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
  const auto add_matrix = [&add](const Eigen::Matrix3d& matrix) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) add(matrix(row, column));
  };
  for (const TankImage& image : images) {
    add_matrix(image.matrix);
    for (int axis = 0; axis < 3; ++axis) add(image.offset[axis]);
    add_matrix(image.velocity_matrix);
    for (int axis = 0; axis < 3; ++axis) add(image.velocity_offset[axis]);
    for (const TankPlane& plane : image.seen_near) {
      for (int axis = 0; axis < 3; ++axis) add(plane.normal[axis]);
      add(plane.offset);
    }
    add(image.mirrored ? 1.0 : 0.0);
  }
  if (values.empty()) values.push_back(Real(0));
  return values;
}

template std::vector<float> image_values(const std::vector<TankImage>&);
template std::vector<double> image_values(const std::vector<TankImage>&);

}  // namespace wavetank
