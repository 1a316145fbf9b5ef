#include "particle_grid.h"

namespace wavetank {
namespace {

int blocks_of(int values) { return (values + field::scan_block - 1) / field::scan_block; }

}  // namespace

ParticleGrid::ParticleGrid(const compute::Device& device, int slots, int particles, int listed)
    : slots_(slots),
      all_slots_(slots + 1),
      blocks_(blocks_of(all_slots_)),
      groups_(blocks_of(blocks_)),
      counts_(device, all_slots_),
      starts_(device, static_cast<std::size_t>(all_slots_) + 1 + listed),
      block_sums_(device, blocks_ + 1),
      group_sums_(device, groups_),
      block_starts_(device, blocks_ + 1),
      slot_of_(device, particles),
      order_(device, particles) {}

void ParticleGrid::resize(const compute::Device& device, int slots, int listed) {
  slots_ = slots;
  all_slots_ = slots + 1;
  blocks_ = blocks_of(all_slots_);
  groups_ = blocks_of(blocks_);
  const auto wanted = static_cast<std::size_t>(all_slots_);
  if (starts_.size() < wanted + 1 + listed) starts_ = compute::Buffer<int>(device, wanted + 1 + listed);
  if (counts_.size() >= wanted) return;  // all zero, as between two sorts
  counts_ = compute::Buffer<int>(device, wanted);
  block_sums_ = compute::Buffer<int>(device, blocks_ + 1);
  group_sums_ = compute::Buffer<int>(device, groups_);
  block_starts_ = compute::Buffer<int>(device, blocks_ + 1);
}

void ParticleGrid::reserve(const compute::Device& device, int particles, int listed) {
  if (listed > 0) {  // the step in progress still goes by them
    std::vector<int> had = starts_.download();
    had.resize(static_cast<std::size_t>(all_slots_) + 1 + listed, 0);
    starts_ = compute::Buffer<int>(device, had);
  }
  slot_of_ = compute::Buffer<int>(device, particles);
  order_ = compute::Buffer<int>(device, particles);
}

void ParticleGrid::bind(const KernelMaker& make, const compute::Arguments& given) {
  compute::Arguments all = given;
  all.value("count", particles_).value("slots", slots_).memory("slot_of", slot_of_).memory("counts", counts_).memory("order", order_);
  all.memory("starts", std::as_const(starts_));
  count_ = make.exact("grid.cl", "count_slots", all);
  // a tree of three levels: of slots, blocks of them, and groups of blocks
  const auto scan = [&](const char* kernel, const int& count, const compute::Buffer<int>& values, compute::Buffer<int>& sums,
                        compute::Buffer<int>& starts) {
    compute::Arguments level = given;
    level.value("count", count).memory("values", values).memory("block_sums", sums).memory("starts", starts);
    return make.exact("grid.cl", kernel, level);
  };
  sum_blocks_ = scan("scan_blocks", all_slots_, counts_, block_sums_, starts_);
  sum_groups_ = scan("scan_blocks", blocks_, block_sums_, group_sums_, starts_);
  total_ = make.exact("grid.cl", "scan_totals", compute::Arguments().value("blocks", groups_).memory("block_sums", group_sums_));
  start_blocks_ = scan("scan_starts", blocks_, block_sums_, group_sums_, block_starts_);
  start_slots_ = scan("scan_starts", all_slots_, counts_, block_starts_, starts_);
  scatter_ = make.exact("grid.cl", "scatter", all);
  settle_ = make.exact("grid.cl", "settle_slots", all);
  reorder_ = make.exact("grid.cl", "reorder", all);
}

void ParticleGrid::sort(int particles) {
  particles_ = particles;
  count_.launch(particles_);
  sum_blocks_.launch(blocks_);
  sum_groups_.launch(groups_);
  total_.launch(1);
  start_blocks_.launch(groups_);
  start_slots_.launch(blocks_);
  scatter_.launch(particles_);
  settle_.launch(all_slots_);
  reorder_.launch(particles_);
}

}  // namespace wavetank
