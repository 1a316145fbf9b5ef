#include "setting.h"

#include <algorithm>
#include <sstream>

namespace wavetank::scene {
namespace {

constexpr std::size_t brief_length = 60;

bool is_word(const std::string& text) {
  static const char* const reserved[] = {"true", "false", "yes", "no", "on", "off", "y", "n", "null"};
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return c < 128 ? std::tolower(c) : c; });
  if (lower.empty() || std::find(std::begin(reserved), std::end(reserved), lower) != std::end(reserved)) return false;
  if (lower.front() < 'a' || lower.front() > 'z') return false;
  return std::all_of(lower.begin(), lower.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

std::string quote(const std::string& text) {
  static const char* const digits = "0123456789ABCDEF";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string scalar_text(const Setting& setting) { return setting.is_string && !is_word(setting.text) ? quote(setting.text) : setting.text; }

std::string flow_text(const Setting& setting) {
  std::string text;
  switch (setting.kind) {
    case Setting::Kind::null:
      return "null";
    case Setting::Kind::scalar:
      return scalar_text(setting);
    case Setting::Kind::list:
      for (const Setting& item : setting.items) text += (text.empty() ? "" : ", ") + flow_text(item);
      return "[" + text + "]";
    case Setting::Kind::map:
      for (const auto& [name, value] : setting.entries) text += (text.empty() ? "" : ", ") + name + ": " + flow_text(value);
      return "{" + text + "}";
  }
  return text;
}

bool has_maps(const Setting& list) {
  return std::any_of(list.items.begin(), list.items.end(), [](const Setting& item) { return item.kind == Setting::Kind::map; });
}

// Writes the entries of a map; `first` is what precedes the first key in place of the indentation ("  - " for an item of a list).
void write_map(std::ostream& out, const Setting& map, std::size_t indentation, std::string first) {
  const std::string margin(indentation, ' ');
  for (const auto& [name, value] : map.entries) {
    out << first << name << ':';
    first = margin;
    if (value.kind == Setting::Kind::map && !value.entries.empty()) {
      out << '\n';
      write_map(out, value, indentation + 2, margin + "  ");
    } else if (value.kind == Setting::Kind::list && has_maps(value)) {
      out << '\n';
      for (const Setting& item : value.items) write_map(out, item, indentation + 4, margin + "  - ");
    } else {
      out << ' ' << flow_text(value) << '\n';
    }
  }
}

}  // namespace

std::string Place::describe() const {
  if (!source) return "case";
  return line > 0 ? *source + ":" + std::to_string(line) : *source;
}

Setting Setting::scalar(std::string text) {
  Setting setting;
  setting.kind = Kind::scalar;
  setting.text = std::move(text);
  return setting;
}

Setting Setting::string(std::string text) {
  Setting setting = scalar(std::move(text));
  setting.is_string = true;
  return setting;
}

Setting Setting::list(std::vector<Setting> items) {
  Setting setting;
  setting.kind = Kind::list;
  setting.items = std::move(items);
  return setting;
}

Setting Setting::map() {
  Setting setting;
  setting.kind = Kind::map;
  return setting;
}

const Setting* Setting::find(const std::string& name) const {
  const auto entry = std::find_if(entries.begin(), entries.end(), [&](const Entry& candidate) { return candidate.first == name; });
  return entry == entries.end() ? nullptr : &entry->second;
}

Setting* Setting::find(const std::string& name) { return const_cast<Setting*>(static_cast<const Setting*>(this)->find(name)); }

std::string Setting::brief() const {
  if (kind == Kind::null) return "empty";
  std::string brief = kind == Kind::scalar ? (text.empty() ? "\"\"" : text) : flow_text(*this);
  std::replace(brief.begin(), brief.end(), '\n', ' ');
  if (brief.size() <= brief_length) return brief;
  std::size_t end = brief_length;
  while (end > 0 && (static_cast<unsigned char>(brief[end]) & 0xc0) == 0x80) --end;  // not within a UTF-8 character
  return brief.substr(0, end) + "…";
}

const Setting& nearest_setting(const Setting& root, const std::string& path) {
  const Setting* setting = &root;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '/');) {
    const Setting* next = nullptr;
    if (setting->kind == Setting::Kind::map) {
      next = setting->find(part);
    } else if (setting->kind == Setting::Kind::list && part.find_first_not_of("0123456789") == std::string::npos && part.size() < 10) {
      const std::size_t index = std::stoul(part);
      if (index < setting->items.size()) next = &setting->items[index];
    }
    if (next == nullptr) break;
    setting = next;
  }
  return *setting;
}

std::string join_path(const std::string& path, const std::string& name) { return path.empty() ? name : path + "/" + name; }

std::string join_path(const std::string& path, std::size_t index) { return join_path(path, std::to_string(index)); }

std::string write_settings(const Setting& map) {
  std::ostringstream out;
  write_map(out, map, 0, "");
  return out.str();
}

}  // namespace wavetank::scene
