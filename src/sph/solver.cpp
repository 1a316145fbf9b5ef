#include "wavetank/sph/solver.h"

#include <algorithm>
#include <limits>
#include <set>

#include "sph_solver.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

/// A device gives so much memory in all, in pieces of bounded size, and kernels count particles with an int.
void check_size(const SolverRows& rows, const compute::DeviceInfo& device, std::size_t particles, std::size_t bytes_a_value) {
  const FieldTable fields(rows.fields);
  const std::size_t largest = fields.count(ParticleArray::state);                     // array's values of a particle
  const std::size_t least_values = 2 * largest + fields.count(ParticleArray::rates);  // of a particle, in all
  constexpr std::size_t most_counted = std::numeric_limits<int>::max() / 2;
  const std::size_t most =
      std::min({most_counted, device.max_allocation / (largest * bytes_a_value), device.global_memory / (least_values * bytes_a_value)});
  if (particles <= most) return;
  throw Error("the case has " + std::to_string(particles) + " particles, but the device " + device.describe() + " can hold no more than " +
              std::to_string(most) + " of them: enlarge fluid/spacing, or choose another device.");
}

}  // namespace

SolverRows rows_for(const Case& settled_case, SolverRows rows) {
  std::vector<ParameterRow> numbers = parameters_of_every_method(settled_case);
  std::set<std::string> brought;
  for (const Method& method : rows.methods(settled_case)) {
    for (const FieldRow& field : method.fields) {
      const auto same = std::find_if(rows.fields.begin(), rows.fields.end(), [&](const FieldRow& other) {
        return other.array == field.array && other.components == field.components;
      });
      if (same == rows.fields.end())
        rows.fields.push_back(field);
      else
        *same = field;
    }
    rows.reports.insert(rows.reports.end(), method.reports.begin(), method.reports.end());
    for (const ParameterRow& row : method.parameters) {
      const auto same = std::find_if(numbers.begin(), numbers.end(), [&](const ParameterRow& other) { return other.name == row.name; });
      if (brought.insert(row.name).second && same != numbers.end())
        *same = row;
      else
        numbers.push_back(row);
    }
  }
  rows.parameters.insert(rows.parameters.end(), numbers.begin(), numbers.end());
  return rows;
}

std::unique_ptr<Solver> make_solver_of(const SolverRows& given, const compute::Device& device, const Case& settled_case,
                                       const Layout& layout, const Discretisation& discretisation,
                                       const std::vector<Eigen::Vector3d>& centres) {
  const SolverRows rows = rows_for(settled_case, given);
  const bool single = settled_case.numerics.precision == Precision::single;
  check_size(rows, device.info(), layout.particles.size(), single ? sizeof(float) : sizeof(double));
  if (single) return std::make_unique<SphSolver<float>>(rows, device, settled_case, layout, discretisation, centres);
  if (!device.info().has_double)
    throw Error("numerics/precision is double, but the device " + device.info().describe() +
                " has no double precision: choose single or another device.");
  return std::make_unique<SphSolver<double>>(rows, device, settled_case, layout, discretisation, centres);
}

std::unique_ptr<Solver> make_solver(const compute::Device& device, const Case& settled_case, const Layout& layout,
                                    const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres) {
  return make_solver_of(SolverRows(), device, settled_case, layout, discretisation, centres);
}

}  // namespace wavetank
