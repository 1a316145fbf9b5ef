#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <unordered_map>

namespace wavetank {

using Node = std::array<int, 3>;

/// Nodes a length apart in each direction.
struct NodeGrid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, of node (0, 0, 0)
  double cell = 1;                                   ///< m

  Eigen::Vector3d place(const Node& node) const { return origin + cell * Eigen::Vector3d(node[0], node[1], node[2]); }
  Eigen::Vector3d in_cells(const Eigen::Vector3d& place) const { return (place - origin) / cell; }
};

/// Values at some nodes of a grid, the same one at all others; kept by bricks of 8 × 8 × 8 nodes.
template <class Value>
class NodeValues {
 public:
  explicit NodeValues(Value elsewhere) : elsewhere_(elsewhere) {}
  NodeValues(const NodeValues&) = delete;
  NodeValues& operator=(const NodeValues&) = delete;

  Value& operator[](const Node& node) {
    const std::uint64_t key = key_of(node);
    if (key != last_key_ || last_ == nullptr) {
      auto found = bricks_.find(key);
      if (found == bricks_.end()) {
        found = bricks_.emplace(key, Brick()).first;
        found->second.fill(elsewhere_);
      }
      last_ = &found->second;
      last_key_ = key;
    }
    return (*last_)[place_in_brick(node)];
  }
  const Value& at(const Node& node) const {
    const std::uint64_t key = key_of(node);
    if (key != last_key_ || last_ == nullptr) {
      const auto found = bricks_.find(key);
      if (found == bricks_.end()) return elsewhere_;
      last_ = const_cast<Brick*>(&found->second);
      last_key_ = key;
    }
    return (*last_)[place_in_brick(node)];
  }

 private:
  using Brick = std::array<Value, 512>;
  static std::uint64_t key_of(const Node& node) {
    const auto part = [](int n) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>((n >> 3) + (1 << 20)) & 0x1fffffU); };
    return part(node[0]) << 42U | part(node[1]) << 21U | part(node[2]);
  }
  static std::size_t place_in_brick(const Node& node) {
    return static_cast<std::size_t>((node[0] & 7) << 6 | (node[1] & 7) << 3 | (node[2] & 7));
  }

  Value elsewhere_;
  std::unordered_map<std::uint64_t, Brick> bricks_;
  mutable Brick* last_ = nullptr;  ///< one node after another is mostly in the same brick
  mutable std::uint64_t last_key_ = 0;
};

}  // namespace wavetank
