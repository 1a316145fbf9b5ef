#pragma once

#include <cstddef>
#include <string>

namespace wavetank {

/// A name of the user's in a message: control characters, which a terminal would obey, are written as \x1b, \n and so on, what is no UTF-8
/// likewise, and what is longer than `longest` bytes is cut off with "…".
std::string visible_text(const std::string& text, std::size_t longest = 200);

/// The same of whole lines: line feeds and tabs stay.
std::string visible_lines(const std::string& text, std::size_t longest = 8000);

}  // namespace wavetank
