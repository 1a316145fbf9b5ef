#include "wavetank/sph/solver.h"

#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {

std::unique_ptr<Solver> make_solver(const compute::Device& device, const Case& settled_case, const Layout& layout,
                                    const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres) {
  if (settled_case.numerics.precision == Precision::single)
    return std::make_unique<SphSolver<float>>(device, settled_case, layout, discretisation, centres);
  if (!device.info().has_double)
    throw Error("numerics/precision is double, but the device " + device.info().describe() +
                " has no double precision: choose single or another device.");
  return std::make_unique<SphSolver<double>>(device, settled_case, layout, discretisation, centres);
}

}  // namespace wavetank
