#include "wavetank/instruments/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "wavetank/common/error.h"
#include "wavetank/instruments/filled.h"

namespace wavetank {

namespace {

constexpr std::size_t state_size = 19, joint_size = 3, imu_size = 13;
constexpr double least_wet = 0.5;  // of the kernel that walls leave: less is filled only over the free surface
const Vector3d none = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

double rate_of_poses(const Case& scene) { return scene.instruments.pose_rate.value_or(std::min(scene.instruments.rate, 100.0)); }

std::vector<double> values_of(const RigidWorld& world) {
  std::vector<double> values;
  const auto add = [&values](const auto& vector) { values.insert(values.end(), vector.data(), vector.data() + vector.size()); };
  for (std::size_t o = 0; o < world.count(); ++o) {
    const RigidState state = o == 0 ? world.state(0) : world.state_in_tank(o);
    add(state.position);
    add(state.orientation.coeffs());
    for (const Vector3d& vector : {state.velocity, state.angular_velocity, state.acceleration, state.angular_acceleration}) add(vector);
  }
  for (std::size_t j = 0; j < world.joint_count(); ++j) {
    const JointState joint = world.joint_state(j);
    for (const double value : {joint.position, joint.velocity, joint.effort}) values.push_back(value);
  }
  return values;
}

PoseSample pose_sample(double time, const std::vector<double>& values, std::size_t owners) {
  PoseSample sample;
  sample.time = time;
  for (std::size_t o = 0; o < owners; ++o) {
    const double* v = values.data() + o * state_size;
    RigidState state;
    state.position = Vector3d(v);
    state.orientation = Quaterniond(v + 3).normalized();  // interpolated within a step, in which it hardly turns
    state.velocity = Vector3d(v + 7);
    state.angular_velocity = Vector3d(v + 10);
    state.acceleration = Vector3d(v + 13);
    state.angular_acceleration = Vector3d(v + 16);
    sample.states.push_back(state);
  }
  for (std::size_t k = owners * state_size; k + joint_size <= values.size(); k += joint_size)
    sample.joints.push_back({values[k], values[k + 1], values[k + 2]});
  return sample;
}

/// Points of a sensor's disc whose plain mean is that over the disc, exact for pressures up to the third degree: two rings of six, whose
/// squared radii are Gauss's points. In 2-D Chebyshev's three of a strip.
std::vector<Vector3d> points_of_disc(const PressureProbeCase& probe, const Vector3d& normal, int dimensions) {
  const double radius = 0.5 * probe.diameter;
  if (dimensions == 2) {
    const Vector3d along = std::sqrt(0.5) * radius * normal.cross(Vector3d::UnitY());
    return {probe.position - along, probe.position, probe.position + along};
  }
  const Vector3d a = normal.unitOrthogonal(), b = normal.cross(a);
  std::vector<Vector3d> points;
  for (int ring = 0; ring < 2; ++ring) {
    const double distance = radius * std::sqrt(0.5 + (ring == 0 ? -0.5 : 0.5) / std::sqrt(3.0));
    for (int k = 0; k < 6; ++k) {
      const double angle = std::acos(-1.0) / 3 * (k + 0.5 * ring);
      points.push_back(probe.position + distance * (std::cos(angle) * a + std::sin(angle) * b));
    }
  }
  return points;
}

}  // namespace

Recorder::Recorder(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world,
                   std::function<std::vector<WallWrench>(Solver&)> wrenches, std::function<std::vector<FlowAtOpening>()> flows)
    : world_(world), gravity_(scene.gravity), wrenches_(std::move(wrenches)), flows_(std::move(flows)) {
  add_pressures(scene, layout, solver);
  add_levels(scene, layout, solver);
  add_wrenches(scene);
  add_energies(scene);
  add_poses(scene);
  add_flows(scene);
  add_velocities(scene, solver);
  add_sections(scene, layout, solver);
  add_imus(scene);
  add_moorings(scene);
}

std::size_t Recorder::rider_of(const Case& scene, const std::string& body) const {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (scene.bodies[b].name == body && world_.moves(1 + b)) return 1 + b;
  return 0;
}

std::vector<PointValue> Recorder::evaluate(const Points& points, Solver& solver) const {
  const auto rides = [](std::size_t owner) { return owner != 0; };
  if (std::any_of(points.owners.begin(), points.owners.end(), rides)) {
    std::vector<Vector3d> places = points.places;
    for (std::size_t k = 0; k < places.size(); ++k)
      if (const std::size_t owner = points.owners[k]; owner != 0)
        places[k] = world_.state_in_tank(owner).moved(places[k], world_.reference(owner));
    points.set->set(places);
  }
  return solver.evaluate(*points.set);
}

void Recorder::add_pressures(const Case& scene, const Layout& layout, const Solver& solver) {
  for (std::size_t k = 0; k < scene.instruments.pressure_probes.size(); ++k) {
    const PressureProbeCase& probe = scene.instruments.pressure_probes[k];
    const std::vector<Vector3d> points =
        probe.diameter > 0 ? points_of_disc(probe, layout.disc_normals.at(k), scene.dimensions) : std::vector<Vector3d>{probe.position};
    probe_points_.push_back(points.size());
    probes_.places.insert(probes_.places.end(), points.begin(), points.end());
    probes_.owners.insert(probes_.owners.end(), points.size(), rider_of(scene, probe.body));
  }
  probes_.set = solver.make_points(probes_.places);
  const bool any = !probes_.places.empty();
  instruments_.push_back({SampleClock(scene.instruments.rate),
                          [this, any](Solver& fluid) {
                            Values pressures;
                            if (!any) return pressures;
                            const std::vector<PointValue> values = evaluate(probes_, fluid);
                            auto next = values.begin();
                            for (const std::size_t points : probe_points_) {
                              double sum = 0;
                              for (std::size_t k = 0; k < points; ++k) sum += (next++)->pressure;
                              pressures.push_back(sum / static_cast<double>(points));
                            }
                            return pressures;
                          },
                          [this](double time, const Values& values) {
                            samples_.pressures.push_back({time, values});
                          }});
}

void Recorder::add_levels(const Case& scene, const Layout& layout, const Solver& solver) {
  gauges_ = std::make_shared<WaveGauges>(scene, layout, solver, world_);
  instruments_.push_back({SampleClock(scene.instruments.gauge_rate.value_or(scene.instruments.rate)),
                          [this](Solver& fluid) { return gauges_->read(fluid); },
                          [this](double time, const Values& values) {
                            samples_.levels.push_back({time, values});
                          }});
}

void Recorder::add_wrenches(const Case& scene) {
  instruments_.push_back({SampleClock(scene.instruments.wrench_rate.value_or(scene.instruments.rate)),
                          [this](Solver& fluid) {
                            Values values;
                            const std::vector<WallWrench> wrenches = wrenches_(fluid);
                            for (std::size_t o = 0; o < wrenches.size(); ++o) {
                              const Quaterniond back =
                                  o == 0 || !world_.moves(o) ? Quaterniond::Identity() : world_.state_in_tank(o).orientation.conjugate();
                              for (const Vector3d& part : wrenches[o]) {
                                const Vector3d own = back * part;
                                values.insert(values.end(), own.data(), own.data() + 3);
                              }
                            }
                            return values;
                          },
                          [this](double time, const Values& values) {
                            WrenchSample sample;
                            sample.time = time;
                            for (std::size_t k = 0; k + 12 <= values.size(); k += 12) {
                              const auto part = [&](std::size_t index) {
                                return Vector3d(values[k + 3 * index], values[k + 3 * index + 1], values[k + 3 * index + 2]);
                              };
                              sample.wrenches.push_back({part(0), part(1), part(2), part(3)});
                            }
                            samples_.wrenches.push_back(std::move(sample));
                          }});
}

EnergySample Recorder::energies(Solver& fluid, double time) const {
  const FluidEnergies found = fluid.energies();
  double potential = found.potential;
  if (world_.moves(0)) {
    const RigidState tank = world_.state(0);
    const Vector3d centre = tank.moved(found.mass_centre, world_.reference(0));
    potential -= found.mass * gravity_.dot(centre - found.mass_centre);
  }
  return {time, found.kinetic, potential, found.compression, found.mass, found.damper_power};
}

void Recorder::add_energies(const Case& scene) {
  instruments_.push_back({SampleClock(scene.instruments.energy_rate.value_or(scene.instruments.rate)),
                          [this](Solver& fluid) {
                            const EnergySample energies = this->energies(fluid, 0);
                            return Values{energies.kinetic, energies.potential, energies.compression, energies.mass, energies.damper_power};
                          },
                          [this](double time, const Values& values) {
                            samples_.energies.push_back({time, values[0], values[1], values[2], values[3], values[4]});
                          }});
}

void Recorder::add_poses(const Case& scene) {
  const bool any = world_.anything_moves();
  instruments_.push_back({SampleClock(rate_of_poses(scene)), [this, any](Solver&) { return any ? values_of(world_) : Values(); },
                          [this, any](double time, const Values& values) {
                            if (any) samples_.poses.push_back(pose_sample(time, values, world_.count()));
                          }});
}

void Recorder::add_flows(const Case& scene) {
  const bool any = flows_ && !scene.openings.empty();
  instruments_.push_back({SampleClock(scene.instruments.flow_rate.value_or(scene.instruments.rate)),
                          [this, any](Solver&) {
                            Values values;
                            if (!any) return values;
                            for (const FlowAtOpening& flow : flows_()) values.insert(values.end(), {flow.discharge, flow.volume});
                            return values;
                          },
                          [this, any](double time, const Values& values) {
                            if (!any) return;
                            FlowSample sample;
                            sample.time = time;
                            for (std::size_t k = 0; k + 2 <= values.size(); k += 2) sample.flows.push_back({values[k], values[k + 1]});
                            samples_.flows.push_back(std::move(sample));
                          }});
}

void Recorder::add_velocities(const Case& scene, const Solver& solver) {
  for (const VelocityProbeCase& probe : scene.instruments.velocity_probes) {
    velocity_probes_.places.push_back(probe.position);
    velocity_probes_.owners.push_back(rider_of(scene, probe.body));
  }
  const bool any = !velocity_probes_.places.empty();
  if (any) velocity_probes_.set = solver.make_points(velocity_probes_.places, PointValues::velocity);
  instruments_.push_back({SampleClock(scene.instruments.rate),
                          [this, any](Solver& fluid) {
                            Values values;
                            if (!any) return values;
                            for (const PointValue& point : evaluate(velocity_probes_, fluid)) {
                              const Vector3d velocity = filled(point) < least_wet ? none : point.velocity;
                              values.insert(values.end(), velocity.data(), velocity.data() + 3);
                            }
                            return values;
                          },
                          [this, any](double time, const Values& values) {
                            if (!any) return;
                            VelocitySample sample;
                            sample.time = time;
                            for (std::size_t k = 0; k + 3 <= values.size(); k += 3) sample.velocities.emplace_back(values.data() + k);
                            samples_.velocities.push_back(std::move(sample));
                          }});
}

void Recorder::add_sections(const Case& scene, const Layout& layout, const Solver& solver) {
  const bool any = !scene.instruments.sections.empty();
  sections_ = std::make_shared<FlowSections>(scene, layout, solver, world_);
  instruments_.push_back({SampleClock(scene.instruments.flow_rate.value_or(scene.instruments.rate)),
                          [this](Solver& fluid) {
                            Values values;
                            for (const FlowThroughSection& flow : sections_->read(fluid))
                              values.insert(values.end(), {flow.discharge, flow.area});
                            return values;
                          },
                          [this, any](double time, const Values& values) {
                            if (!any) return;
                            SectionSample sample;
                            sample.time = time;
                            for (std::size_t k = 0; k + 2 <= values.size(); k += 2) sample.flows.push_back({values[k], values[k + 1]});
                            samples_.sections.push_back(std::move(sample));
                          }});
}

void Recorder::add_imus(const Case& scene) {
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (const auto& imu = scene.bodies[b].imu) imus_.push_back({1 + b, imu->position.value_or(world_.reference(1 + b))});
  const double rate = scene.instruments.imu_rate.value_or(rate_of_poses(scene));
  imu_period_ = 1 / rate;
  instruments_.push_back({SampleClock(rate), [this](Solver&) { return imu_values(); },
                          [this](double time, const Values& values) {
                            if (!imus_.empty()) samples_.imus.push_back(imu_sample(time, values));
                          }});
}

std::vector<double> Recorder::imu_values() const {
  Values values;
  const auto add = [&values](const auto& vector) { values.insert(values.end(), vector.data(), vector.data() + vector.size()); };
  for (const Imu& imu : imus_) {
    const RigidState state = world_.state(imu.owner);
    const Vector3d place = state.moved(imu.place, world_.reference(imu.owner)), arm = place - state.position;
    add(state.orientation.coeffs());
    add(state.angular_velocity);
    add(state.velocity_at(place));
    add(Vector3d(state.acceleration + state.angular_acceleration.cross(arm) +
                 state.angular_velocity.cross(state.angular_velocity.cross(arm))));
  }
  return values;
}

ImuSample Recorder::imu_sample(double time, const Values& values) {
  ImuSample sample;
  sample.time = time;
  const bool first = imu_velocities_.empty();
  imu_velocities_.resize(3 * imus_.size());
  for (std::size_t k = 0; k < imus_.size(); ++k) {
    const double* v = values.data() + imu_size * k;
    ImuReading reading;
    reading.orientation = Quaterniond(v).normalized();
    const Quaterniond into_body = reading.orientation.conjugate();
    reading.angular_velocity = into_body * Vector3d(v + 4);
    Eigen::Map<Vector3d> before(imu_velocities_.data() + 3 * k);
    const Vector3d velocity(v + 7);
    const Vector3d acceleration = first ? Vector3d(v + 10) : Vector3d((velocity - before) / imu_period_);
    before = velocity;
    reading.specific_force = into_body * (acceleration - gravity_);
    sample.readings.push_back(reading);
  }
  return sample;
}

void Recorder::add_moorings(const Case& scene) {
  bool any = !scene.tank.rigid.moorings.empty();
  for (const BodyCase& body : scene.bodies) any = any || !body.rigid.moorings.empty();
  instruments_.push_back({SampleClock(rate_of_poses(scene)),
                          [this, any](Solver&) {
                            Values values;
                            if (!any) return values;
                            for (const MooringState& mooring : world_.moorings()) {
                              values.insert(values.end(), {mooring.tension, mooring.anchor_tension, mooring.lying});
                              values.push_back(static_cast<double>(mooring.line.size()));
                              for (const Vector3d& place : mooring.line) values.insert(values.end(), place.data(), place.data() + 3);
                            }
                            return values;
                          },
                          [this, any](double time, const Values& values) {
                            if (!any) return;
                            MooringSample sample;
                            sample.time = time;
                            for (const double* v = values.data(); v != values.data() + values.size();) {
                              MooringState mooring{v[0], v[1], v[2], {}};
                              const auto places = static_cast<std::size_t>(std::lround(v[3]));
                              v += 4;
                              for (std::size_t k = 0; k < places; ++k, v += 3) mooring.line.emplace_back(v);
                              sample.moorings.push_back(std::move(mooring));
                            }
                            samples_.moorings.push_back(std::move(sample));
                          }});
}

void Recorder::start(Solver& solver) {
  imu_velocities_.clear();
  for (Instrument& instrument : instruments_) {
    instrument.clock.set_index(0);
    instrument.after_time = -1;
    instrument.record(0.0, instrument.read(solver));
    instrument.clock.tick();
  }
}

void Recorder::before_step(Solver& solver, double time, double next_time) {
  for (Instrument& instrument : instruments_) {
    instrument.due = instrument.clock.next() <= next_time;
    if (instrument.due) instrument.before = instrument.after_time == time ? instrument.after : instrument.read(solver);
  }
}

void Recorder::after_step(Solver& solver, double time, double next_time) {
  for (Instrument& instrument : instruments_) {
    if (!instrument.due) continue;
    instrument.after = instrument.read(solver);
    instrument.after_time = next_time;
    const Values& after = instrument.after;
    while (instrument.clock.next() <= next_time) {
      const double sample_time = instrument.clock.next();
      const double share = (sample_time - time) / (next_time - time);
      Values values(after.size());
      for (std::size_t k = 0; k < after.size(); ++k) values[k] = instrument.before[k] + share * (after[k] - instrument.before[k]);
      instrument.record(sample_time, values);
      instrument.clock.tick();
    }
  }
}

double Recorder::seconds_a_step(Solver& solver, double time_step) const {
  using Clock = std::chrono::steady_clock;
  constexpr int readings = 5;
  double seconds = 0;
  for (const Instrument& instrument : instruments_) {
    instrument.read(solver);  // the first launch of a kernel may still compile it
    const Clock::time_point begin = Clock::now();
    for (int k = 0; k < readings; ++k) instrument.read(solver);
    const double reading = std::chrono::duration<double>(Clock::now() - begin).count() / readings;
    // before the step and after it, but at no instant twice
    seconds += std::min(2 * instrument.clock.rate() * time_step, 1.0) * reading;
  }
  return seconds;
}

Samples Recorder::take() { return std::exchange(samples_, {}); }

std::array<std::uint64_t, Recorder::instrument_count> Recorder::clock_indices() const {
  std::array<std::uint64_t, instrument_count> indices{};
  for (std::size_t k = 0; k < instrument_count; ++k) indices[k] = instruments_[k].clock.index();
  return indices;
}

bool Recorder::can_stand_at(const std::array<std::uint64_t, instrument_count>& indices, double time, double slack) const {
  for (std::size_t k = 0; k < instrument_count; ++k) {
    const double rate = instruments_[k].clock.rate();
    if (std::abs(static_cast<double>(indices[k]) / rate - time) > 1.0 / rate + slack) return false;
  }
  return true;
}

void Recorder::set_clock_indices(const std::array<std::uint64_t, instrument_count>& indices) {
  for (std::size_t k = 0; k < instrument_count; ++k) {
    instruments_[k].clock.set_index(indices[k]);
    instruments_[k].after_time = -1;
  }
  samples_ = {};
}

void Recorder::set_memory(const std::vector<double>& memory) {
  if (!memory.empty() && memory.size() != 3 * imus_.size())
    throw Error("the snapshot's instruments have " + std::to_string(memory.size()) + " numbers, but this case's have " +
                std::to_string(3 * imus_.size()) + ".");
  if (!std::all_of(memory.begin(), memory.end(), [](double value) { return std::isfinite(value); }))
    throw Error("the snapshot's instruments have a number that is not finite.");
  imu_velocities_ = memory;
}

}  // namespace wavetank
