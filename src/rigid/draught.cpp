#include "wavetank/rigid/draught.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "section.h"

namespace wavetank {
namespace {

using Interval = std::pair<double, double>;  ///< from and to, m, upwards

/// A body cut into upright columns and level layers, to find what water reaches.
class DisplacedVolume {
 public:
  DisplacedVolume(const TriangleMesh& mesh, int dimensions);
  double layer_top(int layers) const { return layers * step_.z(); }
  int layers() const { return count_[2]; }
  /// With water up to the top of so many layers, m³ (2-D: m²).
  double at(int layers) const;

 private:
  static constexpr int columns_3d = 48, columns_2d = 512, layers_ = 64;
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(k) * count_[1] + j) * count_[0] + i; }
  void cut_section(const TriangleMesh& mesh);
  void cut_columns(const TriangleMesh& mesh);
  void mark_skin(const TriangleMesh& mesh);
  void fill_layers();
  std::vector<char> reached(int layers) const;

  int count_[3] = {columns_3d, columns_3d, layers_};
  Vector3d low_, step_;
  std::vector<std::vector<Interval>> columns_;  ///< where each is solid
  std::vector<float> solid_;                    ///< of each cell, the share that is
  std::vector<char> skin_;                      ///< cells that the surface passes through: no water passes
};

DisplacedVolume::DisplacedVolume(const TriangleMesh& mesh, int dimensions) {
  const Box box = mesh.bounding_box();
  if (dimensions == 2) count_[0] = columns_2d, count_[1] = 1;
  low_ = box.min;
  step_ = (box.max - box.min).cwiseQuotient(Vector3d(count_[0], count_[1], count_[2]));
  if (dimensions == 2) step_.y() = 1;
  columns_.resize(static_cast<std::size_t>(count_[0]) * count_[1]);
  solid_.assign(columns_.size() * count_[2], 0.0F);
  skin_.assign(solid_.size(), 0);
  if (dimensions == 2) {
    cut_section(mesh);
  } else {
    cut_columns(mesh);
    mark_skin(mesh);
  }
  fill_layers();
}

void DisplacedVolume::cut_section(const TriangleMesh& mesh) {
  std::vector<double> abscissae;
  for (int i = 0; i < count_[0]; ++i) abscissae.push_back(low_.x() + (i + 0.5) * step_.x());
  columns_ = section_along(mesh, abscissae);
}

void DisplacedVolume::cut_columns(const TriangleMesh& mesh) {
  // a little off the middle, so that no column runs along the edges of a regular mesh
  const double beside_x = 0.5 + 0.00137, beside_y = 0.5 - 0.00171;
  std::vector<std::vector<std::pair<double, int>>> crossings(columns_.size());  // height, and +1 where the body begins
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
    const double area = (b.x() - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (b.y() - a.y());
    if (area == 0) continue;
    const auto first = [&](double low, double origin, double step, double beside) {
      return std::max(0, static_cast<int>(std::floor((low - origin) / step - beside)));
    };
    const Vector3d least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    for (int j = first(least.y(), low_.y(), step_.y(), beside_y); j < count_[1]; ++j) {
      const double y = low_.y() + (j + beside_y) * step_.y();
      if (y > most.y()) break;
      for (int i = first(least.x(), low_.x(), step_.x(), beside_x); i < count_[0]; ++i) {
        const double x = low_.x() + (i + beside_x) * step_.x();
        if (x > most.x()) break;
        const double beta = ((x - a.x()) * (c.y() - a.y()) - (c.x() - a.x()) * (y - a.y())) / area;
        const double gamma = ((b.x() - a.x()) * (y - a.y()) - (x - a.x()) * (b.y() - a.y())) / area;
        if (beta < 0 || gamma < 0 || beta + gamma > 1) continue;
        crossings[static_cast<std::size_t>(j) * count_[0] + i].emplace_back(a.z() + beta * (b.z() - a.z()) + gamma * (c.z() - a.z()),
                                                                            area < 0 ? 1 : -1);
      }
    }
  }
  for (std::size_t column = 0; column < columns_.size(); ++column) {
    std::sort(crossings[column].begin(), crossings[column].end());
    int depth = 0;
    double begin = 0;
    for (const auto& [height, turn] : crossings[column]) {
      if (depth <= 0 && depth + turn > 0) begin = height;
      if (depth > 0 && depth + turn <= 0) columns_[column].emplace_back(begin, height);
      depth += turn;
    }
  }
}

/// Marks the cells of points of the surface, so close to each other that nothing passes from cell to cell between them.
void DisplacedVolume::mark_skin(const TriangleMesh& mesh) {
  const Vector3d cells = step_.cwiseInverse();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = (mesh.corner(t, 0) - low_).cwiseProduct(cells), b = (mesh.corner(t, 1) - low_).cwiseProduct(cells),
                   c = (mesh.corner(t, 2) - low_).cwiseProduct(cells);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int parts = std::max(1, static_cast<int>(std::ceil(longest / 0.4)));
    for (int p = 0; p <= parts; ++p) {
      for (int q = 0; q + p <= parts; ++q) {
        const Vector3d place = a + (b - a) * (double(p) / parts) + (c - a) * (double(q) / parts);
        int cell[3];
        for (int axis = 0; axis < 3; ++axis) cell[axis] = std::clamp(static_cast<int>(place[axis]), 0, count_[axis] - 1);
        skin_[index(cell[0], cell[1], cell[2])] = 1;
      }
    }
  }
}

void DisplacedVolume::fill_layers() {
  for (int j = 0; j < count_[1]; ++j) {
    for (int i = 0; i < count_[0]; ++i) {
      for (const auto& [from, to] : columns_[static_cast<std::size_t>(j) * count_[0] + i]) {
        const double begin = (from - low_.z()) / step_.z(), end = (to - low_.z()) / step_.z();
        for (int k = std::max(0, static_cast<int>(begin)); k < count_[2] && k < end; ++k) {
          const double share = std::min(end, k + 1.0) - std::max(begin, double(k));
          solid_[index(i, j, k)] += static_cast<float>(std::max(share, 0.0));
          skin_[index(i, j, k)] = 1;
        }
      }
    }
  }
}

/// The cells up to a level that water gets into from the sides and from below.
std::vector<char> DisplacedVolume::reached(int layers) const {
  std::vector<char> wet(solid_.size(), 0);
  std::vector<int> queue;
  const auto enter = [&](int i, int j, int k) {
    if (i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= layers) return;
    const std::size_t cell = index(i, j, k);
    if (wet[cell] || skin_[cell]) return;
    wet[cell] = 1;
    queue.push_back(static_cast<int>(cell));
  };
  for (int k = 0; k < layers; ++k) {
    for (int j = 0; j < count_[1]; ++j) {
      for (int i = 0; i < count_[0]; ++i) {
        const bool outermost = k == 0 || i == 0 || i == count_[0] - 1 || (count_[1] > 1 && (j == 0 || j == count_[1] - 1));
        if (outermost) enter(i, j, k);
      }
    }
  }
  while (!queue.empty()) {
    const int cell = queue.back();
    queue.pop_back();
    const int i = cell % count_[0], j = cell / count_[0] % count_[1], k = cell / count_[0] / count_[1];
    enter(i - 1, j, k), enter(i + 1, j, k), enter(i, j - 1, k), enter(i, j + 1, k), enter(i, j, k - 1), enter(i, j, k + 1);
  }
  return wet;
}

double DisplacedVolume::at(int layers) const {
  const std::vector<char> wet = reached(layers);
  const auto is = [&](const std::vector<char>& cells, int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < count_[0] && j < count_[1] && k < layers && cells[index(i, j, k)] != 0;
  };
  double cells = 0;
  for (int k = 0; k < layers; ++k) {
    for (int j = 0; j < count_[1]; ++j) {
      for (int i = 0; i < count_[0]; ++i) {
        const std::size_t cell = index(i, j, k);
        const double solid = std::min(double(solid_[cell]), 1.0);
        cells += solid;
        if (wet[cell]) continue;
        double dry = 1;
        if (skin_[cell]) {  // what is not solid of it is as wet as the cells about it
          const int about[6][3] = {{i - 1, j, k}, {i + 1, j, k}, {i, j - 1, k}, {i, j + 1, k}, {i, j, k - 1}, {i, j, k + 1}};
          int dry_sides = 0, open_sides = 0;
          for (const auto& side : about) {
            const bool inside = is(skin_, side[0], side[1], side[2]) || side[2] >= layers;
            const bool flooded = !inside && (side[0] < 0 || side[1] < 0 || side[2] < 0 || side[0] >= count_[0] || side[1] >= count_[1] ||
                                             is(wet, side[0], side[1], side[2]));
            if (inside || (count_[1] == 1 && side[1] != j)) continue;
            ++open_sides;
            if (!flooded) ++dry_sides;
          }
          dry = open_sides == 0 ? 0.0 : double(dry_sides) / open_sides;
        }
        cells += dry * (1 - solid);
      }
    }
  }
  return cells * step_.prod();
}

}  // namespace

std::optional<double> draught(const TriangleMesh& closed, double volume, int dimensions) {
  const DisplacedVolume displaced(closed, dimensions);
  double below = 0;
  for (int layers = 1; layers <= displaced.layers(); ++layers) {
    const double here = displaced.at(layers);
    if (here >= volume) {
      const double share = here > below ? (volume - below) / (here - below) : 1.0;
      return displaced.layer_top(layers - 1) +
             std::clamp(share, 0.0, 1.0) * (displaced.layer_top(layers) - displaced.layer_top(layers - 1));
    }
    below = here;
  }
  return std::nullopt;
}

}  // namespace wavetank
