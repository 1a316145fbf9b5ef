// The equations of state as kernels have them: the compression at a pressure is that which has this pressure.
#include <algorithm>

#include "../../src/sph/methods/method.h"
#include "../../src/sph/tables/device_sizes.h"
#include "../../src/sph/tables/rows.h"
#include "sph_fixture.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/compute/program.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank::equation_of_state_test {
namespace {

const char* const there_and_back = R"(
#include "tile.cl"
#include "equation_of_state.cl"
EQUATION_OF_STATE(real, own)

__kernel void there_and_back(__constant const parameters_t* p, int count, __global const real* compressions, __global real* found) {
  const int i = get_global_id(0);
  if (i < count) found[i] = own_compression(p, own_pressure(p, compressions[i]));
}
)";

/// Of each, the compression at the pressure that it has.
template <class Real>
std::vector<Real> found_for(EquationOfState equation, const std::vector<Real>& compressions) {
  Case scene = box_case(Vector3d(0.5, 0, 0.4), 0.25, 0.025);
  scene.numerics.equation_of_state = equation;
  const Layout layout = lay_out(scene);
  scene = settled(scene, layout);
  const SolverRows rows = rows_for(scene);
  const ParameterBlock block(rows.parameters, ParameterSource{scene, layout, discretise(scene, layout), {}, 0});
  const compute::Buffer<char> parameters(test_device(), block.bytes<Real>());
  compute::SourceFiles files = kernel_sources();
  add_sources(rows.methods(scene), files);
  files["parameters.cl"] = parameters_header(rows.parameters);
  files["sizes.cl"] = sizes_header();
  files["fields.cl"] = FieldTable(rows.fields).header();
  files["there_and_back.cl"] = there_and_back;
  const std::string options =
      "-DDIMENSIONS=2 -DTILE_OWN=1 -DTILE_NEAR=1 -DUSE_DOUBLE=" + std::to_string(sizeof(Real) == sizeof(double) ? 1 : 0) +
      " -cl-fast-relaxed-math";
  const compute::Program program(test_device(), files, "there_and_back.cl", options);
  const compute::Buffer<Real> given(test_device(), compressions);
  compute::Buffer<Real> found(test_device(), compressions.size());
  program.kernel("there_and_back").launch(compressions.size(), parameters, static_cast<int>(compressions.size()), given, found);
  return found.download();
}

template <class Real>
void expect_same(EquationOfState equation, double least, double most, double tolerance) {
  std::vector<Real> compressions;
  for (int k = 0; k <= 100; ++k) compressions.push_back(static_cast<Real>(least + (most - least) * k / 100));
  const std::vector<Real> found = found_for<Real>(equation, compressions);
  double worst = 0;
  for (std::size_t k = 0; k < found.size(); ++k) worst = std::max(worst, std::abs(static_cast<double>(found[k] - compressions[k])));
  std::printf("%s between %g and %g: off by %.2g at the most\n", word_of(equation).c_str(), least, most, worst);
  EXPECT_LT(worst, tolerance);
}

TEST(EquationsOfState, AreTheirOwnInverses) {
  for (const EquationOfState equation : {EquationOfState::linear, EquationOfState::cole}) {
    expect_same<float>(equation, -0.2, 0.2, 1e-6);
    expect_same<float>(equation, -0.35, 0.3, 2e-5);
    if (!has_precision(Precision::double_)) continue;
    expect_same<double>(equation, -0.2, 0.2, 1e-10);
    expect_same<double>(equation, -0.05, 0.05, 1e-14);
  }
}

}  // namespace
}  // namespace wavetank::equation_of_state_test
