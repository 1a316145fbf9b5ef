#include "wall_wrenches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wavetank {
namespace {

/// About a box where its pose takes it.
Box moved(const Box& box, const WallPose& pose) {
  Box now{Vector3d::Constant(std::numeric_limits<double>::max()), Vector3d::Constant(std::numeric_limits<double>::lowest())};
  for (int k = 0; k < 8; ++k) {
    const Vector3d corner =
        pose.of({k & 1 ? box.max.x() : box.min.x(), k & 2 ? box.max.y() : box.min.y(), k & 4 ? box.max.z() : box.min.z()});
    now.min = now.min.cwiseMin(corner);
    now.max = now.max.cwiseMax(corner);
  }
  return now;
}

}  // namespace

template <class Real>
WallWrenches<Real>::WallWrenches(const compute::Device& device, const Discretisation& discretisation, const GridShape& grid,
                                 const std::vector<Box>& boxes, const std::vector<WallElement>& pieces, bool everywhere, double drift)
    : device_(device),
      discretisation_(discretisation),
      grid_(grid),
      boxes_(boxes),
      everywhere_(everywhere),
      drift_(drift),
      facing_(device, pieces, discretisation),
      totals_(device, boxes.size() * field::wrench_count) {}

template <class Real>
void WallWrenches<Real>::bind(const KernelMaker& make, const std::string& file, const std::map<Slot, compute::Arguments>& given) {
  std::map<Slot, compute::Arguments> arguments = given;
  for (auto& [slot, own] : arguments) {
    own.value("regions", region_count_).value("items", region_items_).value("chunks", chunks_);
    own.memory("region_values", regions_.on_device()).memory("totals", totals_);
    compute::Arguments sweep = own;
    sweep.value("count", region_items_).memory("wrenches", parts_);
    forces_[slot] = make.over_runs(file, "wall_forces", sweep);
  }
  compute::Arguments reduction = arguments.begin()->second;
  reduction.value("count", sum_count_).memory("wrenches", std::as_const(parts_)).memory("sums", sums_);
  chunk_kernel_ = make.exact("reduce.cl", "wrench_chunks", reduction);
  total_kernel_ = make.exact("reduce.cl", "wrench_totals", reduction);
  facing_.bind(make, arguments);
}

template <class Real>
void WallWrenches<Real>::set_poses(const std::vector<WallPose>& poses) {
  if (poses == poses_) return;
  poses_ = poses;
  facing_.set_poses(poses);
  region_owners_.clear();
}

/// The slots in which particles may touch each owner's walls where they are now, as tables/device_sizes.h has regions.
template <class Real>
void WallWrenches<Real>::find_regions(const std::vector<int>& owners) {
  std::vector<int> values;
  region_items_ = 0;
  int most = 0;
  const Discretisation& d = discretisation_;
  const double margin = d.support + drift_;
  for (const int owner : owners) {
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    const Box now = moved(boxes_[owner], poses_[owner]);
    const int counts[3] = {grid_.slots_x, grid_.rows_y, grid_.rows_z};
    const double sides[3] = {grid_.slot_length, grid_.row_side, grid_.row_side};
    for (int axis = 0; axis < 3; ++axis) {
      if (counts[axis] == 1) continue;
      const auto at = [&](double place) {
        return static_cast<int>(std::clamp(std::floor((place - d.origin[axis]) / sides[axis]) + 1, 1.0, counts[axis] - 2.0));
      };
      low[axis] = everywhere_ ? 1 : at(now.min[axis] - margin);
      high[axis] = everywhere_ ? counts[axis] - 2 : at(now.max[axis] + margin);
    }
    const int runs = (high[0] - low[0]) / field::region_run + 1, rows = high[1] - low[1] + 1;
    for (const int value : {owner, region_items_, low[0], low[1], low[2], high[0] + 1, runs, rows}) values.push_back(value);
    const int items = runs * rows * (high[2] - low[2] + 1);
    region_items_ += items;
    most = std::max(most, items);
  }
  regions_.set(device_, values);
  const std::size_t parts = static_cast<std::size_t>(region_items_) * field::wrench_count;
  if (parts_.size() < parts) parts_ = compute::Buffer<Real>(device_, 2 * parts);
  chunks_ = chunks_of(most);
  region_count_ = static_cast<int>(owners.size());
  sum_count_ = region_count_ * chunks_;
  const std::size_t sums = static_cast<std::size_t>(sum_count_) * field::wrench_count;
  if (sums_.size() < sums) sums_ = compute::Buffer<Real>(device_, sums);
  region_owners_ = owners;
}

template <class Real>
std::vector<WallWrench> WallWrenches<Real>::find(Slot state, const std::vector<int>& owners) {
  if (owners.empty()) return {};
  if (region_owners_ != owners) find_regions(owners);
  forces_.at(state).launch(region_items_);
  chunk_kernel_.launch(sum_count_);
  total_kernel_.launch(region_count_);
  facing_.add(state, region_count_);
  const std::vector<Real> totals = totals_.download(owners.size() * field::wrench_count);
  std::vector<WallWrench> result(owners.size());
  for (std::size_t k = 0; k < owners.size(); ++k)
    for (int part = 0; part < 4; ++part)
      for (int axis = 0; axis < 3; ++axis) result[k][part][axis] = totals[k * field::wrench_count + 3 * part + axis];
  return result;
}

template class WallWrenches<float>;
template class WallWrenches<double>;

}  // namespace wavetank
