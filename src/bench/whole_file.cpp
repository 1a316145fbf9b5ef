#include "whole_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

/// Beside the file itself, so that it can be renamed into place.
std::string part_of(const std::string& path) { return path + ".part"; }

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  std::remove(part_of(path).c_str());
  throw Error("cannot write " + path + ": " + reason);
}

void write_part(const std::string& path, const std::string& content) {
  errno = 0;
  std::ofstream stream(part_of(path), std::ios::binary | std::ios::trunc);
  stream << content;
  stream.close();
  if (!stream) fail(path, errno != 0 ? std::strerror(errno) : "the disk did not take it");
}

}  // namespace

void check_writable(const std::string& path) {
  std::error_code failure;
  if (path.empty()) throw Error("cannot write a file without a name");
  if (std::filesystem::is_directory(path, failure)) throw Error("cannot write " + path + ": it is a directory");
  write_part(path, "");
  std::remove(part_of(path).c_str());
}

void write_whole(const std::string& path, const std::string& content) {
  write_part(path, content);
  if (std::rename(part_of(path).c_str(), path.c_str()) != 0) fail(path, std::strerror(errno));
}

}  // namespace wavetank::bench
