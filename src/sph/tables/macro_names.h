#pragma once

#include <cctype>
#include <string>

namespace wavetank {

/// As the device's headers have a row's name: in capitals.
inline std::string macro_name(std::string name) {
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace wavetank
