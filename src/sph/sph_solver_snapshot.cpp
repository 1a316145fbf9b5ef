#include <algorithm>
#include <array>
#include <functional>
#include <map>
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

std::string gradient_block(int component) { return "particles: gradient " + std::to_string(component); }

std::string surroundings_block(int component) { return "particles: surroundings " + std::to_string(component); }

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

/// What a snapshot has a block of, a component each.
template <class Real>
auto SphSolver<Real>::saved_components(bool gradients) const -> std::vector<SavedComponent> {
  std::vector<SavedComponent> saved;
  for (const FieldRow& row : fields_.rows()) {
    if (!row.is_saved) continue;
    for (const std::string& component : row.components)
      saved.push_back({block_of(row, component), row.array == ParticleArray::state ? SavedArray::state : SavedArray::rates,
                       static_cast<std::size_t>(fields_.at(row.array, component))});
  }
  for (int k = 0; gradients && k < gradient_count(); ++k)
    saved.push_back({gradient_block(k), SavedArray::gradients, static_cast<std::size_t>(k)});
  for (int k = 0; gradients && joins_surface_ && k < field::around_count; ++k)
    if (k != field::around_surface)  // which the next step finds by the others
      saved.push_back({surroundings_block(k), SavedArray::surroundings, static_cast<std::size_t>(k)});
  return saved;
}

template <class Real>
std::vector<char> SphSolver<Real>::save() const {
  const std::map<SavedArray, std::vector<Real>> from{
      {SavedArray::state, state_.download()},
      {SavedArray::rates, rates_.download()},
      {SavedArray::gradients, saves_gradients() ? gradient_.download() : std::vector<Real>()},
      {SavedArray::surroundings, saves_gradients() && joins_surface_ ? around_.download() : std::vector<Real>()}};
  const std::vector<Real>& state = from.at(SavedArray::state);
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
  for (const SavedComponent& saved : saved_components(saves_gradients()))
    blocks.put(saved.block, in_order([&](int i) { return from.at(saved.array)[saved.place * static_cast<std::size_t>(stride_) + i]; }));
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
  const bool with_gradients = holds_gradients_ && blocks.has(gradient_block(0)) && (!joins_surface_ || blocks.has(surroundings_block(0)));
  for (int k = 0; holds_gradients_ && !with_gradients && k < gradient_count(); ++k)
    names.push_back(gradient_block(k));  // of an older version
  const std::vector<SavedComponent> components = saved_components(with_gradients);
  std::vector<std::vector<Real>> values;  // of each
  for (const SavedComponent& saved : components) {
    names.push_back(saved.block);
    values.push_back(blocks.get<Real>(saved.block, id.size()));
  }
  const std::vector<double> step = blocks.get<double>(step_block, 3);
  const std::vector<double> listed = blocks.get<double>(lists_block, moving_walls_ ? moving_walls_->listed().size() : 0);
  const std::vector<double> impulses = blocks.get<double>(guard_block, guarded_.values().size());
  blocks.expect_no_others(names);
  if (part_) {
    part_->all = static_cast<std::int64_t>(id.size());
    left_.clear();
    const int axis = part_->parting().axis;
    const std::vector<int> mine = in_part(blocks.get<Real>(std::string("particles: ") + "xyz"[axis], id.size()));
    const auto pick = [&](auto& all) {
      auto picked = all;
      picked.resize(mine.size());
      for (std::size_t k = 0; k < mine.size(); ++k) picked[k] = all[mine[k]];
      all = std::move(picked);
    };
    pick(id);
    for (std::vector<Real>& of_component : values) pick(of_component);
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
  std::map<SavedArray, std::vector<Real>> arrays{{SavedArray::state, std::vector<Real>(state_.size(), Real(0))},
                                                 {SavedArray::rates, std::vector<Real>(rates_.size(), Real(0))},
                                                 {SavedArray::gradients, std::vector<Real>(gradient_.size(), Real(0))},
                                                 {SavedArray::surroundings, std::vector<Real>()}};
  if (with_gradients && joins_surface_) {
    reserve_surroundings();
    arrays[SavedArray::surroundings].resize(around_.size(), Real(0));
  }
  for (std::size_t k = 0; k < components.size(); ++k)
    std::copy(values[k].begin(), values[k].end(),
              arrays[components[k].array].begin() + static_cast<std::ptrdiff_t>(components[k].place * static_cast<std::size_t>(stride_)));
  std::vector<Real>& state = arrays[SavedArray::state];
  if (part_) std::fill_n(component(state, "own"), count_, Real(1));  // as if all had just come
  // what lies beyond the particles may be left from a run that has gone wrong
  half_.fill_zero();
  gradient_.fill_zero();
  around_.fill_zero();
  state_.upload(state);
  id_.upload(id);
  sort_all();
  upload_by_id(rates_, fields_.count(ParticleArray::rates), arrays[SavedArray::rates]);
  if (holds_gradients_) find_own_gradients();  // of a snapshot without them; of another they are listed by it
  if (with_gradients) upload_by_id(gradient_, gradient_count(), arrays[SavedArray::gradients]);
  if (with_gradients && joins_surface_) upload_by_id(around_, field::around_count, arrays[SavedArray::surroundings]);
  masses_let_in_.clear();
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
  for (const SavedComponent& saved : saved_components(holds_gradients_ && given[0].has(gradient_block(0)))) {
    std::vector<std::vector<Real>> values;
    for (std::size_t part = 0; part < parts.size(); ++part) values.push_back(given[part].get<Real>(saved.block, ids[part].size()));
    std::vector<Real> all = in_order(values);
    // those of a scheme whose steps do not begin with them are in the order of before the sort
    if (saved.array == SavedArray::rates && case_.numerics.integrator != Integrator::symplectic) std::fill(all.begin(), all.end(), Real(0));
    blocks.put(saved.block, all);
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
template std::vector<char> SphSolver<float>::joined(const std::vector<std::vector<char>>&) const;
template std::vector<char> SphSolver<double>::joined(const std::vector<std::vector<char>>&) const;
template std::vector<char> SphSolver<double>::save() const;
template void SphSolver<double>::restore(const std::vector<char>&);

}  // namespace wavetank
