#include "wavetank/sph/parts_need.h"

#include <algorithm>
#include <memory>
#include <set>

#include "part_plan.h"
#include "part_server.h"
#include "wavetank/sph/parted_solver.h"

namespace wavetank {
namespace {

using parallel::Bytes;

/// A part alone, as one of so many: nobody hears it, and it hears nothing.
class OneOfMany final : public parallel::Group {
 public:
  OneOfMany(int size, int rank) : size_(size), rank_(rank) {}
  int size() const override { return size_; }
  int rank() const override { return rank_; }
  void send(int, Bytes) override {}
  Bytes receive(int) override { return {}; }
  std::vector<double> greatest(const std::vector<double>& values) override { return values; }
  std::vector<std::int64_t> sums(const std::vector<std::int64_t>& values) override { return values; }
  std::vector<std::int64_t> least(const std::vector<std::int64_t>& values) override { return values; }

 private:
  int size_, rank_;
};

}  // namespace

PartsNeed need_of_parts(int parts, const compute::Device& device, const Case& scene, const Layout& layout,
                        const Discretisation& discretisation) {
  Parting parting = parting_for(scene, layout, discretisation, device.info(), {});
  const std::vector<Eigen::Vector3d> centres(1 + scene.bodies.size(), Eigen::Vector3d::Zero());
  const auto part_of = [&](parallel::Group& group) {
    parting.group = &group;
    return make_part_server(device, parting, scene, layout, discretisation, centres);
  };
  OneOfMany first(parts, 0);
  std::unique_ptr<PartServer> part = part_of(first);
  const Bytes state = part->laid_out_state(layout);
  const std::vector<int> cuts = cuts_for(part->particles_in_blocks(state), parting, parts, !layout.openings.empty(), {});
  const std::vector<std::int64_t> in_places = part->particles_in_places(state);
  PartsNeed need;
  need.parts = parts;
  int largest = 0, widest = 0, width = 0;
  for (int k = 0; k < parts; ++k) {
    const int begin = parting.begin_of(cuts[k]), end = parting.begin_of(cuts[k + 1]);
    if (end - begin > width) {
      widest = k;
      width = end - begin;
    }
    std::vector<char> has(in_places.size(), 0);  // a small ring may bring it the same places from either side
    for (int place = begin - parting.halo; parts > 1 && place < end + parting.halo; ++place)
      has[parting.in_ring(place, parting.wraps())] = 1;
    std::size_t own = 0, others = 0;
    for (int place = 1; place <= parting.places; ++place) {
      const auto count = static_cast<std::size_t>(in_places[place]);
      if (place >= begin && place < end)
        own += count;
      else if (has[place] != 0)
        others += count;
    }
    need.all_others += others;
    if (own + others < need.own + need.others) continue;
    largest = k;
    need.own = own;
    need.others = others;
  }
  part.reset();                                         // whose memory would count
  for (const int k : std::set<int>{largest, widest}) {  // of little water in much of the tank the slots may weigh more
    OneOfMany one(parts, k);
    need.memory = std::max(need.memory, static_cast<double>(part_of(one)->memory_for(cuts, state)));
  }
  return need;
}

}  // namespace wavetank
