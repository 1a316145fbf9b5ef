#include "wavetank/node/bag_writer.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace wavetank {

namespace fs = std::filesystem;

namespace {

/// Space that a bag needs at the least: one chunk and its index.
constexpr std::uintmax_t smallest_space = 1 << 20;

/// The folder that a file lies in, also of a bare name.
fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

bool disk_is_full(const std::string& path) {
  std::error_code ignored;
  const fs::space_info space = fs::space(folder_of(path), ignored);
  return !ignored && space.available < smallest_space;
}

}  // namespace

BagWriter::BagWriter(const std::string& path, std::string topic_prefix)
    : path_(path), active_path_(path + ".active"), prefix_(std::move(topic_prefix) + "/") {
  std::error_code ignored;
  if (fs::is_directory(path_, ignored)) throw Error("cannot write bag '" + path_ + "': it is a folder; give the name of a file");
  if (!fs::is_directory(folder_of(path_), ignored))
    throw Error("cannot write bag '" + path_ + "': there is no folder '" + folder_of(path_).string() + "'");
  if (disk_is_full(path_)) throw Error("cannot write bag '" + path_ + "': the disk is full");
  bag_ = std::make_unique<rosbag::Bag>();
  errno = 0;
  try {
    bag_->open(active_path_, rosbag::bagmode::Write);
  } catch (const std::exception&) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "the file cannot be opened";
    bag_.reset();
    throw Error("cannot write bag '" + path_ + "': " + reason);
  }
}

BagWriter::~BagWriter() { discard(); }

void BagWriter::finish() {
  guarded([this] {
    bag_->close();
    fs::rename(active_path_, path_);
  });
  bag_.reset();
}

void BagWriter::fail(const std::string& reason) {
  const bool full = disk_is_full(path_);
  discard();
  throw Error("cannot write bag '" + path_ + "': " + (full ? "the disk is full" : reason) + "; the unfinished bag is removed");
}

void BagWriter::discard() {
  if (!bag_) return;
  // A bag that cannot be closed throws from its destructor too, which would end the process: it is left to the end of the process instead.
  try {
    bag_->close();
    bag_.reset();
  } catch (const std::exception&) {
    static_cast<void>(bag_.release());
  }
  std::error_code ignored;
  fs::remove(active_path_, ignored);
}

}  // namespace wavetank
