// jet_on_plate: a plane jet on a plate (particle shifting paper, §6), its pressures on the plate against free-streamline theory.
//   jet_on_plate WORD=VALUE...
// Words: n (particles over the jet's thickness H = 1 m, 20), angle (of the jet with the plate, degrees, 90), end (t U/H, 20), begin (of the
// mean, 10), courant (0.5), damping (acoustic, with symplectic alone, 0.5:
// sound between plate and nozzle rings for long without), sound (c₀/U, 11), distance (of the nozzle from the plate along
// the jet, H, 2), left and right (outlets from the stagnation point, H, 4), scheme, shifting, tensile, integrator, density_diffusion, and
// walls (boundary_integral, ghost) and of_tank (1: the jet comes from a wall of the tank, as it must with ghosts, and not from a nozzle;
// the tank is convex, so that at an angle the wall is farther from the plate, and `left` follows from that).
// Prints the mean p* at points of the plate beside the exact one, the mean and scatter at the stagnation point, the L2 of the difference,
// and the account of mass.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

#include "../common/scratch_directory.h"
#include "validation_case.h"
#include "wavetank/common/error.h"
#include "wavetank/scene/methods.h"
#include "wavetank/simulation/simulation.h"
#include "word_arguments.h"

namespace wavetank {
namespace {

const double pi = std::acos(-1.0);

using namespace validation;

/// Distance from the stagnation point, in H, towards the side that most water goes to, at which the speed is q U; −1 < q < 1.
double place_of(double q, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return (c * std::log(1 - 2 * c * q + q * q) + 2 * s * (std::atan((q - c) / s) + pi / 2 - angle) - (1 + c) * std::log(1 - q) +
          (1 - c) * std::log(1 + q)) /
         pi;
}

/// p/(½ρU²) there.
double exact_pressure(double place, double angle) {
  double low = -1 + 1e-12, high = 1 - 1e-12;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (place_of(middle, angle) < place ? low : high) = middle;
  }
  return 1 - low * low;
}

/// A convex tank of a floor and a ceiling, an oblique wall at the left that the jet comes from, which stands on an upright one, and an
/// upright wall at the right.
std::string tank_with_oblique_end(const ScratchDirectory& scratch, const Vector3d& lower, const Vector3d& upper, double right) {
  const std::string file = scratch.file("tank.obj");
  std::ofstream text(file);
  text.precision(15);
  const double x[5] = {upper.x(), lower.x(), lower.x(), right, right}, z[5] = {upper.z(), lower.z(), 0, 0, upper.z()};
  for (const double y : {-0.5, 0.5})
    for (int k = 0; k < 5; ++k) text << "v " << x[k] << ' ' << y << ' ' << z[k] << '\n';
  for (int k = 0; k < 5; ++k) text << "f " << k + 1 << ' ' << (k + 1) % 5 + 1 << ' ' << (k + 1) % 5 + 6 << ' ' << k + 6 << '\n';
  return file;
}

int run(const Words& words) {
  const double n = number(words, "n", 20), angle = number(words, "angle", 90) * pi / 180, end = number(words, "end", 20),
               begin = number(words, "begin", 10), sound = number(words, "sound", 11);
  const double spacing = 1 / n, cos = std::cos(angle), sin = std::sin(angle), wall = 5 * spacing;
  const auto walls = words.find("walls");
  const bool ghosts = walls != words.end() && walls->second == "ghost", oblique = angle < pi / 2 - 1e-9;
  const bool of_tank = ghosts || number(words, "of_tank", 0) > 0;  // the opening that the jet comes from
  const double outlet = 1.25;                                      // H, higher than either sheet
  // the stagnation point is that far upstream of where the jet's axis meets the plate: from the moment about it
  const double axis = angle == pi / 2 ? 0.0 : (std::abs(angle - pi / 6) < 1e-9 ? 1.4519 : 0.0);
  const double distance = number(words, "distance", of_tank && oblique ? 3.75 : 2), right = number(words, "right", 4);
  // stagnation point at x = 0; the jet comes from above
  const Vector3d along(cos, 0, -sin), mouth = Vector3d(axis, 0, 0) - distance * along;
  const Vector3d lower_lip = mouth - 0.5 * Vector3d(sin, 0, cos), upper_lip = mouth + 0.5 * Vector3d(sin, 0, cos);
  const double left = of_tank && oblique ? -lower_lip.x() : number(words, "left", 4);

  Case scene;
  scene.title = "Plane jet on a plate";
  scene.dimensions = 2;
  scene.gravity = Vector3d::Zero();
  scene.duration = end;
  scene.fluid.spacing = spacing;
  scene.fluid.viscosity = 0;
  scene.fluid.sound_speed = sound;
  scene.numerics.walls.slip = Slip::free_slip;
  scene.numerics.packing.iterations = 0;
  scene.numerics.scheme = Scheme::riemann_parshikov;
  scene.numerics.shifting = Shifting::michel;
  choose(words, "scheme", scene.numerics.scheme);
  choose(words, "shifting", scene.numerics.shifting);
  choose(words, "tensile", scene.numerics.tensile);
  choose(words, "integrator", scene.numerics.integrator);
  const bool riemann = scene.numerics.scheme != Scheme::delta_sph;
  scene.numerics.density_diffusion = riemann ? DensityDiffusion::none : DensityDiffusion::antuono;
  scene.numerics.artificial_viscosity = riemann ? 0 : 0.01;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  scene.numerics.courant = number(words, "courant", scene.numerics.courant);
  scene.numerics.acoustic_damping = number(words, "damping", scene.numerics.integrator == Integrator::symplectic ? 0.5 : 0);
  choose(words, "density_diffusion", scene.numerics.density_diffusion);
  scene.numerics.expected_speed = 1;

  const ScratchDirectory scratch;
  if (ghosts) scene.numerics.walls.method = WallMethod::ghost;
  if (of_tank) {
    scene.numerics.walls.repulsion = number(words, "repulsion", 0);
    scene.tank.shape = BoxTank{Vector3d(left + right, 0, mouth.z()), Vector3d(-left, 0, 0), true};
    if (oblique) scene.tank.shape = MeshSource{tank_with_oblique_end(scratch, lower_lip, upper_lip, right)};
  } else {
    const double depth = 11 * spacing;  // of the nozzle: its pocket is six spacings
    const double top = mouth.z() + depth + 1;
    scene.tank.shape = BoxTank{Vector3d(left + right, 0, top), Vector3d(-left, 0, 0), true};
    BodyCase nozzle;
    nozzle.name = "nozzle";
    MeshSource box;
    char uri[120];
    std::snprintf(uri, sizeof uri, "shape://box?size=%.12g,1,%.12g", depth, 1 + 2 * wall);
    box.uri = uri;
    box.rotation = Vector3d(0, angle, 0);
    box.translation = mouth - 0.5 * depth * along;
    nozzle.shape = box;
    scene.bodies = {nozzle};
  }

  const auto add = [&](const char* name, OpeningKind kind, const Vector3d& centre, const Vector3d& normal, double height) {
    OpeningCase opening;
    opening.name = name;
    opening.kind = kind;
    opening.centre = centre;
    opening.normal = normal;
    opening.size = std::array<double, 2>{1, height};
    scene.openings.push_back(opening);
  };
  add("jet", OpeningKind::inlet, mouth, along, 1);
  if (!of_tank) scene.openings[0].body = "nozzle";
  if (of_tank && !oblique) scene.openings[0].up = Vector3d::UnitX();
  // its front is to hit the plate gently; at an angle from afar it would pile up on the way
  scene.openings[0].velocity = of_tank && oblique ? "1" : "min(t/2, 1)";
  const double left_outlet = of_tank && oblique ? lower_lip.z() : outlet;  // up to where the jet begins
  add("left", OpeningKind::outlet, Vector3d(-left, 0, left_outlet / 2), Vector3d::UnitX(), left_outlet);
  add("right", OpeningKind::outlet, Vector3d(right, 0, outlet / 2), -Vector3d::UnitX(), outlet);
  // the wedge under the jet, into which its front splashes, is to drain: beyond is air, and not what stands before the outlet
  if (of_tank && oblique) scene.openings[1].level = -1;
  if (of_tank && oblique) {  // the jet's upper side must not stick to a ceiling
    add("top", OpeningKind::outlet, Vector3d(0.5 * (upper_lip.x() + right), 0, upper_lip.z()), -Vector3d::UnitZ(), right - upper_lip.x());
    scene.openings.back().up = Vector3d::UnitX();
  }

  std::vector<double> places;
  for (double x = -2; x <= 3; x += 0.05) places.push_back(x);
  for (std::size_t k = 0; k < places.size(); ++k)
    scene.instruments.pressure_probes.push_back({"p" + std::to_string(k), Vector3d(places[k], 0, 0), ""});
  scene.instruments.rate = 50;

  Simulation simulation(scene);
  const double dynamic = 0.5 * scene.fluid.density;
  std::vector<double> mean(places.size(), 0.0);
  double samples = 0, stagnation = 0, squares = 0;
  const auto nearest = static_cast<std::size_t>(std::lround(2 / 0.05));
  while (simulation.state().time < end) {
    simulation.advance();
    for (const PressureSample& sample : simulation.take_samples().pressures) {
      if (sample.time < begin) continue;
      ++samples;
      for (std::size_t k = 0; k < places.size(); ++k) mean[k] += sample.pressures[k] / dynamic;
      stagnation += sample.pressures[nearest] / dynamic;
      squares += std::pow(sample.pressures[nearest] / dynamic, 2);
    }
  }
  double error = 0, force = 0;
  std::printf("%8s %8s %8s\n", "x/H", "p*", "exact");
  for (std::size_t k = 0; k < places.size(); ++k) {
    mean[k] /= samples;
    const double exact = exact_pressure(places[k], angle);
    error += std::pow(mean[k] - exact, 2);
    force += 0.05 * mean[k];
    if (k % 5 == 0) std::printf("%8.2f %8.4f %8.4f\n", places[k], mean[k], exact);
  }
  stagnation /= samples;
  std::printf("H/dx %g, angle %g: p* at the stagnation point %.4f, scatter %.4f; L2 of p* %.4f; force/(2H sin) %.4f\n", n, angle * 180 / pi,
              stagnation, std::sqrt(std::max(squares / samples - stagnation * stagnation, 0.0)),
              std::sqrt(error / static_cast<double>(places.size())), force / (2 * sin));
  double in = 0, out = 0;
  for (const OpeningState& state : simulation.openings()) {
    in += state.mass_in;
    out += state.mass_out;
    std::printf("opening: discharge %.4f, in %llu, out %llu particles\n", state.discharge,
                static_cast<unsigned long long>(state.particles_in), static_cast<unsigned long long>(state.particles_out));
  }
  std::printf("particles %zu, mass inside %.3f, in %.3f, out %.3f\n", simulation.state().particles, simulation.energies().mass, in, out);
  return 0;
}

}  // namespace
}  // namespace wavetank

int main(int count, char** arguments) {
  wavetank::Words words;
  for (int k = 1; k < count; ++k) {
    const std::string word = arguments[k];
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) {
      std::fprintf(stderr, "jet_on_plate: %s is not WORD=VALUE\n", word.c_str());
      return 2;
    }
    words[word.substr(0, equals)] = word.substr(equals + 1);
  }
  try {
    return wavetank::run(words);
  } catch (const wavetank::Error& error) {
    std::fprintf(stderr, "jet_on_plate: %s\n", error.what());
    return 2;
  }
}
