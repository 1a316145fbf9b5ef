#pragma once

#include <ros/message_traits.h>
#include <rosbag/bag.h>

#include <memory>
#include <string>

#include "wavetank/common/error.h"
#include "wavetank/node/stamps.h"

namespace wavetank {

/// Writes a bag under a temporary name (PATH.active, as rosbag record does) and gives it its own name when it is whole, replacing an older
/// file. An object that is destroyed without finish() leaves nothing behind.
class BagWriter {
 public:
  /// topic_prefix: namespace of the relative topics given to write, "/wavetank"; a topic with a leading slash stays as it is. Throws Error
  /// if the file cannot be made there.
  BagWriter(const std::string& path, std::string topic_prefix);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Throws Error if the file cannot grow (a full disk); the bag is then removed and this object is of no more use.
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    guarded([&] { bag_->write(resolved(topic), nonzero(stamp), message); });
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
    guarded([&] { bag_->write(resolved(topic), nonzero(stamp), message, header); });
  }
  /// Ends the bag and gives it its name. Throws Error as write.
  void finish();
  const std::string& path() const { return path_; }
  bool is_open() const { return bag_ != nullptr; }

 private:
  template <class Action>
  void guarded(Action&& action) {
    if (!bag_) throw Error("bag '" + path_ + "' is closed: no more can be written to it");
    try {
      action();
    } catch (const std::exception& failure) {
      fail(failure.what());
    }
  }
  [[noreturn]] void fail(const std::string& reason);
  void discard();
  std::string resolved(const std::string& topic) const { return topic.rfind('/', 0) == 0 ? topic : prefix_ + topic; }

  std::string path_, active_path_, prefix_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace wavetank
