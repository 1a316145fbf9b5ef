#include <algorithm>
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

std::string place_block(int axis) { return std::string("particles: ") + "xyz"[axis]; }

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
  std::vector<int> order = own_particles(state);
  std::sort(order.begin(), order.end(), [&id](int a, int b) { return id[a] < id[b]; });
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

template <class Real>
std::vector<int> SphSolver<Real>::own_particles(const std::vector<Real>& state) const {
  std::vector<int> own;
  own.reserve(count_);
  const Real* const is_own = part_ ? component(state, "own") : nullptr;
  for (int i = 0; i < count_; ++i)
    if (is_own == nullptr || is_own[i] != Real(0)) own.push_back(i);
  return own;
}

template <class Real>
std::vector<std::uint32_t> SphSolver<Real>::own_ids() const {
  const std::vector<std::uint32_t> id = id_.download(count_);
  std::vector<std::uint32_t> own;
  for (const int i : own_particles(state_.download())) own.push_back(id[i]);
  return own;
}

template <class Real>
std::vector<char> SphSolver<Real>::laid_out_state(const Layout& layout) const {
  const auto count = static_cast<Stride>(layout.particles.size());
  std::vector<Real> state(fields_.count(ParticleArray::state) * static_cast<std::size_t>(count), Real(0));
  for (Stride i = 0; i < count; ++i) put_laid_out(state, count, static_cast<int>(i), layout);
  std::vector<std::uint32_t> id(count);
  std::iota(id.begin(), id.end(), 0);
  SnapshotBlocks blocks;
  blocks.put(id_block, id);
  blocks.put(next_id_block, std::vector<double>{static_cast<double>(count)});
  for (const SavedComponent& saved : saved_components(false)) {
    std::vector<Real> values(count, Real(0));
    if (saved.array == SavedArray::state) std::copy_n(&state[saved.place * static_cast<std::size_t>(count)], count, values.begin());
    blocks.put(saved.block, values);
  }
  blocks.put(step_block, std::vector<double>(3, 0.0));
  blocks.put(lists_block, moving_walls_ ? moving_walls_->listed() : std::vector<double>());
  blocks.put(guard_block, std::vector<double>(guarded_.values().size(), 0.0));
  return blocks.bytes();
}

template <class Real>
std::vector<std::int64_t> SphSolver<Real>::particles_in_blocks(const std::vector<char>& bytes) const {
  const Parting& parting = part_->parting();
  const std::vector<std::int64_t> in_places = particles_in_places(bytes);
  std::vector<std::int64_t> counts(parting.blocks(), 0);
  for (int place = 1; place <= parting.places; ++place)
    counts[std::min((place - 1) / parting.block, parting.blocks() - 1)] += in_places[place];
  return counts;
}

template <class Real>
std::vector<std::int64_t> SphSolver<Real>::particles_in_places(const std::vector<char>& bytes) const {
  const Parting& parting = part_->parting();
  std::vector<std::int64_t> counts(parting.places + 1, 0);
  for (const int place : places_in_parts(SnapshotBlocks(bytes).get<Real>(place_block(parting.axis)))) ++counts[place];
  return counts;
}

template <class Real>
auto SphSolver<Real>::read_state(const std::vector<char>& bytes) const -> ReadState {
  const SnapshotBlocks blocks(bytes);
  std::vector<std::string> names{id_block, next_id_block, step_block, lists_block, guard_block};
  ReadState read;
  read.id = open_ ? blocks.get<std::uint32_t>(id_block) : blocks.get<std::uint32_t>(id_block, static_cast<std::size_t>(given_));
  const double next_id = blocks.get<double>(next_id_block, 1)[0];
  const bool ascending = std::adjacent_find(read.id.begin(), read.id.end(), std::greater_equal<>()) == read.id.end();
  constexpr double most_ids = 4294967296;  // 2³², of whole numbers of 32 bits
  const bool counts = next_id >= 0 && next_id <= most_ids;
  if (!ascending || !counts || (!read.id.empty() && next_id <= read.id.back()) || (!open_ && next_id != given_))
    throw Error("the snapshot's particles are not those of this case: their ids are others.");
  read.next_id = static_cast<std::int64_t>(next_id);
  read.with_gradients = holds_gradients_ && blocks.has(gradient_block(0)) && (!joins_surface_ || blocks.has(surroundings_block(0)));
  for (int k = 0; holds_gradients_ && !read.with_gradients && k < gradient_count(); ++k)
    names.push_back(gradient_block(k));  // of an older version
  read.components = saved_components(read.with_gradients);
  for (const SavedComponent& saved : read.components) {
    names.push_back(saved.block);
    read.values.push_back(blocks.get<Real>(saved.block, read.id.size()));
  }
  read.step = blocks.get<double>(step_block, 3);
  read.listed = blocks.get<double>(lists_block, moving_walls_ ? moving_walls_->listed().size() : 0);
  read.impulses = blocks.get<double>(guard_block, guarded_.values().size());
  blocks.expect_no_others(names);
  return read;
}

template <class Real>
int SphSolver<Real>::keep_own(ReadState& read) const {
  const std::string along = place_block(part_->parting().axis);
  const auto place = std::find_if(read.components.begin(), read.components.end(), [&](const auto& saved) { return saved.block == along; });
  const std::vector<Real>& coordinates = read.values[place - read.components.begin()];
  const std::vector<int> mine = in_part(coordinates);
  const double begin = values_->at("own_begin"), end = values_->at("own_end");
  const std::vector<int> places = places_in_parts(coordinates);
  const auto own = std::count_if(places.begin(), places.end(), [&](int at) { return at >= begin && at < end; });
  const auto pick = [&mine](auto& all) {
    auto picked = all;
    picked.resize(mine.size());
    for (std::size_t k = 0; k < mine.size(); ++k) picked[k] = all[mine[k]];
    all = std::move(picked);
  };
  pick(read.id);
  for (std::vector<Real>& of_component : read.values) pick(of_component);
  return static_cast<int>(mine.size()) - static_cast<int>(own);
}

/// Everything is read before anything is set, so that a snapshot that does not fit leaves the solver as it was.
template <class Real>
void SphSolver<Real>::restore(const std::vector<char>& bytes) {
  ReadState read = read_state(bytes);
  int coming = 0;  // with the next step, of a part: another halo, before the one that it has is left
  if (part_) {
    part_->all = static_cast<std::int64_t>(read.id.size());
    left_.clear();
    coming = keep_own(read);
  }
  const std::vector<std::uint32_t>& id = read.id;

  reserve(std::max(static_cast<int>(id.size()) + coming, 1));
  set_count(static_cast<int>(id.size()));
  next_id_ = read.next_id;
  waiting_ = NewParticles();
  if (moving_walls_) moving_walls_->list_for(walls_, read.listed);
  guarded_.clear();
  guarded_.values() = read.impulses;
  step_ = read.step[0];
  greatest_speed_ = read.step[1];
  greatest_acceleration_ = read.step[2];
  report_.upload({static_cast<Real>(step_)});  // its first value, which the next step reads
  std::map<SavedArray, std::vector<Real>> arrays{{SavedArray::state, std::vector<Real>(state_.size(), Real(0))},
                                                 {SavedArray::rates, std::vector<Real>(rates_.size(), Real(0))},
                                                 {SavedArray::gradients, std::vector<Real>(gradient_.size(), Real(0))},
                                                 {SavedArray::surroundings, std::vector<Real>()}};
  const bool with_surroundings = read.with_gradients && joins_surface_;
  if (with_surroundings) {
    reserve_surroundings();
    arrays[SavedArray::surroundings].resize(around_.size(), Real(0));
  }
  for (std::size_t k = 0; k < read.components.size(); ++k) {
    const SavedComponent& saved = read.components[k];
    std::copy(read.values[k].begin(), read.values[k].end(),
              arrays[saved.array].begin() + static_cast<std::ptrdiff_t>(saved.place * static_cast<std::size_t>(stride_)));
  }
  std::vector<Real>& state = arrays[SavedArray::state];
  if (part_) std::fill_n(component(state, "own"), count_, Real(1));  // as if all had just come
  // what lies beyond the particles may be left from a run that has gone wrong
  half_.fill_zero();
  gradient_.fill_zero();
  around_.fill_zero();
  state_.upload(state);
  id_.upload(id);
  sort_all_alone();
  upload_by_id(rates_, fields_.count(ParticleArray::rates), arrays[SavedArray::rates]);
  if (holds_gradients_) find_gradients(Slot::now, ends_with_surface());  // of a snapshot without them; of another they are listed by it
  if (read.with_gradients) upload_by_id(gradient_, gradient_count(), arrays[SavedArray::gradients]);
  if (with_surroundings) upload_by_id(around_, field::around_count, arrays[SavedArray::surroundings]);
  masses_let_in_.clear();
}

template <class Real>
std::vector<char> SphSolver<Real>::joined(const std::vector<std::vector<char>>& parts) const {
  std::vector<SnapshotBlocks> given;
  std::vector<std::vector<std::uint32_t>> ids;
  for (const std::vector<char>& bytes : parts) {
    given.emplace_back(bytes);
    ids.push_back(given.back().get<std::uint32_t>(id_block));
  }
  const std::vector<PlaceInPart> order = by_id(ids);
  const auto in_order = [&order](const auto& values) {
    auto all = values[0];
    all.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) all[k] = values[order[k].part][order[k].place];
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

#define WAVETANK_SNAPSHOTS(Real)                                                                           \
  template std::vector<char> SphSolver<Real>::save() const;                                                \
  template std::vector<int> SphSolver<Real>::own_particles(const std::vector<Real>&) const;                \
  template auto SphSolver<Real>::read_state(const std::vector<char>&) const->ReadState;                    \
  template void SphSolver<Real>::restore(const std::vector<char>&);                                        \
  template std::vector<std::uint32_t> SphSolver<Real>::own_ids() const;                                    \
  template std::vector<char> SphSolver<Real>::laid_out_state(const Layout&) const;                         \
  template std::vector<std::int64_t> SphSolver<Real>::particles_in_places(const std::vector<char>&) const; \
  template std::vector<std::int64_t> SphSolver<Real>::particles_in_blocks(const std::vector<char>&) const; \
  template std::vector<char> SphSolver<Real>::joined(const std::vector<std::vector<char>>&) const;
WAVETANK_SNAPSHOTS(float)
WAVETANK_SNAPSHOTS(double)

}  // namespace wavetank
