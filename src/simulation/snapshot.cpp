#include "snapshot.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fnv_hash.h"
#include "wavetank/common/error.h"
#include "wavetank/common/whole_file.h"

namespace wavetank {
namespace {

constexpr char magic[] = "wavetank snapshot 5\n";
constexpr std::size_t magic_size = sizeof magic - 1;

class Writer {
 public:
  template <class T>
  void value(const T& from) {
    const char* begin = reinterpret_cast<const char*>(&from);
    bytes.insert(bytes.end(), begin, begin + sizeof from);
  }
  template <class Container>
  void block(const Container& from) {
    value(static_cast<std::uint64_t>(from.size()));
    bytes.insert(bytes.end(), from.begin(), from.end());
  }
  std::vector<char> bytes;
};

class Reader {
 public:
  Reader(const std::vector<char>& bytes, std::size_t position, std::string damage)
      : bytes_(bytes), position_(position), damage_(std::move(damage)) {}
  template <class T>
  void value(T& to) {
    need(sizeof to);
    std::memcpy(&to, bytes_.data() + position_, sizeof to);
    position_ += sizeof to;
  }
  template <class Container>
  void block(Container& to) {
    std::uint64_t size = 0;
    value(size);
    need(size);
    to.assign(bytes_.begin() + static_cast<std::ptrdiff_t>(position_), bytes_.begin() + static_cast<std::ptrdiff_t>(position_ + size));
    position_ += size;
  }

 private:
  void need(std::uint64_t size) const {
    if (size > bytes_.size() - position_) throw Error(damage_);
  }
  const std::vector<char>& bytes_;
  std::size_t position_;
  std::string damage_;
};

}  // namespace

void write_snapshot(const std::string& path, const Snapshot& snapshot) {
  Writer writer;
  writer.bytes.assign(magic, magic + magic_size);
  writer.block(snapshot.version);
  writer.block(snapshot.device);
  writer.block(snapshot.scene);
  writer.value(snapshot.time);
  writer.value(snapshot.time_step);
  writer.value(snapshot.step);
  writer.value(snapshot.guard_hits);
  for (const std::uint64_t clock : snapshot.clocks) writer.value(clock);
  writer.value(static_cast<std::uint64_t>(snapshot.instruments.size()));
  for (const double value : snapshot.instruments) writer.value(value);
  writer.block(snapshot.bodies);
  writer.block(snapshot.openings);
  writer.block(snapshot.fluid);
  writer.value(fnv_1a(writer.bytes.data(), writer.bytes.size()));

  write_whole(path, {writer.bytes.data(), writer.bytes.size()}, "the snapshot");
}

Snapshot read_snapshot(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) throw Error("cannot read the snapshot " + path + ": it is a directory.");
  std::ifstream stream(path, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(stream), {});
  if (!stream.is_open() || stream.bad()) throw Error("cannot read the snapshot " + path + ": " + std::strerror(errno) + ".");
  if (bytes.size() < magic_size || std::memcmp(bytes.data(), magic, magic_size) != 0)
    throw Error(path + " is not a snapshot of this version of wavetank: it does not begin with \"wavetank snapshot 5\".");
  const std::string damage =
      "the snapshot " + path + " is truncated or damaged: its checksum does not match its " + std::to_string(bytes.size()) + " bytes.";
  std::uint64_t stored = 0;
  if (bytes.size() < magic_size + sizeof stored) throw Error(damage);
  std::memcpy(&stored, bytes.data() + bytes.size() - sizeof stored, sizeof stored);
  if (stored != fnv_1a(bytes.data(), bytes.size() - sizeof stored)) throw Error(damage);

  Snapshot snapshot;
  Reader reader(bytes, magic_size, damage);
  reader.block(snapshot.version);
  reader.block(snapshot.device);
  reader.block(snapshot.scene);
  reader.value(snapshot.time);
  reader.value(snapshot.time_step);
  reader.value(snapshot.step);
  reader.value(snapshot.guard_hits);
  for (std::uint64_t& clock : snapshot.clocks) reader.value(clock);
  std::uint64_t remembered = 0;
  reader.value(remembered);
  for (std::uint64_t k = 0; k < remembered; ++k) reader.value(snapshot.instruments.emplace_back());
  reader.block(snapshot.bodies);
  reader.block(snapshot.openings);
  reader.block(snapshot.fluid);
  return snapshot;
}

}  // namespace wavetank
