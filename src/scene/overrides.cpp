#include <algorithm>
#include <sstream>

#include "structure.h"
#include "wavetank/common/error.h"
#include "wavetank/common/visible_text.h"

namespace wavetank::scene {
namespace {

void place_all(Setting& setting, const Place& place) {
  setting.place = place;
  for (Setting& item : setting.items) place_all(item, place);
  for (auto& entry : setting.entries) place_all(entry.second, place);
}

// Walks down the tree along an override's key, making what is missing on the way.
class OverrideWalk {
 public:
  OverrideWalk(Setting& root, const KeyDescription& root_keys, const std::string& label)
      : root_keys_(root_keys), label_(label), setting_(&root), keys_(&root_keys), in_section_(true) {
    place_.source = std::make_shared<const std::string>(label);
  }

  void enter(const std::string& part) {
    if (in_section_) {
      enter_key(part);
    } else {
      enter_index(part);
    }
    path_ = join_path(path_, part);
  }

  Setting& setting() { return *setting_; }
  const Place& place() const { return place_; }

 private:
  void enter_key(const std::string& name) {
    const KeyDescription* key = keys_->child(name);
    if (key == nullptr) {
      throw Error(label_ + ": " + join_path(path_, visible_text(name, 64)) + " is not a known key" +
                  suggest_key(path_, name, *keys_, root_keys_));
    }
    become(Setting::Kind::map, "a map of keys");
    if (key->alternative != 0) {
      auto& entries = setting_->entries;
      entries.erase(
          std::remove_if(entries.begin(), entries.end(), [&](const Setting::Entry& entry) { return excludes(*key, entry.first); }),
          entries.end());
    }
    if (setting_->find(name) == nullptr) {
      setting_->entries.emplace_back(name, Setting{});
      setting_->entries.back().second.place = place_;
    }
    setting_ = setting_->find(name);
    keys_ = key;
    in_section_ = key->holds == Holds::section;
  }

  bool excludes(const KeyDescription& key, const std::string& other) const {
    const KeyDescription* other_key = keys_->child(other);
    return other_key != nullptr && other_key->alternative != 0 && other_key->alternative != key.alternative;
  }

  // Into a list: of sections, where the index after the last adds one, or of a vector's numbers.
  void enter_index(const std::string& part) {
    const bool of_sections = keys_->holds == Holds::list_of_sections;
    if (!of_sections && setting_->kind != Setting::Kind::list) {
      throw Error(label_ + ": " + path_ + " is a single value and has no keys, so " + join_path(path_, visible_text(part, 64)) +
                  " is not a known key");
    }
    become(Setting::Kind::list, "a list");
    const std::size_t count = setting_->items.size(), end = of_sections ? count + 1 : count;
    const bool digits = !part.empty() && part.size() < 8 && part.find_first_not_of("0123456789") == std::string::npos;
    if (!digits || std::stoul(part) >= end) {
      throw Error(label_ + ": " + path_ + " has " + std::to_string(count) + (count == 1 ? " entry" : " entries") +
                  "; its index must be from 0 to " + std::to_string(end - 1) + (of_sections ? " (the last adds one)" : "") + ", not " +
                  visible_text(part, 64));
    }
    const std::size_t index = std::stoul(part);
    if (index == count) {
      setting_->items.emplace_back();
      setting_->items.back().place = place_;
    }
    setting_ = &setting_->items[index];
    in_section_ = of_sections;
  }

  void become(Setting::Kind kind, const std::string& what) {
    if (setting_->kind == Setting::Kind::null) setting_->kind = kind;
    if (setting_->kind == kind) return;
    throw Error(label_ + ": " + (path_.empty() ? "the case" : path_) + " is " + setting_->brief() + " (" + setting_->place.describe() +
                "), which is not " + what);
  }

  const KeyDescription& root_keys_;
  std::string label_;
  Place place_;
  Setting* setting_;
  const KeyDescription* keys_;
  bool in_section_;  ///< setting_ is a map of keys_'s children; else a list or a value
  std::string path_;
};

}  // namespace

void apply_override(Setting& root, const KeyDescription& root_keys, const Override& override) {
  const std::string label = override.given_as + visible_text(override.key, 100);
  if (override.key.empty()) throw Error("--set: the key is empty; give KEY=VALUE, as in fluid/spacing=0.02");
  Setting value = parse_settings(override.value, label);
  OverrideWalk walk(root, root_keys, label);
  std::string part;
  std::istringstream parts(override.key);
  while (std::getline(parts, part, '/')) walk.enter(part);
  if (override.key.back() == '/') walk.enter("");
  walk.setting() = std::move(value);
  place_all(walk.setting(), walk.place());
}

}  // namespace wavetank::scene
