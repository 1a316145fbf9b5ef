#include "structure.h"

#include <algorithm>

#include "wavetank/common/error.h"

namespace wavetank::scene {
namespace {

std::string section_title(const std::string& path) { return path.empty() ? "a case" : path; }

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string names_of(const KeyDescription& section) {
  std::vector<std::string> names;
  for (const KeyDescription& key : section.children) names.push_back(key.name);
  return joined(names, ", ");
}

// The first key of each alternative.
std::vector<std::string> alternatives_of(const KeyDescription& section) {
  std::vector<std::string> heads;
  for (const KeyDescription& key : section.children) {
    if (key.alternative > static_cast<int>(heads.size())) heads.push_back(key.name);
  }
  return heads;
}

class StructureCheck {
 public:
  explicit StructureCheck(const KeyDescription& root_keys) : root_keys_(root_keys) {}

  void check_section(const Setting& section, const std::string& path, const KeyDescription& keys) const {
    if (section.kind != Setting::Kind::map) {
      throw Error(section.place.describe() + ": " + section_title(path) + " is " + section.brief() +
                  "; it must be a map of keys: " + names_of(keys));
    }
    for (const auto& [name, value] : section.entries) check_entry(name, value, path, keys);
    const int alternative = check_alternatives(section, path, keys);
    for (const KeyDescription& key : keys.children) {
      const bool wanted = key.required && (key.alternative == 0 || key.alternative == alternative);
      if (!wanted || section.find(key.name) != nullptr) continue;
      const std::string unit = key.unit.empty() ? "" : ", " + key.unit;
      throw Error(place_of(section, path) + ": " + join_path(path, key.name) + " is missing; it must be given (" + key.type + unit + ")");
    }
  }

 private:
  // A case as a whole is nowhere in particular.
  static std::string place_of(const Setting& section, const std::string& path) {
    return path.empty() ? Place{section.place.source, 0}.describe() : section.place.describe();
  }

  void check_entry(const std::string& name, const Setting& value, const std::string& path, const KeyDescription& keys) const {
    const std::string key_path = join_path(path, name);
    const KeyDescription* key = keys.child(name);
    if (key == nullptr) {
      throw Error(value.place.describe() + ": " + key_path + " is not a known key" + suggest_key(path, name, keys, root_keys_));
    }
    if (key->holds == Holds::section) check_section(value, key_path, *key);
    if (key->holds != Holds::list_of_sections) return;
    if (value.kind != Setting::Kind::list) {
      throw Error(value.place.describe() + ": " + key_path + " is " + value.brief() +
                  "; it must be a list, each entry a map of keys: " + names_of(*key));
    }
    for (std::size_t i = 0; i < value.items.size(); ++i) check_section(value.items[i], join_path(key_path, i), *key);
  }

  // The alternative that the section takes, 0 where its keys have none.
  int check_alternatives(const Setting& section, const std::string& path, const KeyDescription& keys) const {
    const std::vector<std::string> heads = alternatives_of(keys);
    if (heads.empty()) return 0;
    const KeyDescription* first = nullptr;
    for (const auto& [name, value] : section.entries) {
      const KeyDescription* key = keys.child(name);
      if (key->alternative == 0) continue;
      if (first == nullptr) first = key;
      if (key->alternative != first->alternative) {
        throw Error(value.place.describe() + ": " + section_title(path) + " has both " + first->name + " and " + key->name +
                    "; give exactly one of " + joined(heads, " and "));
      }
    }
    if (first == nullptr) {
      throw Error(place_of(section, path) + ": " + section_title(path) + " has neither " + joined(heads, " nor ") +
                  "; give exactly one of them");
    }
    return first->alternative;
  }

  const KeyDescription& root_keys_;
};

// Insertions, deletions, replacements and exchanges of neighbouring letters that turn one word into the other.
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::vector<std::vector<std::size_t>> distance(from.size() + 1, std::vector<std::size_t>(to.size() + 1));
  for (std::size_t i = 0; i <= from.size(); ++i) {
    for (std::size_t j = 0; j <= to.size(); ++j) {
      if (i == 0 || j == 0) {
        distance[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = distance[i - 1][j - 1] + (from[i - 1] == to[j - 1] ? 0 : 1);
      distance[i][j] = std::min({distance[i - 1][j] + 1, distance[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1]) {
        distance[i][j] = std::min(distance[i][j], distance[i - 2][j - 2] + 1);
      }
    }
  }
  return distance[from.size()][to.size()];
}

// The first key of that very name anywhere below a section, as a path with N for a list's index; empty if there is none.
std::string find_name(const KeyDescription& section, const std::string& path, const std::string& name) {
  for (const KeyDescription& key : section.children) {
    if (key.name == name) return join_path(path, name);
  }
  for (const KeyDescription& key : section.children) {
    const std::string key_path = join_path(path, key.name);
    const std::string found = find_name(key, key.holds == Holds::list_of_sections ? join_path(key_path, "N") : key_path, name);
    if (!found.empty()) return found;
  }
  return "";
}

}  // namespace

void check_structure(const Setting& root, const KeyDescription& root_keys) {
  if (root.kind != Setting::Kind::map) {
    const std::string what = root.kind == Setting::Kind::null   ? "is empty"
                             : root.kind == Setting::Kind::list ? "is a list"
                                                                : "is a single value, " + root.brief();
    throw Error(root.place.describe() + ": the case " + what + "; it must be a map of keys: " + names_of(root_keys));
  }
  StructureCheck(root_keys).check_section(root, "", root_keys);
}

std::string suggest_key(const std::string& section_path, const std::string& name, const KeyDescription& section,
                        const KeyDescription& root_keys) {
  constexpr std::size_t longest_name = 64;  // longer ones are no slip of the pen, and the search is quadratic
  if (name.size() <= longest_name) {
    const KeyDescription* nearest = nullptr;
    std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
    for (const KeyDescription& key : section.children) {
      const std::size_t distance = edit_distance(name, key.name);
      if (distance < least) {
        least = distance;
        nearest = &key;
      }
    }
    if (nearest != nullptr) return "; did you mean " + join_path(section_path, nearest->name) + "?";
    const std::string elsewhere = find_name(root_keys, "", name);
    if (!elsewhere.empty()) return "; did you mean " + elsewhere + "?";
  }
  if (section.children.empty()) return "; " + section_path + " has no keys";
  return "; the keys of " + section_title(section_path) + " are " + names_of(section);
}

}  // namespace wavetank::scene
