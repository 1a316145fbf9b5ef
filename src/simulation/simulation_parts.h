#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absorbing_paddles.h"
#include "coupling.h"
#include "opening_flows.h"
#include "water_film.h"
#include "wavetank/common/stopwatch.h"
#include "wavetank/compute/device.h"
#include "wavetank/instruments/recorder.h"
#include "wavetank/simulation/simulation.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

struct Snapshot;

/// What a simulation is made of. Its members are in simulation.cpp (start and steps), simulation_watchdog.cpp, simulation_snapshot.cpp and
/// estimate.cpp.
struct Simulation::Parts {
  Parts(const Case& checked, SimulationOptions given);

  Layout laid_out(const Case& checked) const;
  std::vector<FlowLaw> laws_of(const Case& checked) const;
  /// Of any opening or wall from the start to the end, m/s.
  double fastest_inflow(const Case& checked, double fastest_wall) const;
  std::vector<compute::Device> chosen_devices() const;
  std::unique_ptr<Solver> solver_on(const std::vector<compute::Device>& those) const;
  std::unique_ptr<Solver> prepared_solver();
  /// On which another run has the same bits: the device, or, of water in parts, the kind of them.
  std::string kind_of_device() const;
  void progress(const char* what, double fraction) const;
  /// The fluid's, with those of films that particles do not resolve.
  std::vector<WallWrench> wrenches(Solver& fluid);
  /// One step with the samples that fall into it.
  void advance();
  /// The next step is short enough for what walls do in it.
  void shorten_step();
  /// The films that the next step begins with.
  void find_films();
  /// The step alone.
  void step_on();
  /// Throws Violation for a step that the simulation may not go on from.
  void check(const StepReport& report);
  /// The same of the first forces, before any step.
  void check_start();
  /// Throws Violation where particles lie upon each other instead of filling their volume.
  void check_volume();
  /// Says once that the water is fast beside its sound.
  void tell_of_speed(double greatest);
  /// What preparing the solver takes when its kernels were compiled before, as they are when the run comes.
  double loading_seconds();
  /// How fast, m/s, the fastest point of a commanded owner would move relative to the tank, as it moves now; of the tank itself, by how
  /// much it would jump.
  double commanded_speed(std::size_t owner, Vector3d velocity, Vector3d angular_velocity) const;
  /// Throws Error for a commanded speed, m/s, that the water's sound cannot follow.
  void check_commanded_speed(const std::string& whose, double speed) const;
  /// Throws Violation for a body too fast to be followed; says once of one that it has left the tank.
  void check_bodies();
  std::string when() const;  ///< for messages
  /// Bodies and what the fluid has been told of them, as bytes; and back.
  std::vector<char> saved_bodies() const;
  /// Throws Error, and leaves them as they were, for bytes of others.
  void restore_bodies(const std::vector<char>& bytes);
  void check_clocks(const Snapshot& snapshot) const;
  /// Tells the solver where walls are, at the present time.
  void place_walls();

  SimulationOptions options;
  Stopwatch compiling;
  Layout layout;
  std::vector<FlowLaw> laws;
  double fastest;  ///< m/s, expected of walls, and of what comes in
  Case scene;
  Discretisation discretisation;
  RigidWorld world;
  Coupling coupling;
  WaterFilm film;
  OpeningFlows openings;
  std::vector<compute::Device> devices;  ///< one a part of the water
  std::unique_ptr<Solver> solver;
  Recorder recorder;
  AbsorbingPaddles paddles;
  PackingReport packing;
  std::vector<char> initial_fluid, initial_bodies, initial_openings;
  double initial_time_step = 0;
  double time = 0;
  double time_step = 0;
  std::uint64_t step = 0;
  std::uint64_t guard_hits = 0;
  StepReport report;
  std::vector<double> reaches;  ///< of each owner, of its bounding box from its reference point at the start, m
  std::vector<bool> left_tank;  ///< of each owner: it has, and that was said
  bool told_of_loss = false;    ///< of the water's volume
  bool told_of_speed = false;   ///< of water that is fast beside its sound
};

/// Where torques are taken about.
std::vector<Vector3d> reference_points(const RigidWorld& world);
/// Elements or facets, whichever the case has; ghosts have facets for the guard.
std::size_t walls_in_use(const Case& scene, const Layout& layout);

}  // namespace wavetank
