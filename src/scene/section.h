#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "motion_values.h"
#include "values.h"

/// A section of a case: the keys of one YAML map and the struct that they fill. Everything that happens to a key (reading, checking,
/// writing, documenting) follows from its one declaration here.
namespace wavetank::scene {

/// Access to the whole of a variant's alternative, where a member pointer would name a part of it.
struct Whole {
  template <class Value>
  Value& operator()(Value& value) const {
    return value;
  }
};

template <class T>
class Section {
 public:
  using Rule = std::function<void(const T& value, const Setting& map, const std::string& path, const Context&)>;

  /// A key that fills `member` (a member pointer of T, or Whole). The default is T's own.
  template <class Member, class Value>
  KeyDescription& key(const std::string& name, Member member, Codec<Value> codec, const std::string& unit, const std::string& description) {
    return add<Value>(
        name, [member](T& target) -> Value& { return std::invoke(member, target); },
        [member](const T& target) -> const Value* { return &std::invoke(member, target); }, codec, unit, description);
  }

  /// A key that is written only where `belongs` holds of the whole section: what a rule refuses elsewhere.
  template <class Condition, class Member, class Value>
  KeyDescription& key_where(Condition belongs, const std::string& name, Member member, Codec<Value> codec, const std::string& unit,
                            const std::string& description) {
    return add<Value>(
        name, [member](T& target) -> Value& { return std::invoke(member, target); },
        [belongs, member](const T& target) -> const Value* { return belongs(target) ? &std::invoke(member, target) : nullptr; }, codec,
        unit, description);
  }

  /// A key that fills `member` of the alternative Alternative of the variant `shape` (a member pointer of T, or Whole when T is the
  /// variant).
  template <class Alternative, class Shape, class Member, class Value>
  KeyDescription& key_of(Shape shape, const std::string& name, Member member, Codec<Value> codec, const std::string& unit,
                         const std::string& description) {
    return add<Value>(
        name,
        [shape, member](T& target) -> Value& {
          auto& variant = std::invoke(shape, target);
          if (!std::holds_alternative<Alternative>(variant)) variant = Alternative{};
          return std::invoke(member, std::get<Alternative>(variant));
        },
        [shape, member](const T& target) -> const Value* {
          const auto* alternative = std::get_if<Alternative>(&std::invoke(shape, target));
          return alternative == nullptr ? nullptr : &std::invoke(member, *alternative);
        },
        codec, unit, description);
  }

  /// The keys of exactly one of these groups may be given; a group's required keys are required if it is the one.
  void exactly_one_of(const std::vector<std::vector<std::string>>& groups) {
    for (std::size_t group = 0; group < groups.size(); ++group) {
      for (Key& key : *keys_) {
        for (const std::string& name : groups[group]) {
          if (key.description.name == name) key.description.alternative = static_cast<int>(group) + 1;
        }
      }
    }
  }

  /// For units that depend on another key of the section: `from_file` puts what was read into SI units, `to_file` does the reverse.
  void converts(std::function<void(T&)> from_file, std::function<void(T&)> to_file) {
    *conversion_ = {std::move(from_file), std::move(to_file)};
  }

  /// A further check of the section once it is read.
  void rule(Rule rule) { rules_->push_back(std::move(rule)); }

  T read(const Setting& map, const std::string& path, Context& context) const {
    T value{};
    for (const Key& key : *keys_) {
      const Setting* setting = map.find(key.description.name);
      if (setting != nullptr) key.read(value, *setting, {join_path(path, key.description.name), key.description.unit}, context);
    }
    if (conversion_->from_file) conversion_->from_file(value);
    for (const Rule& rule : *rules_) rule(value, map, path, context);
    return value;
  }

  Setting write(const T& value, const Context& context) const {
    if (!conversion_->to_file) return write_keys(value, context);
    T converted = value;
    conversion_->to_file(converted);
    return write_keys(converted, context);
  }

  std::vector<KeyDescription> descriptions() const {
    std::vector<KeyDescription> descriptions;
    for (const Key& key : *keys_) descriptions.push_back(key.description);
    return descriptions;
  }

 private:
  struct Key {
    KeyDescription description;
    std::function<void(T&, const Setting&, const Item&, Context&)> read;
    std::function<std::optional<Setting>(const T&, const Context&)> write;
  };

  struct Conversion {
    std::function<void(T&)> from_file, to_file;
  };

  Setting write_keys(const T& value, const Context& context) const {
    Setting map = Setting::map();
    int alternative = 0;  // a settled case has both a spacing and a number of particles: only the first is written
    for (const Key& key : *keys_) {
      if (alternative != 0 && key.description.alternative != 0 && key.description.alternative != alternative) continue;
      std::optional<Setting> setting = key.write(value, context);
      if (!setting) continue;
      if (key.description.alternative != 0) alternative = key.description.alternative;
      map.entries.emplace_back(key.description.name, std::move(*setting));
    }
    return map;
  }

  template <class Value, class Make, class Find>
  KeyDescription& add(const std::string& name, Make make, Find find, const Codec<Value>& codec, const std::string& unit,
                      const std::string& description) {
    Key key;
    T blank{};
    const std::optional<Setting> initial = codec.write(make(blank), Context{3});
    const std::string default_text = codec.holds == Holds::value && initial ? initial->brief() : "";
    key.description = {name, codec.type, unit, codec.allowed, default_text, description, false, 0, codec.holds, codec.children};
    key.read = [make, codec](T& target, const Setting& setting, const Item& item, Context& context) {
      make(target) = codec.read(setting, item, context);
    };
    key.write = [find, codec](const T& target, const Context& context) -> std::optional<Setting> {
      const Value* value = find(target);
      if (value == nullptr) return std::nullopt;
      return codec.write(*value, context);
    };
    keys_->push_back(std::move(key));
    return keys_->back().description;
  }

  // Shared, so that a section can be part of a codec's functions; nothing is added after that.
  std::shared_ptr<std::vector<Key>> keys_ = std::make_shared<std::vector<Key>>();
  std::shared_ptr<std::vector<Rule>> rules_ = std::make_shared<std::vector<Rule>>();
  std::shared_ptr<Conversion> conversion_ = std::make_shared<Conversion>();
};

/// A key that holds a section.
template <class T>
Codec<T> section_of(const Section<T>& section) {
  return {"section",
          "",
          [section](const Setting& setting, const Item& item, Context& context) { return section.read(setting, item.path, context); },
          [section](const T& value, const Context& context) -> std::optional<Setting> { return section.write(value, context); },
          Holds::section,
          section.descriptions()};
}

/// A key that holds a list of sections.
template <class T>
Codec<std::vector<T>> list_of(const Section<T>& section) {
  return {"list",
          "",
          [section](const Setting& setting, const Item& item, Context& context) {
            std::vector<T> values;
            for (std::size_t i = 0; i < setting.items.size(); ++i) {
              values.push_back(section.read(setting.items[i], join_path(item.path, i), context));
            }
            return values;
          },
          [section](const std::vector<T>& values, const Context& context) -> std::optional<Setting> {
            std::vector<Setting> items;
            for (const T& value : values) items.push_back(section.write(value, context));
            return Setting::list(std::move(items));
          },
          Holds::list_of_sections,
          section.descriptions()};
}

/// A section that may be left out as a whole.
template <class T>
Codec<std::optional<T>> section_if_given(const Section<T>& section) {
  Codec<std::optional<T>> codec = if_given(section_of(section));
  codec.holds = Holds::section;
  codec.children = section.descriptions();
  return codec;
}

}  // namespace wavetank::scene
