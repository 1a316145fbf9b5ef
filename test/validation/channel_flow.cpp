// channel_flow: Poiseuille's flow between two plates, driven by a body force, and Couette's, whose upper plate runs, from rest, at Re = 10;
// prints the error of the layers' speeds over the greatest speed, root mean square and greatest, at t = 0.5 s and steadily.
//   channel_flow poiseuille|couette WORD=VALUE...
// Words: n (particles across, 20), walls (integral, ghost; Poiseuille's alone), end (s, 2.5), and any of the case's method words as
// KEY=WORD: gradients, pressure (of numerics/mls), viscosity_model, integrator.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "wavetank/common/error.h"
#include "wavetank/compute/device.h"
#include "wavetank/sph/solver.h"
#include "word_arguments.h"

namespace wavetank {
namespace {

using namespace validation;

constexpr double height = 1, viscosity = 0.1, density = 1, top_speed = 1;  // Reynolds number 10
const double pi = std::acos(-1.0);

/// Speed at height z and time t after the start.
double poiseuille(double z, double t) {
  double speed = 4 * top_speed * z * (height - z) / (height * height);
  for (int n = 1; n < 400; n += 2)
    speed -= 32 * top_speed / std::pow(n * pi, 3) * std::sin(n * pi * z / height) * std::exp(-std::pow(n * pi / height, 2) * viscosity * t);
  return speed;
}

double couette(double z, double t) {
  double speed = top_speed * z / height;
  for (int n = 1; n < 400; ++n)
    speed += 2 * top_speed / (n * pi) * (n % 2 == 0 ? 1 : -1) * std::sin(n * pi * z / height) *
             std::exp(-std::pow(n * pi / height, 2) * viscosity * t);
  return speed;
}

Case channel(bool plate, int n, const Words& words) {
  Case scene;
  scene.dimensions = 2;
  scene.gravity = plate ? Vector3d(Vector3d::Zero()) : Vector3d(8 * viscosity * top_speed / (density * height * height), 0, 0);
  scene.duration = 1;
  scene.fluid.density = density;
  scene.fluid.viscosity = viscosity;
  scene.fluid.sound_speed = 10 * top_speed;
  scene.fluid.spacing = height / n;
  const double length = 10 * *scene.fluid.spacing;  // no less than twice the support
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(length, 0, height)}};
  scene.tank.shape = BoxTank{Vector3d(length, 0, plate ? 1.2 * height : height), Vector3d::Zero(), true};
  scene.tank.periodic = {true, false, false};
  const auto walls = words.find("walls");
  if (walls != words.end() && walls->second == "ghost") scene.numerics.walls.method = WallMethod::ghost;
  scene.numerics.artificial_viscosity = 0;
  scene.numerics.negative_pressure = NegativePressure::allowed;
  choose(words, "gradients", scene.numerics.gradients);
  choose(words, "pressure", scene.numerics.mls.pressure);
  choose(words, "viscosity_model", scene.numerics.viscosity_model);
  choose(words, "integrator", scene.numerics.integrator);
  if (!plate) return scene;
  BodyCase body;
  body.name = "plate";
  body.shape = Box{Vector3d(0, 0, height), Vector3d(length, 0, 1.2 * height)};
  body.surface_velocity = Vector3d(top_speed, 0, 0);
  scene.bodies.push_back(body);
  return scene;
}

/// Mean differences of layers as thick as the spacing.
class Layers {
 public:
  explicit Layers(int n) : difference_(n, 0.0), members_(n, 0.0) {}

  void add(const FluidState& fluid, double time, double (*exact)(double, double)) {
    const int n = static_cast<int>(difference_.size());
    for (std::size_t i = 0; i < fluid.id.size(); ++i) {
      const int layer = std::clamp(static_cast<int>(fluid.position[i].z() / height * n), 0, n - 1);
      difference_[layer] += (fluid.velocity[i].x() - exact(fluid.position[i].z(), time)) / top_speed;
      members_[layer] += 1;
    }
  }
  void print(const char* when) const {
    double sum = 0, greatest = 0;
    for (std::size_t layer = 0; layer < difference_.size(); ++layer) {
      const double error = difference_[layer] / std::max(members_[layer], 1.0);
      sum += error * error;
      greatest = std::max(greatest, std::abs(error));
    }
    std::printf("%s %.5f %.5f\n", when, std::sqrt(sum / static_cast<double>(difference_.size())), greatest);
  }

 private:
  std::vector<double> difference_, members_;
};

void run(const std::string& flow, const Words& words) {
  const bool plate = flow == "couette";
  if (!plate && flow != "poiseuille") throw Error("there is no flow called " + flow);
  const int n = static_cast<int>(number(words, "n", 20));
  const Case given = channel(plate, n, words);
  const Layout layout = lay_out(given);
  const Case scene = settled(given, layout);
  const compute::Device device(compute::choose_device("auto"));
  const auto solver =
      make_solver(device, scene, layout, discretise(scene, layout), std::vector<Vector3d>(1 + scene.bodies.size(), Vector3d::Zero()));
  solver->pack(100, {});
  double step = solver->start().time_step, time = 0;
  const auto advance_to = [&](double until) {
    while (time + 0.5 * step < until) {
      const StepReport report = solver->advance();
      if (!report.valid()) throw Error("a particle is lost at t = " + std::to_string(time) + " s.");
      time += step;
      step = report.time_step;
    }
  };
  double (*exact)(double, double) = plate ? couette : poiseuille;
  advance_to(0.5);
  Layers early(n), steady(n);
  early.add(solver->download(), time, exact);
  early.print("0.5");
  const double end = number(words, "end", 2.5);
  for (int k = 0; k < 20; ++k) {
    advance_to(end + 0.8 * k / 20);
    steady.add(solver->download(), time, exact);
  }
  steady.print("steady");
}

}  // namespace
}  // namespace wavetank

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: channel_flow poiseuille|couette WORD=VALUE...\n");
    return 2;
  }
  try {
    wavetank::run(arguments[1], wavetank::validation::words_of(count - 2, arguments + 2));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
