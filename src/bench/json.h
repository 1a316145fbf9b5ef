#pragma once

#include <string>
#include <vector>

namespace wavetank::bench {

/// A JSON value as text, made of others.
class Json {
 public:
  Json(double number);  ///< null unless finite
  Json(bool truth) : text_(truth ? "true" : "false") {}
  Json(const std::string& text);
  Json(const char* text) : Json(std::string(text)) {}

  struct Member;
  static Json object(const std::vector<Member>& members);
  static Json list(const std::vector<Json>& values);

  const std::string& text() const { return text_; }

 private:
  Json() = default;

  std::string text_;
};

struct Json::Member {
  std::string name;
  Json value;
};

}  // namespace wavetank::bench
