#include "wavetank/parallel/slabs.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "wavetank/common/error.h"

namespace wavetank::parallel {
namespace {

std::int64_t weight_of(const std::vector<std::int64_t>& weights, int begin, int end) {
  return std::accumulate(weights.begin() + begin, weights.begin() + end, std::int64_t{0});
}

/// As few blocks from `begin` on as a slab may have.
int nearest_end(const std::vector<std::int64_t>& weights, int begin, int least) {
  const int blocks = static_cast<int>(weights.size());
  int end = begin + least;
  while (end <= blocks && weight_of(weights, begin, end) == 0) ++end;
  return end;
}

/// From which block on so many slabs find room, as far towards the end as can be.
int latest_begin(const std::vector<std::int64_t>& weights, int slabs, int least) {
  int begin = static_cast<int>(weights.size());
  for (int slab = 0; slab < slabs; ++slab) {
    const int end = begin;
    begin -= least;
    while (begin >= 0 && weight_of(weights, begin, end) == 0) --begin;
    if (begin < 0) return -1;
  }
  return begin;
}

}  // namespace

std::vector<int> cut_into_slabs(const std::vector<std::int64_t>& weights, int slabs, int least) {
  if (slabs < 1 || latest_begin(weights, slabs, least) < 0)
    throw Error("the water is to be cut into " + std::to_string(slabs) + " parts, but it is too short for that: of its " +
                std::to_string(weights.size()) + " blocks each part needs " + std::to_string(least) + (least == 1 ? "" : " or more") +
                ", with water: choose fewer devices or ranks.");
  const std::int64_t all = weight_of(weights, 0, static_cast<int>(weights.size()));
  std::vector<int> cuts{0};
  std::int64_t before = 0;
  for (int slab = 1; slab < slabs; ++slab) {
    const int latest = latest_begin(weights, slabs - slab, least);
    int cut = nearest_end(weights, cuts.back(), least);
    before += weight_of(weights, cuts.back(), cut);
    // on as long as that brings the weight before the cut nearer to what it should be
    while (cut < latest && slabs * (2 * before + weights[cut]) <= 2 * all * slab) before += weights[cut++];
    cuts.push_back(cut);
  }
  cuts.push_back(static_cast<int>(weights.size()));
  return cuts;
}

double imbalance(const std::vector<std::int64_t>& weights, const std::vector<int>& cuts) {
  std::int64_t greatest = 0, all = 0;
  for (std::size_t slab = 0; slab + 1 < cuts.size(); ++slab) {
    const std::int64_t weight = weight_of(weights, cuts[slab], cuts[slab + 1]);
    greatest = std::max(greatest, weight);
    all += weight;
  }
  return all == 0 ? 1.0 : static_cast<double>(greatest) * static_cast<double>(cuts.size() - 1) / static_cast<double>(all);
}

}  // namespace wavetank::parallel
