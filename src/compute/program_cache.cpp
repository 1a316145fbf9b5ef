#include "program_cache.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "driver_environment.h"

namespace wavetank::compute {
namespace {

/// What stands before the binary in a file of the cache.
struct Header {
  char magic[8];
  std::uint64_t key[2];
  std::uint64_t size;         ///< bytes of the binary
  std::uint64_t checksum[2];  ///< of the binary
};

/// Raise the digit whenever the layout changes: older files are then not understood, and replaced.
constexpr char file_magic[8] = {'W', 'T', 'K', 'E', 'R', 'N', '0', '1'};

Header header_of(const Hash& key, const std::vector<unsigned char>& binary) {
  Header header{};
  std::memcpy(header.magic, file_magic, sizeof file_magic);
  std::memcpy(header.key, key.value().data(), sizeof header.key);
  header.size = binary.size();
  Hash checksum;
  checksum.add(binary.data(), binary.size());
  std::memcpy(header.checksum, checksum.value().data(), sizeof header.checksum);
  return header;
}

std::filesystem::path file_of(const std::string& directory, const Hash& key) {
  return std::filesystem::path(directory) / (key.hexadecimal() + ".bin");
}

}  // namespace

void Hash::add(const void* data, std::size_t size) {
  constexpr Wide prime = (Wide(1) << 88) | 0x13b;
  const unsigned char* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t i = 0; i < size; ++i) {
    value_ ^= bytes[i];
    value_ *= prime;
  }
}

void Hash::add(const std::string& text) {
  const std::uint64_t size = text.size();
  add(&size, sizeof size);
  add(text.data(), text.size());
}

std::array<std::uint64_t, 2> Hash::value() const { return {std::uint64_t(value_ >> 64), std::uint64_t(value_)}; }

std::string Hash::hexadecimal() const {
  char text[33];
  const auto words = value();
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(words[0]), static_cast<unsigned long long>(words[1]));
  return text;
}

std::string cache_directory() {
  const char* own = std::getenv("WAVETANK_CACHE_DIRECTORY");
  if (own != nullptr) return own;
  const std::string user = user_cache_directory();
  return user.empty() ? "" : user + "/wavetank";
}

std::vector<unsigned char> load_binary(const std::string& directory, const Hash& key) {
  const std::filesystem::path file = file_of(directory, key);
  std::error_code failure;
  const std::uintmax_t file_size = std::filesystem::file_size(file, failure);
  if (failure || file_size <= sizeof(Header)) return {};
  std::ifstream in(file, std::ios::binary);
  Header stored{};
  std::vector<unsigned char> binary(file_size - sizeof stored);
  in.read(reinterpret_cast<char*>(&stored), sizeof stored);
  in.read(reinterpret_cast<char*>(binary.data()), std::streamsize(binary.size()));
  const Header expected = header_of(key, binary);
  if (!in || std::memcmp(&stored, &expected, sizeof stored) != 0) return {};
  return binary;
}

void store_binary(const std::string& directory, const Hash& key, const std::vector<unsigned char>& binary) {
  static std::atomic<unsigned> count{0};
  if (binary.empty() || !make_writable_directory(directory)) return;
  const std::filesystem::path file = file_of(directory, key);
  std::filesystem::path temporary = file;
  temporary += "." + std::to_string(getpid()) + "." + std::to_string(count++) + ".part";
  std::error_code failure;
  bool written = false;
  {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    const Header header = header_of(key, binary);
    out.write(reinterpret_cast<const char*>(&header), sizeof header);
    out.write(reinterpret_cast<const char*>(binary.data()), std::streamsize(binary.size()));
    out.close();
    written = bool(out);
  }
  if (written) std::filesystem::rename(temporary, file, failure);
  if (!written || failure) std::filesystem::remove(temporary, failure);
}

}  // namespace wavetank::compute
