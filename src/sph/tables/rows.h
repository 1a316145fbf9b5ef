#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "../integrators/integrator.h"
#include "../methods/method.h"
#include "../parting.h"
#include "fields.h"
#include "parameters.h"
#include "reports.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// What a solver is made of beside its kernels. The methods that a case chooses bring rows of their own.
struct SolverRows {
  std::vector<FieldRow> fields = common_fields();
  std::vector<ParameterRow> parameters = common_parameters();
  std::vector<ReportRow> reports = common_reports();
  std::function<Methods(const Case&)> methods = methods_of;
  /// The steps of a case; `engine` may be null where they are not run.
  std::function<Schedule(const Case&, StepEngine* engine)> integrator = [](const Case& scene, StepEngine* engine) {
    return schedule_of(scene, engine);
  };
  std::optional<Parting> parting;  ///< of a solver of a part of the water
};

/// Those of a case, with what its methods bring.
SolverRows rows_for(const Case& settled_case, SolverRows rows = SolverRows());

/// As make_solver, with these rows.
std::unique_ptr<Solver> make_solver_of(const SolverRows& rows, const compute::Device& device, const Case& settled_case,
                                       const Layout& layout, const Discretisation& discretisation,
                                       const std::vector<Eigen::Vector3d>& centres);

}  // namespace wavetank
