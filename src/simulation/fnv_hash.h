#pragma once

#include <cstddef>
#include <cstdint>

namespace wavetank {

/// FNV-1a over 64 bits, of `size` bytes after those that `hash` is of already: tells what is damaged or differs by accident, not on
/// purpose.
inline std::uint64_t fnv_1a(const void* data, std::size_t size, std::uint64_t hash = 14695981039346656037ULL) {
  const auto* bytes = static_cast<const unsigned char*>(data);
  for (std::size_t k = 0; k < size; ++k) hash = (hash ^ bytes[k]) * 1099511628211ULL;
  return hash;
}

}  // namespace wavetank
