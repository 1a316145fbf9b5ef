#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <wavetank/Advance.h>

#include <atomic>
#include <map>
#include <memory>
#include <string>

#include "wavetank/node/body_inputs.h"
#include "wavetank/node/clock_note.h"
#include "wavetank/node/cloud_publisher.h"
#include "wavetank/node/messages.h"
#include "wavetank/node/parameters.h"
#include "wavetank/node/run_recorder.h"
#include "wavetank/node/solver_loop.h"
#include "wavetank/node/surface_publisher.h"
#include "wavetank/node/transform_publisher.h"

namespace wavetank {

/// The live node: a case's simulation with its topics, services, transforms and diagnostics (docs/topics.md).
/// Callbacks may come from several threads; messages of samples are published by the solver's thread, in order.
class TankNode {
 public:
  /// Throws Error if the bag cannot be made or two instruments share a topic. The simulation starts in its own thread meanwhile.
  /// `team`: as SimulationOptions has it.
  TankNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, NodeSetup setup, parallel::Team* team = nullptr);
  ~TankNode();

  /// Whether the process should end: when it cannot start, some seconds after a failure, or at the end of the duration if so asked.
  bool wants_to_exit() const { return wants_to_exit_; }
  /// Stops the simulation and answers whoever waits for it; to be called before the threads of callbacks are waited for.
  void stop();
  /// Stops the simulation and closes the bag; the exit code of the process: 0, 2 if the case could not be laid out or its snapshot not be
  /// restored, or 3 after a failure of the simulation or of the bag.
  int finish();

 private:
  using Clock = std::chrono::steady_clock;
  void advertise_topics();
  void advertise_services();
  LoopHooks make_hooks();
  void started(const Simulation& simulation);
  void publish_present_poses(const Simulation& simulation);
  void stepped(const Simulation& simulation, const Samples& samples);
  void idle(const Simulation& simulation);
  void ended(const LoopStatus& status);
  void publish_samples(const Samples& samples);
  template <class Message>
  void publish_sample(const std::string& topic, const ros::Time& stamp, const Message& message);
  void send(const std::string& topic, const tf2_msgs::TFMessage& message);
  template <class Message>
  void send(const std::string& topic, const Message& message);
  void publish_clock(double time);
  void follow_earlier_clock();
  void note_clock(const LoopStatus& status);
  bool everything_is_heard();
  std::string snapshot_path(const std::string& what) const;
  std::string path_to_save(double time);
  void every_second();
  void measure_rates(const LoopStatus& status);
  void fill_diagnostics(diagnostic_updater::DiagnosticStatusWrapper& report);
  RunState run_state(const LoopStatus& status) const;
  void decide_about_exit(const LoopStatus& status);

  ros::NodeHandle handle_, private_;
  NodeSetup setup_;
  Case case_;
  StampClock clock_;
  std::unique_ptr<SampleMessages> messages_;  ///< of the solver's thread, once started
  std::map<std::string, ros::Publisher> sample_publishers_;
  std::map<std::size_t, ros::Publisher> inertias_;  ///< of the free, by owner: 0 the tank, 1 + i body i
  ros::Publisher markers_, case_publisher_, status_, ros_clock_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  std::unique_ptr<TransformPublisher> moving_transforms_;  ///< none where nothing moves
  BodyInputs inputs_;
  std::vector<ros::ServiceServer> services_;
  std::unique_ptr<ClockNote> clock_note_;  ///< where /clock is published
  std::unique_ptr<RunRecorder> recorder_;
  std::map<std::string, std::string> saved_;  ///< paths that ~save has written, by those that it would have liked
  Clock::time_point clock_due_;
  Clock::time_point subscribers_due_;  ///< when the first step is taken at the latest
  bool all_heard_ = false;
  std::unique_ptr<CloudPublisher> clouds_;
  std::unique_ptr<SurfacePublisher> surfaces_;  ///< none where none can be found

  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer timer_;
  std::atomic<double> real_time_factor_{0.0}, steps_per_second_{0.0};
  double last_time_ = 0;
  std::uint64_t last_step_ = 0;
  Clock::time_point last_tick_;
  int seconds_since_end_ = 0;
  std::atomic<bool> wants_to_exit_{false};

  std::unique_ptr<SolverLoop> loop_;  ///< last: its thread uses all of the above
};

}  // namespace wavetank
