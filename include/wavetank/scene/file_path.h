#pragma once

#include <functional>
#include <string>

namespace wavetank {

/// Turns a URI of a scheme that is not known here (package://) into a path; throws Error if it cannot.
using ResourceResolver = std::function<std::string(const std::string& uri)>;

/// The path of a file as a user names it: package:// through the resolver, file://, an absolute path, or one relative to the case's
/// directory. `kind` names the file in messages ("mesh"). Throws Error for an empty URI, and where there is no resolver or no directory.
std::string file_path(const std::string& kind, const std::string& uri, const std::string& case_directory, const ResourceResolver& resolve);

/// Throws Error if the path is not that of a regular file with something in it.
void check_file(const std::string& kind, const std::string& path);

}  // namespace wavetank
