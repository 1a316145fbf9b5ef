#include "water_part.h"

#include <chrono>
#include <cstring>
#include <utility>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

template <class T>
void append_values(parallel::Bytes& bytes, const T* values, std::size_t count) {
  const char* begin = reinterpret_cast<const char*>(values);
  bytes.insert(bytes.end(), begin, begin + count * sizeof(T));
}

/// Of an exchange, from when the device has done what was queued before.
class Watch {
 public:
  explicit Watch(Exchanged& exchanged) : exchanged_(exchanged), begin_(std::chrono::steady_clock::now()) {}
  ~Watch() { exchanged_.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

 private:
  Exchanged& exchanged_;
  std::chrono::steady_clock::time_point begin_;
};

}  // namespace

template <class Real>
WaterPart<Real>::WaterPart(const compute::Device& device, const Parting& parting, int tile)
    : device_(device), parting_(parting), tile_(tile), sent_(device, 3), edge_runs_(device, 8) {
  list_.set(device, {0});
  grow(1, 1);
}

template <class Real>
void WaterPart<Real>::reserve(Stride stride) {
  if (stride <= stride_) return;
  stride_ = stride;
  chosen_ = compute::Buffer<int>(device_, 3 * static_cast<std::size_t>(stride));
  chosen_room_ = static_cast<int>(stride);
}

template <class Real>
void WaterPart<Real>::set_window(int rows, int slots) {
  rows_ = rows;
  slots_ = slots;
  const std::size_t wanted = 8 * static_cast<std::size_t>(rows);
  if (edge_runs_.size() < wanted) edge_runs_ = compute::Buffer<int>(device_, wanted);
}

template <class Real>
void WaterPart<Real>::bind(const KernelMaker& make, const compute::Arguments& given, compute::Buffer<int>& starts, bool rates_are_new) {
  starts_ = &starts;
  stills_ = rates_are_new ? 1 : 0;
  carried_.clear();
  compute::Arguments all = given;
  all.value("rows", rows_).value("slots", slots_);
  find_edges_ = make.exact("parts.cl", "find_edges", compute::Arguments(all).memory("edges", edge_runs_));
  list_tiles_ = make.exact("parts.cl", "list_tiles",
                           compute::Arguments(all).value("tile_own", tile_).value("segment", parting_.segment).memory("starts", starts));
  choose_ = make.exact("parts.cl", "choose_sent",
                       compute::Arguments(all).value("room", chosen_room_).memory("sent", sent_).memory("chosen", chosen_));
  tell_ = make.exact("parts.cl", "tell_own", compute::Arguments(all).value("count", count_).value("stills", stills_));
  still_ = make.exact("parts.cl", "still_others", compute::Arguments(all).value("count", count_).value("room", room_));
  pack_ids_ = make.exact(
      "parts.cl", "pack_ids",
      compute::Arguments(all).value("items", items_).value("first", first_).memory("list", std::as_const(chosen_)).memory("ids", ids_));
}

template <class Real>
void WaterPart<Real>::carry(const std::string& name, const std::vector<int>& places, const compute::Buffer<Real>& from,
                            compute::Buffer<Real>& to, const KernelMaker& make, const compute::Arguments& given) {
  Carried& carried = carried_[name];
  carried.places.set(device_, places);
  carried.components = static_cast<int>(places.size());
  compute::Arguments all = given;
  all.value("items", items_).value("first", first_).value("components", components_).memory("places", carried.places.on_device());
  const auto kernel = [&](const char* what, const compute::Arguments& arguments) { return make.exact("parts.cl", what, arguments); };
  compute::Arguments out = all;
  out.memory("array", from).memory("message", message_);
  carried.pack = kernel("pack", out.memory("list", list_.on_device()));
  carried.pack_chosen = kernel("pack", out.memory("list", std::as_const(chosen_)));
  compute::Arguments in = all;
  in.memory("array", to).memory("message", std::as_const(message_)).memory("list", list_.on_device());
  carried.unpack = kernel("unpack", in);
  carried.spoil = kernel("spoil", in);
}

template <class Real>
int WaterPart<Real>::neighbour(int side) const {
  const int rank = parting_.group->rank() + (side == 0 ? -1 : 1), size = parting_.group->size();
  if (parting_.wraps()) return (rank + size) % size;
  return rank < size ? rank : -1;
}

template <class Real>
void WaterPart<Real>::send(int side, parallel::Bytes bytes) {
  ++exchanged_.messages;
  exchanged_.bytes += bytes.size();
  parting_.group->send(neighbour(side), std::move(bytes));
}

template <class Real>
void WaterPart<Real>::grow(std::size_t items, std::size_t components) {
  if (message_.size() < items * components) message_ = compute::Buffer<Real>(device_, 2 * items * components);
  if (ids_.size() < items) ids_ = compute::Buffer<std::uint32_t>(device_, 2 * items);
}

template <class Real>
typename WaterPart<Real>::Arrived WaterPart<Real>::chosen(int list, int count) {
  if (count == 0) return {};
  items_ = count;
  first_ = list * chosen_room_;
  grow(items_, components_);
  carried_.at("state").pack_chosen.launch(items_);
  pack_ids_.launch(items_);
  return {ids_.download(items_), message_.download(static_cast<std::size_t>(items_) * components_)};
}

template <class Real>
std::vector<typename WaterPart<Real>::Arrived> WaterPart<Real>::exchange_particles(int count, Arrived& gone) {
  if (!is_alone()) device_.finish();
  const Watch watch(exchanged_);
  components_ = carried_.at("state").components;
  sent_.upload({0, 0, 0});
  choose_.launch(count);
  const std::vector<int> counts = sent_.download();
  gone = chosen(2, counts[2]);
  for (const int side : {0, 1}) {
    if (neighbour(side) < 0) continue;
    const Arrived leaving = chosen(side, counts[side]);
    parallel::Bytes bytes;
    append_values(bytes, leaving.id.data(), leaving.id.size());
    append_values(bytes, leaving.values.data(), leaving.values.size());
    send(side, std::move(bytes));
  }
  std::vector<Arrived> arrived;
  for (const int side : {1, 0}) {  // as refresh() has it
    if (neighbour(side) < 0) continue;
    const parallel::Bytes bytes = parting_.group->receive(neighbour(side));
    const std::size_t particles = bytes.size() / (sizeof(std::uint32_t) + components_ * sizeof(Real));
    Arrived more{std::vector<std::uint32_t>(particles), std::vector<Real>(particles * components_)};
    if (particles > 0) {
      std::memcpy(more.id.data(), bytes.data(), particles * sizeof(std::uint32_t));
      std::memcpy(more.values.data(), bytes.data() + particles * sizeof(std::uint32_t), more.values.size() * sizeof(Real));
    }
    arrived.push_back(std::move(more));
  }
  return arrived;
}

template <class Real>
void WaterPart<Real>::still_others(int count, int arrived) {
  count_ = count;
  room_ = count + arrived;
  still_.launch(room_);
}

template <class Real>
int WaterPart<Real>::look_around(int count) {
  count_ = watched_ = count;
  const int no_tiles = 0;
  starts_->memory().write(&no_tiles, sizeof no_tiles, (static_cast<std::size_t>(slots_) + 2) * sizeof(int));
  tell_.launch(count);
  list_tiles_.launch(rows_);
  find_edges_.launch(rows_);
  int counted[3];  // in the part, with those that have left it, tiles
  starts_->memory().read(counted, sizeof counted, static_cast<std::size_t>(slots_) * sizeof(int));
  tiles_ = counted[2];
  const std::vector<int> runs = edge_runs_.download();
  std::vector<int> list;
  for (int k = 0; k < 4; ++k) {
    edges_[k].first = static_cast<int>(list.size());
    for (int row = 0; row < rows_; ++row)
      for (int i = runs[8 * row + 2 * k]; i < runs[8 * row + 2 * k + 1]; ++i) list.push_back(i);
    edges_[k].count = static_cast<int>(list.size()) - edges_[k].first;
  }
  list_.set(device_, list);
  return counted[0];
}

template <class Real>
void WaterPart<Real>::refresh(const std::string& name) {
  if (is_alone()) return;
  device_.finish();
  const Watch watch(exchanged_);
  Carried& carried = carried_.at(name);
  components_ = carried.components;
  const auto use = [&](const Edge& edge) {
    items_ = edge.count;
    first_ = edge.first;
    grow(items_, components_);
  };
  for (const int side : {0, 1}) {
    if (neighbour(side) < 0) continue;
    use(edges_[side == 0 ? sent_before : sent_after]);
    carried.pack.launch(items_);
    const std::vector<Real> values = message_.download(static_cast<std::size_t>(items_) * components_);
    parallel::Bytes bytes;
    append_values(bytes, values.data(), values.size());
    send(side, std::move(bytes));
  }
  for (const int side : {1, 0}) {  // of two parts in a ring, the first message is of the one that comes after
    if (neighbour(side) < 0) continue;
    use(edges_[side == 0 ? from_before : from_after]);
    const parallel::Bytes bytes = parting_.group->receive(neighbour(side));
    if (bytes.size() != static_cast<std::size_t>(items_) * components_ * sizeof(Real)) {
      // as of a particle that is nowhere, which the report of this step tells of
      mismatch = "part " + std::to_string(parting_.group->rank()) + " of the water was sent the " + name + " of " +
                 std::to_string(bytes.size() / (components_ * sizeof(Real))) + " particles, but has " + std::to_string(items_) +
                 " in its halo there";
      continue;
    }
    if (items_ == 0) continue;
    message_.memory().write(bytes.data(), bytes.size());
    carried.unpack.launch(items_);
  }
}

template <class Real>
void WaterPart<Real>::spoil(const std::string& name) {
  Carried& carried = carried_.at(name);
  components_ = carried.components;
  carried.spoil.launch(watched_);
}

template class WaterPart<float>;
template class WaterPart<double>;

}  // namespace wavetank
