#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "wavetank/node/stamps.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

enum class CloudFields {
  surface,  ///< x y z (m) vx vy vz (m/s) pressure (Pa, gauge)
  all       ///< those and density (kg/m³) shepard (γ, 0…1) surface (1 on the free surface, else 0) eigenvalue (λ, 0…1)
};

/// A cloud as a message of unordered points, every field float32. At most max_points of them: thinned evenly, and by the particles' ids, so
/// that the same particles are drawn in every picture.
sensor_msgs::PointCloud2 cloud_message(const ParticleCloud& cloud, CloudFields fields, int max_points, const std::string& frame,
                                       const StampClock& clock);

/// The particles of a cloud that lie on the free surface.
ParticleCloud surface_of(const ParticleCloud& cloud);

}  // namespace wavetank
