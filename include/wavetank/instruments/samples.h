#pragma once

#include <Eigen/Core>
#include <vector>

#include "wavetank/rigid/rigid_state.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

using Eigen::Vector3d;

struct PressureSample {
  double time = 0;                ///< s, exactly on the instrument's clock
  std::vector<double> pressures;  ///< Pa, gauge, in the case's order of pressure probes
};

struct LevelSample {
  double time = 0;  ///< s
  std::vector<double>
      levels;  ///< m, of the free surface on each gauge's line: z, or the axis of the tank's top; the floor's where it is dry
};

/// Of the fluid on a body, in the body's axes about its reference point (RigidState): the centre of mass, or for a tank that is not free
/// the case's origin. 2-D: per metre of width.
struct Wrench {
  Vector3d pressure_force = Vector3d::Zero();   ///< N
  Vector3d viscous_force = Vector3d::Zero();    ///< N
  Vector3d pressure_torque = Vector3d::Zero();  ///< N·m
  Vector3d viscous_torque = Vector3d::Zero();   ///< N·m
};

struct WrenchSample {
  double time = 0;               ///< s
  std::vector<Wrench> wrenches;  ///< 0 the tank, 1 + i body i
};

struct PoseSample {
  double time = 0;                 ///< s
  std::vector<RigidState> states;  ///< 0 the tank, in the world; 1 + i body i, relative to the tank and in its axes
  std::vector<JointState> joints;  ///< in the case's order
};

/// Of the water.
struct EnergySample {
  double time = 0;          ///< s
  double kinetic = 0;       ///< J (2-D: J/m), of its motion in the tank
  double potential = 0;     ///< J, −Σ m g·x about the domain's lowest place at the start, wherever the tank is
  double compression = 0;   ///< J, of the fluid's elasticity
  double mass = 0;          ///< kg (2-D: kg/m)
  double damper_power = 0;  ///< W (2-D: W/m), that the acoustic damper takes of sound
};

/// Of what passes one opening.
struct FlowAtOpening {
  double discharge = 0;  ///< m³/s (2-D: m²/s), into the water; negative: out of it
  double volume = 0;     ///< m³ (2-D: m²), that has come in less what has left, at the fluid's density ρ₀
};

struct FlowSample {
  double time = 0;                   ///< s
  std::vector<FlowAtOpening> flows;  ///< in the case's order of openings
};

struct VelocitySample {
  double time = 0;  ///< s
  /// m/s, relative to the tank and in its axes, in the case's order of velocity probes; no numbers where it is dry.
  std::vector<Vector3d> velocities;
};

struct FlowThroughSection {
  double discharge = 0;  ///< m³/s (2-D: m²/s), along the section's normal
  double area = 0;       ///< m² (2-D: m), of it that is wet
};

struct SectionSample {
  double time = 0;                        ///< s
  std::vector<FlowThroughSection> flows;  ///< in the case's order of sections
};

/// Of an inertial measurement unit: its axes are the body's.
struct ImuReading {
  Quaterniond orientation = Quaterniond::Identity();  ///< in the world
  Vector3d angular_velocity = Vector3d::Zero();       ///< rad/s, in its own axes
  /// m/s², acceleration less gravity, in its own axes: the mean since the sample before, as of a sensor that no vibration deceives; of the
  /// first sample that of its instant.
  Vector3d specific_force = Vector3d::Zero();
};

struct ImuSample {
  double time = 0;                   ///< s
  std::vector<ImuReading> readings;  ///< of the bodies that have one, in the case's order
};

struct MooringSample {
  double time = 0;                     ///< s
  std::vector<MooringState> moorings;  ///< of the tank and then of the bodies, in the case's order
};

/// What the instruments recorded since it was last taken; each list in order of time, every sample exactly once.
struct Samples {
  std::vector<PressureSample> pressures;
  std::vector<LevelSample> levels;
  std::vector<WrenchSample> wrenches;
  std::vector<EnergySample> energies;
  std::vector<PoseSample> poses;           ///< only where something moves
  std::vector<FlowSample> flows;           ///< only of cases with openings
  std::vector<VelocitySample> velocities;  ///< only of cases with velocity probes
  std::vector<SectionSample> sections;     ///< only of cases with sections
  std::vector<ImuSample> imus;             ///< only of cases with inertial measurement units
  std::vector<MooringSample> moorings;     ///< only of cases with moorings
};

}  // namespace wavetank
