#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "wavetank/scene/methods.h"

/// A case: everything that a simulation is made from, as plain structs in SI units. z is up; a 2-D case lies in the x–z plane (y = 0).
/// The defaults here are the only place where defaults are stated, but for those that depend on other keys: of the acoustic damper and of
/// what dissipates (the reader of case files sets them).
namespace wavetank {

using Eigen::Vector3d;

struct Box {
  Vector3d min = Vector3d::Zero();  ///< m
  Vector3d max = Vector3d::Zero();  ///< m
};

/// A mesh file as a user names it: package://, file://, an absolute path, or a path relative to the case file. Or a parametric shape:
/// shape://box?size=X,Y,Z, shape://sphere?radius=R, shape://cylinder?radius=R&length=L.
struct MeshSource {
  std::string uri;
  Vector3d scale = Vector3d::Ones();        ///< metres per unit of the file, along its axes; a negative one mirrors
  Vector3d translation = Vector3d::Zero();  ///< m, applied last
  Vector3d rotation = Vector3d::Zero();     ///< rad, roll-pitch-yaw about fixed axes, applied after the scale
};

/// Water filled in a closed region from a point inside it up to a level, bounded by the walls.
struct FloodFill {
  Vector3d seed = Vector3d::Zero();  ///< m
  double level = 0.0;                ///< m, z of the free surface over the seed; where gravity is nearer to x or y, that coordinate
};

using FillRegion = std::variant<Box, FloodFill>;

enum class InitialWaveKind {
  linear,    ///< of small waves
  stokes_2,  ///< regular waves to the second order of their steepness
  solitary
};

/// Waves by theory that are there at the start: the surface, velocity and pressure together.
struct InitialWaveCase {
  InitialWaveKind kind = InitialWaveKind::linear;
  double depth = 0;                        ///< m, of still water over a level floor
  double height = 0;                       ///< m, from trough to crest; of a solitary one the crest's over the still level
  std::optional<double> wavelength;        ///< m; exactly one of it and the period, unless solitary
  std::optional<double> period;            ///< s
  bool standing = false;                   ///< a standing wave, at rest and highest
  Vector3d direction = Vector3d::UnitX();  ///< in which they go, level; any length but 0
  double crest = 0;                        ///< m along the direction, from the case's origin
};

/// The water at the start: its free surface, velocity and pressure, each an expression (wavetank::Expression), or waves by theory, which
/// give all of them. Empty: level, at rest, and hydrostatic.
struct InitialCase {
  std::string u, v, w;                   ///< m/s, of x, y, z
  std::string pressure;                  ///< Pa, likewise
  std::string elevation;                 ///< m, of x and y: of the free surface over the level that is filled to
  std::optional<InitialWaveCase> waves;  ///< then none of the others is given
};

/// A box in which the water's velocity is damped, so that waves do not come back from behind it.
struct DampingCase {
  Box box;                                 ///< m
  Vector3d direction = Vector3d::UnitX();  ///< along which the damping grows; any length but 0
  double strength = 0;                     ///< 1/s, at the box's far side; with the square of the way there
  Vector3d velocity = Vector3d::Zero();    ///< m/s, towards which
};

struct FluidCase {
  double density = 1000.0;               ///< kg/m³
  double viscosity = 1.0e-3;             ///< Pa·s, dynamic
  std::optional<double> sound_speed;     ///< m/s; none = automatic: 10 × the greatest expected speed
  std::optional<double> spacing;         ///< m; exactly one of spacing and particles is given
  std::optional<std::size_t> particles;  ///< approximate number of fluid particles
  std::vector<FillRegion> fill;          ///< at least one where there are no openings
  InitialCase initial;
  Vector3d current = Vector3d::Zero();  ///< m/s, of all water at the start, beside what `initial` says
  std::vector<DampingCase> damping;
};

/// A parametric rectangular tank.
struct BoxTank {
  Vector3d size = Vector3d::Zero();    ///< m; in 2-D size y is 0
  Vector3d origin = Vector3d::Zero();  ///< m, the corner of least coordinates
  bool closed = false;                 ///< true: with a lid; without one, the side nearest to against gravity is open
};

/// How the tank or a body moves.
enum class Motion {
  fixed,
  free,        ///< by its weight, the fluid, contacts, joints and outside forces
  prescribed,  ///< as the case says
  commanded    ///< at a velocity that is given while it runs
};

/// Along and about the axes of the case's coordinates (surge … yaw, REP 103), or along and about a motion's own axis (stroke, angle). In
/// 2-D surge, heave, pitch, stroke and angle exist. Rotations are about the motion's point, yaw after pitch after roll.
enum class Direction { surge, sway, heave, roll, pitch, yaw, stroke, angle };

/// amplitude · sin(2π frequency t + phase), less its value at t = 0, times a smooth rise from 0 to 1 over `rise`.
struct HarmonicCase {
  Direction direction = Direction::surge;
  double amplitude = 0;  ///< m or rad
  double frequency = 0;  ///< Hz
  double phase = 0;      ///< rad
  double rise = 0;       ///< s
};

/// A smooth change (velocity and acceleration continuous) between two times.
struct RampCase {
  Direction direction = Direction::surge;
  double change = 0;  ///< m or rad
  double from = 0;    ///< s
  double to = 0;      ///< s; > from
};

/// A column of a file of comma-separated values with one header line, followed by a natural cubic spline; held at its ends. Its value at
/// t = 0 counts as a displacement from the case's geometry.
struct RecordCase {
  std::string file;                    ///< package://, file://, absolute, or relative to the case file
  std::string time_column = "time";    ///< s, increasing
  std::string column;                  ///< empty: every column named as a direction
  std::optional<Direction> direction;  ///< of `column`; none = the one it is named after
  double factor = 1;                   ///< m or rad per unit of the column; negative turns it round
  double delay = 0;                    ///< s, added to the file's times
};

enum class WaveKind {
  regular,
  irregular,  ///< a sea of a spectrum
  focused,    ///< whose crests meet at one place and time
  solitary,
  record  ///< of a surface's elevation
};
enum class WaveSpectrum { jonswap, pierson_moskowitz };

/// Where and when the crests of a focused wave meet.
struct WaveFocusCase {
  double distance = 0;  ///< m, from the paddle at rest
  double time = 0;      ///< s
};

/// A column of elevations in a file of comma-separated values with one header line, of which the waves are the Fourier sum.
struct WaveRecordCase {
  std::string file;                  ///< package://, file://, absolute, or relative to the case file
  std::string time_column = "time";  ///< s, increasing
  std::string column = "elevation";
  double factor = 1;    ///< m per unit of the column
  double delay = 0;     ///< s, added to the file's times
  double distance = 0;  ///< m, from the paddle at rest to where it is to be seen
};

/// Of the waves that come back to a piston, by a gauge before it.
struct WaveAbsorptionCase {
  std::string gauge;             ///< of instruments/wave_gauges
  std::optional<double> recall;  ///< s, within which the paddle comes back to its middle; none = four periods
  std::optional<double> reach;   ///< m, farthest from where the theory has the paddle; none = what the tank leaves
};

/// Waves by theory, that a prescribed body makes as a piston (surge, sway, stroke) or a flap (pitch, angle).
struct WaveCase {
  WaveKind kind = WaveKind::regular;
  Direction direction = Direction::surge;
  bool reversed = false;  ///< the waves go against the direction
  double depth = 0;       ///< m, of still water before the paddle, over a level floor
  double hinge = 0;       ///< m over the floor, that a flap turns about
  double height = 0;      ///< m, from trough to crest; of a focused or solitary one the crest's over the still level
  double period = 0;      ///< s, of regular ones
  int order = 1;          ///< of the paddle's motion
  WaveSpectrum spectrum = WaveSpectrum::jonswap;  ///< of irregular and focused ones
  double significant_height = 0;                  ///< m, four standard deviations of the surface
  double peak_period = 0;                         ///< s, of the spectrum's peak
  double peak_enhancement = 3.3;                  ///< γ of jonswap
  int components = 200;
  int seed = 1;
  WaveFocusCase focus;
  WaveRecordCase record;
  std::optional<double> rise;  ///< s, from rest to the full motion; none = one period, or peak period
  std::optional<WaveAbsorptionCase> absorption;
};

struct PrescribedCase {
  std::optional<Vector3d> point;        ///< m, that rotations are about; none = centre of mass, for the tank the case's origin
  Vector3d axis{0.0, 1.0, 0.0};         ///< of stroke and angle; any length but 0
  std::vector<HarmonicCase> harmonics;  ///< all of these are added up, direction by direction
  std::vector<RampCase> ramps;
  std::vector<RecordCase> records;
  std::optional<WaveCase> waves;
};

/// Limits on a commanded motion; none = as it is commanded.
struct CommandCase {
  std::optional<double> greatest_speed;                       ///< m/s
  std::optional<double> greatest_angular_speed;               ///< rad/s
  std::optional<double> greatest_acceleration = 1.0;          ///< m/s²
  std::optional<double> greatest_angular_acceleration = 1.0;  ///< rad/s²
  double timeout = 0.5;  ///< s of simulated time without a command after which it brakes to a stop; 0 = never
};

/// A force on a free body from outside, constant or harmonic in time.
struct ForceCase {
  Vector3d force = Vector3d::Zero();   ///< N (2-D: N/m)
  Vector3d torque = Vector3d::Zero();  ///< N·m (2-D: N)
  std::optional<Vector3d> point;       ///< m, of the body as given, where the force acts; none = centre of mass
  bool turns_with_body = false;        ///< force and torque keep their direction in the body, as a thruster's
  double from = 0;                     ///< s
  std::optional<double> to;            ///< s; none = to the end
  double frequency = 0;                ///< Hz; 0 = constant, else times sin(2π frequency (t − from) + phase)
  double phase = 0;                    ///< rad
};

enum class MooringLine {
  spring,   ///< linear, with a damper along it
  catenary  ///< hangs by its weight, in rest at every instant
};

/// A line between a point of the world and one of a free body.
struct MooringCase {
  std::string name;                        ///< of its topic; empty = its place in the list, from 0
  MooringLine line = MooringLine::spring;  ///< what the line is
  Vector3d anchor = Vector3d::Zero();      ///< m, in the tank's coordinates; moves with the tank
  Vector3d attachment = Vector3d::Zero();  ///< m, of the body as given
  double stiffness = 0;                    ///< N/m (2-D: N/m²), of a spring
  double damping = 0;                      ///< N·s/m, of a spring
  std::optional<double> length;            ///< m, unstretched; none = the distance at the start; a catenary has one
  bool slack = true;                       ///< a spring pulls only, as a rope; else pushes too
  double weight = 0;                       ///< N/m (2-D: N/m²) of a catenary's length, in the water
  std::optional<double> axial_stiffness;   ///< N (2-D: N/m), EA of a catenary; none = it does not stretch
  bool bed = true;                         ///< a catenary lies, without friction, on a level bed at its anchor; else hangs below that too
};

/// Drag of the wind on what of a free body is over the water, ½ ρ C A |U − u| (U − u).
struct WindCase {
  Vector3d velocity = Vector3d::Zero();  ///< m/s, the mean
  double area = 0;                       ///< m² (2-D: m), that the wind meets
  std::optional<Vector3d> centre;        ///< m, of that area, of the body as given; none = centre of mass
  double drag_coefficient = 1;           ///< C
  double density = 1.225;                ///< kg/m³, of the air
  double gust_intensity = 0;             ///< standard deviation of the speed over its mean
  double gust_time = 10;                 ///< s, integral time scale of the gusts
  int seed = 1;                          ///< of the gusts
};

/// What stands for a body in contacts.
enum class CollisionShape {
  automatic,  ///< the box for a box; the convex hull where it fills less than 2 % more than the mesh; else a decomposition
  convex_hull,
  decomposition,  ///< convex parts, found automatically
  parts,          ///< convex hulls of the meshes listed
  none            ///< passes through everything but the fluid
};

/// What rigid-body dynamics asks of the tank or a body.
struct RigidCase {
  std::optional<double> mass;              ///< kg (2-D: kg/m)
  std::optional<double> density;           ///< kg/m³, of the volume enclosed; a free body has exactly one of mass and density
  std::optional<Vector3d> centre_of_mass;  ///< m; none = centre of volume
  std::optional<std::array<double, 6>>
      inertia;  ///< kg·m², xx yy zz xy xz yz about the centre of mass; none = of uniform density. 2-D: only yy counts
  Vector3d velocity = Vector3d::Zero();          ///< m/s, at the start
  Vector3d angular_velocity = Vector3d::Zero();  ///< rad/s, at the start
  double friction = 0.5;                         ///< Coulomb's; of two in contact, the product's root
  double restitution = 0.0;                      ///< of two in contact, the greater
  CollisionShape collision = CollisionShape::automatic;
  std::vector<MeshSource> collision_parts;
  bool water_film = true;  ///< of a free body: water presses on what of it lies on a wall or nearly so; else it is sealed there
  PrescribedCase prescribed;
  CommandCase command;
  std::vector<ForceCase> forces;
  std::vector<MooringCase> moorings;
  std::optional<WindCase> wind;
};

/// What holds the water back along a wall.
enum class FrictionLaw {
  as_case,  ///< of a body: that of numerics/walls/friction
  none,
  viscous,          ///< μ u/d at each particle's distance d: of a boundary layer that the particles resolve
  law_of_the_wall,  ///< ρ u_τ², with u_τ by the logarithmic law at each particle's distance, smooth or rough
  coefficient       ///< ½ C_f ρ u²
};

struct FrictionCase {
  FrictionLaw law = FrictionLaw::viscous;
  double coefficient = 0.003;  ///< C_f of `coefficient`
  double roughness = 0;        ///< m, the height k_s of Nikuradse's sand grains, of `law_of_the_wall`
};

/// Of a body.
struct SkinFrictionCase : FrictionCase {
  SkinFrictionCase() { law = FrictionLaw::as_case; }
};

struct TankCase {
  std::variant<BoxTank, MeshSource> shape;
  bool splash_guard =
      true;  ///< spray above the rim is kept over the tank, as if its walls went on upwards; else it is lost and the run stops
  std::array<bool, 3> periodic{};  ///< along x, y, z: what leaves the tank's bounding box at one end comes in at the other
  Motion motion = Motion::fixed;
  RigidCase rigid;
};

/// An inertial measurement unit of a body.
struct ImuCase {
  std::optional<Vector3d> position;  ///< m, of the body as given; none = centre of mass
};

struct BodyCase {
  std::string name;
  std::variant<Box, MeshSource> shape;
  Motion motion = Motion::fixed;
  Vector3d surface_velocity = Vector3d::Zero();  ///< m/s, of a belt: its surface runs while the body stands
  SkinFrictionCase skin_friction;
  RigidCase rigid;
  std::optional<ImuCase> imu;
};

enum class JointType {
  fixed,
  hinge,   ///< turns about the axis
  slider,  ///< slides along it
  ball,
  spring,  ///< a spring and a damper along the line between the two points
  six_dof  ///< limits along and about x, y, z
};

enum class JointQuantity { effort, velocity };

/// Of a hinge or a slider whose effort or velocity is commanded while it runs.
struct JointCommandCase {
  JointQuantity quantity = JointQuantity::effort;  ///< of the command
  std::optional<double> greatest_effort;           ///< N or N·m (2-D: a metre of width); none = no limit
  std::optional<double> greatest_velocity;         ///< m/s or rad/s, of commanded velocities
  double timeout = 0.5;  ///< s of simulated time without a command, after which an effort ends and a velocity brakes to 0; 0 = never
};

/// Between two bodies, or a body and the tank or the world.
struct JointCase {
  std::string name;
  JointType type = JointType::hinge;
  std::string parent = "world";                 ///< a body, "tank" or "world"
  std::string child;                            ///< a body
  Vector3d point = Vector3d::Zero();            ///< m, of the child; a spring's end on it
  std::optional<Vector3d> parent_point;         ///< m, a spring's end on the parent; only of a spring, and required there
  Vector3d axis{0.0, 1.0, 0.0};                 ///< of hinge and slider; any length but 0
  std::optional<std::array<double, 2>> limits;  ///< rad or m from the start, of hinge and slider; none = free
  std::array<std::optional<std::array<double, 2>>, 6>
      six_limits;                ///< of six_dof: x y z in m, roll pitch yaw in rad; none = free; equal = locked
  double stiffness = 0;          ///< N/m, N·m/rad about a hinge: towards the start
  double damping = 0;            ///< N·s/m, N·m·s/rad
  std::optional<double> length;  ///< m, of a spring unstretched; none = the distance at the start
  std::optional<JointCommandCase> command;
};

/// Of a joint of a robot. What it leaves out of the greatest effort and velocity is the URDF's `limit`, if that has it.
struct RobotCommandCase : JointCommandCase {
  std::string joint;  ///< its name in the URDF
};

/// A robot described in URDF, which reading a case turns into bodies and joints: a case that has been read has none of these.
struct RobotCase {
  std::string urdf;                      ///< file: package://, file://, absolute, or relative to the case file; or else ...
  std::string parameter;                 ///< ... the name of a ROS parameter that holds its text
  Vector3d position = Vector3d::Zero();  ///< m, of the root link's origin
  Vector3d rotation = Vector3d::Zero();  ///< rad, of the root link, roll-pitch-yaw about fixed axes
  Motion motion = Motion::free;          ///< of the root link: free or fixed
  std::vector<RobotCommandCase> commands;
};

/// What water does at an opening.
enum class OpeningKind {
  inlet,    ///< comes in as the opening's law says
  outlet,   ///< leaves freely, to a level beyond the opening, or at a discharge
  pressure  ///< stands under a head beyond the opening, and flows either way
};
enum class FlowQuantity { discharge, velocity, head };

/// A column of a file of comma-separated values with one header line, followed in straight lines; held at its ends.
struct FlowRecordCase {
  std::string file;                                 ///< package://, file://, absolute, or relative to the case file
  FlowQuantity quantity = FlowQuantity::discharge;  ///< of the column
  std::string time_column = "time";                 ///< s, increasing
  std::string column;                               ///< empty: named as the quantity
  double factor = 1;                                ///< m³/s (2-D: m²/s), m/s or m per unit of the column
  double delay = 0;                                 ///< s, added to the file's times
};

/// Limits on a discharge that is commanded while it runs; none = as it is commanded.
struct FlowCommandCase {
  std::optional<double> greatest_discharge;  ///< m³/s (2-D: m²/s)
  std::optional<double> greatest_rate;       ///< m³/s² (2-D: m²/s²), at which the discharge goes over to the one commanded
  double timeout = 0.5;                      ///< s of simulated time without a command after which the discharge goes to zero; 0 = never
};

/// A plane hole in a wall of the tank or of a body that is not free, through which water comes and goes.
struct OpeningCase {
  std::string name;
  OpeningKind kind = OpeningKind::inlet;
  std::string body;                           ///< in whose wall it is; empty = the tank
  Vector3d centre = Vector3d::Zero();         ///< m
  Vector3d normal = Vector3d::Zero();         ///< into the water; any length, 0 only with a part
  std::optional<std::array<double, 2>> size;  ///< m, width and height of a rectangle; the width is not used in 2-D
  std::optional<Vector3d> up;                 ///< direction of the height; none = against gravity, or else along x
  std::optional<double> diameter;             ///< m, of a disc; exactly one of size, diameter and part is given
  std::string part;                           ///< of the wall's mesh, by its name: the opening is where that is; empty = not given
  std::string velocity;                       ///< m/s, mean over the wet part: an expression of t, or of t and place; empty = not given
  std::string discharge;                      ///< m³/s (2-D: m²/s), likewise
  std::string head;                           ///< m, likewise: height that water beyond would stand to
  std::optional<FlowRecordCase> record;       ///< of one of these three, which is then not given
  std::optional<FlowCommandCase> command;     ///< the discharge is commanded: none of the above is given
  std::string profile = "uniform";            ///< of the velocity, where it is given: uniform, parabolic, or an expression of x, y, z
  std::string returns_to;                     ///< of an outlet: the inlet, without a law of its own, by which what leaves comes in again
  std::optional<double> level;                ///< m, of the free surface: of water that comes in; beyond an outlet
};

enum class WallMethod { boundary_integral, ghost };
enum class ShepardFactor { none, volumetric, monolithic, geometric };
enum class WallElements { numerical, semi_analytical, facet };
enum class Slip { no_slip, free_slip };
enum class Precision { single, double_ };
/// What the fluid does where its pressure would fall below that of the air, which is not simulated.
enum class NegativePressure { allowed, clamped };

struct WallCase {
  WallMethod method = WallMethod::boundary_integral;
  ShepardFactor shepard = ShepardFactor::geometric;
  WallElements elements = WallElements::facet;
  Slip slip = Slip::no_slip;
  FrictionCase friction;               ///< of walls without slip; not as_case
  bool renormalise_divergence = true;  ///< divide the velocity's divergence by the Shepard factor, as the pressure's gradient
  double repulsion = 0.0;              ///< of ghosts: short-range force as a multiple of (c₀/10)²; 0 = none
  double guard_distance = 0.1;         ///< of the spacing: nearer to a wall, a particle loses its approaching normal velocity; 0 = off
};

struct PackingCase {
  int iterations = 100;  ///< at most; 0 = start from the lattice
  double settling = 0;   ///< of damped steps before the start, in periods 4 H/c₀ of the slowest sound; 0 = none
};

/// Of the second-order moving least squares that `gradients` may go by.
struct LeastSquaresCase {
  MlsPressure pressure = MlsPressure::automatic;  ///< form of the pressure's gradient
  double pivot = 0.05;                            ///< least part of a basis function that those before it do not explain
  std::optional<double> support;                  ///< R_m/Δx of the fit's weights; none = 3.4 in 2-D, 2.6 in 3-D
};

struct NumericsCase {
  Scheme scheme = Scheme::delta_sph;
  double limiter = 1.0;  ///< θ of Riemann schemes' limiter, from 1 to 2
  Gradients gradients = Gradients::sph;
  LeastSquaresCase mls;
  std::optional<double> support;  ///< R/Δx; none = 4 in 2-D, 3 in 3-D
  WallCase walls;
  DensityDiffusion density_diffusion = DensityDiffusion::fourtakas;
  double density_diffusion_coefficient = 0.1;  ///< δ
  double artificial_viscosity = 0.02;          ///< α
  double acoustic_damping = 0;                 ///< α₂
  Turbulence turbulence = Turbulence::none;
  double smagorinsky_coefficient = 0.15;  ///< C_s
  EquationOfState equation_of_state = EquationOfState::linear;
  ViscosityModel viscosity_model = ViscosityModel::monaghan_gingold;
  NegativePressure negative_pressure = NegativePressure::clamped;
  Shifting shifting = Shifting::none;
  Tensile tensile = Tensile::hybrid;     ///< where shifting laws hold particles apart that come close
  std::optional<double> expected_speed;  ///< m/s, of shifting laws; none = a tenth of the speed of sound
  Integrator integrator = Integrator::symplectic;
  double courant = 0.5;  ///< Δt as a fraction of h/(c₀ + |u|)
  Precision precision = Precision::single;
  PackingCase packing;
};

struct PressureProbeCase {
  std::string name;
  Vector3d position = Vector3d::Zero();  ///< m, at the start
  std::string body;                      ///< that it is fixed to; empty = the tank
  double diameter = 0;  ///< m, of the sensor's disc on its wall (2-D: length of its strip), whose mean it reads; 0 = a point
};

struct WaveGaugeCase {
  std::string name;
  Vector3d position = Vector3d::Zero();  ///< m; a point of the line: along z, or the axis nearest to gravity, it is not used
};

struct VelocityProbeCase {
  std::string name;
  Vector3d position = Vector3d::Zero();  ///< m, at the start
  std::string body;                      ///< that it is fixed to; empty = the tank
};

/// A plane rectangle or disc in the water, through which the discharge is measured.
struct FlowSectionCase {
  std::string name;
  Vector3d centre = Vector3d::Zero();         ///< m
  Vector3d normal = Vector3d::Zero();         ///< the way that counts as positive; any length but 0
  std::optional<std::array<double, 2>> size;  ///< m, width and height of a rectangle; the width is not used in 2-D
  std::optional<Vector3d> up;                 ///< direction of the height; none = against gravity, or else along x
  std::optional<double> diameter;             ///< m, of a disc; exactly one of size and diameter is given
};

struct InstrumentsCase {
  std::vector<PressureProbeCase> pressure_probes;
  std::vector<WaveGaugeCase> wave_gauges;
  std::vector<VelocityProbeCase> velocity_probes;
  std::vector<FlowSectionCase> sections;
  double rate = 1000.0;               ///< Hz of simulated time, of every instrument that has no rate of its own
  std::optional<double> gauge_rate;   ///< Hz
  std::optional<double> wrench_rate;  ///< Hz
  std::optional<double> energy_rate;  ///< Hz
  std::optional<double> flow_rate;    ///< Hz, of discharges at openings and through sections
  std::optional<double> pose_rate;    ///< Hz, of moving bodies' poses, joints and moorings; none = 100, or `rate` where that is less
  std::optional<double> imu_rate;     ///< Hz, of inertial measurement units; none = that of poses
};

/// How the node publishes; the solver does not know of it.
struct PublishingCase {
  double cloud_rate = 20.0;          ///< Hz of wall time, of clouds while someone listens
  double cloud_bag_rate = 50.0;      ///< Hz of simulated time, of clouds in a bag written by wavetank_run --clouds
  double surface_rate = 10.0;        ///< Hz of wall time, at most, of the water's surface while someone listens
  double surface_bag_rate = 20.0;    ///< Hz of simulated time, of the water's surface in a bag written by wavetank_run --surface
  int max_points = 50000;            ///< of a cloud; more are decimated
  double reference_pressure = 0.0;   ///< Pa, added to gauge pressure in sensor_msgs/FluidPressure
  std::string world_frame = "tank";  ///< tf frame of the case's coordinates
  bool publish_clock = false;        ///< publish /clock from the simulated time
  double real_time_factor = 0.0;     ///< upper limit of simulated over wall time; 0 = as fast as it goes
};

struct Case {
  std::string title;
  int dimensions = 3;                 ///< 2 or 3
  Vector3d gravity{0.0, 0.0, -9.81};  ///< m/s², of any direction
  double duration = 0.0;              ///< s of simulated time; > 0
  std::string device = "auto";        ///< auto, cpu, gpu, a part of a device's name, or platform:device
  FluidCase fluid;
  TankCase tank;
  std::vector<BodyCase> bodies;
  std::vector<JointCase> joints;
  std::vector<RobotCase> robots;
  std::vector<OpeningCase> openings;
  NumericsCase numerics;
  InstrumentsCase instruments;
  PublishingCase publishing;
  std::string directory;  ///< of the case file, that relative mesh paths refer to; empty when it came from parameters
};

/// What holds the water back along the walls of an owner: 0 the tank, 1 + i body i. Never as_case.
FrictionCase friction_of(const Case& scene, std::size_t owner);

}  // namespace wavetank
