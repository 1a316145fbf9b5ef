#pragma once

#include <ros/message_traits.h>
#include <rosbag/bag.h>

#include <memory>
#include <set>
#include <string>

#include "wavetank/common/error.h"
#include "wavetank/node/stamps.h"

namespace wavetank {

/// A bag that cannot grow any more. what() says why, and where what it holds so far is.
class BagError : public Error {
 public:
  using Error::Error;
};

/// Writes a bag under a temporary name (PATH.active, as rosbag record does) and gives it its own name when it is whole, replacing an older
/// plain file. What its end takes is reserved on the disk all along, so that a bag on a disk that fills up ends early, but whole. An object
/// that is destroyed without finish() leaves nothing behind.
class BagWriter {
 public:
  /// topic_prefix: namespace of the relative topics given to write, "/wavetank"; a topic with a leading slash stays as it is. Throws Error
  /// if the file cannot be made there: no folder, something else than a plain file at either name, a full disk, or another process that
  /// writes it at present. What a process that died left at PATH.active is kept as PATH.1.active (2, 3, …), which is logged.
  BagWriter(const std::string& path, std::string topic_prefix);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Throws BagError if the file cannot grow. On a full disk nothing of the message is written, and write_last() and finish() still work;
  /// otherwise (is_open() is false then) the file is left as it is at PATH.active.
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    append(topic, stamp, message, {}, true);
  }
  /// The same for a topic that players of the bag latch.
  template <class Message>
  void write_latched(const std::string& topic, const ros::Time& stamp, const Message& message) {
    auto header = boost::make_shared<ros::M_string>();
    (*header)["type"] = ros::message_traits::datatype(message);
    (*header)["md5sum"] = ros::message_traits::md5sum(message);
    (*header)["message_definition"] = ros::message_traits::definition(message);
    (*header)["topic"] = resolved(topic);
    (*header)["callerid"] = prefix_.substr(0, prefix_.size() - 1);
    (*header)["latching"] = "1";
    append(topic, stamp, message, header, true);
  }
  /// A small last message, for which there is room on a full disk too.
  template <class Message>
  void write_last(const std::string& topic, const ros::Time& stamp, const Message& message) {
    append(topic, stamp, message, {}, false);
  }
  /// All that is written until now is handed to the system, in a form that rosbag reindex reads: it is not lost with this process. Costs a
  /// seek and some hundred bytes of the bag. Throws BagError as write.
  void keep();
  /// Ends the bag and gives it its name. Throws BagError as write.
  void finish();
  const std::string& path() const { return path_; }
  bool is_open() const { return bag_ != nullptr; }

 private:
  template <class Message>
  void append(const std::string& topic, const ros::Time& stamp, const Message& message, const boost::shared_ptr<ros::M_string>& header,
              bool keep_room) {
    guarded([&] {
      const std::string name = resolved(topic);
      if (topics_.insert(name).second) definitions_ += std::string(ros::message_traits::definition(message)).size();
      if (keep_room) reserve(ros::serialization::serializationLength(message));
      bag_->write(name, nonzero(stamp), message, header);
    });
  }
  template <class Action>
  void guarded(Action&& action) {
    if (!bag_) throw BagError("bag '" + path_ + "' is closed: no more can be written to it");
    try {
      action();
    } catch (const BagError&) {
      throw;
    } catch (const std::exception& failure) {
      fail(failure.what());
    }
  }
  void open_active();
  void keep_what_died();
  void reserve(std::uint64_t message_length);
  std::uint64_t closing_length(std::uint64_t bag_length) const;
  [[noreturn]] void fail(const std::string& reason);
  bool close_bag();
  void discard();
  std::string resolved(const std::string& topic) const { return topic.rfind('/', 0) == 0 ? topic : prefix_ + topic; }

  std::string path_, active_path_, prefix_;
  int file_ = -1;  ///< the same file, locked
  std::unique_ptr<rosbag::Bag> bag_;
  std::set<std::string> topics_;
  std::uint64_t definitions_ = 0;  ///< bytes, of the topics' messages
  std::uint64_t kept_ = 0;         ///< chunks that ended before they were full
  std::uint64_t reserved_ = 0;     ///< bytes of the disk that are the file's, used or not
  bool can_reserve_ = true;        ///< the disk's driver knows how
};

}  // namespace wavetank
