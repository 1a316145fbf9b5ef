#include "wavetank/sph/kernel_sources.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "wavetank/common/error.h"

namespace wavetank {

compute::SourceFiles kernel_sources() {
  compute::SourceFiles files = embedded_kernel_sources();
  const char* directory = std::getenv("WAVETANK_KERNEL_DIRECTORY");
  if (directory == nullptr || *directory == '\0') return files;
  std::error_code failure;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory, failure)) {
    if (entry.path().extension() != ".cl") continue;
    std::ifstream stream(entry.path());
    files[entry.path().lexically_relative(directory).string()] = std::string(std::istreambuf_iterator<char>(stream), {});
  }
  if (failure)
    throw Error("WAVETANK_KERNEL_DIRECTORY is \"" + std::string(directory) + "\", which cannot be read: " + failure.message() + ".");
  return files;
}

}  // namespace wavetank
