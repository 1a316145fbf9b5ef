#pragma once

#include <string>
#include <vector>

namespace wavetank::scene {

enum class Holds { value, section, list_of_sections };

/// What is known of a key apart from its C++ type: enough to check a case's structure, to find the nearest key, and to write the page of
/// keys.
struct KeyDescription {
  std::string name;
  std::string type;
  std::string unit;
  std::string allowed;
  std::string default_text;
  std::string description;
  bool required = false;
  int alternative = 0;  ///< keys of different alternatives, numbered from 1, exclude each other; 0 = goes with every one
  Holds holds = Holds::value;
  std::vector<KeyDescription> children;  ///< of the section, or of each item of the list

  const KeyDescription* child(const std::string& child_name) const {
    for (const KeyDescription& candidate : children) {
      if (candidate.name == child_name) return &candidate;
    }
    return nullptr;
  }
};

}  // namespace wavetank::scene
