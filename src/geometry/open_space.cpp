#include "open_space.h"

#include <algorithm>
#include <cmath>

#include "polygon.h"
#include "slow_work.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double fine_voxels = 1.0e6;  // up to so many at half the spacing, which finds narrower passages
constexpr double most_voxels = 1.0e8;

}  // namespace

OpenSpace::OpenSpace(const Box& domain, int dimensions, double spacing, const TriangleGrid& grid, Walls walls, const Top& top)
    : grid_(grid), walls_(walls), dimensions_(dimensions), domain_(domain), top_(top) {
  const Vector3d size = domain.max - domain.min;
  const double across = dimensions == 2 ? 1.0 : size.y() / spacing;
  const double count = (size.x() / spacing) * across * (size.z() / spacing);
  if (count > most_voxels) {
    throw Error("the tank of " + describe(size) + " m is too large for a particle spacing of " + describe(spacing) +
                " m: more than 1e8 cells; check the scale of its mesh");
  }
  const double side = count * (dimensions == 2 ? 4 : 8) <= fine_voxels ? 0.5 * spacing : spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = dimensions == 2 && axis == 1;
    count_[axis] = flat ? 1 : std::max(1, static_cast<int>(std::ceil(size[axis] / side - 1e-6)));
    side_[axis] = flat ? spacing : size[axis] / count_[axis];
  }
  if (dimensions == 2) domain_.min.y() = -0.5 * spacing, domain_.max.y() = 0.5 * spacing;
  reached_.assign(static_cast<std::size_t>(count_[0]) * count_[1] * count_[2], 0);
}

Vector3d OpenSpace::centre(const int voxel[3]) const {
  return domain_.min + Vector3d((voxel[0] + 0.5) * side_[0], (voxel[1] + 0.5) * side_[1], (voxel[2] + 0.5) * side_[2]);
}

void OpenSpace::step(const int voxel[3], const Vector3d& position, int axis, int way, const FreeSurface& surface,
                     std::vector<std::size_t>& next) {
  int other[3] = {voxel[0], voxel[1], voxel[2]};
  other[axis] += way;
  const bool outside = other[axis] < 0 || other[axis] >= count_[axis];
  const bool over_the_top = outside && axis == top_.axis && way == top_.way && std::isinf(surface.height);
  if (over_the_top ? open_top_ : outside && escape_) return;
  if (!outside && reached_[index(other)]) return;
  Vector3d target = position;
  target[axis] += way * side_[axis];
  if (!surface.wets(target) || grid_.crosses(position, target, walls_)) return;
  if (over_the_top) {
    open_top_ = true;
    return;
  }
  if (outside) {
    escape_ = 0.5 * (position + target);
    return;
  }
  reached_[index(other)] = 1;
  next.push_back(index(other));
}

void OpenSpace::flood(const std::vector<Vector3d>& from, const FreeSurface& surface) {
  std::vector<std::size_t> queue, next;
  const auto enter = [&](const Vector3d& point, const int voxel[3]) {
    const std::size_t i = index(voxel);
    if (reached_[i]) return true;
    if (grid_.crosses(point, centre(voxel), walls_)) return false;
    reached_[i] = 1;
    queue.push_back(i);
    return true;
  };
  for (const Vector3d& point : from) {
    int home[3], voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      home[axis] = std::clamp(static_cast<int>(std::floor((point[axis] - domain_.min[axis]) / side_[axis])), 0, count_[axis] - 1);
    }
    if (enter(point, home)) continue;
    for (int neighbour = 0; neighbour < 6; ++neighbour) {  // a wall lies between the point and its voxel's centre
      std::copy(home, home + 3, voxel);
      voxel[neighbour / 2] = std::clamp(home[neighbour / 2] + (neighbour % 2 ? 1 : -1), 0, count_[neighbour / 2] - 1);
      enter(point, voxel);
    }
  }
  SlowWork work("finding the space that the water can reach");
  std::size_t done = 0;
  while (!queue.empty()) {  // breadth first: an escape is found on the shortest way out
    next.clear();
    for (const std::size_t i : queue) {
      work.tell(++done, reached_.size());
      const int voxel[3] = {static_cast<int>(i % count_[0]), static_cast<int>(i / count_[0] % count_[1]),
                            static_cast<int>(i / count_[0] / count_[1])};
      const Vector3d position = centre(voxel);
      for (int axis = 0; axis < 3; ++axis) {
        if (dimensions_ == 2 && axis == 1) continue;
        step(voxel, position, axis, -1, surface, next);
        step(voxel, position, axis, +1, surface, next);
      }
    }
    queue.swap(next);
  }
}

bool OpenSpace::reached(const Vector3d& from, const Vector3d& about) const {
  if (!holds(from)) return false;
  int low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {  // the voxels whose centres surround the place
    const int base = static_cast<int>(std::floor((about[axis] - domain_.min[axis]) / side_[axis] - 0.5));
    low[axis] = std::clamp(base, 0, count_[axis] - 1);
    high[axis] = std::clamp(base + 1, 0, count_[axis] - 1);
  }
  int voxel[3];
  for (voxel[2] = low[2]; voxel[2] <= high[2]; ++voxel[2]) {
    for (voxel[1] = low[1]; voxel[1] <= high[1]; ++voxel[1]) {
      for (voxel[0] = low[0]; voxel[0] <= high[0]; ++voxel[0]) {
        if (reached_[index(voxel)] && !grid_.crosses(from, centre(voxel), walls_)) return true;
      }
    }
  }
  return false;
}

}  // namespace wavetank
