#include "wavetank/node/run_recorder.h"

#include <tf2_msgs/TFMessage.h>

#include "wavetank/node/clouds.h"
#include "wavetank/node/markers.h"

namespace wavetank {
namespace {

constexpr double status_period = 0.01;  ///< s of simulated time
constexpr double rounding = 1e-9;       ///< s, below any instrument's period

}  // namespace

RunRecorder::RunRecorder(const std::string& bag, const std::string& topic_prefix, const Case& scene, const StampClock& clock, bool clouds,
                         bool particles)
    : case_(scene), clock_(clock), bag_(bag, topic_prefix), clouds_(clouds), particles_(particles) {}

void RunRecorder::start(const Simulation& simulation, const std::vector<BodyFrame>& frames) {
  next_status_ = next_cloud_ = simulation.state().time;
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
  if (!(clouds_ || particles_) || time < next_cloud_ - rounding) return;
  next_cloud_ += 1.0 / case_.publishing.cloud_bag_rate;
  const ParticleCloud all = simulation.particles();
  const auto write_cloud = [&](const char* topic, const ParticleCloud& cloud, CloudFields fields) {
    const auto message = cloud_message(cloud, fields, case_.publishing.max_points, case_.publishing.world_frame, clock_);
    bag_.write(topic, message.header.stamp, message);
  };
  if (clouds_) write_cloud("free_surface", surface_of(all), CloudFields::surface);
  if (particles_) write_cloud("particles", all, CloudFields::all);
}

void RunRecorder::finish(const SolverState& solver, const EnergySample& energies, const RunState& run) {
  bag_.write_last("status", clock_.at(solver.time), status_message(case_, solver, energies, run, clock_));
  bag_.finish();
}

}  // namespace wavetank
