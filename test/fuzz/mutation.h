#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

/// Damages sound inputs, the same way for the same seed.
namespace wavetank::fuzz {

/// Numbers that programs trip over, as texts.
inline const std::vector<std::string>& awkward_numbers() {
  static const std::vector<std::string> numbers{"0",
                                                "-0",
                                                "1",
                                                "-1",
                                                "0.0",
                                                "1e-300",
                                                "1e300",
                                                "-1e308",
                                                "1e39",
                                                "1e-39",
                                                "1e15",
                                                "1e-15",
                                                "2147483647",
                                                "-2147483648",
                                                "4294967295",
                                                "4294967296",
                                                "9223372036854775807",
                                                "1e9",
                                                ".nan",
                                                ".inf",
                                                "-.inf",
                                                "nan",
                                                "inf",
                                                "0x10",
                                                "1e",
                                                "--1",
                                                "1,5",
                                                "1.5.2",
                                                "1e999",
                                                "1 m",
                                                "",
                                                "null",
                                                "[]",
                                                "{}",
                                                "[1, 2]",
                                                "true",
                                                "1e-6",
                                                "1e6",
                                                "0.3333",
                                                "1000000",
                                                "٣"};
  return numbers;
}

class Mutation {
 public:
  /// `damages`: else what it is given stays as it is.
  explicit Mutation(std::uint64_t seed, bool damages = true) : random_(seed), damages_(damages) {}
  bool damages() const { return damages_; }

  /// From 0 to below `count`; 0 if that is 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : static_cast<std::size_t>(random_() % count); }
  template <class Value>
  const Value& one_of(const std::vector<Value>& values) {
    return values[below(values.size())];
  }
  template <class Value>
  Value& one_of(std::vector<Value>& values) {
    return values[below(values.size())];
  }
  bool chance(int percent) { return below(100) < static_cast<std::size_t>(percent); }

  /// Of any size that a case may have, now and then with its sign changed.
  std::string plausible_number() {
    char text[40];
    std::snprintf(text, sizeof text, "%s%zu.%02zue%d", chance(10) ? "-" : "", below(10), below(100), static_cast<int>(below(6)) - 3);
    return text;
  }

  /// A text with one to four places damaged: numbers, words, lines and bytes.
  std::string text(std::string whole) {
    if (!damages_) return whole;
    for (std::size_t k = 1 + below(4); k > 0 && !whole.empty(); --k) {
      switch (below(9)) {
        case 0:
        case 1:
        case 2:
          replace_word(whole, true);
          break;
        case 3:
          replace_word(whole, false);
          break;
        case 4:
          move_line(whole);
          break;
        case 5:
          whole.erase(below(whole.size()), 1 + below(chance(80) ? 12 : whole.size()));
          break;
        case 6:
          whole.insert(below(whole.size()), whole.substr(below(whole.size()), 1 + below(200)));
          break;
        case 7:
          whole.insert(below(whole.size()), one_of(awkward_texts()));
          break;
        default:
          whole[below(whole.size())] = static_cast<char>(below(256));
      }
    }
    return whole;
  }

  /// A text with one or two numbers, of whole words, replaced.
  std::string numbers(std::string whole) {
    if (!damages_) return whole;
    for (std::size_t k = 1 + below(2); k > 0; --k) {
      for (int attempt = 0; attempt < 200; ++attempt) {
        std::size_t begin = below(whole.size());
        if (std::string(" [,").find(whole[begin]) == std::string::npos) continue;
        const std::size_t end = std::min(whole.find_first_not_of("-+.0123456789e", ++begin), whole.size());
        if (end == begin || whole.find_first_of("0123456789", begin) >= end) continue;
        whole.replace(begin, end - begin, chance(30) ? one_of(awkward_numbers()) : plausible_number());
        break;
      }
    }
    return whole;
  }

  /// Bytes with one to six places damaged.
  std::string bytes(std::string whole) {
    if (!damages_) return whole;
    for (std::size_t k = 1 + below(6); k > 0 && !whole.empty(); --k) {
      const std::size_t at = below(chance(30) ? std::min<std::size_t>(whole.size(), 300) : whole.size());
      switch (below(6)) {
        case 0:
          whole[at] = static_cast<char>(whole[at] ^ 1 << below(8));
          break;
        case 1:
          whole[at] = static_cast<char>(below(256));
          break;
        case 2:
          for (std::size_t b = at; b < std::min(at + 4, whole.size()); ++b) whole[b] = static_cast<char>(chance(50) ? 0xff : 0x7f);
          break;
        case 3:
          whole.resize(chance(30) ? at : whole.size());
          break;
        case 4:
          whole.erase(at, 1 + below(16));
          break;
        default:
          whole.insert(at, whole.substr(below(whole.size()), 1 + below(64)));
      }
    }
    return whole;
  }

 private:
  static const std::vector<std::string>& awkward_texts() {
    static const std::vector<std::string> texts{"\x1b[2J",
                                                std::string(5000, 'x'),
                                                "\n\n",
                                                "\t",
                                                "{",
                                                "}",
                                                "[",
                                                "]",
                                                ": ",
                                                "&a *a",
                                                "\"",
                                                "'",
                                                "#",
                                                "<",
                                                ">",
                                                "/>",
                                                "\xff\xfe",
                                                std::string(300, '['),
                                                std::string(300, '('),
                                                "../../../etc/passwd",
                                                "%s%n",
                                                "é",
                                                "\xe2\x80\xae"};
    return texts;
  }

  static bool is_of_word(char c) { return std::string(" \t\r\n,:[]{}<>\"'").find(c) == std::string::npos; }

  /// By a number, or by another word of the text.
  void replace_word(std::string& whole, bool numbers) {
    for (int attempt = 0; attempt < 50; ++attempt) {
      std::size_t begin = below(whole.size());
      if (!is_of_word(whole[begin])) continue;
      while (begin > 0 && is_of_word(whole[begin - 1])) --begin;
      std::size_t end = begin;
      while (end < whole.size() && is_of_word(whole[end])) ++end;
      const bool is_number = std::string("-+.0123456789").find(whole[begin]) != std::string::npos;
      if (numbers && !is_number && attempt < 40) continue;
      std::string other = one_of(awkward_numbers());
      if (!numbers) {
        std::size_t from = below(whole.size());
        while (from > 0 && is_of_word(whole[from - 1])) --from;
        std::size_t to = from;
        while (to < whole.size() && is_of_word(whole[to])) ++to;
        other = whole.substr(from, to - from);
      }
      whole.replace(begin, end - begin, other);
      return;
    }
  }

  void move_line(std::string& whole) {
    const std::size_t begin = whole.rfind('\n', below(whole.size())) + 1, end = std::min(whole.find('\n', begin), whole.size() - 1) + 1;
    if (begin >= whole.size()) return;
    const std::string line = whole.substr(begin, end - begin);
    if (chance(50)) whole.erase(begin, end - begin);
    const std::size_t place = whole.empty() ? 0 : whole.rfind('\n', below(whole.size())) + 1;
    whole.insert(std::min(place, whole.size()), line);
  }

  std::mt19937_64 random_;
  bool damages_;
};

}  // namespace wavetank::fuzz
