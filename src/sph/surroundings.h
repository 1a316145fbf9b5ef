#pragma once

#include "barriers.h"
#include "particle_grid.h"
#include "solver_kernels.h"
#include "wall_arrays.h"
#include "wavetank/compute/program.h"

namespace wavetank {

/// What every kernel that goes over neighbours reads besides the particles.
template <class Real>
struct Surroundings {
  using Buffer = compute::Buffer<Real>;

  /// Queues such a kernel over `count` particles, points or walls; `others` are its own arguments.
  template <class... Others>
  void sweep(const SweepKernel& sweep, int count, const Buffer& state, const WallArrays<Real>& walls, const Others&... others) const {
    sweep.kernel.launch((count + sweep.own - 1) / sweep.own, parameters, count, grid.starts(), state, stride, reach, walls.starts,
                        walls.list, walls.fields, walls.stride, motions.on_device(), barriers.starts.on_device(), barriers.list.on_device(),
                        barriers.planes.on_device(), barriers.edge_starts.on_device(), barriers.edge_list.on_device(),
                        barriers.edges.on_device(), images, others...);
  }

  compute::Buffer<char> parameters;
  Stride stride = 0;  ///< of particles, from a field to the next
  Real reach = 0;     ///< the support, and how far a particle may have moved since it was sorted, m
  ParticleGrid grid;
  KeptBuffer<Real> motions;  ///< field::frame_count values of the frame, field::motion_count of each owner
  Barriers<Real> barriers;
  Buffer images;
  KeptBuffer<Real> film;  ///< as film.cl has it, for the kernels that ask for it
};

}  // namespace wavetank
