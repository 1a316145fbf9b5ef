#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wavetank/compute/device.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/geometry/thin_walls.h"
#include "wavetank/scene/case.h"
#include "wavetank/sph/discretisation.h"
#include "wavetank/sph/pair_count.h"

namespace wavetank {

/// A particle that has left the water by a drain.
struct LeftParticle {
  std::uint32_t id = 0;
  double mass = 0;                                     ///< kg (2-D: kg/m), exactly as the device had it
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, in the case's coordinates
};

/// What one step reports to the host: the only thing that leaves the device in a step, but for forces and the guard's impulses where bodies
/// are free.
struct StepReport {
  double time_step = 0;              ///< s, of the next step
  double greatest_speed = 0;         ///< m/s
  double greatest_acceleration = 0;  ///< m/s²
  int not_finite = 0;                ///< particles with a value that is not a number
  int outside = 0;                   ///< particles outside the watchdog's box
  int too_fast = 0;                  ///< particles faster than c₀/2
  int guard_hits = 0;
  int shepard_bounded = 0;
  std::map<std::string, double> more;  ///< what rows that a case adds report, by their names
  std::vector<double> let_in;          ///< kg (2-D: kg/m), of each particle that came in, in its order, exactly as the device has it
  std::vector<LeftParticle> left;      ///< in the course of the step
  std::int64_t offender = -1;          ///< index of the first offending particle, or -1
  std::uint32_t offender_id = 0;
  Eigen::Vector3d offender_position = Eigen::Vector3d::Zero();  ///< m, in the case's coordinates
  Eigen::Vector3d offender_velocity = Eigen::Vector3d::Zero();  ///< m/s

  bool valid() const { return offender < 0; }  ///< no particle is in violation
  /// A count that a case's method adds; 0 where it does not.
  std::uint64_t counted(const std::string& name) const {
    const auto found = more.find(name);
    return found == more.end() ? 0 : static_cast<std::uint64_t>(found->second);
  }
};

struct PackingReport {
  int iterations = 0;
  double first_error = 0;  ///< root mean square of h|E| on the lattice
  double last_error = 0;   ///< and packed
};

/// The fluid at a point.
struct PointValue {
  double pressure = 0;                                 ///< Pa, gauge; 0 where dry
  double filling = 0;                                  ///< Σ W V: 1 inside the fluid, 1/2 on its free surface
  double shepard = 0;                                  ///< γ at the point
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s, the mean of the water about the point, Σ W V u / Σ W V; 0 where dry
};

/// What is wanted of the fluid at points.
enum class PointValues {
  pressure,  ///< all but the velocity, which is 0 unless the case has openings
  velocity   ///< all
};

/// Points kept on the device, made by the solver that evaluates them.
class PointSet {
 public:
  virtual ~PointSet() = default;
  /// Takes others instead, m, in the case's coordinates; as many as there are.
  virtual void set(const std::vector<Eigen::Vector3d>& points) = 0;
};

/// Water in a gap where there are no particles, but where those beside it feel some.
struct FilmLump {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, of its middle, in the case's coordinates
  double volume = 0;                                ///< m³ (2-D: m²), that is felt
  double pressure = 0;                              ///< Pa, gauge
  double closed = 0;  ///< m³ (2-D: m²) of a gap too narrow for particles: those that it has caught have the film's pressure
};

/// In the frame that the fluid is solved in.
struct FluidEnergies {
  double kinetic = 0;                                     ///< J (2-D: J/m)
  double potential = 0;                                   ///< J, under the case's gravity, about the tank's lowest place
  double compression = 0;                                 ///< J
  double mass = 0;                                        ///< kg (2-D: kg/m)
  Eigen::Vector3d mass_centre = Eigen::Vector3d::Zero();  ///< m, in the case's coordinates
  double damper_power = 0;                                ///< W (2-D: W/m), that the acoustic damper takes of sound
  Eigen::Vector3d zone_force = Eigen::Vector3d::Zero();   ///< N (2-D: N/m), of the water on damping zones
  Eigen::Vector3d zone_moment = Eigen::Vector3d::Zero();  ///< N·m (2-D: N), its moment about the case's origin
};

/// Pressure force, viscous force (N), pressure torque, viscous torque (N·m) of the fluid on one owner of walls; about the owner's centre.
using WallWrench = std::array<Eigen::Vector3d, 4>;

/// How an owner of walls moves, as far as the fluid feels it, relative to the tank. SI units, about the owner's centre, which was given to
/// make_solver and moves with it.
struct WallMotion {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();              ///< m/s
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          ///< m/s²
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< rad/s²
  Eigen::Vector3d surface_velocity = Eigen::Vector3d::Zero();      ///< m/s, of a belt; only its part along the surface acts
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();          ///< m, of the centre from where the layout has it; only of moving owners
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< from that of the layout
};

/// The frame in which the fluid is solved, the tank's, where that moves. All in the tank's axes.
struct FrameMotion {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();               ///< m/s², less the acceleration of the frame's origin
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();                ///< m, in the tank's coordinates: what the two others are about
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      ///< rad/s
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  ///< rad/s²

  /// What acts as gravity on what rests in the frame at a place of it, m/s².
  Eigen::Vector3d gravity_at(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d arm = place - origin;
    return gravity - angular_acceleration.cross(arm) - angular_velocity.cross(angular_velocity.cross(arm));
  }
};

struct WallMotions {
  std::vector<WallMotion> owners;    ///< 0 the tank, whose walls stand in its own frame; 1 + i body i
  std::optional<FrameMotion> frame;  ///< of a tank that moves
};

/// Moves walls in the course of a step.
class WallMover {
 public:
  virtual ~WallMover() = default;
  /// Owners whose wrenches to_end wants.
  virtual std::vector<int> coupled() const = 0;
  /// Where they are expected after a fraction of a step of `time_step`, s: 0.5, or 1.
  virtual WallMotions at(double time_step, double fraction) = 0;
  /// At its end; `wrenches` (one a coupled owner, in their order): of the fluid over the step, in the tank's axes, from the very sums that
  /// act on the fluid.
  virtual WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) = 0;
};

/// Of the water in parts.
struct PartsState {
  int count = 1;
  double imbalance = 1;    ///< particles of the part that has the most, over those of the mean
  std::uint64_t cuts = 0;  ///< times that the water was cut since the start of the run
  // of the first part, for a step, on average since the water was cut last
  double exchange_share = 0;  ///< of its time: that it exchanges particles and halos with others, and waits for them
  double messages = 0;        ///< of particles and halos, that it sends
  double bytes = 0;           ///< in them
};

/// How much of the volume that the particles' densities say is not there, because they lie upon each other.
struct LostVolume {
  double lost = 0;                                  ///< m³ (2-D: m²)
  double whole = 0;                                 ///< likewise, that of all particles by their densities
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< m, of the particle that is most crowded, in the case's coordinates
};

/// Particle state on the host, in an order that find_surface() has too. Positions in the case's coordinates.
struct FluidState {
  std::vector<std::uint32_t> id;
  std::vector<Eigen::Vector3d> position;  ///< m
  std::vector<Eigen::Vector3d> velocity;  ///< m/s
  std::vector<double> pressure;           ///< Pa
  std::vector<double> compression;        ///< ρ/ρ₀ − 1
  std::vector<double> mass;               ///< kg (2-D: kg/m)
};

/// Particles that come into the water, as many of each.
struct NewParticles {
  std::vector<Eigen::Vector3d> position;  ///< m, in the case's coordinates
  std::vector<Eigen::Vector3d> velocity;  ///< m/s
  std::vector<double> volume;             ///< m³ (2-D: m²), that the water of each fills at its pressure
  std::vector<double> pressure;           ///< Pa, gauge
};

/// A box in which particles leave the water; its edges need not be along the axes.
struct Drain {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();          ///< m, in the case's coordinates
  Eigen::Matrix3d half_edges = Eigen::Matrix3d::Identity();  ///< m: columns, at right angles, from the centre to the middle of a face
};

/// A block of water, behind an opening, whose state is given: a box divided into columns along its normal.
struct ImposedZone {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< m, of the box's front face, in the case's coordinates
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();   ///< unit, out of the box through its front face
  Eigen::Vector3d across = Eigen::Vector3d::UnitY();   ///< unit
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();       ///< unit
  double depth = 0;                                    ///< m, against the normal
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();     ///< m/s, at which the water at the centre is carried, whatever its speed
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();   ///< 1/s: drift + turning (x − centre) at a place x
  Eigen::Vector3d heading = Eigen::Vector3d::UnitX();  ///< unit, of the speed: the normal, of a zone that turns that at the step's end
  std::array<int, 2> cells{1, 1};                      ///< across and up
  std::array<double, 2> cell_size{0, 0};               ///< m; across it may be 0 in 2-D
  std::array<double, 2> first_edge{0, 0};              ///< m from the centre, of the first cell's outer edges
  int layers = 1;                                      ///< into which the depth is divided
  std::vector<double>
      speed;  ///< m/s along the heading, by layer from the front, then cell, across fastest; none: what particles have is kept
  std::vector<double> pressure;  ///< Pa, gauge, likewise
  std::vector<char> is_free;     ///< of each cell of the front: what is behind it is no part of the zone; empty: none is so
};

/// What a sweep finds of the particles, in the order of FluidState.
struct FluidSurface {
  std::vector<double> shepard;           ///< γ
  std::vector<std::uint8_t> on_surface;  ///< 1 on the free surface
  std::vector<double> eigenvalue;        ///< λ, the least of Σ r ⊗ ∇W V with its walls: 1 inside, less towards a free surface
};

/// The SPH solver of one fluid between walls.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Iterates the positions towards Σ∇WV + Σ n∫W dS = 0 between the walls and the lid (numerics: packing), then keeps them.
  virtual PackingReport pack(int iterations, const std::function<void(double fraction)>& progress) = 0;
  /// Hydrostatic pressure, at rest, from the present positions; the first Δt.
  virtual StepReport start() = 0;
  /// start(), and then the water comes to rest in what the particles make of hydrostatics: steps with damped velocities, gravity's
  /// part along Layout::up alone and the lid where it is not on top, for `periods` times 4 H/c₀, the slowest period of the sound in water
  /// of the greatest depth H. The damping is critical for that period, so that all sound decays at its rate at least. Ends at rest; a
  /// report in violation ends it early.
  virtual StepReport settle(double periods, const std::function<void(double fraction)>& progress) = 0;
  /// One time step of the case's integrator. Without a mover walls stay where they are.
  virtual StepReport advance(WallMover* mover = nullptr) = 0;

  /// Places, velocities and accelerations of the walls, from the next step on.
  virtual void set_wall_motions(const WallMotions& motions) = 0;
  /// The water in gaps too narrow for particles, from now on: packing and steps take it for water; the steps of least squares
  /// (numerics/gradients) do not. Lumps near each other in the list are best near each other in the tank.
  virtual void set_film(const std::vector<FilmLump>& lumps) = 0;
  /// The next steps are no longer than this, s, whatever the fluid allows.
  virtual void limit_time_step(double limit) = 0;
  /// The next step alone is no longer than this, s, greater than 0. Returns its length.
  virtual double shorten_step(double longest) = 0;

  virtual std::size_t particle_count() const = 0;
  virtual PartsState parts() const { return {}; }
  /// These come into the water at the end of the next step, in their order, with ids that no particle had before. Memory on the device
  /// grows with them. (By the symplectic integrator their compressions still change by half that step, as all others do then.) Throws Error
  /// if the lists are not of one length, or if a value is not finite or a volume not greater than 0.
  virtual void let_in(const NewParticles& particles) = 0;
  /// Particles that are in one of these at a step's end are no more in the water then; {}: none. After a call of this or of let_in
  /// snapshots of any number of particles are taken. Throws Error for a drain without size, or with edges that are not at right angles.
  virtual void set_drains(const std::vector<Drain>& drains) = 0;
  /// From now on particles within these boxes keep their velocity and pressure, through packing and steps, and are not shifted; steps begin
  /// with those that the zones' tables give, if they do. For a case with openings only. Throws Error for a table of another size.
  virtual void set_zones(const std::vector<ImposedZone>& zones) = 0;
  /// The thinnest wall with fluid on both sides that is thinner than the support, if there is one: taken for a thin plate.
  virtual std::optional<ThinWall> thinnest_wall() const = 0;
  virtual std::unique_ptr<PointSet> make_points(const std::vector<Eigen::Vector3d>& points,
                                                PointValues wanted = PointValues::pressure) const = 0;
  virtual std::vector<PointValue> evaluate(const PointSet& points) = 0;
  /// One wrench an owner (0 the tank, 1 + i body i) about its centre, in the tank's axes.
  virtual std::vector<WallWrench> wrenches() = 0;
  virtual FluidEnergies energies() = 0;
  /// Of particles in the open water; beside walls and under a free surface it is found too small.
  virtual LostVolume lost_volume() = 0;
  virtual FluidState download() = 0;
  /// Of the present positions.
  virtual FluidSurface find_surface() = 0;
  /// Of the present positions.
  virtual PairCount count_pairs() = 0;
  /// The exact state, as bytes of this solver's precision: what a restart needs. Without particles that wait to come in.
  virtual std::vector<char> save() const = 0;
  /// Throws Error if the bytes are not those of a state of this case; of as many particles, where none may come or go.
  virtual void restore(const std::vector<char>& bytes) = 0;
  /// Bytes on the device; of parts, on all devices.
  virtual std::size_t device_memory() const = 0;
};

/// `centres`: of each owner of walls, that torques are taken about, m. The case must be settled.
std::unique_ptr<Solver> make_solver(const compute::Device& device, const Case& settled_case, const Layout& layout,
                                    const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres);

}  // namespace wavetank
