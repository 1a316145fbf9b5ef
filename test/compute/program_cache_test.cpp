#include "../../src/compute/program_cache.h"

#include <sys/stat.h>

#include <fstream>

#include "compute_fixture.h"

namespace wavetank::compute::program_cache_test {
namespace {

namespace fs = std::filesystem;

Hash key_of(const std::string& text) {
  Hash key;
  key.add(text);
  return key;
}

std::vector<fs::path> files_in(const fs::path& directory) {
  std::vector<fs::path> files;
  if (fs::exists(directory))
    for (const auto& entry : fs::directory_iterator(directory)) files.push_back(entry.path());
  return files;
}

std::vector<char> content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void overwrite(const fs::path& file, const std::vector<char>& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc).write(bytes.data(), std::streamsize(bytes.size()));
}

/// A stored file is always a new one, so the same number means that it was used as it was.
ino_t file_number(const fs::path& file) {
  struct stat status {};
  return stat(file.c_str(), &status) == 0 ? status.st_ino : 0;
}

TEST(Hash, IsThePublishedFnv1a) {
  Hash empty, a;
  a.add("a", 1);
  EXPECT_EQ(empty.hexadecimal(), "6c62272e07bb014262b821756295c58d");
  EXPECT_EQ(a.hexadecimal(), "d228cb696f1a8caf78912b704e4a8964");
}

TEST(Hash, TellsPartsApart) {
  Hash one, other;
  one.add(std::string("ab"));
  one.add(std::string("c"));
  other.add(std::string("a"));
  other.add(std::string("bc"));
  EXPECT_NE(one.value(), other.value());
}

TEST(BinaryFiles, RoundTripAndRefuseDamage) {
  const ScratchDirectory scratch;
  const std::string directory = (scratch.path() / "deep" / "er").string();
  const Hash key = key_of("weir");
  const std::vector<unsigned char> binary{1, 2, 3, 250};
  EXPECT_TRUE(load_binary(directory, key).empty());
  store_binary(directory, key, binary);
  EXPECT_EQ(load_binary(directory, key), binary);
  ASSERT_EQ(files_in(directory).size(), 1u);
  const fs::path file = files_in(directory).front();
  const auto whole = content(file);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    auto damaged = whole;
    damaged[at] = char(damaged[at] ^ 16);
    overwrite(file, damaged);
    EXPECT_TRUE(load_binary(directory, key).empty()) << "byte " << at;
    overwrite(file, {whole.begin(), whole.begin() + std::ptrdiff_t(at)});
    EXPECT_TRUE(load_binary(directory, key).empty()) << "cut at " << at;
  }
  overwrite(file, whole);
  EXPECT_EQ(load_binary(directory, key), binary);
  fs::rename(file, fs::path(directory) / (key_of("dam").hexadecimal() + ".bin"));
  EXPECT_TRUE(load_binary(directory, key_of("dam")).empty());
}

class ProgramCacheTest : public ::testing::Test {
 protected:
  void SetUp() override { setenv("WAVETANK_CACHE_DIRECTORY", directory.c_str(), 1); }
  void TearDown() override { unsetenv("WAVETANK_CACHE_DIRECTORY"); }

  /// Builds a program with this number in it and asks for it, on a device that has built nothing before.
  int answer(int number) {
    const Device device(choose_device("auto"));
    const std::string source = "kernel void answer(global int* o) { o[0] = " + std::to_string(number) + "; }\n";
    Buffer<int> out(device, 1);
    Program(device, {{"answer.cl", source}}, "answer.cl", "").kernel("answer").launch(1, out);
    return out.download()[0];
  }

  ScratchDirectory scratch;
  fs::path directory = scratch.path() / "cache";
};

TEST_F(ProgramCacheTest, IsUsedTheSecondTime) {
  EXPECT_EQ(answer(41), 41);
  auto files = files_in(directory);
  if (files.empty()) GTEST_SKIP() << "this driver gives no binaries";
  ASSERT_EQ(files.size(), 1u);
  const ino_t number = file_number(files.front());
  EXPECT_EQ(answer(41), 41);
  EXPECT_EQ(files_in(directory), files);
  EXPECT_EQ(file_number(files.front()), number);
  EXPECT_EQ(answer(42), 42);
  EXPECT_EQ(files_in(directory).size(), 2u);
}

TEST_F(ProgramCacheTest, ReplacesADamagedFile) {
  EXPECT_EQ(answer(51), 51);
  const auto files = files_in(directory);
  if (files.empty()) GTEST_SKIP() << "this driver gives no binaries";
  const auto whole = content(files.front());
  for (const std::vector<char>& damage : {std::vector<char>{}, std::vector<char>(7, 'x'), std::vector<char>(whole.size(), '\0'),
                                          std::vector<char>(whole.begin(), whole.end() - 1)}) {
    overwrite(files.front(), damage);
    EXPECT_EQ(answer(51), 51);
    EXPECT_NE(content(files.front()), damage);
    EXPECT_EQ(files_in(directory), files);
  }
}

TEST_F(ProgramCacheTest, RebuildsWhatTheDriverDoesNotTake) {
  EXPECT_EQ(answer(61), 61);
  const auto files = files_in(directory);
  if (files.empty()) GTEST_SKIP() << "this driver gives no binaries";
  const std::string name = files.front().stem().string();
  // A sound file, but of something that is no program at all: its checksum is right, and so is its key.
  const auto whole = content(files.front());
  const Hash other = key_of("other");
  store_binary(directory.string(), other, std::vector<unsigned char>(500, 'x'));
  auto forged = content(directory / (other.hexadecimal() + ".bin"));
  std::copy(whole.begin(), whole.begin() + 24, forged.begin());  // magic and key
  overwrite(files.front(), forged);
  EXPECT_EQ(answer(61), 61);
}

TEST_F(ProgramCacheTest, IsNoErrorWhereItCannotBeWritten) {
  overwrite(scratch.path() / "file", {'x'});
  setenv("WAVETANK_CACHE_DIRECTORY", (scratch.path() / "file" / "cache").c_str(), 1);
  EXPECT_EQ(answer(71), 71);
  EXPECT_EQ(answer(71), 71);
  EXPECT_EQ(content(scratch.path() / "file").size(), 1u);
}

TEST_F(ProgramCacheTest, CanBeSwitchedOff) {
  setenv("WAVETANK_CACHE_DIRECTORY", "", 1);
  EXPECT_EQ(cache_directory(), "");
  EXPECT_EQ(answer(81), 81);
  EXPECT_TRUE(files_in(directory).empty());
}

TEST(CacheDirectory, FollowsTheEnvironment) {
  const std::string home = getenv("HOME") ? getenv("HOME") : "";
  const std::string cache = getenv("XDG_CACHE_HOME") ? getenv("XDG_CACHE_HOME") : "";
  unsetenv("WAVETANK_CACHE_DIRECTORY");
  setenv("HOME", "/home/ada", 1);
  setenv("XDG_CACHE_HOME", "/var/cache/ada", 1);
  EXPECT_EQ(cache_directory(), "/var/cache/ada/wavetank");
  unsetenv("XDG_CACHE_HOME");
  EXPECT_EQ(cache_directory(), "/home/ada/.cache/wavetank");
  unsetenv("HOME");
  EXPECT_EQ(cache_directory(), "");
  if (!home.empty()) setenv("HOME", home.c_str(), 1);
  if (!cache.empty()) setenv("XDG_CACHE_HOME", cache.c_str(), 1);
}

}  // namespace
}  // namespace wavetank::compute::program_cache_test
