#include <sstream>

#include "case_keys.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank {
namespace {

using scene::Holds;
using scene::KeyDescription;

const char* const introduction = R"(# The case file

A case is one YAML file, given to `wavetank_run` or to the launch files, or the same keys as private parameters of the node. Any key can also be
set on the command line, as in `--set fluid/spacing=0.02`; entries of a list are counted from 0 (`--set instruments/pressure_probes/0/position=[1,0.5,0]`),
and the number after the last adds one. Setting a key of one alternative (`fluid/particles`) removes those of the others (`fluid/spacing`).

All values are in SI units but angles, which are in degrees; z points up unless `gravity` says otherwise. Keys that are not listed here, wrong types and values
out of range are refused. A default stands for a key that is left out; the others are required, where alternatives are marked (a), (b): with the one that is
given. N is the index of an entry in a list.

This page is generated from the keys that the program declares; a test compares the two.
)";

std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string default_column(const KeyDescription& key) {
  if (key.required) return key.alternative == 0 ? "required" : std::string("required (") + char('a' + key.alternative - 1) + ")";
  const std::string mark = key.alternative == 0 ? "" : std::string(" (") + char('a' + key.alternative - 1) + ")";
  if (key.holds == Holds::list_of_sections) return "none" + mark;
  return (key.default_text.empty() ? "" : "`" + key.default_text + "`") + mark;
}

void write_row(std::ostream& out, const std::string& path, const KeyDescription& key) {
  out << "| `" << path << "` | " << key.type << " | " << key.unit << " | " << escape(key.allowed) << " | " << default_column(key) << " | "
      << escape(key.description) << " |\n";
}

void write_rows(std::ostream& out, const std::string& path, const KeyDescription& key) {
  write_row(out, path, key);
  const std::string children_path = key.holds == Holds::list_of_sections ? path + "/N" : path;
  for (const KeyDescription& child : key.children) write_rows(out, children_path + "/" + child.name, child);
}

void write_heading(std::ostream& out, const std::string& title) {
  out << "\n## " << title << "\n\n| key | type | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n";
}

}  // namespace

std::string describe_case_keys() {
  std::ostringstream out;
  out << introduction;
  write_heading(out, "The case as a whole");
  for (const KeyDescription& key : scene::case_keys().children) {
    if (key.holds == Holds::value) write_row(out, key.name, key);
  }
  for (const KeyDescription& key : scene::case_keys().children) {
    if (key.holds == Holds::value) continue;
    write_heading(out, key.name);
    write_rows(out, key.name, key);
  }
  return out.str();
}

}  // namespace wavetank
