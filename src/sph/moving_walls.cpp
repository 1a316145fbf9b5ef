#include "moving_walls.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hidden_walls.h"

namespace wavetank {
namespace {

// of the spacing: how far walls move before the lists are made anew. Elements are found up to a support from their cell, facets are listed
// with this much to spare; the kernel is below 1e-6 of its greatest so near to the end of its support.
constexpr double facet_margin = 0.25;
constexpr double element_margin = 0.1;

// as place_walls.cl
enum Kind { scalar, place_field, vector_field };

std::vector<int> kinds_of_fields(WallKind kind, int field_count) {
  std::vector<int> kinds(field_count, scalar);
  kinds[field::wall_x] = place_field;
  kinds[field::wall_normal_x] = vector_field;
  if (kind == WallKind::rectangles) kinds[field::wall_tangent_x] = vector_field;
  if (kind == WallKind::triangles)
    for (int k = 0; k < 3; ++k) kinds[field::wall_corners + 3 * k] = vector_field;
  if (kind == WallKind::facets) {
    for (int edge = field::wall_edges; edge < field_count; edge += field::edge_count) {
      kinds[edge] = place_field;
      kinds[edge + 3] = vector_field;
    }
  }
  return kinds;
}

int fields_of(WallKind kind, int dimensions) {
  if (kind == WallKind::rectangles) return field::wall_rectangle_count;
  if (kind == WallKind::triangles) return field::wall_triangle_count;
  return field::wall_edges + (dimensions == 3 ? 3 : 1) * field::edge_count;
}

}  // namespace

template <class Real>
std::vector<Real> pose_values(const std::vector<WallPose>& poses, const Discretisation& discretisation) {
  std::vector<Real> values;
  for (const WallPose& pose : poses) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) values.push_back(static_cast<Real>(pose.rotation(row, column)));
    const Vector3d shift = pose.of(discretisation.origin) - discretisation.origin;
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(shift[axis]));
  }
  return values;
}

template <class Real>
MovingWalls<Real>::MovingWalls(const compute::Device& device, const WallArrays<Real>& walls, const std::vector<bool>& moving,
                               const std::vector<Vector3d>& centres, const Layout& layout, const Discretisation& discretisation)
    : device_(device),
      discretisation_(discretisation),
      hidden_(std::make_shared<HiddenWalls>(layout, discretisation.dimensions)),
      radius_(moving.size(), 0.0),
      owner_moves_(moving.begin(), moving.end()) {
  for (int s = 0; s < walls.count; ++s) {
    const Facet& shape = walls.shapes[s];
    if (!moving.at(shape.owner)) continue;
    if (!hidden_->concerns(shape.owner)) listed_anew_.push_back(s);
    moving_.push_back(s);
    for (const Vector3d& corner : shape.corners)
      radius_[shape.owner] = std::max(radius_[shape.owner], (corner - centres[shape.owner]).norm());
  }
  if (moving_.empty()) return;
  if (walls.kind == WallKind::facets) {
    for (int s = 0; s < walls.count; ++s)
      if (!moving.at(walls.shapes[s].owner) && !hidden_->concerns(walls.shapes[s].owner))
        add_cells_of(walls.shapes[s], s, 0.0, discretisation, still_);
  }
  field_count_ = fields_of(walls.kind, discretisation.dimensions);
  rest_ = compute::Buffer<Real>(device, walls.fields.download());
  kinds_ = compute::Buffer<int>(device, kinds_of_fields(walls.kind, field_count_));
  slots_ = compute::Buffer<int>(device, moving_);
  std::vector<int> all(walls.count);
  std::iota(all.begin(), all.end(), 0);
  from_ = compute::Buffer<int>(device, all);
  const bool elements = walls.kind != WallKind::facets;
  if (elements) all_ = compute::Buffer<int>(device, all);
  from_field_ = elements ? walls.stride : 1;
  from_wall_ = elements ? 1 : walls.stride;
  moving_count_ = static_cast<int>(moving_.size());
  all_count_ = elements ? walls.count : 0;
}

template <class Real>
void MovingWalls<Real>::bind(const KernelMaker& make, const compute::Arguments& given, WallArrays<Real>& walls) {
  compute::Arguments arguments = given;
  arguments.value("field_count", field_count_).value("from_field", from_field_).value("from_wall", from_wall_);
  arguments.memory("from", from_).memory("kinds", kinds_).memory("poses", poses_.on_device()).memory("rest", rest_);
  arguments.memory("fields", walls.fields);
  place_moving_ = make.exact("place_walls.cl", "place_walls", arguments.value("count", moving_count_).memory("slots", slots_));
  place_all_ = make.exact("place_walls.cl", "place_walls", arguments.value("count", all_count_).memory("slots", all_));
}

template <class Real>
Facet MovingWalls<Real>::moved(const Facet& facet, const std::vector<WallPose>& poses) const {
  Facet result = facet;
  for (Vector3d& corner : result.corners) corner = poses[facet.owner].of(corner);
  return result;
}

template <class Real>
bool MovingWalls<Real>::lists_hold(const std::vector<WallPose>& poses) const {
  if (listed_.empty()) return false;
  for (std::size_t o = 0; o < poses.size(); ++o) {
    if (!owner_moves_[o]) continue;
    // x' − x'_listed = (Q − Q_listed) (x − rest) + …: no point of the owner moves by more than this
    const Eigen::Matrix3d turn = poses[o].rotation - listed_[o].rotation;
    const Vector3d shift = poses[o].place - listed_[o].place;
    if (turn.norm() * radius_[o] + shift.norm() > (all_.size() > 0 ? element_margin : facet_margin) * discretisation_.spacing) return false;
  }
  return true;
}

template <class Real>
void MovingWalls<Real>::list_facets(WallArrays<Real>& walls, const std::vector<WallPose>& poses) {
  CellPairs pairs = still_;
  const auto list = [&](int s) {
    add_cells_of(moved(walls.shapes[s], poses), s, facet_margin * discretisation_.spacing, discretisation_, pairs);
  };
  for (const int s : listed_anew_) list(s);
  for (const int s : hidden_->facets_in_sight(poses)) list(s);
  const CellOrder cells = lists_of(std::move(pairs), discretisation_);
  walls.starts.upload(cells.begin);
  if (cells.order.empty()) return;
  if (walls.list.size() < cells.order.size()) walls.list = compute::Buffer<int>(device_, 2 * cells.order.size());
  walls.list.upload(cells.order);
}

template <class Real>
void MovingWalls<Real>::sort_elements(WallArrays<Real>& walls, const std::vector<WallPose>& poses) {
  std::vector<Vector3d> centres;
  std::vector<int> seen, hidden;
  for (int s = 0; s < walls.count; ++s) {
    const Facet& shape = walls.shapes[s];
    (hidden_->hides(shape, poses) ? hidden : seen).push_back(s);
    if (seen.empty() || seen.back() != s) continue;
    centres.push_back(middle_of(owner_moves_[shape.owner] ? moved(shape, poses) : shape, discretisation_.dimensions));
  }
  CellOrder cells = sorted_by_cell(centres, discretisation_);
  walls.starts.upload(cells.begin);
  for (int& s : cells.order) s = seen[s];
  cells.order.insert(cells.order.end(), hidden.begin(), hidden.end());  // behind the last cell's, where no particle looks
  from_.upload(cells.order);
  moving_.clear();
  for (std::size_t slot = 0; slot < cells.order.size(); ++slot)
    if (owner_moves_[walls.shapes[cells.order[slot]].owner]) moving_.push_back(static_cast<int>(slot));
  slots_.upload(moving_);
}

template <class Real>
void MovingWalls<Real>::list(WallArrays<Real>& walls, const std::vector<WallPose>& poses) {
  if (walls.kind == WallKind::facets)
    list_facets(walls, poses);
  else
    sort_elements(walls, poses);
  listed_ = poses;
}

template <class Real>
std::vector<double> MovingWalls<Real>::listed() const {
  std::vector<double> values;
  for (const WallPose& pose : listed_) {
    values.insert(values.end(), pose.rest.data(), pose.rest.data() + 3);
    values.insert(values.end(), pose.place.data(), pose.place.data() + 3);
    values.insert(values.end(), pose.rotation.data(), pose.rotation.data() + 9);
  }
  return values;
}

template <class Real>
void MovingWalls<Real>::list_for(WallArrays<Real>& walls, const std::vector<double>& listed) {
  std::vector<WallPose> poses(listed_.size());
  for (std::size_t o = 0; o < poses.size(); ++o) {
    const double* values = listed.data() + 15 * o;
    poses[o] = {Vector3d(values), Vector3d(values + 3), Eigen::Matrix3d(values + 6)};
  }
  list(walls, poses);
  move(walls, poses, true);
}

template <class Real>
void MovingWalls<Real>::place(WallArrays<Real>& walls, const std::vector<WallPose>& poses) {
  const bool anew = !lists_hold(poses);
  if (anew) list(walls, poses);
  move(walls, poses, anew);
}

/// `resorted`: elements stand in other slots than before.
template <class Real>
void MovingWalls<Real>::move(WallArrays<Real>& walls, const std::vector<WallPose>& poses, bool resorted) {
  if (!poses_.set(device_, pose_values<Real>(poses, discretisation_)) && !resorted) return;
  if (resorted && walls.kind != WallKind::facets)
    place_all_.launch(all_count_);
  else
    place_moving_.launch(moving_count_);
}

template std::vector<float> pose_values(const std::vector<WallPose>&, const Discretisation&);
template std::vector<double> pose_values(const std::vector<WallPose>&, const Discretisation&);
template class MovingWalls<float>;
template class MovingWalls<double>;

}  // namespace wavetank
