#pragma once

#include <map>
#include <string>
#include <vector>

#include "../../src/sph/snapshot_blocks.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// All blocks of an array.
inline void remove_components(SnapshotBlocks& blocks, const std::string& array) {
  for (int k = 0; k < 20; ++k)
    if (blocks.has(array + std::to_string(k))) blocks.remove(array + std::to_string(k));
}

/// Those that a step is to begin with, and what was found with them: of the state that the snapshot was of.
inline void remove_gradients(SnapshotBlocks& blocks) {
  remove_components(blocks, "particles: gradient ");
  remove_components(blocks, "particles: surroundings ");
}

/// The bytes of a solver's state, by field and particle's id.
template <class Real>
class StateBytes {
 public:
  explicit StateBytes(const Solver& solver) : StateBytes(solver.save(), solver.particle_count()) {}
  StateBytes(const std::vector<char>& saved, std::size_t particles) : count(particles), blocks_(saved) {}

  Real get(const std::string& component, std::size_t id) { return values(component).at(id); }
  void set(const std::string& component, std::size_t id, double value) { values(component).at(id) = static_cast<Real>(value); }
  std::vector<char> bytes() {
    if (!values_.empty()) remove_gradients(blocks_);
    for (const auto& [component, changed] : values_) blocks_.put("particles: " + component, changed);
    return blocks_.bytes();
  }

  std::size_t count;

 private:
  std::vector<Real>& values(const std::string& component) {
    const auto [found, is_new] = values_.try_emplace(component);
    if (is_new) found->second = blocks_.get<Real>("particles: " + component, count);
    return found->second;
  }

  SnapshotBlocks blocks_;
  std::map<std::string, std::vector<Real>> values_;
};

/// Components of a vector field.
inline const std::string places[3] = {"x", "y", "z"};
inline const std::string velocities[3] = {"u", "v", "w"};

}  // namespace wavetank
