#include <algorithm>
#include <array>
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
constexpr const char* gradients_block = "particles: gradients";  // one component after the other

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
  std::vector<int> order = order_by_id(id);
  if (part_)
    order.erase(std::remove_if(order.begin(), order.end(), [&](int i) { return component(state, "own")[i] == Real(0); }), order.end());
  const auto in_order = [&](const auto& value_of) {
    std::vector<std::decay_t<decltype(value_of(0))>> values(order.size());
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
  if (gradients_are_held_) {
    const std::vector<Real> gradients = gradient_.download();
    std::vector<Real> all;
    for (int k = 0; k < gradient_count(); ++k) {
      const std::vector<Real> component = in_order([&](int i) { return gradients[static_cast<std::size_t>(k) * stride_ + i]; });
      all.insert(all.end(), component.begin(), component.end());
    }
    blocks.put(gradients_block, all);
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
  std::vector<std::uint32_t> id =
      open_ || part_ ? blocks.get<std::uint32_t>(id_block) : blocks.get<std::uint32_t>(id_block, static_cast<std::size_t>(given_));
  const double next_id = blocks.get<double>(next_id_block, 1)[0];
  const bool ascending = std::adjacent_find(id.begin(), id.end(), std::greater_equal<>()) == id.end();
  constexpr double most_ids = 4294967296;  // 2³², of whole numbers of 32 bits
  const bool counts = next_id >= 0 && next_id <= most_ids;
  if (!ascending || !counts || (!id.empty() && next_id <= id.back()) || (!open_ && !part_ && next_id != given_))
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
  std::vector<std::vector<Real>> gradients;
  if (holds_gradients_ && blocks.has(gradients_block)) {
    names.emplace_back(gradients_block);
    const std::vector<Real> all = blocks.get<Real>(gradients_block, gradient_count() * id.size());
    for (auto from = all.begin(); from != all.end(); from += static_cast<std::ptrdiff_t>(id.size()))
      gradients.emplace_back(from, from + static_cast<std::ptrdiff_t>(id.size()));
  }
  const std::vector<double> step = blocks.get<double>(step_block, 3);
  const std::vector<double> listed = blocks.get<double>(lists_block, moving_walls_ ? moving_walls_->listed().size() : 0);
  const std::vector<double> impulses = blocks.get<double>(guard_block, guarded_.values().size());
  blocks.expect_no_others(names);
  if (part_) {
    const int axis = part_->parting().axis;
    const std::vector<int> mine = in_part(blocks.get<Real>(std::string("particles: ") + "xyz"[axis], id.size()));
    const auto pick = [&](auto& values) {
      auto picked = values;
      picked.resize(mine.size());
      for (std::size_t k = 0; k < mine.size(); ++k) picked[k] = values[mine[k]];
      values = std::move(picked);
    };
    pick(id);
    for (auto& field : fields)
      for (std::vector<Real>& values : field.second) pick(values);
    for (std::vector<Real>& values : gradients) pick(values);
  }

  reserve(std::max(static_cast<int>(id.size()), 1));
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
  if (part_) std::fill_n(component(state, "own"), count_, Real(1));  // as if all had just come
  // what lies beyond the particles may be left from a run that has gone wrong
  half_.fill_zero();
  gradient_.fill_zero();
  state_.upload(state);
  id_.upload(id);
  if (part_)
    sort_alone();
  else
    sort_all();
  upload_by_id(rates_, fields_.count(ParticleArray::rates), rates);
  if (holds_gradients_) restore_gradients(gradients);
  masses_let_in_.clear();
}

/// By component, in the order of ids. An older snapshot has none: then they are those of its state.
template <class Real>
void SphSolver<Real>::restore_gradients(const std::vector<std::vector<Real>>& gradients) {
  reserve_blocks();
  over_own(kernels_.gradients[Slot::now]);
  blocks_are_of_now_ = gradients_are_held_ = true;
  if (gradients.empty()) return;
  std::vector<Real> all(gradient_.size(), Real(0));
  for (std::size_t k = 0; k < gradients.size(); ++k)
    std::copy(gradients[k].begin(), gradients[k].end(), all.begin() + static_cast<std::ptrdiff_t>(k * stride_));
  upload_by_id(gradient_, gradient_count(), all);
}

template <class Real>
std::vector<char> SphSolver<Real>::joined(const std::vector<std::vector<char>>& parts) const {
  std::vector<SnapshotBlocks> given;
  std::vector<std::vector<std::uint32_t>> ids;
  std::vector<std::array<std::size_t, 2>> order;  // part, and place in it
  for (const std::vector<char>& bytes : parts) {
    given.emplace_back(bytes);
    ids.push_back(given.back().get<std::uint32_t>(id_block));
    for (std::size_t k = 0; k < ids.back().size(); ++k) order.push_back({ids.size() - 1, k});
  }
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) { return ids[a[0]][a[1]] < ids[b[0]][b[1]]; });
  const auto in_order = [&order](const auto& values) {
    auto all = values[0];
    all.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) all[k] = values[order[k][0]][order[k][1]];
    return all;
  };
  SnapshotBlocks blocks;
  blocks.put(id_block, in_order(ids));
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    for (const std::string& component : row.components) {
      std::vector<std::vector<Real>> values;
      for (std::size_t part = 0; part < parts.size(); ++part)
        values.push_back(given[part].get<Real>(block_of(row, component), ids[part].size()));
      std::vector<Real> all = in_order(values);
      // those of a scheme whose steps do not begin with them are in the order of before the sort
      if (row.array == ParticleArray::rates && case_.numerics.integrator != Integrator::symplectic)
        std::fill(all.begin(), all.end(), Real(0));
      blocks.put(block_of(row, component), all);
    }
  }
  if (holds_gradients_ && given[0].has(gradients_block)) {
    std::vector<std::vector<std::vector<Real>>> components(gradient_count());
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const std::vector<Real> all = given[part].get<Real>(gradients_block, gradient_count() * ids[part].size());
      const auto count = static_cast<std::ptrdiff_t>(ids[part].size());
      for (int k = 0; k < gradient_count(); ++k) components[k].emplace_back(all.begin() + k * count, all.begin() + (k + 1) * count);
    }
    std::vector<Real> all;
    for (const auto& values : components) {
      const std::vector<Real> component = in_order(values);
      all.insert(all.end(), component.begin(), component.end());
    }
    blocks.put(gradients_block, all);
  }
  for (const char* of_all : {next_id_block, step_block, lists_block, guard_block}) blocks.put(of_all, given[0].get<double>(of_all));
  return blocks.bytes();
}

/// Given in the order of their ids, into that which the particles have on the device.
template <class Real>
void SphSolver<Real>::upload_by_id(Buffer& array, int components, const std::vector<Real>& by_id) {
  const std::vector<int> order = order_by_id(id_.download(count_));
  std::vector<Real> values(by_id.size(), Real(0));
  for (int f = 0; f < components; ++f)
    for (int k = 0; k < count_; ++k)
      values[static_cast<std::size_t>(f) * stride_ + order[k]] = by_id[static_cast<std::size_t>(f) * stride_ + k];
  array.upload(values);
}

template std::vector<char> SphSolver<float>::save() const;
template void SphSolver<float>::restore(const std::vector<char>&);
template void SphSolver<float>::restore_gradients(const std::vector<std::vector<float>>&);
template std::vector<char> SphSolver<float>::joined(const std::vector<std::vector<char>>&) const;
template std::vector<char> SphSolver<double>::joined(const std::vector<std::vector<char>>&) const;
template std::vector<char> SphSolver<double>::save() const;
template void SphSolver<double>::restore(const std::vector<char>&);
template void SphSolver<double>::restore_gradients(const std::vector<std::vector<double>>&);

}  // namespace wavetank
