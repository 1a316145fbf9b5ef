#pragma once

#include <string>
#include <string_view>

namespace wavetank {

/// Why no file may be made at a path, or be replaced there; empty if it may. Only plain files are replaced: what is written to a link, a
/// device, a pipe or a socket goes elsewhere, and a file put in its place takes it away from whoever uses it.
std::string obstacle_to_file(const std::string& path);

/// The first of `base` and `base`.1, .2, … (before `ending`) at which there is nothing.
std::string free_path(const std::string& base, const std::string& ending);

/// Throws Error if a file could not be written there; leaves everything as it is. `what` names it in the message: "the snapshot".
void check_writable(const std::string& path, const std::string& what);

/// Writes a file whole or not at all: under another name beside it, then renamed. An older plain file is replaced. `until_on_disk`: returns
/// only when the disk has it, which takes long; without, it may be lost when the machine goes down, but not when the program does. Throws
/// Error.
void write_whole(const std::string& path, std::string_view content, const std::string& what, bool until_on_disk = true);

}  // namespace wavetank
