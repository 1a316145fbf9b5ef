#pragma once

#include <string>

namespace wavetank::bench {

/// Throws Error if a file could not be written there; leaves everything as it is.
void check_writable(const std::string& path);
/// Writes a file whole or not at all; an older one is replaced. Throws Error.
void write_whole(const std::string& path, const std::string& content);

}  // namespace wavetank::bench
