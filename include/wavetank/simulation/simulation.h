#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/instruments/samples.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/rigid/wave_theory.h"
#include "wavetank/scene/case.h"
#include "wavetank/simulation/case_size.h"
#include "wavetank/sph/pair_count.h"
#include "wavetank/sph/parts_need.h"

namespace wavetank::parallel {
class Team;
}

namespace wavetank {

/// The fluid at one instant, for clouds and files. Arrays of one length, in no particular order; `id` names a particle for good.
struct ParticleCloud {
  double time = 0;  ///< s
  std::vector<std::uint32_t> id;
  std::vector<Eigen::Vector3f> position;  ///< m, in the case's coordinates
  std::vector<Eigen::Vector3f> velocity;  ///< m/s
  std::vector<float> pressure;            ///< Pa, gauge
  std::vector<float> density;             ///< kg/m³
  std::vector<float> mass;                ///< kg (2-D: kg/m)
  std::vector<float> shepard;             ///< γ, 0…1
  std::vector<std::uint8_t> surface;      ///< 1 on the free surface
  std::vector<float> eigenvalue;          ///< λ: 1 inside the water, less towards its free surface, 0 of a lone drop
};

struct SolverState {
  double time = 0;  ///< s
  std::uint64_t step = 0;
  double time_step = 0;  ///< s, of the next step
  std::size_t particles = 0;
  double greatest_speed = 0;                 ///< m/s
  std::uint64_t guard_hits = 0;              ///< since the start: times a particle was kept from crossing a wall
  std::uint64_t shepard_bounded = 0;         ///< in the last step: particles whose γ was below 0.05 or above 1.005
  std::uint64_t fits_of_first_order = 0;     ///< likewise: particles whose least squares fell back to first order
  std::uint64_t fits_below_first_order = 0;  ///< likewise: to what few neighbours tell
  int parts = 1;                             ///< of the water
  double imbalance = 1;                      ///< particles of the part that has the most, over those of the mean
  std::uint64_t cuts = 0;                    ///< times that the water was cut into parts
  double exchange_share = 0;                 ///< as PartsState has these
  double messages = 0, message_bytes = 0;
};

/// Of an opening, since the start.
struct OpeningState {
  double discharge = 0;              ///< m³/s (2-D: m²/s), into the water in the last step; negative: out of it
  double volume = 0;                 ///< m³ (2-D: m²), that has come in less what has left, at the fluid's density ρ₀
  double mass_in = 0, mass_out = 0;  ///< kg (2-D: kg/m), of the particles that came in and left
  std::uint64_t particles_in = 0, particles_out = 0;
};

/// The watchdog's: a running simulation that may not go on. what() says which particle, where, when, in which step.
class Violation : public Error {
 public:
  using Error::Error;
};

struct KernelTime {
  std::string kernel;
  std::uint64_t launches = 0;
  double seconds = 0;
};

struct SimulationOptions {
  ResourceResolver resolve;  ///< of package:// URIs; may be empty
  /// Progress of the start ("packing", 0…1); called often. May throw to abandon the start.
  std::function<void(const std::string& what, double fraction)> progress;
  bool time_kernels = false;
  bool in_parts = false;          ///< the water on one device too is one part of itself: with the bits of any number of parts
  bool parts_take_turns = false;  ///< in one process: one runs at a time, on whatever devices
  /// Processes that make the steps, each of them a part of the water, with this one, which is the first. The
  /// others serve it by part_work (simulation/part_work.h). Must outlive the simulation. None: devices of this process alone.
  parallel::Team* team = nullptr;
};

/// What `--check` reports: from the layout, and a few steps and readings that are timed.
struct Estimate {
  std::size_t particles = 0;
  std::size_t wall_elements = 0;  ///< or facets
  std::size_t lid_elements = 0;
  CaseSize size;
  std::optional<double> thinnest_wall;  ///< m, of the walls thinner than the support with fluid on both sides; none = there are none
  std::vector<ExpectedWaves> waves;     ///< of paddles that make them by theory
  double spacing = 0;                   ///< m
  double device_memory = 0;             ///< bytes
  double time_step = 0;                 ///< s, at rest
  double start_seconds = 0;             ///< of wall time: laying out, compiling, packing, settling
  double step_seconds = 0;              ///< all steps
  double instrument_seconds = 0;        ///< all readings
  double wall_seconds = 0;              ///< the whole run: the sum of the three; without writing files
};
/// Measured on the case's device, as busy as it is now.
Estimate estimate(const Case& checked, const SimulationOptions& options = {});

/// What its water in so many parts would need, the largest of which is made on the case's first device. Throws Error as Simulation does for
/// its layout and its device.
struct PartsEstimate {
  double spacing = 0;         ///< m
  std::size_t particles = 0;  ///< of all
  PartsNeed need;
};
PartsEstimate estimate_parts(const Case& checked, int parts, const SimulationOptions& options = {});

/// One simulation made from a case: fluid, bodies and instruments. Not thread-safe: one thread at a time.
class Simulation {
 public:
  /// Lays the case out, opens the device, packs the particles: ready at time 0. The samples at time 0 are ready to be taken.
  explicit Simulation(const Case& checked, SimulationOptions options = {});
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Continues bit for bit from a snapshot of the same case on the same device. Throws Error for a truncated, foreign or mismatched file
  /// and leaves this simulation as it was.
  void restore(const std::string& path);
  /// Writes a snapshot, whole or not at all; an older plain file is replaced. Throws Error for anything else that lies there.
  void save(const std::string& path) const;
  /// Back to time 0, the same bits as at first.
  void reset();

  /// One time step. Throws Violation when the watchdog stops the simulation; samples up to then can still be taken.
  void advance();
  Samples take_samples();

  /// On a free body (owner 1 + i) from the next step on. Throws Error for a body that is not free, a value that is not finite, and one that
  /// alone would accelerate it beyond RigidWorld::greatest_acceleration; the wrench before stays.
  void set_outside_wrench(std::size_t owner, const OutsideWrench& wrench);
  /// Of a commanded body or tank (owner 0), in its own axes, from the next step on. Throws Error for one that is not commanded, a value
  /// that is not finite, and, but for what its limits of acceleration ease, a speed of any of its points, relative to the tank, of half the
  /// speed of sound and more; the command before stays.
  void command(std::size_t owner, const Vector3d& velocity, const Vector3d& angular_velocity);
  /// Of a commanded opening, m³/s (2-D: m²/s), from the next step on. Throws Error for an opening that is not commanded, and for a value
  /// that is not finite, negative, or faster than a tenth of the speed of sound.
  void command_discharge(std::size_t opening, double discharge);
  /// Of a joint that is commanded, N, N·m, m/s or rad/s, from the next step on. Throws Error for one that is not, for a value that is
  /// not finite, an effort as RigidWorld::command_joint has it, and a velocity of half the speed of sound and more.
  void command_joint(std::size_t joint, double value);
  const std::vector<OpeningState>& openings() const;  ///< in the case's order
  const RigidWorld& bodies() const;

  SolverState state() const;
  EnergySample energies() const;
  ParticleCloud particles() const;              ///< all
  ParticleCloud free_surface() const;           ///< those on the free surface
  std::vector<Eigen::Vector3f> places() const;  ///< m, of all particles, in the case's coordinates
  /// How much of what walls leave of the kernel about each place (m, in the case's coordinates) the water fills: 1 in it, 1/2 on its
  /// surface, 0 in the air and well inside of walls.
  std::vector<float> filling(const std::vector<Vector3d>& places) const;
  const Case& scene() const;  ///< the case, with its automatic values settled (sound speed, spacing, support)
  const Layout& layout() const;
  std::string device_description() const;  ///< device, platform, driver, in one line
  std::string summary() const;             ///< several lines: spacing, h, c₀, bounds on Δt, particles, elements, memory, device
  std::vector<KernelTime> kernel_times() const;
  PairCount count_pairs() const;      ///< of the neighbour loop at the present positions
  std::size_t device_memory() const;  ///< bytes

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
  friend Estimate estimate(const Case&, const SimulationOptions&);
};

}  // namespace wavetank
