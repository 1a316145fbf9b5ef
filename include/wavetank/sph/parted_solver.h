#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "wavetank/parallel/group.h"
#include "wavetank/sph/parts_need.h"
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

/// The water in as many slabs as there are devices, which may be one device several times; each does all that a solver does with its own
/// particles. State and readings are the same to the last bit for any number of parts on devices of one kind, but for the errors that
/// pack() reports; they are not those of make_solver(), whose sums have another order. download() and find_surface() have the particles in
/// the order of their ids. Throws Error, in one sentence, for a case that cannot be cut into parts.
std::unique_ptr<Solver> make_parted_solver(const std::vector<compute::Device>& devices, const Case& settled_case, const Layout& layout,
                                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres,
                                           const PartedSolverOptions& options = {});

/// The same with a part in each process of a team, by the one that has the first. The others
/// make theirs with it, by work_of_part, from the case as `scene_text` has it. Throws Error besides if one of them has made another of it;
/// tells of those whose bits may be others, and of those that were given too few cores.
std::unique_ptr<Solver> make_parted_solver(parallel::Team& team, const compute::Device& device, const std::string& scene_text,
                                           const Case& settled_case, const Layout& layout, const Discretisation& discretisation,
                                           const std::vector<Eigen::Vector3d>& centres);

/// Makes one part at a time. Throws Error if the water is too short for them, or the device too small.
PartsNeed need_of_parts(int parts, const compute::Device& device, const Case& settled_case, const Layout& layout,
                        const Discretisation& discretisation);

/// What another process of the team makes its part of.
struct PreparedPart {
  compute::Device device;
  Case scene;  ///< settled
  Layout layout;
  Discretisation discretisation;
};
using PartPreparation = std::function<PreparedPart(const std::string& scene_text)>;

/// What that process does for the first. `member` must outlive it.
parallel::Team::Work work_of_part(parallel::Group& member, PartPreparation prepare);

}  // namespace wavetank
