#pragma once

#include "barriers.h"
#include "particle_grid.h"
#include "wall_arrays.h"
#include "wavetank/compute/arguments.h"

namespace wavetank {

/// What every kernel that goes over neighbours reads besides the particles.
template <class Real>
struct Surroundings {
  /// All of it, and the walls, under the names that kernels have for them.
  compute::Arguments arguments(const WallArrays<Real>& walls) const;

  compute::Buffer<char> parameters;
  Stride stride = 0;  ///< of particles, from a field to the next
  Real reach = 0;     ///< the support, and how far a particle may have moved since it was sorted, m
  ParticleGrid grid;
  KeptBuffer<Real> motions;  ///< field::frame_count values of the frame, field::motion_count of each owner
  Barriers<Real> barriers;
  compute::Buffer<Real> images;
  KeptBuffer<Real> film;  ///< as film.cl has it
};

template <class Real>
compute::Arguments Surroundings<Real>::arguments(const WallArrays<Real>& walls) const {
  compute::Arguments arguments({{"real", compute::KernelType<Real>::name}, {"parameters_t", compute::KernelType<char>::name}});
  arguments.memory("p", parameters).memory("slot_start", grid.starts()).value("stride", stride).value("reach", reach);
  arguments.memory("wall_start", walls.starts).memory("wall_list", walls.list).memory("wall_fields", walls.fields);
  arguments.value("wall_stride", walls.stride).memory("wall_motions", motions.on_device());
  arguments.memory("barrier_start", barriers.starts.on_device()).memory("barrier_list", barriers.list.on_device());
  arguments.memory("barriers", barriers.planes.on_device()).memory("edge_start", barriers.edge_starts.on_device());
  arguments.memory("edge_list", barriers.edge_list.on_device()).memory("edges", barriers.edges.on_device());
  arguments.memory("images", images).memory("film", film.on_device());
  return arguments;
}

}  // namespace wavetank
