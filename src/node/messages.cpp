#include "wavetank/node/messages.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "wavetank/common/version.h"
#include "wavetank/node/geometry_messages.h"
#include "wavetank/scene/case_reader.h"

namespace wavetank {

namespace {

geometry_msgs::TransformStamped translation(const std::string& parent, const std::string& child, const Vector3d& to) {
  geometry_msgs::TransformStamped transform;
  transform.header.frame_id = parent;
  transform.child_frame_id = child;
  transform.transform.translation = vector_message(to);
  transform.transform.rotation.w = 1.0;
  return transform;
}

}  // namespace

SampleMessages::SampleMessages(const Case& checked, const Layout& layout, const std::vector<BodyFrame>& frames)
    : publishing_(checked.publishing), frames_(frames), poses_(checked, frames) {
  check_names(checked);
  probes_.header.frame_id = gauges_.header.frame_id = publishing_.world_frame;
  for (const PressureProbeCase& probe : checked.instruments.pressure_probes) {
    probes_.names.push_back(probe.name);
    probes_.positions.push_back(point_message(probe.position));
    probe_topics_.push_back(probe_topic(probe.name));
    probe_frames_.push_back(probe_frame(publishing_, probe.name));
  }
  for (const WaveGaugeCase& gauge : checked.instruments.wave_gauges) {
    gauges_.names.push_back(gauge.name);
    const Top top = top_of(checked);
    Vector3d foot = gauge.position;
    foot[top.axis] = top.bottom_of(layout.domain);
    gauges_.positions.push_back(point_message(foot));
    gauge_topics_.push_back(gauge_topic(gauge.name));
    gauge_axis_ = top.axis;
  }
  for (const VelocityProbeCase& probe : checked.instruments.velocity_probes) velocity_topics_.push_back(velocity_topic(probe.name));
  for (const FlowSectionCase& section : checked.instruments.sections) section_topics_.push_back(section_topic(section.name));
  for (const BodyCase& body : checked.bodies) {
    if (!body.imu) continue;
    imu_topics_.push_back(imu_topic(body.name));
    imu_frames_.push_back(imu_frame(publishing_, body.name));
  }
  const auto add_moorings = [&](const std::string& body, const RigidCase& rigid, const BodyFrame& frame) {
    for (std::size_t m = 0; m < rigid.moorings.size(); ++m) {
      mooring_topics_.push_back(mooring_topic(body, name_of(rigid, m)));
      mooring_frames_.push_back(frame.name);
    }
  };
  add_moorings(tank_name, checked.tank.rigid, frames_[0]);
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) add_moorings(checked.bodies[b].name, checked.bodies[b].rigid, frames_[1 + b]);
  mooring_rate_ = checked.instruments.pose_rate.value_or(std::min(checked.instruments.rate, 100.0));
  line_width_ = 0.002 * (layout.domain.max - layout.domain.min).norm();
  for (const OpeningCase& opening : checked.openings) flow_topics_.push_back(flow_topic(opening.name));
  wrench_topics_.push_back(wrench_topic(tank_name));
  for (const BodyCase& body : checked.bodies) wrench_topics_.push_back(wrench_topic(body.name));
}

ProbeArray SampleMessages::probes(const PressureSample& sample, const StampClock& clock) const {
  ProbeArray message = probes_;
  message.header.stamp = clock.at(sample.time);
  message.pressures = sample.pressures;
  return message;
}

sensor_msgs::FluidPressure SampleMessages::probe(std::size_t index, const PressureSample& sample, const StampClock& clock) const {
  sensor_msgs::FluidPressure message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = probe_frames_[index];
  message.fluid_pressure = sample.pressures[index] + publishing_.reference_pressure;
  return message;
}

WaveGaugeArray SampleMessages::gauges(const LevelSample& sample, const StampClock& clock) const {
  WaveGaugeArray message = gauges_;
  message.header.stamp = clock.at(sample.time);
  message.levels = sample.levels;
  return message;
}

geometry_msgs::PointStamped SampleMessages::gauge(std::size_t index, const LevelSample& sample, const StampClock& clock) const {
  geometry_msgs::PointStamped message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = publishing_.world_frame;
  message.point = gauges_.positions[index];
  double& level = gauge_axis_ == 0 ? message.point.x : gauge_axis_ == 1 ? message.point.y : message.point.z;
  level = sample.levels[index];
  return message;
}

geometry_msgs::Vector3Stamped SampleMessages::velocity(std::size_t index, const VelocitySample& sample, const StampClock& clock) const {
  geometry_msgs::Vector3Stamped message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = publishing_.world_frame;
  message.vector = vector_message(sample.velocities[index]);
  return message;
}

SectionFlow SampleMessages::section(std::size_t index, const SectionSample& sample, const StampClock& clock) const {
  SectionFlow message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = publishing_.world_frame;
  message.discharge = sample.flows[index].discharge;
  message.area = sample.flows[index].area;
  return message;
}

sensor_msgs::Imu SampleMessages::imu(std::size_t index, const ImuSample& sample, const StampClock& clock) const {
  const ImuReading& reading = sample.readings[index];
  sensor_msgs::Imu message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = imu_frames_[index];
  message.orientation = quaternion_message(reading.orientation);
  message.angular_velocity = vector_message(reading.angular_velocity);
  message.linear_acceleration = vector_message(reading.specific_force);
  return message;
}

MooringTension SampleMessages::mooring(std::size_t index, const MooringSample& sample, const StampClock& clock) const {
  const MooringState& state = sample.moorings[index];
  MooringTension message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = mooring_frames_[index];
  message.tension = state.tension;
  message.anchor_tension = state.anchor_tension;
  message.lying = state.lying;
  return message;
}

bool SampleMessages::are_drawn(const MooringSample& sample) const {
  constexpr double drawings = 20;  // a second of simulated time
  const auto every = std::max(1LL, std::llround(mooring_rate_ / drawings));
  return std::llround(sample.time * mooring_rate_) % every == 0;
}

visualization_msgs::MarkerArray SampleMessages::mooring_markers(const MooringSample& sample, const StampClock& clock) const {
  visualization_msgs::MarkerArray drawing;
  for (const MooringState& mooring : sample.moorings) {
    visualization_msgs::Marker line;
    line.header.stamp = clock.at(sample.time);
    line.header.frame_id = publishing_.world_frame;
    line.ns = "moorings";
    line.id = static_cast<int>(drawing.markers.size());
    line.type = visualization_msgs::Marker::LINE_STRIP;
    line.pose.orientation.w = 1.0;
    line.scale.x = line_width_;
    line.color.r = line.color.g = 0.85F;
    line.color.b = 0.3F;
    line.color.a = 1.0F;
    line.frame_locked = true;
    for (const Vector3d& place : mooring.line) line.points.push_back(point_message(place));
    drawing.markers.push_back(line);
  }
  return drawing;
}

OpeningFlow SampleMessages::flow(std::size_t index, const FlowSample& sample, const StampClock& clock) const {
  OpeningFlow message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = publishing_.world_frame;
  message.discharge = sample.flows[index].discharge;
  message.volume = sample.flows[index].volume;
  return message;
}

geometry_msgs::WrenchStamped SampleMessages::wrench(std::size_t index, Part part, const WrenchSample& sample,
                                                    const StampClock& clock) const {
  const Wrench& wrench = sample.wrenches[index];
  Vector3d force = Vector3d::Zero();
  Vector3d torque = Vector3d::Zero();
  if (part != Part::viscous) {
    force += wrench.pressure_force;
    torque += wrench.pressure_torque;
  }
  if (part != Part::pressure) {
    force += wrench.viscous_force;
    torque += wrench.viscous_torque;
  }
  const BodyFrame& frame = frames_[index];
  torque += (frame.reference - frame.origin).cross(force);  // a free tank's is about its centre of mass, not its frame's origin
  geometry_msgs::WrenchStamped message;
  message.header.stamp = clock.at(sample.time);
  message.header.frame_id = frame.name;
  message.wrench.force = vector_message(force);
  message.wrench.torque = vector_message(torque);
  return message;
}

std::vector<geometry_msgs::TransformStamped> static_transforms(const Case& checked, const std::vector<BodyFrame>& frames) {
  const PublishingCase& publishing = checked.publishing;
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const PressureProbeCase& probe : checked.instruments.pressure_probes) {
    const BodyFrame& frame = frames[owner_of(checked, probe.body)];
    transforms.push_back(translation(frame.name, probe_frame(publishing, probe.name), probe.position - frame.origin));
  }
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (!frames[i].moves) transforms.push_back(translation(frames[i].parent, frames[i].name, frames[i].origin));
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) {
    const BodyCase& body = checked.bodies[b];
    if (!body.imu) continue;
    const Vector3d place = body.imu->position ? Vector3d(*body.imu->position - frames[1 + b].origin) : Vector3d(Vector3d::Zero());
    transforms.push_back(translation(frames[1 + b].name, imu_frame(publishing, body.name), place));
  }
  return transforms;
}

SolverStatus status_message(const Case& checked, const SolverState& solver, const EnergySample& energies, const RunState& run,
                            const StampClock& clock) {
  SolverStatus message;
  message.header.stamp = clock.at(solver.time);
  message.header.frame_id = checked.publishing.world_frame;
  message.title = checked.title;
  message.device = run.device;
  message.phase = run.phase;
  message.paused = run.paused;
  message.start_progress = run.start_progress;
  message.failure = run.failure;
  message.time = solver.time;
  message.duration = checked.duration;
  message.step = solver.step;
  message.time_step = solver.time_step;
  message.particles = solver.particles;
  message.mass = energies.mass;
  message.kinetic_energy = energies.kinetic;
  message.potential_energy = energies.potential;
  message.compression_energy = energies.compression;
  message.damper_power = energies.damper_power;
  message.greatest_speed = solver.greatest_speed;
  message.real_time_factor = run.real_time_factor;
  message.steps_per_second = run.steps_per_second;
  message.guard_hits = solver.guard_hits;
  message.shepard_bounded = solver.shepard_bounded;
  message.fits_of_first_order = solver.fits_of_first_order;
  message.fits_below_first_order = solver.fits_below_first_order;
  message.parts = static_cast<std::uint32_t>(solver.parts);
  message.imbalance = solver.imbalance;
  message.cuts = solver.cuts;
  message.exchange_share = solver.exchange_share;
  return message;
}

geometry_msgs::InertiaStamped inertia_message(const MassProperties& properties, const BodyFrame& frame) {
  geometry_msgs::InertiaStamped message;
  message.header.frame_id = frame.name;
  message.inertia.m = properties.mass;
  message.inertia.com = vector_message(properties.centre - frame.origin);
  const Eigen::Matrix3d& inertia = properties.inertia;
  message.inertia.ixx = inertia(0, 0);
  message.inertia.ixy = inertia(0, 1);
  message.inertia.ixz = inertia(0, 2);
  message.inertia.iyy = inertia(1, 1);
  message.inertia.iyz = inertia(1, 2);
  message.inertia.izz = inertia(2, 2);
  return message;
}

std_msgs::String case_message(const Case& checked, const std::string& device) {
  std::string comment = device;
  std::replace(comment.begin(), comment.end(), '\n', ' ');
  std_msgs::String message;
  message.data = "# wavetank " + std::string(version()) + "\n# device: " + comment + "\n" + write_case(checked);
  return message;
}

}  // namespace wavetank
