#pragma once

#include <geometry_msgs/InertiaStamped.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/FluidPressure.h>
#include <sensor_msgs/Imu.h>
#include <std_msgs/String.h>
#include <visualization_msgs/MarkerArray.h>
#include <wavetank/MooringTension.h>
#include <wavetank/OpeningFlow.h>
#include <wavetank/ProbeArray.h>
#include <wavetank/SectionFlow.h>
#include <wavetank/SolverStatus.h>
#include <wavetank/WaveGaugeArray.h>

#include <string>
#include <vector>

#include "wavetank/geometry/layout.h"
#include "wavetank/instruments/samples.h"
#include "wavetank/node/pose_messages.h"
#include "wavetank/node/stamps.h"
#include "wavetank/scene/names.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Turns the instruments' samples into messages, for a live node and for a bag alike. Free of the ROS graph.
class SampleMessages {
 public:
  /// Of what part of the fluid's action on a body a wrench message tells.
  enum class Part { total, pressure, viscous };

  /// Throws Error if two instruments or bodies would share a topic.
  SampleMessages(const Case& checked, const Layout& layout, const std::vector<BodyFrame>& frames);

  ProbeArray probes(const PressureSample& sample, const StampClock& clock) const;
  /// Of one probe, in its own frame, with the case's reference pressure added. Pa.
  sensor_msgs::FluidPressure probe(std::size_t index, const PressureSample& sample, const StampClock& clock) const;
  WaveGaugeArray gauges(const LevelSample& sample, const StampClock& clock) const;
  /// Of one gauge: the place of the surface on its line.
  geometry_msgs::PointStamped gauge(std::size_t index, const LevelSample& sample, const StampClock& clock) const;
  /// Of one velocity probe, m/s in the tank's axes; NaN where it is dry.
  geometry_msgs::Vector3Stamped velocity(std::size_t index, const VelocitySample& sample, const StampClock& clock) const;
  SectionFlow section(std::size_t index, const SectionSample& sample, const StampClock& clock) const;
  /// Of the case's inertial measurement unit `index`, as REP 145 has it: its covariances are not known.
  sensor_msgs::Imu imu(std::size_t index, const ImuSample& sample, const StampClock& clock) const;
  /// Of mooring `index`, of the tank and then of the bodies.
  MooringTension mooring(std::size_t index, const MooringSample& sample, const StampClock& clock) const;
  /// The moorings' lines.
  visualization_msgs::MarkerArray mooring_markers(const MooringSample& sample, const StampClock& clock) const;
  /// On body `index` (0 the tank), in its frame and about that frame's origin.
  geometry_msgs::WrenchStamped wrench(std::size_t index, Part part, const WrenchSample& sample, const StampClock& clock) const;

  /// Of opening `index`.
  OpeningFlow flow(std::size_t index, const FlowSample& sample, const StampClock& clock) const;

  const PoseMessages& poses() const { return poses_; }

  /// Calls sink(topic, stamp, message) for every message of the samples, each exactly once and in order of time on its topic.
  template <class Sink>
  void emit(const Samples& samples, const StampClock& clock, Sink&& sink) const {
    const auto pass = [&sink](const std::string& topic, const auto& message) { sink(topic, message.header.stamp, message); };
    for (const PoseSample& sample : samples.poses) poses_.emit(sample, clock, sink);
    for (const PressureSample& sample : samples.pressures) {
      pass(probes_topic, probes(sample, clock));
      for (std::size_t i = 0; i < probe_topics_.size(); ++i) pass(probe_topics_[i], probe(i, sample, clock));
    }
    for (const LevelSample& sample : samples.levels) {
      pass(gauges_topic, gauges(sample, clock));
      for (std::size_t i = 0; i < gauge_topics_.size(); ++i) pass(gauge_topics_[i], gauge(i, sample, clock));
    }
    for (const VelocitySample& sample : samples.velocities)
      for (std::size_t i = 0; i < velocity_topics_.size(); ++i) pass(velocity_topics_[i], velocity(i, sample, clock));
    for (const SectionSample& sample : samples.sections)
      for (std::size_t i = 0; i < section_topics_.size(); ++i) pass(section_topics_[i], section(i, sample, clock));
    for (const ImuSample& sample : samples.imus)
      for (std::size_t i = 0; i < imu_topics_.size(); ++i) pass(imu_topics_[i], imu(i, sample, clock));
    for (const MooringSample& sample : samples.moorings) {
      for (std::size_t i = 0; i < mooring_topics_.size(); ++i) pass(mooring_topics_[i], mooring(i, sample, clock));
      if (are_drawn(sample)) sink(markers_topic, clock.at(sample.time), mooring_markers(sample, clock));
    }
    for (const FlowSample& sample : samples.flows)
      for (std::size_t i = 0; i < flow_topics_.size(); ++i) pass(flow_topics_[i], flow(i, sample, clock));
    for (const WrenchSample& sample : samples.wrenches) {
      for (std::size_t i = 0; i < sample.wrenches.size(); ++i) {
        pass(wrench_topics_[i], wrench(i, Part::total, sample, clock));
        pass(wrench_topics_[i] + "/pressure", wrench(i, Part::pressure, sample, clock));
        pass(wrench_topics_[i] + "/viscous", wrench(i, Part::viscous, sample, clock));
      }
    }
  }

  static inline const std::string probes_topic = "probes";
  static inline const std::string gauges_topic = "gauges";
  static inline const std::string markers_topic = "markers";

 private:
  PublishingCase publishing_;
  ProbeArray probes_;      ///< names and positions filled in
  WaveGaugeArray gauges_;  ///< likewise
  std::vector<std::string> probe_topics_, probe_frames_;
  /// Whether moorings are drawn at this sample: about twenty times a second.
  bool are_drawn(const MooringSample& sample) const;

  std::vector<std::string> gauge_topics_, velocity_topics_, section_topics_, imu_topics_, imu_frames_;
  int gauge_axis_ = 2;  ///< along which levels are
  std::vector<std::string> mooring_topics_, mooring_frames_;
  double mooring_rate_ = 0;  ///< Hz
  double line_width_ = 0;    ///< m, of what is drawn
  std::vector<std::string> wrench_topics_, flow_topics_;
  std::vector<BodyFrame> frames_;
  PoseMessages poses_;
};

/// Tank → every probe and every body that does not move, and body → its inertial measurement unit; with stamp 0, as static transforms have.
std::vector<geometry_msgs::TransformStamped> static_transforms(const Case& checked, const std::vector<BodyFrame>& frames);

/// What is known of a run besides the solver's own state.
struct RunState {
  std::uint8_t phase = SolverStatus::STARTING;
  bool paused = false;
  double start_progress = 0;  ///< 0…1
  double real_time_factor = 0;
  double steps_per_second = 0;
  std::string device;
  std::string failure;
};

SolverStatus status_message(const Case& checked, const SolverState& solver, const EnergySample& energies, const RunState& run,
                            const StampClock& clock);

/// How heavy a free body is: mass (2-D: of a metre of width), its centre in the body's frame, and the inertia about that (2-D: only yy);
/// for controllers. Without a stamp: it holds throughout.
geometry_msgs::InertiaStamped inertia_message(const MassProperties& properties, const BodyFrame& frame);

/// What a bag needs to be understood and its run to be repeated: version and device as comments, then the whole case as YAML.
std_msgs::String case_message(const Case& checked, const std::string& device);

}  // namespace wavetank
