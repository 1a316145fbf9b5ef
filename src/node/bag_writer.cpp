#include "wavetank/node/bag_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "wavetank/common/log.h"
#include "wavetank/common/whole_file.h"

namespace wavetank {

namespace fs = std::filesystem;

namespace {

/// Space that a bag needs at the least: one chunk and its index.
constexpr std::uint64_t smallest_space = 1 << 20;
constexpr std::uint64_t chunk_length = 768 * 1024;         // rosbag's
constexpr std::uint64_t reservation = 4 * smallest_space;  // is asked for at a time, while there is plenty

std::uint64_t length_of(int file) {
  struct stat now;
  return fstat(file, &now) == 0 ? static_cast<std::uint64_t>(now.st_size) : 0;
}

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

bool is_same_file(int file, const std::string& path) {
  struct stat a, b;
  return fstat(file, &a) == 0 && lstat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// 0, or errno's value. Beyond the file's end, so that its length stays what was written.
int reserve_up_to(int file, std::uint64_t from, std::uint64_t to) {
  rlimit limit;
  if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY && to > limit.rlim_cur) return EFBIG;
  int result;
  do {
    result = fallocate(file, FALLOC_FL_KEEP_SIZE, static_cast<off_t>(from), static_cast<off_t>(to - from)) == 0 ? 0 : errno;
  } while (result == EINTR);
  return result;
}

}  // namespace

BagWriter::BagWriter(const std::string& path, std::string topic_prefix)
    : path_(path), active_path_(path + ".active"), prefix_(std::move(topic_prefix) + "/") {
  const std::string what = "cannot write bag '" + path_ + "': ";
  const std::string obstacle = obstacle_to_file(path_);
  if (!obstacle.empty()) throw Error(what + obstacle);
  std::error_code ignored;
  if (!fs::is_directory(folder_of(path_), ignored)) throw Error(what + "there is no folder '" + folder_of(path_).string() + "'");
  if (disk_is_full(path_)) throw Error(what + "the disk is full");
  open_active();
  try {
    bag_ = std::make_unique<rosbag::Bag>();
    // by its descriptor: at its name, something else may lie by now
    bag_->open("/proc/self/fd/" + std::to_string(file_), rosbag::bagmode::Write);
    reserve(0);
  } catch (const std::exception& failure) {
    discard();
    throw Error(what + failure.what());
  }
}

BagWriter::~BagWriter() { discard(); }

/// Makes the file, through no link, and locks it until it is whole.
void BagWriter::open_active() {
  constexpr int most_attempts = 100;  // of which each follows another process that was faster
  for (int k = 0; k < most_attempts && file_ < 0; ++k) {
    file_ = open(active_path_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file_ < 0 && errno != EEXIST) throw Error("cannot write bag '" + path_ + "': " + std::strerror(errno));
    if (file_ < 0) keep_what_died();
  }
  const bool others_have_it = file_ < 0 || (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK);
  if (!others_have_it && is_same_file(file_, active_path_)) return;
  if (file_ >= 0)
    close(file_);  // between its making and its lock, a process that began at the same time took it for what one that died had left
  file_ = -1;
  throw Error("cannot write bag '" + path_ + "': another process is writing it");
}

/// Puts what lies at the active name out of the way, if nobody writes it. Whoever moves it there or away has locked it: what is locked and
/// is still there by its name stays there.
void BagWriter::keep_what_died() {
  const std::string what = "cannot write bag '" + path_ + "': ";
  const std::string obstacle = obstacle_to_file(active_path_);
  if (!obstacle.empty()) throw Error(what + "it is made as '" + active_path_ + "', and there " + obstacle.substr(0, obstacle.find(';')));
  const int left = open(active_path_.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (left < 0 && errno == ENOENT) return;  // another process was faster
  const bool is_written = left >= 0 && flock(left, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  std::string reason;
  if (!is_written && (left < 0 || is_same_file(left, active_path_))) {
    const std::string kept = free_path(path_, ".active");
    const bool has_nothing = left >= 0 && length_of(left) == 0;  // a process that began at the same time and comes too late made it
    const bool is_gone = (has_nothing ? unlink(active_path_.c_str()) : std::rename(active_path_.c_str(), kept.c_str())) == 0;
    if (!is_gone && errno != ENOENT) reason = std::strerror(errno);
    if (is_gone && !has_nothing)
      log(LogLevel::warning,
          "a run that died left '" + active_path_ + "': it is kept as '" + kept + "', which rosbag reindex makes readable");
  }
  if (left >= 0) close(left);
  if (!reason.empty()) throw Error(what + "'" + active_path_ + "', which a run that died left, cannot be put out of the way: " + reason);
  if (is_written) throw Error(what + "another process is writing it");
}

/// What the end of a bag of this length takes: index and connections, of which each is in its chunk as well.
std::uint64_t BagWriter::closing_length(std::uint64_t bag_length) const {
  const std::uint64_t topics = topics_.size(), chunks = bag_length / chunk_length + kept_ + 2;
  return smallest_space / 2 + 2 * definitions_ + 1024 * topics + chunks * (128 + 16 * topics);
}

/// Before a message is written: sees to it that both it and the end of the bag have room.
void BagWriter::reserve(std::uint64_t message_length) {
  if (!can_reserve_) return;
  const std::uint64_t length = length_of(file_), needed = length + message_length + closing_length(length + message_length);
  if (needed <= reserved_) return;
  const std::uint64_t from = std::max(length, reserved_);
  int problem = reserve_up_to(file_, from, needed + reservation);
  reserved_ = needed + reservation;
  if (problem == ENOSPC || problem == EDQUOT || problem == EFBIG) {
    problem = reserve_up_to(file_, from, needed);
    reserved_ = needed;
  }
  if (problem == 0) return;
  reserved_ = from;
  if (problem == EFBIG) throw BagError("bag '" + path_ + "' has reached the limit on the size of files (ulimit -f)");
  if (problem == ENOSPC || problem == EDQUOT) throw BagError("the disk is full, which bag '" + path_ + "' lies on");
  can_reserve_ = false;
}

void BagWriter::keep() {
  guarded([this] {
    bag_->setChunkThreshold(bag_->getChunkThreshold());  // which ends the chunk in progress
    std::fflush(nullptr);                                // its index too: the bag's own stream cannot be reached
    ++kept_;
  });
}

void BagWriter::finish() {
  guarded([this] {
    bag_->close();
    static_cast<void>(ftruncate(file_, static_cast<off_t>(length_of(file_))) == 0);  // gives back what is reserved beyond the end
    const std::string obstacle = obstacle_to_file(path_);
    if (!obstacle.empty()) throw Error(obstacle);
    if (!is_same_file(file_, active_path_)) throw Error("'" + active_path_ + "' was taken away meanwhile");
    fs::rename(active_path_, path_);
  });
  bag_.reset();
  close(file_);
  file_ = -1;
}

void BagWriter::fail(const std::string& reason) {
  const bool full = disk_is_full(path_);
  const bool is_whole = close_bag();
  close(file_);
  file_ = -1;
  throw BagError("cannot write bag '" + path_ + "': " + (full ? "the disk is full" : reason) + "; what it holds until then is left in '" +
                 active_path_ + "'" + (is_whole ? "" : ", which rosbag reindex makes readable"));
}

/// Whether it could be.
bool BagWriter::close_bag() {
  // A bag that cannot be closed throws from its destructor too, which would end the process: it is left to the end of the process instead.
  try {
    bag_->close();
    bag_.reset();
    return true;
  } catch (const std::exception&) {
    static_cast<void>(bag_.release());
    return false;
  }
}

void BagWriter::discard() {
  if (bag_) close_bag();
  if (file_ < 0) return;
  std::error_code ignored;
  if (is_same_file(file_, active_path_)) fs::remove(active_path_, ignored);
  close(file_);
  file_ = -1;
}

}  // namespace wavetank
