// What moving least squares are not built for, and where water would not rest with them, is refused when the case is read.
#include "broken_case.h"

namespace wavetank::least_squares_errors_test {

namespace {

const char* const sound = R"(dimensions: 2
duration: 2
fluid:
  spacing: 0.1
  fill:
    - box: {min: [0, 0], max: [1, 1]}
tank:
  box: {size: [2, 2]}
numerics:
  gradients: mls_corrected
  support: 4
  mls: {support: 3, pivot: 0.05, pressure: auto}
  walls: {method: ghost}
)";

class BrokenLeastSquares : public testing::TestWithParam<Fault> {};

TEST(LeastSquaresCase, Reads) {
  EXPECT_EQ(error_of(sound), "(no error)");
  for (const char* gradients : {"mls", "sph\n  mls: {pressure: sum}"}) {
    const std::string text = replaced(sound, "mls_corrected", gradients);
    EXPECT_EQ(error_of(text) == "(no error)", std::string(gradients) == "mls") << error_of(text);
  }
}

TEST(LeastSquaresCase, IsWrittenAsItIsRead) {
  const Case read = read_case_text(sound, "case.yaml");
  EXPECT_EQ(read.numerics.gradients, Gradients::mls_corrected);
  EXPECT_EQ(read.numerics.mls.support, 3.0);
  const Case again = read_case_text(write_case(read), "again.yaml");
  EXPECT_EQ(again.numerics.gradients, read.numerics.gradients);
  EXPECT_EQ(again.numerics.mls.support, read.numerics.mls.support);
  EXPECT_EQ(again.numerics.mls.pressure, read.numerics.mls.pressure);
}

TEST_P(BrokenLeastSquares, IsRefusedInOneClearSentence) { expect_refused(sound, GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Faults, BrokenLeastSquares,
    testing::Values(
        Fault{"KeysWithoutIt",
              "gradients: mls_corrected",
              "gradients: sph",
              {"case.yaml:12: numerics/mls is of moving least squares, and numerics/gradients is sph"}},
        Fault{"RiemannScheme",
              "support: 4",
              "scheme: riemann_ale",
              {"case.yaml:11: numerics/scheme is riemann_ale", "numerics/gradients is mls_corrected"}},
        Fault{"AntuonosDiffusion", "support: 4", "density_diffusion: antuono", {"case.yaml:11: numerics/density_diffusion is antuono"}},
        Fault{"Shifting", "support: 4", "shifting: michel", {"case.yaml:11: numerics/shifting is michel"}},
        Fault{"Turbulence", "support: 4", "turbulence: smagorinsky", {"case.yaml:11: numerics/turbulence is smagorinsky"}},
        Fault{"ViscositysForm",
              "support: 4",
              "viscosity_model: morris",
              {"case.yaml:11: numerics/viscosity_model is morris", "leave it out"}},
        Fault{"LargerThanTheKernel", "support: 4", "support: 2.5", {"case.yaml:12: numerics/mls/support is greater than numerics/support"}},
        Fault{"NoPivot", "pivot: 0.05", "pivot: 1", {"numerics/mls/pivot is 1; it must be from 1e-06 to 0.2"}},
        Fault{"DifferenceWithAFreeSurface",
              "pressure: auto",
              "pressure: difference",
              {"case.yaml:12: numerics/mls/pressure is difference", "choose sum or adjoint"}},
        Fault{"AdjointOnIntegrals",
              "pressure: auto}\n  walls: {method: ghost}",
              "pressure: adjoint}",
              {"case.yaml:12: numerics/mls/pressure is adjoint", "choose sum"}},
        Fault{"AdjointOfCorrectedSums",
              "pressure: auto",
              "pressure: adjoint",
              {"case.yaml:12: numerics/mls/pressure is adjoint", "choose sum"}},
        Fault{"Elements",
              "walls: {method: ghost}",
              "walls: {elements: numerical}",
              {"case.yaml:13: numerics/walls/elements is not facet", "leave it out"}},
        Fault{"LawOfTheWall",
              "walls: {method: ghost}",
              "walls: {friction: {law: coefficient}}",
              {"case.yaml:13: numerics/walls/friction/law is coefficient", "choose one of these"}},
        Fault{"Bodies",
              "pressure: auto}\n  walls: {method: ghost}\n",
              "pressure: auto}\nbodies: [{name: pier, box: {min: [1.5, 0], max: [2, 1]}}]\n",
              {"case.yaml:13: bodies is given, and numerics/gradients is mls_corrected, with which water does not rest at their edges"}},
        Fault{"MovingTank",
              "  box: {size: [2, 2]}\nnumerics:\n  gradients: mls_corrected\n  support: 4\n  mls: {support: 3, pivot: 0.05, pressure: "
              "auto}\n  walls: {method: ghost}\n",
              "  box: {size: [2, 2]}\n  motion: commanded\nnumerics: {gradients: mls_corrected}\n",
              {"numerics/gradients is mls_corrected, which is not built for it"}},
        Fault{"AcousticDamper", "support: 4", "acoustic_damping: 1", {"case.yaml:11: numerics/acoustic_damping is above 0"}},
        Fault{"NegativePressure",
              "support: 4",
              "negative_pressure: allowed",
              {"case.yaml:11: numerics/negative_pressure is allowed", "choose clamped"}},
        Fault{"Openings",
              "numerics:",
              "openings:\n  - {name: pipe, kind: inlet, centre: [0, 0.5], normal: [1, 0], size: [0, 0.2], velocity: 1}\nnumerics:",
              {"case.yaml:9: openings is given, and numerics/gradients is mls_corrected"}}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace

}  // namespace wavetank::least_squares_errors_test
