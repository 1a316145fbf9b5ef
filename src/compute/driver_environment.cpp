#include "driver_environment.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>

namespace wavetank::compute {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Whether the directory takes files or, where it is not there yet, could be made.
bool can_be_written(std::filesystem::path directory) {
  std::error_code failure;
  while (!std::filesystem::exists(directory, failure) && directory.has_relative_path()) directory = directory.parent_path();
  return std::filesystem::is_directory(directory, failure) && access(directory.c_str(), W_OK | X_OK) == 0;
}

/// Code is loaded from there, so a directory or link that somebody else has put in the shared temporary directory will not do.
bool is_own_directory(const std::string& directory) {
  struct stat status {};
  return lstat(directory.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == geteuid() &&
         (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

void give_pocl_a_cache() {
  if (!environment("POCL_CACHE_DIR").empty()) return;
  const std::string usual = user_cache_directory();
  if (!usual.empty() && can_be_written(usual + "/pocl/kcache")) return;
  std::error_code ignored;
  const std::string temporary = std::filesystem::temp_directory_path(ignored).string() + "/wavetank-pocl-" + std::to_string(geteuid());
  if (make_writable_directory(temporary) && is_own_directory(temporary)) setenv("POCL_CACHE_DIR", temporary.c_str(), 0);
}

}  // namespace

bool make_writable_directory(const std::string& directory) {
  std::error_code failure;
  std::filesystem::create_directories(directory, failure);
  return std::filesystem::is_directory(directory, failure) && access(directory.c_str(), W_OK | X_OK) == 0;
}

std::string user_cache_directory() {
  const std::string cache = environment("XDG_CACHE_HOME");
  if (!cache.empty() && cache.front() == '/') return cache;
  const std::string home = environment("HOME");
  return home.empty() ? "" : home + "/.cache";
}

void prepare_driver_environment() {
  static std::once_flag once;
  std::call_once(once, give_pocl_a_cache);
}

}  // namespace wavetank::compute
