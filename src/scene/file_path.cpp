#include "wavetank/scene/file_path.h"

#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

std::string percent_decoded(const std::string& text) {
  std::string plain;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '%' && k + 2 < text.size() && std::isxdigit(text[k + 1]) && std::isxdigit(text[k + 2])) {
      plain += static_cast<char>(std::strtol(text.substr(k + 1, 2).c_str(), nullptr, 16));
      k += 2;
    } else {
      plain += text[k];
    }
  }
  return plain;
}

}  // namespace

std::string file_path(const std::string& kind, const std::string& uri, const std::string& case_directory, const ResourceResolver& resolve) {
  const std::string file_scheme = "file://";
  if (uri.empty())
    throw Error("a " + kind + " has an empty path; give package://, file://, an absolute path or one relative to the case file");
  if (uri.compare(0, file_scheme.size(), file_scheme) == 0) return percent_decoded(uri.substr(file_scheme.size()));
  if (uri.find("://") != std::string::npos) {
    if (!resolve) throw Error(kind + " '" + uri + "' cannot be found: nothing here resolves such addresses; give a file path");
    const std::string path = resolve(uri);
    if (path.compare(0, file_scheme.size(), file_scheme) == 0) return percent_decoded(path.substr(file_scheme.size()));
    return path;
  }
  const std::filesystem::path path(uri);
  if (path.is_absolute()) return uri;
  if (case_directory.empty()) {
    throw Error(kind + " '" + uri +
                "' is a relative path, which needs a case file that it is relative to; give package://, file:// or an absolute path");
  }
  return (std::filesystem::path(case_directory) / path).string();
}

void check_file(const std::string& kind, const std::string& path) {
  std::error_code failure;
  const std::string file = kind + " file '" + path + "'";
  if (!std::filesystem::exists(path, failure)) throw Error(file + " does not exist");
  if (!std::filesystem::is_regular_file(path, failure)) throw Error(file + " is not a regular file");
  if (std::filesystem::file_size(path, failure) == 0 && !failure) throw Error(file + " is empty");
}

}  // namespace wavetank
