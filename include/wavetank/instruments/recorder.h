#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "wavetank/instruments/flow_sections.h"
#include "wavetank/instruments/sample_clock.h"
#include "wavetank/instruments/samples.h"
#include "wavetank/instruments/wave_gauges.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// All instruments of a case, each at its own rate of simulated time whatever Δt is: a reading is taken at the ends of the step that
/// contains the sample's time and interpolated linearly, so instruments never change the steps.
class Recorder {
 public:
  /// `world` is looked at throughout; `wrenches`: of each owner, as Solver::wrenches() has them and by default those; `flows`: at this
  /// instant, of each opening.
  Recorder(const Case& settled_case, const Layout& layout, const Solver& solver, const RigidWorld& world,
           std::function<std::vector<WallWrench>(Solver&)> wrenches = &Solver::wrenches,
           std::function<std::vector<FlowAtOpening>()> flows = {});

  /// The samples at time 0.
  void start(Solver& solver);
  /// Before the step from `time` to `next_time`, and after it.
  void before_step(Solver& solver, double time, double next_time);
  void after_step(Solver& solver, double time, double next_time);

  /// At this instant.
  EnergySample energies(Solver& solver, double time) const;

  Samples take();

  /// Wall time that readings take in a step of `time_step` (s) on average, from a few that are made now and not kept, s.
  double seconds_a_step(Solver& solver, double time_step) const;

  static constexpr std::size_t instrument_count = 10;
  std::array<std::uint64_t, instrument_count> clock_indices() const;
  /// Whether each clock, so set, stands at its next sample at `time`, s, give or take a sample and `slack`, s.
  bool can_stand_at(const std::array<std::uint64_t, instrument_count>& indices, double time, double slack) const;
  void set_clock_indices(const std::array<std::uint64_t, instrument_count>& indices);
  /// What the next samples depend on besides: of each inertial measurement unit its velocity at its last sample, m/s in the world's axes.
  const std::vector<double>& memory() const { return imu_velocities_; }
  /// Throws Error, and keeps its own, if it is not one of this case.
  void set_memory(const std::vector<double>& memory);

 private:
  using Values = std::vector<double>;
  struct Instrument {
    SampleClock clock;
    std::function<Values(Solver&)> read;
    std::function<void(double time, const Values&)> record;
    Values before{};
    bool due = false;        ///< its next sample lies in the present step
    Values after{};          ///< read at the end of a step, which is the beginning of the next one
    double after_time = -1;  ///< s, of that; none if negative
  };

  /// Points that move with bodies or stand in the tank, on the device.
  struct Points {
    std::vector<Vector3d> places;     ///< as the case's geometry has them, m
    std::vector<std::size_t> owners;  ///< the body that each moves with; 0 = none
    std::shared_ptr<PointSet> set;
  };
  /// The body that points of the name move with, or 0.
  std::size_t rider_of(const Case& scene, const std::string& body) const;
  /// At the points' present places in the tank.
  std::vector<PointValue> evaluate(const Points& points, Solver& solver) const;
  void add_pressures(const Case& scene, const Layout& layout, const Solver& solver);
  void add_levels(const Case& scene, const Layout& layout, const Solver& solver);
  void add_wrenches(const Case& scene);
  void add_poses(const Case& scene);
  void add_energies(const Case& scene);
  void add_flows(const Case& scene);
  void add_velocities(const Case& scene, const Solver& solver);
  void add_sections(const Case& scene, const Layout& layout, const Solver& solver);
  void add_imus(const Case& scene);
  void add_moorings(const Case& scene);
  /// Where inertial measurement units are and how they move, in the world.
  std::vector<double> imu_values() const;
  ImuSample imu_sample(double time, const std::vector<double>& values);

  const RigidWorld& world_;
  Vector3d gravity_;
  std::function<std::vector<WallWrench>(Solver&)> wrenches_;
  std::function<std::vector<FlowAtOpening>()> flows_;
  Points probes_;
  std::vector<std::size_t> probe_points_;  ///< how many each probe has, of which it reads the mean
  Points velocity_probes_;
  std::shared_ptr<FlowSections> sections_;
  struct Imu {
    std::size_t owner;
    Vector3d place;  ///< m, as the case's geometry has it
  };
  std::vector<Imu> imus_;
  double imu_period_ = 0;               ///< s
  std::vector<double> imu_velocities_;  ///< see memory(); empty before the first sample
  std::shared_ptr<WaveGauges> gauges_;
  std::vector<Instrument> instruments_;
  Samples samples_;
};

}  // namespace wavetank
