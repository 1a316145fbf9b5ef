#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "bound_kernels.h"
#include "kept_buffer.h"
#include "parting.h"
#include "schedule/schedule.h"
#include "tables/device_sizes.h"

namespace wavetank {

/// What a part has exchanged with those beside it, so far.
struct Exchanged {
  double seconds = 0;  ///< with the waiting for them
  std::uint64_t messages = 0, bytes = 0;
};

/// What the solver of a part of the water keeps to exchange particles with the parts beside it (parts.cl). Must stay where it is once it is
/// bound.
template <class Real>
class WaterPart {
 public:
  /// Particles that have come from another part, or leave.
  struct Arrived {
    std::vector<std::uint32_t> id;
    std::vector<Real> values;  ///< component by component of the state
  };

  /// `tile`: own particles of a tile.
  WaterPart(const compute::Device& device, const Parting& parting, int tile);

  /// Room for so many particles.
  void reserve(Stride stride);
  /// So many rows of the grid are in memory, and slots in all.
  void set_window(int rows, int slots);
  /// `arguments`: all that kernels may be given; `starts`: of the slots.
  /// `rates_are_new`: γ is found after the sort, in the new order.
  void bind(const KernelMaker& make, const compute::Arguments& arguments, compute::Buffer<int>& starts, bool rates_are_new);
  /// Names components of an array that can be exchanged.
  void carry(const std::string& name, const std::vector<int>& places, const compute::Buffer<Real>& from, compute::Buffer<Real>& to,
             const KernelMaker& make, const compute::Arguments& arguments);
  bool carries(const std::string& name) const { return carried_.count(name) != 0; }

  /// Sends those of the `count` particles that the parts beside this one need, and takes those that this one needs. `gone`: own particles
  /// that leave the water.
  std::vector<Arrived> exchange_particles(int count, Arrived& gone);
  /// Of `count` particles and `arrived` more nothing of others is left that reports count.
  void still_others(int count, int arrived);
  /// After a sort of `count` particles: which are own, and lists of tiles and edges. Returns how many are in the part.
  int look_around(int count);
  /// Brings the named values of the halo from the parts that have them.
  void refresh(const std::string& name);
  /// For tests: they are not numbers until they have been brought.
  void spoil(const std::string& name);

  const Parting& parting() const { return parting_; }
  int tiles() const { return tiles_; }
  /// Particles that the report of the present step goes over: with those that have left the part.
  int watched() const { return watched_; }

  const Exchanged& exchanged() const { return exchanged_; }

  std::vector<std::vector<Access>> exchanges;  ///< of each stage of the schedule
  std::string mismatch;                        ///< of halos in this step, which have other particles than were sent: a sentence, or ""
  std::int64_t all = 0;                        ///< particles, of all parts together
  std::int64_t most_own = 0;                   ///< own particles of the part that has the most, after the last step

 private:
  struct Carried {
    KeptBuffer<int> places;
    int components = 0;
    compute::BoundKernel pack, pack_chosen, unpack, spoil;
  };
  struct Edge {
    int first = 0, count = 0;  ///< in the list
  };
  enum { sent_before, sent_after, from_before, from_after };

  int neighbour(int side) const;
  bool is_alone() const { return neighbour(0) < 0 && neighbour(1) < 0; }
  void send(int side, parallel::Bytes bytes);
  Arrived chosen(int list, int count);
  void grow(std::size_t items, std::size_t components);

  compute::Device device_;
  Parting parting_;
  Exchanged exchanged_;
  int rows_ = 1, slots_ = 1, tile_;
  Stride stride_ = 0;
  int count_ = 0, room_ = 0, items_ = 0, first_ = 0, components_ = 0, chosen_room_ = 0, stills_ = 0;
  int tiles_ = 0, watched_ = 0;
  std::array<Edge, 4> edges_;
  compute::Buffer<int> sent_, chosen_, edge_runs_;
  KeptBuffer<int> list_;
  compute::Buffer<Real> message_;
  compute::Buffer<std::uint32_t> ids_;
  compute::Buffer<int>* starts_ = nullptr;
  std::map<std::string, Carried> carried_;
  compute::BoundKernel choose_, still_, tell_, list_tiles_, find_edges_, pack_ids_;
};

}  // namespace wavetank
