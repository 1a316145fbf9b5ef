#include "text_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "wavetank/common/error.h"

namespace wavetank::scene {
namespace {

constexpr std::size_t greatest_file = 16u << 20;  // bytes; a case is a few kB, and /dev/zero has no end

}  // namespace

std::string read_text_file(const std::string& path, const std::string& kind, const std::string& nature) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path + ": is a directory; " + nature);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(path + ": cannot open the " + kind + ": " + std::strerror(errno != 0 ? errno : ENOENT));
  std::string text;
  for (char block[65536]; file.read(block, sizeof block) || file.gcount() > 0;) {
    text.append(block, static_cast<std::size_t>(file.gcount()));
    if (text.size() > greatest_file) throw Error(path + ": is larger than 16 MiB; that is no " + kind);
  }
  if (file.bad()) throw Error(path + ": reading the " + kind + " failed: " + std::strerror(errno));
  return text;
}

}  // namespace wavetank::scene
