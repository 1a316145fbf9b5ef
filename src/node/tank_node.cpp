#include "wavetank/node/tank_node.h"

#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "wavetank/common/log.h"
#include "wavetank/node/markers.h"
#include "wavetank/node/resources.h"

namespace wavetank {

namespace {

/// Messages a subscriber may lag behind before samples are lost to it: 20 s at 1 kHz, and of one that never reads some 4 MB a topic.
constexpr std::uint32_t sample_queue = 20000;
constexpr auto clock_period = std::chrono::milliseconds(10);
constexpr auto recorder_pause = std::chrono::milliseconds(500);  ///< between a recorder's first and last subscription

constexpr int exit_refused = 2;  // as wavetank_run for a case that cannot be laid out
constexpr int exit_failed = 3;

}  // namespace

TankNode::TankNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, NodeSetup setup, parallel::Team* team)
    : handle_(handle),
      private_(private_handle),
      setup_(std::move(setup)),
      case_(setup_.scene),
      inputs_(private_, case_, setup_.parameters.external_wrench_timeout),
      clock_due_(Clock::now()),
      diagnostics_(handle_, private_),
      last_tick_(Clock::now()) {
  check_names(case_);
  const NodeParameters& parameters = setup_.parameters;
  if (!parameters.bag.empty())
    recorder_ = std::make_unique<RunRecorder>(parameters.bag, private_.getNamespace(), case_, clock_,
                                              RecordedPictures{parameters.bag_clouds, false, parameters.bag_surface});
  advertise_topics();
  clouds_ = std::make_unique<CloudPublisher>(private_, case_.publishing, clock_);
  if (can_find_surface()) surfaces_ = std::make_unique<SurfacePublisher>(private_, case_.publishing, clock_);
  diagnostics_.setHardwareID(case_.device);
  diagnostics_.add("solver", this, &TankNode::fill_diagnostics);

  SimulationOptions options;
  options.resolve = resolve_resource;
  options.team = team;
  LoopSettings settings;
  settings.restore_from = parameters.restore;
  settings.failure_snapshot = snapshot_path("failure");
  settings.paused = parameters.paused;
  if (parameters.wait_for_subscribers > 0) settings.may_start = [this] { return everything_is_heard(); };
  loop_ = std::make_unique<SolverLoop>(case_, std::move(options), std::move(settings), make_hooks());
  advertise_services();
  timer_ = handle_.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { every_second(); });
}

TankNode::~TankNode() {
  timer_.stop();
  loop_->stop();  // first: a service that is being called ends only then
  services_.clear();
  loop_.reset();
}

void TankNode::stop() { loop_->stop(); }

int TankNode::finish() {
  timer_.stop();
  loop_->stop();
  const LoopStatus status = loop_->status();
  if (status.phase == LoopPhase::failed) return status.has_started || status.is_violation ? exit_failed : exit_refused;
  clock_note_.reset();
  if (case_.publishing.publish_clock) private_.deleteParam(clock_reached);
  return 0;
}

void TankNode::advertise_topics() {
  const auto advertise = [this](const std::string& topic, auto message) {
    sample_publishers_[topic] = private_.advertise<decltype(message)>(topic, sample_queue);
  };
  advertise(SampleMessages::probes_topic, ProbeArray());
  advertise(SampleMessages::gauges_topic, WaveGaugeArray());
  for (const PressureProbeCase& probe : case_.instruments.pressure_probes) advertise(probe_topic(probe.name), sensor_msgs::FluidPressure());
  for (const WaveGaugeCase& gauge : case_.instruments.wave_gauges) advertise(gauge_topic(gauge.name), geometry_msgs::PointStamped());
  for (const VelocityProbeCase& probe : case_.instruments.velocity_probes)
    advertise(velocity_topic(probe.name), geometry_msgs::Vector3Stamped());
  for (const FlowSectionCase& section : case_.instruments.sections) advertise(section_topic(section.name), SectionFlow());
  for (const BodyCase& body : case_.bodies)
    if (body.imu) advertise(imu_topic(body.name), sensor_msgs::Imu());
  bool any_moorings = false;
  const auto advertise_moorings = [&](const std::string& body, const RigidCase& rigid) {
    for (std::size_t m = 0; m < rigid.moorings.size(); ++m) advertise(mooring_topic(body, name_of(rigid, m)), MooringTension());
    any_moorings = any_moorings || !rigid.moorings.empty();
  };
  advertise_moorings(tank_name, case_.tank.rigid);
  for (const BodyCase& body : case_.bodies) advertise_moorings(body.name, body.rigid);
  std::vector<std::string> bodies{tank_name};
  for (const BodyCase& body : case_.bodies) bodies.push_back(body.name);
  for (const std::string& body : bodies)
    for (const char* part : {"", "/pressure", "/viscous"}) advertise(wrench_topic(body) + part, geometry_msgs::WrenchStamped());
  for (const OpeningCase& opening : case_.openings) advertise(flow_topic(opening.name), OpeningFlow());
  std::vector<std::string> moving;
  if (case_.tank.motion != Motion::fixed) moving.push_back(tank_name);
  for (const BodyCase& body : case_.bodies)
    if (body.motion != Motion::fixed) moving.push_back(body.name);
  for (const std::string& body : moving) advertise(odometry_topic(body), nav_msgs::Odometry());
  if (!moving.empty()) moving_transforms_ = std::make_unique<TransformPublisher>(handle_);
  if (std::any_of(case_.joints.begin(), case_.joints.end(), has_position))
    advertise(PoseMessages::joint_states_topic, sensor_msgs::JointState());
  const auto advertise_inertia = [this](std::size_t owner, Motion motion, const std::string& body) {
    if (motion == Motion::free) inertias_[owner] = private_.advertise<geometry_msgs::InertiaStamped>(inertia_topic(body), 1, true);
  };
  advertise_inertia(0, case_.tank.motion, tank_name);
  for (std::size_t b = 0; b < case_.bodies.size(); ++b) advertise_inertia(1 + b, case_.bodies[b].motion, case_.bodies[b].name);
  markers_ = private_.advertise<visualization_msgs::MarkerArray>(SampleMessages::markers_topic, 1, true);
  // Lines that move come beside what is latched, not in its place.
  if (any_moorings) advertise(SampleMessages::markers_topic, visualization_msgs::MarkerArray());
  case_publisher_ = private_.advertise<std_msgs::String>("case", 1, true);
  status_ = private_.advertise<SolverStatus>("status", 10);
  if (case_.publishing.publish_clock) {
    ros_clock_ = handle_.advertise<rosgraph_msgs::Clock>("/clock", 10);
    if (!ros::param::param("/use_sim_time", false))
      log(LogLevel::warning, "this node publishes /clock, but the parameter /use_sim_time is not true: others will not follow it");
    follow_earlier_clock();
    clock_note_ = std::make_unique<ClockNote>(private_.resolveName(clock_reached));
  }
}

void TankNode::advertise_services() {
  const auto trigger = [this](const std::string& name, const std::function<Reply()>& action) {
    services_.push_back(private_.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
        name, [action](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
          const Reply reply = action();
          response.success = reply.success;
          response.message = reply.message;
          return true;
        }));
  };
  trigger("step", [this] { return loop_->step(); });
  trigger("reset", [this] { return loop_->reset(); });
  trigger("save", [this] { return loop_->save([this](const SolverState& state) { return path_to_save(state.time); }); });
  services_.push_back(private_.advertiseService<Advance::Request, Advance::Response>(
      "advance", [this](Advance::Request& request, Advance::Response& response) {
        const Reply reply = loop_->advance_by(request.seconds);
        response.success = reply.success;
        response.message = reply.message;
        response.time = reply.time;
        response.stamp.fromNSec(reply.stamp);
        return true;
      }));
  services_.push_back(private_.advertiseService<std_srvs::SetBool::Request, std_srvs::SetBool::Response>(
      "pause", [this](std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
        const Reply reply = loop_->pause(request.data);
        response.success = reply.success;
        response.message = reply.message;
        return true;
      }));
}

// ---------------------------------------------------------------- called by the solver's thread

LoopHooks TankNode::make_hooks() {
  LoopHooks hooks;
  hooks.started = [this](const Simulation& simulation) { started(simulation); };
  hooks.stepped = [this](const Simulation& simulation, const Samples& samples) { stepped(simulation, samples); };
  hooks.violated = [this] {
    if (recorder_) recorder_->draw_no_more();
  };
  hooks.before_step = [this](Simulation& simulation) { inputs_.apply(simulation); };
  hooks.restarted = [this](const SolverState& last) {
    inputs_.clear();
    if (surfaces_) surfaces_->restart();
    clock_.restart_after(last.time);
    if (recorder_) recorder_->restart();
    log(LogLevel::info, "reset to time 0; stamps and /clock go on without running backwards");
  };
  hooks.stamp = [this](double time) { return clock_.at(time).toNSec(); };
  hooks.idle = [this](const Simulation& simulation) { idle(simulation); };
  hooks.ended = [this](const LoopStatus& status) { ended(status); };
  return hooks;
}

void TankNode::started(const Simulation& simulation) {
  const std::vector<BodyFrame> frames = body_frames(case_, reference_points(simulation.bodies()));
  messages_ = std::make_unique<SampleMessages>(case_, simulation.layout(), frames);
  markers_.publish(markers(case_, simulation.layout(), frames));
  for (const auto& [owner, publisher] : inertias_) publisher.publish(inertia_message(simulation.bodies().properties(owner), frames[owner]));
  case_publisher_.publish(case_message(simulation.scene(), simulation.device_description()));
  const auto transforms = static_transforms(case_, frames);
  if (!transforms.empty()) static_transforms_.sendTransform(transforms);
  if (recorder_) recorder_->start(simulation, frames);
  if (!setup_.parameters.restore.empty()) publish_present_poses(simulation);
  log(LogLevel::info, simulation.summary());
  subscribers_due_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(setup_.parameters.wait_for_subscribers));
}

/// A restored simulation has no sample of poses before it goes on, which it may not do for long: paused, or at its end.
void TankNode::publish_present_poses(const Simulation& simulation) {
  const double time = simulation.state().time;
  publish_clock(time);
  Samples samples;
  samples.poses.push_back(present_poses(simulation.bodies(), time));
  publish_samples(samples);
}

void TankNode::stepped(const Simulation& simulation, const Samples& samples) {
  const double time = simulation.state().time;
  // Before the samples, so that nobody gets one from the future.
  const bool any_published = !samples.pressures.empty() || !samples.levels.empty() || !samples.wrenches.empty() || !samples.poses.empty() ||
                             !samples.flows.empty() || !samples.velocities.empty() || !samples.sections.empty() || !samples.imus.empty() ||
                             !samples.moorings.empty();
  if (any_published || Clock::now() >= clock_due_) publish_clock(time);
  publish_samples(samples);
  if (!recorder_) return;
  LoopStatus status;
  status.phase = LoopPhase::running;
  status.start_progress = 1.0;
  status.device = simulation.device_description();
  recorder_->record(simulation, samples.energies, run_state(status));
}

void TankNode::publish_samples(const Samples& samples) {
  messages_->emit(samples, clock_,
                  [this](const std::string& topic, const ros::Time& stamp, const auto& message) { publish_sample(topic, stamp, message); });
}

void TankNode::send(const std::string&, const tf2_msgs::TFMessage& message) { moving_transforms_->publish(message); }

template <class Message>
void TankNode::send(const std::string& topic, const Message& message) {
  sample_publishers_.at(topic).publish(message);
}

template <class Message>
void TankNode::publish_sample(const std::string& topic, const ros::Time& stamp, const Message& message) {
  send(topic, message);
  if (recorder_) recorder_->write(topic, stamp, message);
}

void TankNode::idle(const Simulation& simulation) {
  const double time = simulation.state().time;
  if (Clock::now() >= clock_due_) publish_clock(time);
  const bool took_cloud = clouds_->offer(simulation);
  const bool took_surface = surfaces_ && surfaces_->offer(simulation);
  // A cloud is of any time, samples of poses are not; where the simulation stands, the cloud's would be too late to be placed in the world.
  if ((took_cloud || took_surface) && case_.tank.motion != Motion::fixed)
    moving_transforms_->publish_between_samples(messages_->poses().transforms(present_poses(simulation.bodies(), time), clock_));
}

void TankNode::publish_clock(double time) {
  if (!case_.publishing.publish_clock) return;
  clock_due_ = Clock::now() + clock_period;
  rosgraph_msgs::Clock message;
  message.clock = nonzero(clock_.at(time));
  ros_clock_.publish(message);
}

/// A node that is started again (respawn) after it failed must not turn the clock back for those that followed it.
void TankNode::follow_earlier_clock() {
  double reached = 0;
  if (!private_.getParam(clock_reached, reached) || !(reached > 0)) return;
  clock_.restart_after(reached);
  log(LogLevel::info, "an earlier run's /clock goes on: the simulation starts at " + std::to_string(clock_.at(0).sec) + " s of it");
}

void TankNode::note_clock(const LoopStatus& status) {
  if (!case_.publishing.publish_clock) return;
  // until the next note comes the clock may go on as fast as it just did, and a little faster
  const double next_second = 2.0 * real_time_factor_ + 1.0;
  clock_note_->write(clock_.at(status.solver.time).toSec() + next_second);
}

bool TankNode::everything_is_heard() {
  const auto is_heard = [this](const std::string& topic, bool has_instruments) {
    return !has_instruments || sample_publishers_.at(topic).getNumSubscribers() > 0;
  };
  if (!all_heard_ && is_heard(SampleMessages::probes_topic, !case_.instruments.pressure_probes.empty()) &&
      is_heard(SampleMessages::gauges_topic, !case_.instruments.wave_gauges.empty())) {
    all_heard_ = true;
    subscribers_due_ = std::min(subscribers_due_, Clock::now() + recorder_pause);
  }
  return Clock::now() >= subscribers_due_;
}

void TankNode::ended(const LoopStatus& status) {
  if (!recorder_ || !recorder_->is_open()) return;
  if (!messages_) {  // it never started
    recorder_.reset();
    return;
  }
  recorder_->finish(status.solver, status.energies, run_state(status));
  log(LogLevel::info, "wrote '" + std::filesystem::absolute(recorder_->path()).string() + "'");
}

}  // namespace wavetank
