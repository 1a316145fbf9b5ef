#include "wavetank/instruments/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace wavetank {

namespace {

constexpr std::size_t state_size = 19, joint_size = 3;

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
}

void Recorder::add_pressures(const Case& scene, const Layout& layout, const Solver& solver) {
  bool any_rides = false;
  for (std::size_t k = 0; k < scene.instruments.pressure_probes.size(); ++k) {
    const PressureProbeCase& probe = scene.instruments.pressure_probes[k];
    const std::vector<Vector3d> points =
        probe.diameter > 0 ? points_of_disc(probe, layout.disc_normals.at(k), scene.dimensions) : std::vector<Vector3d>{probe.position};
    std::size_t owner = 0;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
      if (scene.bodies[b].name == probe.body && world_.moves(1 + b)) owner = 1 + b;
    probe_points_.push_back(points.size());
    probe_places_.insert(probe_places_.end(), points.begin(), points.end());
    probe_owners_.insert(probe_owners_.end(), points.size(), owner);
    any_rides = any_rides || owner != 0;
  }
  probes_ = solver.make_points(probe_places_);
  const bool any = !probe_places_.empty();
  instruments_.push_back({SampleClock(scene.instruments.rate),
                          [this, any, any_rides](Solver& fluid) {
                            Values pressures;
                            if (!any) return pressures;
                            if (any_rides) probes_->set(places_of_probes());
                            const std::vector<PointValue> values = fluid.evaluate(*probes_);
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

std::vector<Vector3d> Recorder::places_of_probes() const {
  std::vector<Vector3d> places = probe_places_;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (probe_owners_[k] != 0) places[k] = world_.state_in_tank(probe_owners_[k]).moved(places[k], world_.reference(probe_owners_[k]));
  return places;
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
  instruments_.push_back({SampleClock(scene.instruments.pose_rate.value_or(std::min(scene.instruments.rate, 100.0))),
                          [this, any](Solver&) { return any ? values_of(world_) : Values(); },
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

void Recorder::start(Solver& solver) {
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

void Recorder::set_clock_indices(const std::array<std::uint64_t, instrument_count>& indices) {
  for (std::size_t k = 0; k < instrument_count; ++k) {
    instruments_[k].clock.set_index(indices[k]);
    instruments_[k].after_time = -1;
  }
  samples_ = {};
}

}  // namespace wavetank
