#include "wavetank/common/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

std::string folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

[[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& reason) {
  throw Error("cannot write " + what + " '" + path + "': " + reason);
}

/// A new file beside the path, made by nobody else and reached through no link. Returns its descriptor.
int open_part(const std::string& path, const std::string& what, std::string& part) {
  constexpr int most_leftovers = 1000;  // of runs that died
  for (int k = 0; k < most_leftovers; ++k) {
    part = path + ".part" + (k == 0 ? "" : std::to_string(k));
    const int file = open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0) return file;
    if (errno != EEXIST) fail(path, what, std::strerror(errno));
  }
  fail(path, what, "too many '.part' files lie beside it");
}

/// errno's value of what went wrong; 0 = nothing.
int write_all(int file, std::string_view content, bool until_on_disk) {
  while (!content.empty()) {
    const ssize_t written = write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    if (written == 0) return ENOSPC;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  if (!until_on_disk) return 0;
  // some disks tell only now that they are full
  return fsync(file) != 0 && errno != EINVAL && errno != EROFS ? errno : 0;
}

}  // namespace

std::string obstacle_to_file(const std::string& path) {
  if (path.empty()) return "it has no name";
  struct stat there;
  if (lstat(path.c_str(), &there) != 0) return errno == ENOENT ? "" : std::strerror(errno);
  if (S_ISREG(there.st_mode)) return path.back() == '/' ? "it is no folder" : "";
  const char* kind = S_ISDIR(there.st_mode)                             ? "a folder"
                     : S_ISLNK(there.st_mode)                           ? "a link, which is not followed"
                     : S_ISFIFO(there.st_mode)                          ? "a pipe"
                     : S_ISSOCK(there.st_mode)                          ? "a socket"
                     : S_ISCHR(there.st_mode) || S_ISBLK(there.st_mode) ? "a device"
                                                                        : "no plain file";
  return std::string("it is ") + kind + "; give the name of a plain file";
}

std::string free_path(const std::string& base, const std::string& ending) {
  struct stat ignored;
  std::string path = base + ending;
  for (int k = 1; lstat(path.c_str(), &ignored) == 0; ++k) path = base + "." + std::to_string(k) + ending;
  return path;
}

void check_writable(const std::string& path, const std::string& what) {
  const std::string obstacle = obstacle_to_file(path);
  if (!obstacle.empty()) fail(path, what, obstacle);
  const std::string folder = folder_of(path);
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) fail(path, what, "there is no folder '" + folder + "'");
  if (access(folder.c_str(), W_OK) != 0) fail(path, what, std::strerror(errno));
  std::string part;
  close(open_part(path, what, part));  // not all that can be told by rights works: in /proc, say
  std::remove(part.c_str());
}

void write_whole(const std::string& path, std::string_view content, const std::string& what, bool until_on_disk) {
  const std::string obstacle = obstacle_to_file(path);
  if (!obstacle.empty()) fail(path, what, obstacle);
  std::string part;
  const int file = open_part(path, what, part);
  int problem = write_all(file, content, until_on_disk);
  if (close(file) != 0 && problem == 0) problem = errno;
  if (problem == 0 && std::rename(part.c_str(), path.c_str()) != 0) problem = errno;
  if (problem == 0) return;
  std::remove(part.c_str());
  fail(path, what, problem == ENOSPC || problem == EDQUOT ? "the disk is full" : std::strerror(problem));
}

}  // namespace wavetank
