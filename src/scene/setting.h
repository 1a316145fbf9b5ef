#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

/// The tree of settings between YAML text and the case's structs: every value remembers where it was given.
namespace wavetank::scene {

/// Where a setting was given: a line of a file, or an override.
struct Place {
  std::shared_ptr<const std::string> source;  ///< file, parameter namespace or override ("--set KEY")
  int line = 0;                               ///< from 1; 0 = the source has no lines
  std::string describe() const;               ///< "file:12" or "--set KEY"
};

struct Setting {
  enum class Kind { null, scalar, list, map };
  using Entry = std::pair<std::string, Setting>;

  Kind kind = Kind::null;
  std::string text;            ///< of a scalar
  bool is_string = false;      ///< of a scalar: to be written so that it reads back as a string
  std::vector<Setting> items;  ///< of a list
  std::vector<Entry> entries;  ///< of a map, in the file's order
  Place place;                 ///< of an entry in a map: its key's

  static Setting scalar(std::string text);
  static Setting string(std::string text);
  static Setting list(std::vector<Setting> items);
  static Setting map();

  const Setting* find(const std::string& name) const;  ///< of a map; null when there is no such entry
  Setting* find(const std::string& name);
  std::string brief() const;  ///< the value in one short line, for messages
};

/// The setting at a path below `root`, or the deepest one on the way there that exists: where a message about that path should point.
const Setting& nearest_setting(const Setting& root, const std::string& path);

/// `path/name`, or `name` at the root.
std::string join_path(const std::string& path, const std::string& name);
std::string join_path(const std::string& path, std::size_t index);

/// Reads YAML text of one document. Throws Error, beginning with the source and line, for bytes that are no text, bad YAML, a key given
/// twice in one map, a key that is no word, or nesting without end. Text of a single line has no line numbers worth printing, so it gets
/// none.
Setting parse_settings(const std::string& yaml, const std::string& source);

/// YAML in block style that parse_settings reads back to the same tree.
std::string write_settings(const Setting& map);

}  // namespace wavetank::scene
