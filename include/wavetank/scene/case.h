#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// A case: everything that a simulation is made from, as plain structs in SI units. z is up; a 2-D case lies in the x–z plane (y = 0).
/// The defaults here are the only place where defaults are stated.
namespace wavetank {

using Eigen::Vector3d;

struct Box {
  Vector3d min = Vector3d::Zero();  ///< m
  Vector3d max = Vector3d::Zero();  ///< m
};

/// A mesh file as a user names it: package://, file://, an absolute path, or a path relative to the case file.
struct MeshSource {
  std::string uri;
  double scale = 1.0;                       ///< metres per unit of the file
  Vector3d translation = Vector3d::Zero();  ///< m, applied last
  Vector3d rotation = Vector3d::Zero();     ///< rad, roll-pitch-yaw about fixed axes, applied after the scale
};

/// Water filled in a closed region from a point inside it up to a level, bounded by the walls.
struct FloodFill {
  Vector3d seed = Vector3d::Zero();  ///< m
  double level = 0.0;                ///< m, z of the free surface
};

using FillRegion = std::variant<Box, FloodFill>;

struct FluidCase {
  double density = 1000.0;               ///< kg/m³
  double viscosity = 1.0e-3;             ///< Pa·s, dynamic
  std::optional<double> sound_speed;     ///< m/s; none = automatic: 10 × the greatest expected speed
  std::optional<double> spacing;         ///< m; exactly one of spacing and particles is given
  std::optional<std::size_t> particles;  ///< approximate number of fluid particles
  std::vector<FillRegion> fill;          ///< at least one
};

/// A parametric rectangular tank.
struct BoxTank {
  Vector3d size = Vector3d::Zero();    ///< m; in 2-D size y is 0
  Vector3d origin = Vector3d::Zero();  ///< m, the corner of least coordinates
  bool closed = false;                 ///< true: with a lid
};

struct TankCase {
  std::variant<BoxTank, MeshSource> shape;
  bool splash_guard =
      true;  ///< spray above the rim is kept over the tank, as if its walls went on upwards; else it is lost and the run stops
  std::array<bool, 3> periodic{};  ///< along x, y, z: what leaves the tank's bounding box at one end comes in at the other
};

enum class Motion { fixed };

struct BodyCase {
  std::string name;
  std::variant<Box, MeshSource> shape;
  Motion motion = Motion::fixed;
  Vector3d surface_velocity = Vector3d::Zero();  ///< m/s, of a belt: its surface runs while the body stands
};

enum class Scheme { delta_sph };
enum class DensityDiffusion { none, fourtakas, antuono };
enum class EquationOfState { linear, cole };
enum class ViscosityModel { monaghan_gingold, morris };
enum class WallMethod { boundary_integral, ghost };
enum class ShepardFactor { none, volumetric, monolithic, geometric };
enum class WallElements { numerical, semi_analytical, facet };
enum class Slip { no_slip, free_slip };
enum class Shifting { none };
enum class Integrator { symplectic };
enum class Precision { single, double_ };
/// What the fluid does where its pressure would fall below that of the air, which is not simulated.
enum class NegativePressure { allowed, clamped };

struct WallCase {
  WallMethod method = WallMethod::boundary_integral;
  ShepardFactor shepard = ShepardFactor::geometric;
  WallElements elements = WallElements::facet;
  Slip slip = Slip::no_slip;
  bool renormalise_divergence = true;  ///< divide the velocity's divergence by the Shepard factor, as the pressure's gradient
  double repulsion = 0.0;              ///< of ghosts: short-range force as a multiple of (c₀/10)²; 0 = none
  double guard_distance = 0.1;         ///< of the spacing: nearer to a wall, a particle loses its approaching normal velocity; 0 = off
};

struct PackingCase {
  int iterations = 300;  ///< at most; 0 = start from the lattice
  double settling = 0;   ///< of damped steps before the start, in periods 4 H/c₀ of the slowest sound; 0 = none
};

struct NumericsCase {
  Scheme scheme = Scheme::delta_sph;
  std::optional<double> support;  ///< R/Δx; none = 4 in 2-D, 3 in 3-D
  WallCase walls;
  DensityDiffusion density_diffusion = DensityDiffusion::fourtakas;
  double density_diffusion_coefficient = 0.1;  ///< δ
  double artificial_viscosity = 0.02;          ///< α
  EquationOfState equation_of_state = EquationOfState::linear;
  ViscosityModel viscosity_model = ViscosityModel::monaghan_gingold;
  NegativePressure negative_pressure = NegativePressure::clamped;
  Shifting shifting = Shifting::none;
  Integrator integrator = Integrator::symplectic;
  double courant = 0.5;  ///< Δt as a fraction of h/(c₀ + |u|)
  Precision precision = Precision::single;
  PackingCase packing;
};

struct PressureProbeCase {
  std::string name;
  Vector3d position = Vector3d::Zero();  ///< m
};

struct WaveGaugeCase {
  std::string name;
  Vector3d position = Vector3d::Zero();  ///< m; x and y (in 2-D: x) of the vertical line; z is not used
};

struct InstrumentsCase {
  std::vector<PressureProbeCase> pressure_probes;
  std::vector<WaveGaugeCase> wave_gauges;
  double rate = 1000.0;               ///< Hz of simulated time, of every instrument that has no rate of its own
  std::optional<double> gauge_rate;   ///< Hz
  std::optional<double> wrench_rate;  ///< Hz
  std::optional<double> energy_rate;  ///< Hz
};

/// How the node publishes; the solver does not know of it.
struct PublishingCase {
  double cloud_rate = 20.0;          ///< Hz of wall time, of clouds while someone listens
  double cloud_bag_rate = 50.0;      ///< Hz of simulated time, of clouds in a bag written by wavetank_run --clouds
  int max_points = 50000;            ///< of a cloud; more are decimated
  double reference_pressure = 0.0;   ///< Pa, added to gauge pressure in sensor_msgs/FluidPressure
  std::string world_frame = "tank";  ///< tf frame of the case's coordinates
  bool publish_clock = false;        ///< publish /clock from the simulated time
  double real_time_factor = 0.0;     ///< upper limit of simulated over wall time; 0 = as fast as it goes
};

struct Case {
  std::string title;
  int dimensions = 3;                 ///< 2 or 3
  Vector3d gravity{0.0, 0.0, -9.81};  ///< m/s²
  double duration = 0.0;              ///< s of simulated time; > 0
  std::string device = "auto";        ///< auto, cpu, gpu, a part of a device's name, or platform:device
  FluidCase fluid;
  TankCase tank;
  std::vector<BodyCase> bodies;
  NumericsCase numerics;
  InstrumentsCase instruments;
  PublishingCase publishing;
  std::string directory;  ///< of the case file, that relative mesh paths refer to; empty when it came from parameters
};

}  // namespace wavetank
