#include "cold_build.h"

#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <vector>

#include "bench_options.h"
#include "start_up.h"
#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

/// An empty directory, which goes with the object.
class CacheDirectory {
 public:
  CacheDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "wavetank_bench_XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw Error("no temporary directory could be made for the cold build");
    path_ = pattern;
  }
  ~CacheDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  CacheDirectory(const CacheDirectory&) = delete;
  CacheDirectory& operator=(const CacheDirectory&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// This process's environment with every cache of kernels in the directory: pocl's, wavetank's own and other drivers'. Wavetank's is not
/// named outright, or pocl would use it beside its own (compute/program.h).
std::vector<std::string> environment_with(const std::string& directory) {
  const std::vector<std::string> replaced = {"POCL_CACHE_DIR=", "XDG_CACHE_HOME=", "CUDA_CACHE_PATH=", "WAVETANK_CACHE_DIRECTORY="};
  std::vector<std::string> result;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    bool keep = true;
    for (const std::string& name : replaced) keep = keep && std::string(*entry).rfind(name, 0) != 0;
    if (keep) result.emplace_back(*entry);
  }
  for (const std::size_t k : {0, 1, 2}) result.push_back(replaced[k] + directory);
  return result;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

std::string read_all(int descriptor) {
  std::string text;
  char buffer[512];
  for (;;) {
    const ssize_t count = read(descriptor, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer, static_cast<std::size_t>(count));
  }
}

/// What the command prints. Its errors go where ours go.
std::string output_of(std::vector<std::string> command, std::vector<std::string> environment) {
  int ends[2];
  if (pipe(ends) != 0) throw Error("no pipe could be made for the cold build");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  pid_t child = 0;
  const int failure =
      posix_spawn(&child, command.front().c_str(), &actions, nullptr, pointers_to(command).data(), pointers_to(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  const std::string text = failure == 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  if (failure != 0) throw Error("the program " + command.front() + " could not be started for the cold build");
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error("the process that builds the kernels anew failed");
  return text;
}

}  // namespace

double cold_build_seconds(const std::vector<std::string>& command, const std::string& case_name, const std::string& device) {
  const CacheDirectory cache;
  std::vector<std::string> whole = command;
  whole.insert(whole.end(), {start_up_option, case_name, "--device", device});
  const std::vector<std::string> environment = environment_with(cache.path());
  const StartUp cold = start_up_of(output_of(whole, environment));
  const StartUp warm = start_up_of(output_of(whole, environment));
  return cold.without_layout() - warm.without_layout();
}

}  // namespace wavetank::bench
