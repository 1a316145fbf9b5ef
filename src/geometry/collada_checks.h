#pragma once

#include <string>

namespace wavetank {

/// By its extension or, as assimp does where it knows no reader of that, by how it begins.
bool is_collada(const std::string& path);

/// What assimp takes on trust of a Collada file: that an array of numbers is as long as it says and as is read of it, that indices are
/// whole numbers, and that nodes are nested no deeper than some hundreds and do not hold themselves. Throws
/// Error with the line; also for what is compressed or no text of UTF-8, which cannot be looked at.
void check_collada(const std::string& path);

}  // namespace wavetank
