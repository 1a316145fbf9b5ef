#include <algorithm>
#include <functional>
#include <numeric>
#include <type_traits>
#include <utility>

#include "snapshot_blocks.h"
#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr const char* id_block = "particles: id";
constexpr const char* next_id_block = "particles: next id";
constexpr const char* step_block = "step: next, greatest speed, greatest acceleration";
constexpr const char* lists_block = "walls: poses of the lists";
constexpr const char* guard_block = "guard: impulses";

std::string block_of(const FieldRow& row, const std::string& component) {
  return (row.array == ParticleArray::state ? "particles: " : "particles: rate of ") + component;
}

}  // namespace

/// Of particles, in the order of their ids.
template <class Real>
std::vector<int> SphSolver<Real>::order_by_id(const std::vector<std::uint32_t>& id) const {
  std::vector<int> order(count_);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&id](int a, int b) { return id[a] < id[b]; });
  return order;
}

template <class Real>
std::vector<char> SphSolver<Real>::save() const {
  const std::vector<Real> state = state_.download(), rates = rates_.download();
  const std::vector<std::uint32_t> id = id_.download(count_);
  const std::vector<int> order = order_by_id(id);
  const auto in_order = [&](const auto& value_of) {
    std::vector<std::decay_t<decltype(value_of(0))>> values(count_);
    std::transform(order.begin(), order.end(), values.begin(), value_of);
    return values;
  };
  SnapshotBlocks blocks;
  blocks.put(id_block, in_order([&](int i) { return id[i]; }));
  blocks.put(next_id_block, std::vector<double>{static_cast<double>(next_id_)});
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    const std::vector<Real>& from = row.array == ParticleArray::state ? state : rates;
    for (const std::string& component : row.components)
      blocks.put(block_of(row, component), in_order([&](int i) { return from[index_of(component.c_str(), i, row.array)]; }));
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
  std::vector<std::string> names{id_block, next_id_block, step_block, lists_block, guard_block};
  const std::vector<std::uint32_t> id =
      open_ ? blocks.get<std::uint32_t>(id_block) : blocks.get<std::uint32_t>(id_block, static_cast<std::size_t>(given_));
  const double next_id = blocks.get<double>(next_id_block, 1)[0];
  const bool ascending = std::adjacent_find(id.begin(), id.end(), std::greater_equal<>()) == id.end();
  if (!ascending || (!id.empty() && next_id <= id.back()) || (!open_ && next_id != given_))
    throw Error("the snapshot's particles are not those of this case: their ids are others.");
  std::vector<std::pair<const FieldRow*, std::vector<std::vector<Real>>>> fields;
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    fields.push_back({&row, {}});
    for (const std::string& component : row.components) {
      names.push_back(block_of(row, component));
      fields.back().second.push_back(blocks.get<Real>(names.back(), id.size()));
    }
  }
  const std::vector<double> step = blocks.get<double>(step_block, 3);
  const std::vector<double> listed = blocks.get<double>(lists_block, moving_walls_ ? moving_walls_->listed().size() : 0);
  const std::vector<double> impulses = blocks.get<double>(guard_block, guarded_.values().size());
  blocks.expect_no_others(names);

  reserve(static_cast<int>(id.size()));
  set_count(static_cast<int>(id.size()));
  next_id_ = static_cast<std::int64_t>(next_id);
  waiting_ = NewParticles();
  if (moving_walls_) moving_walls_->list_for(walls_, listed);
  guarded_.clear();
  guarded_.values() = impulses;
  step_ = step[0];
  greatest_speed_ = step[1];
  greatest_acceleration_ = step[2];
  report_.upload({static_cast<Real>(step_)});  // its first value, which the next step reads
  std::vector<Real> state(state_.size(), Real(0)), rates(rates_.size(), Real(0));
  for (const auto& [row, components] : fields)
    for (std::size_t k = 0; k < components.size(); ++k)
      std::copy(components[k].begin(), components[k].end(),
                (row->array == ParticleArray::state ? state : rates).begin() +
                    static_cast<std::ptrdiff_t>(index_of(row->components[k].c_str(), 0, row->array)));
  // what lies beyond the particles may be left from a run that has gone wrong
  half_.fill_zero();
  gradient_.fill_zero();
  state_.upload(state);
  id_.upload(id);
  sort_all();
  upload_rates(rates);
  masses_let_in_.clear();
}

/// Given in the order of their ids, into that which the particles have on the device.
template <class Real>
void SphSolver<Real>::upload_rates(const std::vector<Real>& by_id) {
  const std::vector<int> order = order_by_id(id_.download(count_));
  std::vector<Real> rates(by_id.size(), Real(0));
  for (int f = 0; f < fields_.count(ParticleArray::rates); ++f)
    for (int k = 0; k < count_; ++k)
      rates[static_cast<std::size_t>(f) * stride_ + order[k]] = by_id[static_cast<std::size_t>(f) * stride_ + k];
  rates_.upload(rates);
}

template std::vector<char> SphSolver<float>::save() const;
template void SphSolver<float>::restore(const std::vector<char>&);
template std::vector<char> SphSolver<double>::save() const;
template void SphSolver<double>::restore(const std::vector<char>&);

}  // namespace wavetank
