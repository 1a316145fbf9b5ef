#include "wall_wrenches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace wavetank {
namespace {

constexpr int places = exact_places(field::wrench_count);

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
                                 const std::vector<Box>& boxes, const std::vector<WallElement>& pieces, bool everywhere, double drift,
                                 const ExactScale& scale)
    : device_(device),
      discretisation_(discretisation),
      grid_(grid),
      boxes_(boxes),
      everywhere_(everywhere),
      drift_(drift),
      facing_(device, pieces, discretisation),
      scale_(scale),
      per_force_(static_cast<Real>(scale.quanta[0])),
      per_moment_(static_cast<Real>(scale.quanta[1])),
      totals_(device, boxes.size() * places) {}

template <class Real>
void WallWrenches<Real>::bind(const KernelMaker& make, const std::string& file, const std::map<Slot, compute::Arguments>& given) {
  std::map<Slot, compute::Arguments> arguments = given;
  for (auto& [slot, own] : arguments) {
    own.value("regions", region_count_).value("items", region_items_).value("chunks", chunks_);
    own.value("per_force", per_force_).value("per_moment", per_moment_);
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

template <class Real>
void WallWrenches<Real>::set_part(const Parting& parting, int begin, int end) {
  group_ = parting.group;
  part_axis_ = parting.axis;
  part_begin_ = begin;
  part_end_ = end;
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
  const int run = slots_of_segment(d, grid_);
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
    low[0] = 1 + (low[0] - 1) / run * run;
    if (group_ != nullptr) {
      low[part_axis_] = std::max(low[part_axis_], part_begin_);
      high[part_axis_] = std::min(high[part_axis_], part_end_ - 1);
    }
    const int runs = (high[0] - low[0] + run) / run, rows = high[1] - low[1] + 1;
    const bool any = low[part_axis_] <= high[part_axis_];
    for (const int value : {owner, region_items_, low[0], low[1], low[2], high[0] + 1, runs, rows, run}) values.push_back(value);
    const int items = any ? runs * rows * (high[2] - low[2] + 1) : 0;
    region_items_ += items;
    most = std::max(most, items);
  }
  regions_.set(device_, values);
  const std::size_t parts = static_cast<std::size_t>(region_items_) * field::wrench_count;
  if (parts_.size() < std::max<std::size_t>(parts, 1)) parts_ = compute::Buffer<Real>(device_, 2 * std::max<std::size_t>(parts, 1));
  chunks_ = std::max(chunks_of(most), 1);
  region_count_ = static_cast<int>(owners.size());
  sum_count_ = region_count_ * chunks_;
  const std::size_t sums = static_cast<std::size_t>(sum_count_) * places;
  if (sums_.size() < sums) sums_ = compute::Buffer<std::int64_t>(device_, sums);
  region_owners_ = owners;
}

template <class Real>
std::vector<WallWrench> WallWrenches<Real>::find(Slot state, const std::vector<int>& owners) {
  if (owners.empty()) return {};
  if (region_owners_ != owners) find_regions(owners);
  if (region_items_ > 0) forces_.at(state).launch(region_items_);
  chunk_kernel_.launch(sum_count_);
  total_kernel_.launch(static_cast<std::size_t>(region_count_) * places);
  facing_.add(state, region_count_);
  std::vector<std::int64_t> totals = totals_.download(owners.size() * places);
  if (group_ != nullptr) totals = group_->sums(totals);
  std::vector<WallWrench> result(owners.size());
  for (std::size_t k = 0; k < owners.size(); ++k)
    for (int part = 0; part < 4; ++part)
      for (int axis = 0; axis < 3; ++axis)
        result[k][part][axis] = exact_value(&totals[k * places], 3 * part + axis, field::wrench_count, scale_.quanta[part < 2 ? 0 : 1]);
  return result;
}

template class WallWrenches<float>;
template class WallWrenches<double>;

}  // namespace wavetank
