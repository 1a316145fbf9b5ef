#pragma once

#include <memory>
#include <vector>

#include "wavetank/sph/solver.h"

namespace wavetank {

/// For tests of the parts themselves.
struct PartedSolverOptions {
  int halo_less = 0;         ///< places by which halos are narrower than they must be
  bool spoils = false;       ///< what a part has not been sent yet of its halo is not a number
  int cut_every = 0;         ///< steps after which the water is cut anew whatever it costs; 0: when that pays
  int uneven = 0;            ///< blocks by which the first cut is moved
  bool takes_turns = false;  ///< one part runs at a time
};

/// The water in as many slabs as there are devices, which may be one device several times. Steps are made by all of them; what comes before
/// the first step, and whatever is read or saved, by one solver of all the water on the first device, to which the parts then bring their
/// particles. The state is the same to the last bit for any number of parts on devices of one kind; it is not that of make_solver(), whose
/// sums have another order.
/// Throws Error, in one sentence, for a case that cannot be cut into parts.
std::unique_ptr<Solver> make_parted_solver(const std::vector<compute::Device>& devices, const Case& settled_case, const Layout& layout,
                                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres,
                                           const PartedSolverOptions& options = {});

}  // namespace wavetank
