#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace wavetank::compute {

/// 128-bit FNV-1a: names cached programs and finds damage; no defence against a forger.
class Hash {
 public:
  void add(const void* data, std::size_t size);
  /// Adds the text and its length, so that ("ab", "c") and ("a", "bc") differ.
  void add(const std::string& text);
  std::array<std::uint64_t, 2> value() const;
  std::string hexadecimal() const;

 private:
  __extension__ using Wide = unsigned __int128;
  Wide value_ = (Wide(0x6c62272e07bb0142ull) << 64) | 0x62b821756295c58dull;
};

/// Where compiled programs are kept (see Program); empty when caching is off or has no place.
std::string cache_directory();

/// The binary stored under the key; empty if there is none, or if the file is truncated, damaged or another's.
std::vector<unsigned char> load_binary(const std::string& directory, const Hash& key);

/// Stores a binary so that a reader sees all of it or nothing. Whatever goes wrong is passed over in silence: the cache only saves time.
void store_binary(const std::string& directory, const Hash& key, const std::vector<unsigned char>& binary);

}  // namespace wavetank::compute
