#pragma once

#include <memory>

#include "wavetank/scene/case.h"

namespace wavetank {

/// The water at the start as `fluid/initial` has it: from expressions, or from waves by theory. Not to be shared between threads.
class InitialState {
 public:
  explicit InitialState(const Case& checked);
  ~InitialState();

  /// Whether the surface is other than level.
  bool has_elevation() const;
  bool has_velocity(int axis) const;
  bool has_pressure() const;
  /// Of the free surface over the level that is filled to, m. Throws Error, as the others do, where it is not finite, with key and place.
  double elevation(const Vector3d& place) const;
  double velocity(int axis, const Vector3d& place) const;  ///< m/s
  double pressure(const Vector3d& place) const;            ///< Pa

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// The level that a region is filled to: the coordinate of its surface along the axis of the tank's top, m.
double filled_to(const FillRegion& region, const Case& checked);

/// Of waves that repeat themselves, by their wavelength or period, 1/m; 0 of a solitary one.
double wave_number_of(const InitialWaveCase& wave, double gravity);

}  // namespace wavetank
