#pragma once

#include <memory>
#include <string>

#include "wavetank/geometry/mesh.h"
#include "wavetank/rigid/rigid_state.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// A prescribed motion: harmonics, ramps, records and waves added up direction by direction. Velocity and acceleration are the derivatives
/// of the position and orientation that it gives, exactly, rotations included (roll, then pitch, then yaw, then the own axis' angle, about
/// fixed axes through the motion's point). Before t = 0 it rests where it is at t = 0.
/// Its axis in 2-D: a stroke needs one in the x–z plane; the angle is about +y, or −y where the axis points that way.
class PrescribedMotion {
 public:
  /// `gravity`: m/s², downwards, of the waves that a paddle makes. `reference`: of the RigidState, the case's origin or the body's centre
  /// of mass, as given. `what` opens the messages. Throws Error for a record that cannot be read, has no such column, unordered times, a
  /// value that is no number (file, line), or fewer than two lines; for a direction that does not exist in 2-D; and for numbers that make
  /// no motion.
  PrescribedMotion(const PrescribedCase& prescribed, const Vector3d& reference, int dimensions, double gravity,
                   const std::string& case_directory, const ResourceResolver& resolve, const std::string& what);
  ~PrescribedMotion();
  PrescribedMotion(PrescribedMotion&&) noexcept;
  PrescribedMotion& operator=(PrescribedMotion&&) noexcept;

  RigidState at(double time) const;
  /// The greatest speed of any point of the box over [0, duration], m/s, found on a grid of times: what the speed of sound must allow for.
  double greatest_speed(const Box& box, double duration) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace wavetank
