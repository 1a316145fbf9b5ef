// A tank at rest, run for long: kinetic energy, and the L2 error of the pressure from hydrostatics, against time. One line of CSV a sample.
//   tank_at_rest CASE.yaml OUT.csv END [KEY=VALUE]...      END: t √(g/H) at the end, with H the depth of the water
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/simulation/simulation.h"

namespace {

using wavetank::Vector3d;

constexpr double sample_interval = 0.1;  // of t √(g/H)

struct Rest {
  double gravity, density, level, depth;
};

double pressure_error(const wavetank::ParticleCloud& fluid, const Rest& rest) {
  double sum = 0;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    const double hydrostatic = rest.density * rest.gravity * (rest.level - fluid.position[i].z());
    sum += std::pow(fluid.pressure[i] - hydrostatic, 2);
  }
  return std::sqrt(sum / static_cast<double>(fluid.id.size())) / (rest.density * rest.gravity * rest.depth);
}

void run(const std::string& case_file, const std::string& out, double end, const std::vector<wavetank::Override>& overrides) {
  const wavetank::Case scene = wavetank::read_case_file(case_file, overrides);
  wavetank::SimulationOptions options;
  options.resolve = [](const std::string& uri) -> std::string {
    const std::string package = "package://wavetank/";
    if (uri.rfind(package, 0) != 0) throw wavetank::Error("a mesh is given as " + uri + ", but only package://wavetank is known here.");
    return std::string(WAVETANK_SOURCE_DIRECTORY) + "/" + uri.substr(package.size());
  };
  wavetank::Simulation simulation(scene, options);
  std::printf("%s", simulation.summary().c_str());
  Rest rest{-scene.gravity.z(), scene.fluid.density, 0, 0};
  for (const double level : simulation.layout().levels) rest.level = std::max(rest.level, level);
  rest.depth = rest.level - simulation.layout().domain.min.z();
  const double unit = std::sqrt(rest.depth / rest.gravity);
  std::FILE* file = std::fopen(out.c_str(), "w");
  if (file == nullptr) throw wavetank::Error("'" + out + "' cannot be written.");
  std::fprintf(file, "time,kinetic_over_potential,pressure_error,guard_hits\n");
  double next = 0;
  while (simulation.state().time < end * unit) {
    try {
      simulation.advance();
    } catch (const wavetank::Error& error) {  // the end of this method in this tank: a result too
      std::printf("stopped at t sqrt(g/H) = %.2f: %s\n", simulation.state().time / unit, error.what());
      break;
    }
    simulation.take_samples();
    if (simulation.state().time < next * unit) continue;
    const auto energies = simulation.energies();
    std::fprintf(file, "%.4f,%.6g,%.6g,%llu\n", simulation.state().time / unit, energies.kinetic / energies.potential,
                 pressure_error(simulation.particles(), rest), static_cast<unsigned long long>(simulation.state().guard_hits));
    std::fflush(file);
    next += sample_interval;
  }
  std::fclose(file);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "usage: tank_at_rest CASE.yaml OUT.csv END [KEY=VALUE]...\n");
    return 2;
  }
  try {
    std::vector<wavetank::Override> overrides;
    for (int k = 4; k < count; ++k) {
      const std::string text = arguments[k];
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos) throw wavetank::Error("'" + text + "' is no KEY=VALUE.");
      overrides.push_back({text.substr(0, equals), text.substr(equals + 1)});
    }
    run(arguments[1], arguments[2], std::atof(arguments[3]), overrides);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
