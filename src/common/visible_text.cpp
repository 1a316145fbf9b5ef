#include "wavetank/common/visible_text.h"

namespace wavetank {
namespace {

constexpr char hexadecimal[] = "0123456789abcdef";

std::string escaped(unsigned char byte) {
  if (byte == '\n') return "\\n";
  if (byte == '\t') return "\\t";
  if (byte == '\r') return "\\r";
  return {'\\', 'x', hexadecimal[byte >> 4], hexadecimal[byte & 15]};
}

/// Of the UTF-8 character that begins there; 0 where none does.
std::size_t utf8_length(const std::string& text, std::size_t at) {
  const auto byte = static_cast<unsigned char>(text[at]);
  const std::size_t length = byte < 0x80                   ? 1
                             : byte >= 0xc2 && byte < 0xe0 ? 2
                             : (byte & 0xf0) == 0xe0       ? 3
                             : byte >= 0xf0 && byte < 0xf5 ? 4
                                                           : 0;
  if (length == 0 || at + length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((static_cast<unsigned char>(text[at + k]) & 0xc0) != 0x80) return 0;
  if (length >= 3) {  // neither written longer than it must be, nor half of a pair of UTF-16, nor beyond the last character
    const auto second = static_cast<unsigned char>(text[at + 1]);
    if ((byte == 0xe0 && second < 0xa0) || (byte == 0xed && second >= 0xa0) || (byte == 0xf0 && second < 0x90) ||
        (byte == 0xf4 && second >= 0x90))
      return 0;
  }
  return length;
}

/// Control characters, and those that turn the direction of what follows.
bool is_obeyed(const std::string& text, std::size_t at, std::size_t length) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[at + k]); };
  if (length == 1) return byte(0) < 0x20 || byte(0) == 0x7f;
  if (length == 2) return byte(0) == 0xc2 && byte(1) < 0xa0;
  if (length != 3 || byte(0) != 0xe2) return false;
  const bool turns = byte(1) == 0x80 && (byte(2) == 0x8e || byte(2) == 0x8f || (byte(2) >= 0xa8 && byte(2) <= 0xae));
  return turns || (byte(1) == 0x81 && byte(2) >= 0xa6 && byte(2) <= 0xa9);
}

std::string visible(const std::string& text, std::size_t longest, bool lines) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at), taken = length == 0 ? 1 : length;
    std::string next = text.substr(at, taken);
    const bool stays = lines && (next == "\n" || next == "\t");
    if (!stays && (length == 0 || is_obeyed(text, at, length))) {
      next.clear();
      for (std::size_t k = 0; k < taken; ++k) next += escaped(static_cast<unsigned char>(text[at + k]));
    }
    if (result.size() + next.size() > longest) return result + "…";
    result += next;
    at += taken;
  }
  return result;
}

}  // namespace

std::string visible_text(const std::string& text, std::size_t longest) { return visible(text, longest, false); }

std::string visible_lines(const std::string& text, std::size_t longest) { return visible(text, longest, true); }

}  // namespace wavetank
