#include <algorithm>
#include <numeric>

#include "snapshot_blocks.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr const char* step_block = "step: next, greatest speed, greatest acceleration";
constexpr const char* lists_block = "walls: poses of the lists";
constexpr const char* guard_block = "guard: impulses";

std::string block_of(const FieldRow& row, const std::string& component) {
  return (row.array == ParticleArray::state ? "particles: " : "particles: rate of ") + component;
}

}  // namespace

template <class Real>
std::vector<char> SphSolver<Real>::save() const {
  const std::vector<Real> state = state_.download(), rates = rates_.download();
  const std::vector<std::uint32_t> id = id_.download();
  SnapshotBlocks blocks;
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    const std::vector<Real>& from = row.array == ParticleArray::state ? state : rates;
    for (const std::string& component : row.components) {
      std::vector<Real> by_id(count_);
      for (int i = 0; i < count_; ++i) by_id[id[i]] = from[index_of(component.c_str(), i, row.array)];
      blocks.put(block_of(row, component), by_id);
    }
  }
  blocks.put(step_block, std::vector<double>{step_, greatest_speed_, greatest_acceleration_});
  blocks.put(lists_block, moving_walls_ ? moving_walls_->listed() : std::vector<double>());
  blocks.put(guard_block, guarded_.values());
  return blocks.bytes();
}

/// Everything is read before anything is set, so that a snapshot that does not fit leaves the solver as it was.
template <class Real>
void SphSolver<Real>::restore(const std::vector<char>& bytes) {
  const SnapshotBlocks blocks(bytes);
  std::vector<Real> state(state_.size(), Real(0)), rates_by_id(rates_.size(), Real(0));
  std::vector<std::string> names{step_block, lists_block, guard_block};
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    std::vector<Real>& to = row.array == ParticleArray::state ? state : rates_by_id;
    for (const std::string& component : row.components) {
      names.push_back(block_of(row, component));
      const std::vector<Real> by_id = blocks.get<Real>(names.back(), count_);
      std::copy(by_id.begin(), by_id.end(), to.begin() + static_cast<std::ptrdiff_t>(index_of(component.c_str(), 0, row.array)));
    }
  }
  const std::vector<double> step = blocks.get<double>(step_block, 3);
  const std::vector<double> listed = blocks.get<double>(lists_block, moving_walls_ ? moving_walls_->listed().size() : 0);
  const std::vector<double> impulses = blocks.get<double>(guard_block, guarded_.values().size());
  blocks.expect_no_others(names);

  if (moving_walls_) moving_walls_->list_for(walls_, listed);
  guarded_.clear();
  guarded_.values() = impulses;
  step_ = step[0];
  greatest_speed_ = step[1];
  greatest_acceleration_ = step[2];
  report_.upload({static_cast<Real>(step_)});  // its first value, which the next step reads
  std::vector<std::uint32_t> id(count_);
  std::iota(id.begin(), id.end(), 0U);
  state_.upload(state);
  id_.upload(id);
  sort();
  upload_rates(rates_by_id);
}

/// Into the order that the particles have on the device.
template <class Real>
void SphSolver<Real>::upload_rates(const std::vector<Real>& by_id) {
  const std::vector<std::uint32_t> id = id_.download();
  std::vector<Real> rates(by_id.size(), Real(0));
  for (int f = 0; f < fields_.count(ParticleArray::rates); ++f)
    for (int i = 0; i < count_; ++i)
      rates[static_cast<std::size_t>(f) * stride_ + i] = by_id[static_cast<std::size_t>(f) * stride_ + id[i]];
  rates_.upload(rates);
}

template std::vector<char> SphSolver<float>::save() const;
template void SphSolver<float>::restore(const std::vector<char>&);
template std::vector<char> SphSolver<double>::save() const;
template void SphSolver<double>::restore(const std::vector<char>&);

}  // namespace wavetank
