#pragma once

#include <string>

namespace wavetank {

bool is_collada(const std::string& path);

/// What assimp takes on trust of a Collada file: that an array of numbers is as long as it says and as is read of it, that indices are
/// whole numbers, and that nodes are nested no deeper than some hundreds and do not hold themselves. Throws Error with the line.
void check_collada(const std::string& path);

}  // namespace wavetank
