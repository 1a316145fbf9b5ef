#include "wavetank/node/run_recorder.h"

#include <tf2_msgs/TFMessage.h>

#include "wavetank/node/clouds.h"
#include "wavetank/node/markers.h"

namespace wavetank {
namespace {

constexpr double status_period = 0.01;  ///< s of simulated time
constexpr double rounding = 1e-9;       ///< s, below any instrument's period

}  // namespace

RunRecorder::RunRecorder(const std::string& bag, const std::string& topic_prefix, const Case& scene, const StampClock& clock,
                         RecordedPictures pictures)
    : case_(scene), clock_(clock), bag_(bag, topic_prefix), pictures_(pictures) {
  if (pictures_.surface)
    drawer_ = std::make_unique<SurfaceDrawer>([this](const WaterSurface& surface, const ros::Time& stamp) {
      SurfaceMessages messages = surface_messages(surface, case_.publishing.max_points, case_.publishing.world_frame, stamp);
      const std::lock_guard<std::mutex> lock(mutex_);
      found_.push_back(std::move(messages));
    });
}

void RunRecorder::start(const Simulation& simulation, const std::vector<BodyFrame>& frames) {
  next_status_ = next_cloud_ = next_surface_ = simulation.state().time;
  const ros::Time stamp = clock_.at(simulation.state().time);
  bag_.write_latched("case", stamp, case_message(simulation.scene(), simulation.device_description()));
  bag_.write_latched("markers", stamp, markers(case_, simulation.layout(), frames, false));
  tf2_msgs::TFMessage transforms;
  transforms.transforms = static_transforms(case_, frames);
  bag_.write_latched("/tf_static", stamp, transforms);
}

void RunRecorder::record(const Simulation& simulation, const std::vector<EnergySample>& energies, const RunState& run) {
  SolverState solver = simulation.state();
  const double time = solver.time;
  for (const EnergySample& sample : energies) {
    if (sample.time < next_status_ - rounding) continue;
    next_status_ += status_period;
    solver.time = sample.time;
    bag_.write("status", clock_.at(sample.time), status_message(case_, solver, sample, run, clock_));
  }
  if ((pictures_.clouds || pictures_.particles) && time >= next_cloud_ - rounding) record_cloud(simulation);
  if (!pictures_.surface) return;
  if (is_drawing_ && time >= next_surface_ - rounding) record_surface(simulation);
  write_surfaces();
  check_drawing();
}

void RunRecorder::record_cloud(const Simulation& simulation) {
  next_cloud_ += 1.0 / case_.publishing.cloud_bag_rate;
  const ParticleCloud all = simulation.particles();
  const auto write_cloud = [&](const char* topic, const ParticleCloud& cloud, CloudFields fields) {
    const auto message = cloud_message(cloud, fields, case_.publishing.max_points, case_.publishing.world_frame, clock_);
    bag_.write(topic, message.header.stamp, message);
  };
  if (pictures_.clouds) write_cloud("free_surface", surface_of(all), CloudFields::surface);
  if (pictures_.particles) write_cloud("particles", all, CloudFields::all);
}

void RunRecorder::record_surface(const Simulation& simulation) {
  next_surface_ += 1.0 / case_.publishing.surface_bag_rate;
  drawer_->draw(simulation, clock_.at(simulation.state().time));
}

void RunRecorder::check_drawing() const {
  const std::string failure = drawer_->failure();
  if (!failure.empty()) throw BagError("the water's surface cannot be drawn into bag '" + path() + "': " + failure);
}

void RunRecorder::write_surfaces() {
  std::vector<SurfaceMessages> found;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    found.swap(found_);
  }
  for (const SurfaceMessages& each : found) {
    bag_.write(SurfaceMessages::mesh_topic, each.surface.header.stamp, each.surface);
    bag_.write(SurfaceMessages::mesh_topic, each.spray.header.stamp, each.spray);
    bag_.write(SurfaceMessages::height_topic, each.heights.header.stamp, each.heights);
  }
}

void RunRecorder::finish(const SolverState& solver, const EnergySample& energies, const RunState& run) {
  const std::string missing = missing_surface();
  RunState last = run;
  if (!missing.empty() && last.failure.empty()) {
    last.phase = SolverStatus::FAILED;
    last.failure = missing;
  }
  bag_.write_last("status", clock_.at(solver.time), status_message(case_, solver, energies, last, clock_));
  bag_.finish();
  is_whole_ = true;
  if (!missing.empty()) throw BagError(missing);
}

/// Writes the last surface, and returns why it is not in the bag: a full disk may have no room for it, but for the end of the bag.
std::string RunRecorder::missing_surface() {
  if (!drawer_) return "";
  drawer_->wait();
  try {
    write_surfaces();
    check_drawing();
  } catch (const BagError& error) {
    if (!bag_.is_open()) throw;
    return error.what();
  }
  return "";
}

}  // namespace wavetank
