#include "wavetank/node/clock_note.h"

#include <XmlRpcValue.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <utility>

namespace wavetank {

ClockNote::ClockNote(std::string parameter) : parameter_(std::move(parameter)), thread_([this] { run(); }) {}

ClockNote::~ClockNote() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void ClockNote::write(double reached) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = reached;
  }
  wake_.notify_all();
}

void ClockNote::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return ending_ || newest_; });
    if (ending_) return;
    XmlRpc::XmlRpcValue request, response, payload;
    request[0] = ros::this_node::getName();
    request[1] = parameter_;
    request[2] = *newest_;
    newest_.reset();
    lock.unlock();
    // not NodeHandle::setParam, which waits for the master for as long as it is away, and holds the lock of all parameters meanwhile
    ros::master::execute("setParam", request, response, payload, false);
    lock.lock();
  }
}

}  // namespace wavetank
