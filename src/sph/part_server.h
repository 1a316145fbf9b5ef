#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "part_messages.h"
#include "water_part.h"
#include "wavetank/compute/device.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/parallel/group.h"
#include "wavetank/parallel/packed.h"
#include "wavetank/sph/discretisation.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// Makes the steps of one part of the water, as orders have it.
class PartServer {
 public:
  virtual ~PartServer() = default;
  virtual parallel::Bytes obey(const parallel::Bytes& order) = 0;
  virtual PartFacts facts() const = 0;
  // of states as SphSolver has them
  virtual parallel::Bytes laid_out_state(const Layout& layout) const = 0;
  virtual void check_state(const parallel::Bytes& state) const = 0;
  virtual std::vector<std::int64_t> particles_in_blocks(const parallel::Bytes& state) const = 0;
  virtual std::vector<std::int64_t> particles_in_places(const parallel::Bytes& state) const = 0;
  virtual parallel::Bytes joined(const std::vector<parallel::Bytes>& parts) const = 0;
  virtual std::optional<ThinWall> thinnest_wall() const = 0;
  virtual std::size_t memory_for(const std::vector<int>& cuts, const parallel::Bytes& state) = 0;
  /// Of the last step, or the start, the same of all parts.
  virtual const StepReport& report() const = 0;
  virtual const PackingReport& packing() const = 0;
  /// Of the next step, s, after an order to shorten it.
  virtual double time_step() const = 0;
  /// As SphSolver has these.
  virtual double imbalance() const = 0;
  virtual const Exchanged& exchanged() const = 0;
  /// Of all the water.
  virtual std::size_t particles() const = 0;
  /// Of the part that has bodies: who moves them in the next step.
  virtual void lead(WallMover* mover) = 0;
  /// Of one part: whom it tells how far packing and settling are.
  virtual void tell(const std::function<void(double fraction)>& progress) = 0;
  /// As they were asked for last, the same of all parts.
  virtual const std::vector<WallWrench>& wrenches() const = 0;
  virtual const FluidEnergies& energies() const = 0;
  /// Where walls went in the last step that moved them.
  virtual const std::optional<WallMotions>& motions() const = 0;
};

/// Throws Error for a device without the precision that the case asks for.
void check_precision(const Case& scene, const compute::Device& device);

/// Throws Error as make_solver does. `layout`: of all the water.
std::unique_ptr<PartServer> make_part_server(const compute::Device& device, const Parting& parting, const Case& settled_case,
                                             const Layout& layout, const Discretisation& discretisation,
                                             const std::vector<Eigen::Vector3d>& centres);

}  // namespace wavetank
