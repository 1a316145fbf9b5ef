#pragma once

#include <map>
#include <string>

#include "wavetank/common/error.h"
#include "wavetank/scene/methods.h"

namespace wavetank::validation {

/// NAME=VALUE arguments of a program, by their names.
using Words = std::map<std::string, std::string>;

inline Words words_of(int count, char** arguments) {
  Words words;
  for (int k = 0; k < count; ++k) {
    const std::string word = arguments[k];
    const std::size_t sign = word.find('=');
    if (sign == std::string::npos) throw Error(word + " is no WORD=VALUE");
    words[word.substr(0, sign)] = word.substr(sign + 1);
  }
  return words;
}

inline double number(const Words& words, const std::string& name, double otherwise) {
  const auto found = words.find(name);
  return found == words.end() ? otherwise : std::stod(found->second);
}

/// Leaves `value` as it is where it is not given. Throws Error for what is no word of that choice.
template <class Choice>
void choose(const Words& words, const std::string& name, Choice& value) {
  const auto found = words.find(name);
  if (found == words.end()) return;
  for (const MethodWord<Choice>& known : method_words<Choice>())
    if (found->second == known.word) {
      value = known.choice;
      return;
    }
  throw Error(name + " is " + found->second + ", which is no word of that key");
}

}  // namespace wavetank::validation
