#include "wavetank/node/cloud_publisher.h"

#include <boost/make_shared.hpp>

#include "wavetank/common/stopwatch.h"

namespace wavetank {
namespace {

// What a cloud takes in all over what it takes here: sent, read, packed and sent again to two pages it held steps up for 75 ms, of which 29
// are this node's (test/validation/page_clients.py, 110 550 particles on two cores).
constexpr double with_its_readers = 2.5;

}  // namespace

CloudPublisher::CloudPublisher(ros::NodeHandle& private_handle, const PublishingCase& publishing, const StampClock& clock)
    : publishing_(publishing),
      clock_(clock),
      all_(private_handle.advertise<sensor_msgs::PointCloud2>("particles", 1)),
      surface_(private_handle.advertise<sensor_msgs::PointCloud2>("free_surface", 1)),
      pace_(publishing.cloud_rate) {
  thread_ = std::thread([this] { run(); });
}

CloudPublisher::~CloudPublisher() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

bool CloudPublisher::offer(const Simulation& simulation) {
  const double seconds = with_its_readers * (taking_seconds_ + publishing_seconds_);
  if (!pace_.is_due(seconds)) return false;
  const bool wants_all = all_.getNumSubscribers() > 0;
  const bool wants_surface = surface_.getNumSubscribers() > 0;
  if (!wants_all && !wants_surface) return false;
  pace_.begin(seconds);
  Clouds clouds;
  Stopwatch taking;
  {
    const Stopwatch::Lap lap(taking);
    if (wants_all) clouds.all = simulation.particles();
    if (wants_surface) clouds.surface = wants_all ? surface_of(*clouds.all) : simulation.free_surface();
  }
  taking_seconds_ = taking.seconds();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    latest_ = std::move(clouds);
  }
  wake_.notify_one();
  return true;
}

void CloudPublisher::run() {
  const auto publish = [this](const ros::Publisher& publisher, const std::optional<ParticleCloud>& cloud, CloudFields fields) {
    if (!cloud) return;
    publisher.publish(boost::make_shared<sensor_msgs::PointCloud2>(
        cloud_message(*cloud, fields, publishing_.max_points, publishing_.world_frame, clock_)));
  };
  while (true) {
    Clouds clouds;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || latest_; });
      if (stopping_) return;
      clouds = std::move(*latest_);
      latest_.reset();
    }
    Stopwatch publishing;
    {
      const Stopwatch::Lap lap(publishing);
      publish(all_, clouds.all, CloudFields::all);
      publish(surface_, clouds.surface, CloudFields::surface);
    }
    publishing_seconds_ = publishing.seconds();
  }
}

}  // namespace wavetank
