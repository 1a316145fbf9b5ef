#include "wavetank/node/messages.h"

#include <Eigen/Geometry>
#include <algorithm>

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
  }
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
    const BodyFrame& frame = frames[owner_of(checked, probe)];
    transforms.push_back(translation(frame.name, probe_frame(publishing, probe.name), probe.position - frame.origin));
  }
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (!frames[i].moves) transforms.push_back(translation(frames[i].parent, frames[i].name, frames[i].origin));
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
