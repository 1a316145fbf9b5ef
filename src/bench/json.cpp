#include "json.h"

#include <cmath>
#include <cstdio>

namespace wavetank::bench {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char escaped[8];
      std::snprintf(escaped, sizeof escaped, "\\u%04x", static_cast<unsigned>(c));
      result += escaped;
    } else {
      result += c;
    }
  }
  return result + "\"";
}

/// One entry a line, deeper by two blanks.
std::string enclosed(const std::string& entries, char open, char close) {
  if (entries.empty()) return {open, close};
  std::string result = {open, '\n', ' ', ' '};
  for (const char c : entries) result += c == '\n' ? std::string("\n  ") : std::string(1, c);
  return result + "\n" + close;
}

void append(std::string& entries, const std::string& entry) { entries += (entries.empty() ? "" : ",\n") + entry; }

}  // namespace

Json::Json(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", number);
  text_ = std::isfinite(number) ? text : "null";
}

Json::Json(const std::string& text) : text_(quoted(text)) {}

Json Json::object(const std::vector<Member>& members) {
  std::string entries;
  for (const Member& member : members) append(entries, quoted(member.name) + ": " + member.value.text());
  Json result;
  result.text_ = enclosed(entries, '{', '}');
  return result;
}

Json Json::list(const std::vector<Json>& values) {
  std::string entries;
  for (const Json& value : values) append(entries, value.text());
  Json result;
  result.text_ = enclosed(entries, '[', ']');
  return result;
}

}  // namespace wavetank::bench
