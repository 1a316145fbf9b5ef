// channel_flow: Poiseuille's flow between two plates, driven by a body force, and Couette's, whose upper plate runs, from rest, at Re = 10;
// prints the error of the layers' speeds over the greatest speed, root mean square and greatest, at t = 0.5 s and steadily.
//   channel_flow poiseuille|couette WORD=VALUE...
// Words: n (particles across, 20), walls (integral, ghost; Poiseuille's alone), end (s, 2.5), and any of the case's method words as
// KEY=WORD: gradients, pressure (of numerics/mls), viscosity_model, integrator.
#include "../sph/channel_flow.h"

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

using namespace channel_flow;

Case channel(bool plate, int n, const Words& words) {
  Case scene = channel_flow::channel(height / n, plate);
  if (!plate) scene.gravity = Vector3d(driving_force, 0, 0);
  const auto walls = words.find("walls");
  if (walls != words.end() && walls->second == "ghost") scene.numerics.walls.method = WallMethod::ghost;
  choose(words, "gradients", scene.numerics.gradients);
  choose(words, "pressure", scene.numerics.mls.pressure);
  choose(words, "viscosity_model", scene.numerics.viscosity_model);
  choose(words, "integrator", scene.numerics.integrator);
  return scene;
}

void print(const char* when, const Layers& layers) { std::printf("%s %.5f %.5f\n", when, layers.mean(), layers.greatest()); }

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
  print("0.5", early);
  const double end = number(words, "end", 2.5);
  for (int k = 0; k < 20; ++k) {
    advance_to(end + 0.8 * k / 20);
    steady.add(solver->download(), time, exact);
  }
  print("steady", steady);
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
