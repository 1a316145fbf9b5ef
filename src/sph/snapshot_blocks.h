#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace wavetank {

/// A solver's state as blocks of values by name, each with a checksum; those of particles in the order of their ids. So it depends neither
/// on where a device keeps a particle nor on how much room it has.
class SnapshotBlocks {
 public:
  struct Block {
    std::uint32_t value_size = 0;  ///< bytes
    std::vector<char> bytes;
  };

  SnapshotBlocks() = default;
  /// Throws Error, in one sentence, if the bytes are cut short, or a block's checksum is not that of its bytes.
  explicit SnapshotBlocks(const std::vector<char>& bytes);
  std::vector<char> bytes() const;

  template <class T>
  void put(const std::string& name, const std::vector<T>& values);
  bool has(const std::string& name) const { return blocks_.count(name) != 0; }
  void remove(const std::string& name) { blocks_.erase(name); }
  /// Throws Error if the block is missing, or does not hold `count` such values.
  template <class T>
  std::vector<T> get(const std::string& name, std::size_t count) const;
  /// Of as many values as there are.
  template <class T>
  std::vector<T> get(const std::string& name) const;
  /// Throws Error if there are other blocks than these.
  void expect_no_others(const std::vector<std::string>& names) const;

 private:
  const Block& block(const std::string& name) const;

  std::map<std::string, Block> blocks_;
};

}  // namespace wavetank
