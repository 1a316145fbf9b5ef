// Files are written whole or not at all, and only where a plain one belongs.
#include "wavetank/common/whole_file.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "error_of.h"
#include "scratch_directory.h"

namespace wavetank::whole_file_test {
namespace {

namespace fs = std::filesystem;

std::string content(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(WholeFile, ReplacesAnOlderOneAndLeavesNothingElse) {
  const ScratchDirectory scratch;
  const std::string path = scratch.write("out", "old");
  check_writable(path, "the file");
  EXPECT_EQ(content(path), "old");
  write_whole(path, "new", "the file");
  EXPECT_EQ(content(path), "new");
  for (const std::string& wrong : {scratch.file("no/folder"), scratch.path().string(), std::string()}) {
    EXPECT_THROW(check_writable(wrong, "the file"), Error) << wrong;
    EXPECT_THROW(write_whole(wrong, "x", "the file"), Error) << wrong;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(scratch.path()), {}), 1);
}

TEST(WholeFile, DoesNotTakeThePlaceOfAnythingButAPlainFile) {
  const ScratchDirectory scratch;
  const std::string plain = scratch.write("precious", "kept"), link = scratch.file("link"), dangling = scratch.file("dangling"),
                    pipe = scratch.file("pipe"), socket_path = scratch.file("socket");
  fs::create_symlink(plain, link);
  fs::create_symlink(scratch.file("nowhere"), dangling);
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, socket_path.c_str(), sizeof address.sun_path - 1);
  const int server = socket(AF_UNIX, SOCK_STREAM, 0);
  ASSERT_EQ(bind(server, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(server);
  // one of its own where the user may make it; else the system's, which this user cannot replace
  std::string device = scratch.file("device");
  if (mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) device = "/dev/null";
  for (const auto& [path, kind] : std::vector<std::pair<std::string, std::string>>{
           {link, "a link"}, {dangling, "a link"}, {pipe, "a pipe"}, {socket_path, "a socket"}, {device, "a device"}}) {
    const auto before = fs::symlink_status(path).type();
    EXPECT_NE(error_of([&, wrong = path] { check_writable(wrong, "the file"); }).find(kind), std::string::npos) << path;
    EXPECT_NE(error_of([&, wrong = path] { write_whole(wrong, "x", "the file"); }).find(kind), std::string::npos) << path;
    EXPECT_EQ(fs::symlink_status(path).type(), before) << path;
  }
  EXPECT_EQ(content(plain), "kept");
  EXPECT_FALSE(fs::exists(scratch.file("nowhere")));
}

TEST(WholeFile, DoesNotWriteThroughALinkInThePlaceOfItsPart) {
  const ScratchDirectory scratch;
  const std::string plain = scratch.write("precious", "kept"), path = scratch.file("out");
  fs::create_symlink(plain, path + ".part");
  write_whole(path, "new", "the file");
  EXPECT_EQ(content(path), "new");
  EXPECT_FALSE(fs::is_symlink(path));
  EXPECT_EQ(content(plain), "kept");
  EXPECT_TRUE(fs::is_symlink(path + ".part"));
}

TEST(WholeFile, FindsAFreeName) {
  const ScratchDirectory scratch;
  EXPECT_EQ(free_path(scratch.file("a"), ".b"), scratch.file("a.b"));
  scratch.write("a.b", "");
  fs::create_symlink(scratch.file("nowhere"), scratch.file("a.1.b"));
  EXPECT_EQ(free_path(scratch.file("a"), ".b"), scratch.file("a.2.b"));
}

}  // namespace
}  // namespace wavetank::whole_file_test
