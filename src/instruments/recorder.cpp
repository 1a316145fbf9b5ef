#include "wavetank/instruments/recorder.h"

#include <utility>

namespace wavetank {

Recorder::Recorder(const Case& scene, const Layout& layout, const Solver& solver) {
  add_pressures(scene, solver);
  add_levels(scene, layout, solver);
  add_wrenches(scene);
  add_energies(scene);
}

void Recorder::add_pressures(const Case& scene, const Solver& solver) {
  std::vector<Vector3d> points;
  for (const PressureProbeCase& probe : scene.instruments.pressure_probes) points.push_back(probe.position);
  probes_ = solver.make_points(points);
  const bool any = !points.empty();
  instruments_.push_back({SampleClock(scene.instruments.rate),
                          [this, any](Solver& fluid) {
                            Values pressures;
                            if (!any) return pressures;
                            for (const PointValue& value : fluid.evaluate(*probes_)) pressures.push_back(value.pressure);
                            return pressures;
                          },
                          [this](double time, const Values& values) {
                            samples_.pressures.push_back({time, values});
                          },
                          {},
                          false});
}

void Recorder::add_levels(const Case& scene, const Layout& layout, const Solver& solver) {
  gauges_ = std::make_shared<WaveGauges>(scene, layout, solver);
  instruments_.push_back({SampleClock(scene.instruments.gauge_rate.value_or(scene.instruments.rate)),
                          [this](Solver& fluid) { return gauges_->read(fluid); },
                          [this](double time, const Values& values) {
                            samples_.levels.push_back({time, values});
                          },
                          {},
                          false});
}

void Recorder::add_wrenches(const Case& scene) {
  instruments_.push_back({SampleClock(scene.instruments.wrench_rate.value_or(scene.instruments.rate)),
                          [](Solver& fluid) {
                            Values values;
                            for (const WallWrench& wrench : fluid.wrenches())
                              for (const Vector3d& part : wrench) values.insert(values.end(), part.data(), part.data() + 3);
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
                          },
                          {},
                          false});
}

void Recorder::add_energies(const Case& scene) {
  instruments_.push_back({SampleClock(scene.instruments.energy_rate.value_or(scene.instruments.rate)),
                          [](Solver& fluid) {
                            const FluidEnergies energies = fluid.energies();
                            return Values{energies.kinetic, energies.potential, energies.compression, energies.mass};
                          },
                          [this](double time, const Values& values) {
                            samples_.energies.push_back({time, values[0], values[1], values[2], values[3]});
                          },
                          {},
                          false});
}

void Recorder::start(Solver& solver) {
  for (Instrument& instrument : instruments_) {
    instrument.clock.set_index(0);
    instrument.record(0.0, instrument.read(solver));
    instrument.clock.tick();
  }
}

void Recorder::before_step(Solver& solver, double, double next_time) {
  for (Instrument& instrument : instruments_) {
    instrument.due = instrument.clock.next() <= next_time;
    if (instrument.due) instrument.before = instrument.read(solver);
  }
}

void Recorder::after_step(Solver& solver, double time, double next_time) {
  for (Instrument& instrument : instruments_) {
    if (!instrument.due) continue;
    const Values after = instrument.read(solver);
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

Samples Recorder::take() { return std::exchange(samples_, {}); }

std::array<std::uint64_t, Recorder::instrument_count> Recorder::clock_indices() const {
  std::array<std::uint64_t, instrument_count> indices{};
  for (std::size_t k = 0; k < instrument_count; ++k) indices[k] = instruments_[k].clock.index();
  return indices;
}

void Recorder::set_clock_indices(const std::array<std::uint64_t, instrument_count>& indices) {
  for (std::size_t k = 0; k < instrument_count; ++k) instruments_[k].clock.set_index(indices[k]);
  samples_ = {};
}

}  // namespace wavetank
