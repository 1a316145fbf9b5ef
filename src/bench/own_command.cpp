#include "own_command.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "wavetank/common/error.h"

namespace wavetank::bench {

std::vector<std::string> command_of(const std::string& cmdline, int argc, const std::string& executable) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < cmdline.size();) {
    const std::size_t end = std::min(cmdline.find('\0', begin), cmdline.size());
    words.push_back(cmdline.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::size_t of_main = static_cast<std::size_t>(argc);
  if (words.size() <= of_main) return {executable};
  words.resize(words.size() - of_main + 1);  // the loader's, and the program
  words.front() = executable;
  return words;
}

std::vector<std::string> own_command(int argc) {
  std::error_code failure;
  const std::string executable = std::filesystem::read_symlink("/proc/self/exe", failure).string();
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string cmdline(std::istreambuf_iterator<char>(file), {});
  if (failure || cmdline.empty()) throw Error("/proc does not tell how this program was started; --no-cold-build does without");
  return command_of(cmdline, argc, executable);
}

}  // namespace wavetank::bench
