#include "source.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>
#include <unordered_set>

#include "wavetank/common/error.h"

namespace wavetank::compute {
namespace {

constexpr std::size_t errors_shown = 3;
constexpr int unreadable_log_lines = 20;

std::string names_of(const SourceFiles& files) {
  std::string names;
  for (const auto& file : files) names += (names.empty() ? "" : ", ") + file.first;
  return names.empty() ? "none" : names;
}

/// What follows '#' and blanks at the start of a line; empty for a line that is no directive.
std::string directive(const std::string& line) {
  const auto hash = line.find_first_not_of(" \t");
  if (hash == std::string::npos || line[hash] != '#') return "";
  const auto word = line.find_first_not_of(" \t", hash + 1);
  return word == std::string::npos ? "" : line.substr(word);
}

bool starts_with(const std::string& text, const char* start) { return text.rfind(start, 0) == 0; }

/// The NAME of `include "NAME"`; empty if the directive is another.
std::string included_name(const std::string& directive) {
  if (!starts_with(directive, "include")) return "";
  const auto open = directive.find_first_not_of(" \t", std::string("include").size());
  if (open == std::string::npos || directive[open] != '"') return "";
  const auto close = directive.find('"', open + 1);
  return close == std::string::npos ? "" : directive.substr(open + 1, close - open - 1);
}

/// Writes one program text out of many files.
class Resolver {
 public:
  explicit Resolver(const SourceFiles& files) : files_(files) {}

  void add(const std::string& name, const std::string& text, bool conditional) {
    open_.insert(name);
    if (!conditional) written_.insert(name);
    out_ << "#line 1 \"" << name << "\"\n";
    std::istringstream lines(text);
    std::string line;
    int conditions = conditional ? 1 : 0;  // how many #if's surround this line
    for (int number = 1; std::getline(lines, line); ++number) {
      const std::string command = directive(line);
      if (starts_with(command, "if")) ++conditions;
      if (starts_with(command, "endif")) --conditions;
      const std::string included = included_name(command);
      if (included.empty()) {
        out_ << line << '\n';
      } else {
        include(included, name, number, conditions > 0);
        out_ << "#line " << number + 1 << " \"" << name << "\"\n";
      }
    }
    open_.erase(name);
  }

  std::string text() const { return out_.str(); }

 private:
  void include(const std::string& name, const std::string& from, int line, bool conditional) {
    const auto file = files_.find(name);
    if (file == files_.end())
      throw Error(from + ":" + std::to_string(line) + ": #include \"" + name + "\" names no kernel source; there are: " + names_of(files_));
    if (open_.count(name) != 0 || written_.count(name) != 0) return;
    // An include under a condition may turn out not to be taken, so whether the file has been read is left to the preprocessor.
    const std::string guard = guard_of(name);
    out_ << "#ifndef " << guard << "\n#define " << guard << '\n';
    add(name, file->second, conditional);
    out_ << "#endif\n";
  }

  static std::string guard_of(const std::string& name) {
    std::string guard = "WAVETANK_INCLUDED_";
    for (const char c : name) guard += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
    return guard;
  }

  const SourceFiles& files_;
  std::ostringstream out_;
  std::set<std::string> open_;     ///< being written, from the main file down to the present one
  std::set<std::string> written_;  ///< written where no condition can have left them out
};

std::string source_line(const SourceFiles& files, const std::string& file, int number) {
  const auto source = files.find(file);
  if (source == files.end()) return "";
  std::istringstream lines(source->second);
  std::string line;
  for (int i = 0; i < number; ++i)
    if (!std::getline(lines, line)) return "";
  const auto first = line.find_first_not_of(" \t");
  return first == std::string::npos ? "" : line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
}

/// Of a path that the compiler names, the file that it ends with.
std::string file_of(const SourceFiles& files, const std::string& path) {
  std::string rest = path;
  while (files.count(rest) == 0) {
    const auto slash = rest.find('/');
    if (slash == std::string::npos) break;
    rest.erase(0, slash + 1);
  }
  return rest;
}

/// Turns a line number of the resolved text into a file and its line, by the #line directives before it.
void place_in_files(const std::string& resolved, CompilerError& error) {
  std::istringstream lines(resolved);
  std::string line, file;
  int line_in_file = 0;
  for (int number = 1; number <= error.line && std::getline(lines, line); ++number) {
    ++line_in_file;
    const std::string command = directive(line);
    const auto quote = command.find('"');
    if (!starts_with(command, "line ") || quote == std::string::npos) continue;
    file = command.substr(quote + 1, command.rfind('"') - quote - 1);
    line_in_file = std::atoi(command.c_str() + std::string("line ").size()) - 1;
  }
  error.file = file;
  error.line = line_in_file;
}

using Names = std::unordered_set<std::string_view>;

bool is_part_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

void add_names(std::string_view text, Names& names) {
  for (auto from = std::find_if(text.begin(), text.end(), is_part_of_name); from != text.end();) {
    const auto to = std::find_if_not(from, text.end(), is_part_of_name);
    names.insert(text.substr(from - text.begin(), to - from));
    from = std::find_if(to, text.end(), is_part_of_name);
  }
}

std::string_view without_comment(std::string_view line) { return line.substr(0, line.find("//")); }

/// The NAME of "#define NAME..."; empty for another line.
std::string_view defined_name(std::string_view line) {
  constexpr std::string_view head = "#define ";
  if (line.substr(0, head.size()) != head) return {};
  line.remove_prefix(head.size());
  return line.substr(0, std::find_if_not(line.begin(), line.end(), is_part_of_name) - line.begin());
}

/// A line of the text, and whether it is of a file that holds nothing but definitions, each of one line.
struct Line {
  std::string_view text;
  bool of_table = false;
};

/// What follows a #line directive up to the next, and an #endif of the file that included it.
bool is_table(std::vector<Line>::const_iterator from, std::vector<Line>::const_iterator to) {
  const auto fits = [](const Line& line) {
    return line.text == "#endif" || (!defined_name(line.text).empty() && line.text.back() != '\\');
  };
  return from != to && std::all_of(from, to, fits);
}

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    lines.push_back({text.substr(from, to - from)});
    from = to + 1;
  }
  for (auto from = lines.begin(); from != lines.end();) {
    const auto next = std::find_if(from, lines.end(), [](const Line& line) { return line.text.substr(0, 6) == "#line "; });
    if (is_table(from, next))
      for (; from != next; ++from) from->of_table = true;
    from = next == lines.end() ? next : next + 1;
  }
  return lines;
}

std::string first_lines(const std::string& text, int count) {
  std::istringstream lines(text);
  std::string line, first;
  while (count-- > 0 && std::getline(lines, line)) first += line + '\n';
  while (!first.empty() && std::isspace(static_cast<unsigned char>(first.back()))) first.pop_back();
  return first;
}

}  // namespace

std::string resolve_includes(const SourceFiles& files, const std::string& main) {
  const auto file = files.find(main);
  if (file == files.end()) throw Error("there is no kernel source called \"" + main + "\"; there are: " + names_of(files));
  Resolver resolver(files);
  resolver.add(main, file->second, false);
  return resolver.text();
}

std::string definitions_that_matter(const std::string& resolved) {
  const std::vector<Line> lines = lines_of(resolved);
  Names names;
  for (const Line& line : lines) {
    std::string_view text = without_comment(line.text);
    if (line.of_table && !defined_name(text).empty()) {
      const std::string_view name = defined_name(text);
      text.remove_prefix(name.data() + name.size() - text.data());
    }
    add_names(text, names);
  }
  std::vector<std::string_view> beginnings;  // which ## makes names with
  for (const std::string_view name : names)
    if (name.back() == '_') beginnings.push_back(name);
  const auto matters = [&](std::string_view name) {
    return names.count(name) != 0 || std::any_of(beginnings.begin(), beginnings.end(), [name](std::string_view beginning) {
             return name.substr(0, beginning.size()) == beginning;
           });
  };
  std::string text;
  text.reserve(resolved.size());
  for (const Line& line : lines) {
    const std::string_view name = line.of_table ? defined_name(line.text) : std::string_view();
    if (!name.empty() && !matters(name)) continue;
    text += name.empty() ? line.text : without_comment(line.text);
    text += '\n';
  }
  return text;
}

std::string options_that_matter(const std::string& options, const std::string& resolved) {
  if (options.find_first_of("\"'\\") != std::string::npos) return options;  // a value with blanks in it
  Names names;
  for (const Line& line : lines_of(resolved)) add_names(without_comment(line.text), names);
  std::istringstream words(options);
  std::string word, kept;
  while (words >> word) {
    const bool defines = starts_with(word, "-D") && word.size() > 2;
    if (defines && names.count(std::string_view(word).substr(2, word.find('=') - 2)) == 0) continue;
    kept += (kept.empty() ? "" : " ") + word;
  }
  return kept;
}

std::vector<CompilerError> compiler_errors(const std::string& log, const SourceFiles& files, const std::string& resolved) {
  // FILE:LINE:COLUMN: error: MESSAGE (clang and what grew from it), "FILE", line LINE: error: MESSAGE, and pocl's error: FILE:LINE:COLUMN:
  // MESSAGE
  static const std::regex place_first("^\"?([^:\"]+)\"?(?::|, line )([0-9]+)(?::[0-9]+)?: *(?:fatal |catastrophic )?error: *(.*)$");
  static const std::regex place_last("^(?:fatal )?error: ([^:\"]+):([0-9]+)(?::[0-9]+)?: *(.*)$");
  std::vector<CompilerError> errors;
  std::istringstream lines(log);
  std::string line;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (line.size() > 2000 || !(std::regex_match(line, match, place_first) || std::regex_match(line, match, place_last))) continue;
    CompilerError error;
    error.message = match[3];
    error.file = file_of(files, match[1]);
    error.line = std::stoi(match[2].str().substr(0, 9));
    if (files.count(error.file) == 0) place_in_files(resolved, error);
    errors.push_back(error);
  }
  return errors;
}

std::string explain_build_log(const std::string& log, const SourceFiles& files, const std::string& resolved) {
  const auto errors = compiler_errors(log, files, resolved);
  if (errors.empty()) {
    const std::string text = first_lines(log, unreadable_log_lines);
    return text.empty() ? "the compiler says nothing about why" : text;
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(errors.size(), errors_shown); ++i) {
    const CompilerError& error = errors[i];
    if (i > 0) text += '\n';
    if (!error.file.empty()) text += error.file + ":" + std::to_string(error.line) + ": ";
    text += error.message;
    const std::string quoted = source_line(files, error.file, error.line);
    if (!quoted.empty()) text += "\n    " + quoted;
  }
  if (errors.size() > errors_shown) text += "\n(and " + std::to_string(errors.size() - errors_shown) + " more)";
  return text;
}

}  // namespace wavetank::compute
