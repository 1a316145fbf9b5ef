#include "snapshot_blocks.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

std::uint32_t checksum(const std::vector<char>& bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

template <class T>
void append(std::vector<char>& bytes, const T& value) {
  const char* begin = reinterpret_cast<const char*>(&value);
  bytes.insert(bytes.end(), begin, begin + sizeof value);
}

/// Takes values from the front of bytes.
class Front {
 public:
  explicit Front(const std::vector<char>& bytes) : next_(bytes.data()), left_(bytes.size()) {}

  bool empty() const { return left_ == 0; }
  const char* take(std::uint64_t size) {
    if (size > left_) throw Error("the snapshot's fluid is cut short.");
    const char* begin = next_;
    next_ += size;
    left_ -= static_cast<std::size_t>(size);
    return begin;
  }
  template <class T>
  T value() {
    T result;
    std::memcpy(&result, take(sizeof result), sizeof result);
    return result;
  }

 private:
  const char* next_;
  std::size_t left_;
};

}  // namespace

SnapshotBlocks::SnapshotBlocks(const std::vector<char>& bytes) {
  for (Front front(bytes); !front.empty();) {
    const auto name_size = front.value<std::uint32_t>();
    const std::string name(front.take(name_size), name_size);
    Block block;
    block.value_size = front.value<std::uint32_t>();
    const auto size = front.value<std::uint64_t>();
    const auto stored = front.value<std::uint32_t>();
    const char* begin = front.take(size);
    block.bytes.assign(begin, begin + size);
    if (checksum(block.bytes) != stored) throw Error("the snapshot's \"" + name + "\" is damaged: its checksum is another.");
    blocks_[name] = std::move(block);
  }
}

std::vector<char> SnapshotBlocks::bytes() const {
  std::vector<char> all;
  for (const auto& [name, block] : blocks_) {
    append(all, static_cast<std::uint32_t>(name.size()));
    all.insert(all.end(), name.begin(), name.end());
    append(all, block.value_size);
    append(all, static_cast<std::uint64_t>(block.bytes.size()));
    append(all, checksum(block.bytes));
    all.insert(all.end(), block.bytes.begin(), block.bytes.end());
  }
  return all;
}

template <class T>
void SnapshotBlocks::put(const std::string& name, const std::vector<T>& values) {
  Block& block = blocks_[name];
  block.value_size = sizeof(T);
  block.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(block.bytes.data(), values.data(), block.bytes.size());
}

const SnapshotBlocks::Block& SnapshotBlocks::block(const std::string& name) const {
  const auto found = blocks_.find(name);
  if (found == blocks_.end()) throw Error("the snapshot has no \"" + name + "\", which this case needs.");
  return found->second;
}

template <class T>
std::vector<T> SnapshotBlocks::get(const std::string& name) const {
  return get<T>(name, block(name).bytes.size() / sizeof(T));
}

template <class T>
std::vector<T> SnapshotBlocks::get(const std::string& name, std::size_t count) const {
  const Block& block = this->block(name);
  if (block.value_size != sizeof(T) || block.bytes.size() != count * sizeof(T))
    throw Error("the snapshot's \"" + name + "\" has " + std::to_string(block.bytes.size() / std::max(block.value_size, 1U)) +
                " values of " + std::to_string(block.value_size) + " bytes, but this case's has " + std::to_string(count) + " of " +
                std::to_string(sizeof(T)) + ".");
  std::vector<T> values(count);
  if (count != 0) std::memcpy(values.data(), block.bytes.data(), block.bytes.size());
  return values;
}

void SnapshotBlocks::expect_no_others(const std::vector<std::string>& names) const {
  for (const auto& entry : blocks_)
    if (std::find(names.begin(), names.end(), entry.first) == names.end())
      throw Error("the snapshot has \"" + entry.first + "\", which this case does not know.");
}

template void SnapshotBlocks::put(const std::string&, const std::vector<float>&);
template void SnapshotBlocks::put(const std::string&, const std::vector<double>&);
template void SnapshotBlocks::put(const std::string&, const std::vector<std::uint32_t>&);
template std::vector<std::uint32_t> SnapshotBlocks::get(const std::string&, std::size_t) const;
template std::vector<std::uint32_t> SnapshotBlocks::get(const std::string&) const;
template std::vector<float> SnapshotBlocks::get(const std::string&, std::size_t) const;
template std::vector<float> SnapshotBlocks::get(const std::string&) const;
template std::vector<double> SnapshotBlocks::get(const std::string&, std::size_t) const;
template std::vector<double> SnapshotBlocks::get(const std::string&) const;

}  // namespace wavetank
