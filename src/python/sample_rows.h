#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "wavetank/instruments/samples.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

/// Samples of one kind: a time and a row of numbers each.
struct Rows {
  std::size_t width = 0;       ///< numbers in a row
  std::vector<double> times;   ///< s
  std::vector<double> values;  ///< row after row
};

/// What the instruments sample, as arrays of numbers, which are those of the messages that a bag of the same run has, to the last bit.
/// Kinds, and what a row of each has:
/// - pressures: Pa, by probe; levels: m, by gauge
/// - wrenches: by owner (0 the tank, 1 + i body i) the fluid's force (N) and torque (N·m), then the pressure's, then the viscous, each
///   in the body's axes about its frame's origin
/// - poses: by owner position (m) and orientation (x y z w) of its frame, velocity (m/s) and angular velocity (rad/s) in its own axes
/// - joints: by joint position, velocity, effort
/// - flows: by opening discharge (m³/s) and volume (m³); sections: by section discharge (m³/s) and wet area (m²)
/// - velocities: m/s, by velocity probe
/// - imus: by body that has one orientation (x y z w), angular velocity (rad/s), specific force (m/s²)
/// - moorings: of the tank, then of the bodies, tension (N), that at the anchor (N), length that lies on the bed (m)
/// - energies: kinetic, potential, of compression (J), mass (kg), power of the acoustic damper (W)
class SampleRows {
 public:
  /// `world` is looked at while samples are added.
  explicit SampleRows(const RigidWorld& world) : world_(world) {}
  void add(const Samples& samples);
  /// Everything since the last time, which is then forgotten; kinds without a sample are left out.
  std::map<std::string, Rows> take();
  /// The newest sample of each kind, taken or not.
  const std::map<std::string, Rows>& newest() const { return newest_; }
  void clear();

 private:
  template <class Sample, class Fill>
  void add_kind(const std::string& kind, const std::vector<Sample>& samples, Fill fill);

  const RigidWorld& world_;
  std::map<std::string, Rows> rows_, newest_;
};

}  // namespace wavetank
