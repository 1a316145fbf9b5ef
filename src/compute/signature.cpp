#include "signature.h"

#include <cctype>
#include <regex>
#include <set>

#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

std::string without_comments(const std::string& text) {
  static const std::regex comments("//[^\n]*|/\\*[^*]*\\*+(?:[^/*][^*]*\\*+)*/");
  return std::regex_replace(text, comments, " ");
}

/// What a macro without arguments stands for, from the first line that defines it; empty if none does.
std::string expansion_of(const std::string& resolved, const std::string& macro) {
  const std::string head = "#define " + macro;
  for (std::size_t at = resolved.find(head); at != std::string::npos; at = resolved.find(head, at + 1)) {
    std::size_t from = at + head.size();
    if (from < resolved.size() && !std::isspace(static_cast<unsigned char>(resolved[from]))) continue;
    std::string text;
    for (; from < resolved.size() && resolved[from] != '\n'; ++from) {
      const bool goes_on = resolved[from] == '\\' && from + 1 < resolved.size() && resolved[from + 1] == '\n';
      if (goes_on) ++from;
      text += goes_on ? ' ' : resolved[from];
    }
    return without_comments(text);
  }
  return "";
}

std::vector<std::string> split_at_commas(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '_')
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  if (words.back().empty()) words.pop_back();
  return words;
}

Parameter parameter_of(const std::string& declaration) {
  Parameter parameter;
  parameter.is_memory = declaration.find('*') != std::string::npos;
  static const std::set<std::string> qualifiers{"const", "restrict", "global", "constant", "local", "private"};
  for (const std::string& word : words_of(declaration)) {
    const std::string plain = word.rfind("__", 0) == 0 ? word.substr(2) : word;  // OpenCL has its keywords with and without
    if (plain == "const" || plain == "constant") parameter.is_const = true;
    if (qualifiers.count(plain) != 0) continue;
    parameter.type = parameter.name;  // the last word but one
    parameter.name = word;
  }
  return parameter;
}

void add_parameters(const std::string& resolved, const std::string& list, std::vector<Parameter>& parameters) {
  for (const std::string& declaration : split_at_commas(list)) {
    const std::vector<std::string> words = words_of(declaration);
    if (words.empty()) continue;
    const std::string expansion = words.size() == 1 ? expansion_of(resolved, words[0]) : "";
    if (expansion.empty())
      parameters.push_back(parameter_of(declaration));
    else
      add_parameters(resolved, expansion, parameters);
  }
}

}  // namespace

std::vector<Parameter> signature_of(const std::string& resolved, const std::string& kernel) {
  for (std::size_t at = resolved.find("kernel void "); at != std::string::npos; at = resolved.find("kernel void ", at + 1)) {
    const std::size_t open = resolved.find('(', at), close = resolved.find(')', open);
    if (open == std::string::npos || close == std::string::npos) break;
    if (words_of(resolved.substr(at, open - at)).back() != kernel) continue;
    std::vector<Parameter> parameters;
    add_parameters(resolved, without_comments(resolved.substr(open + 1, close - open - 1)), parameters);
    return parameters;
  }
  throw Error("the parameters of the kernel " + kernel + " are not found in its source");
}

}  // namespace wavetank::compute
