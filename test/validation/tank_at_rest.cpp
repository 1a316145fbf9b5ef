// A tank at rest, run for long: kinetic energy, and the L2 error of the pressure from hydrostatics, against time, one line of CSV a sample.
// Prints the greatest values, the means of the second half, and of each body the mean vertical force of the second half over Archimedes'.
//   tank_at_rest CASE.yaml OUT.csv END [KEY=VALUE]...      END: t √(g/H) at the end, with H the depth of the water; 0: the case's duration
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "validation_case.h"
#include "wavetank/common/error.h"
#include "wavetank/simulation/simulation.h"

namespace {

using wavetank::Vector3d;

constexpr double sample_interval = 0.1;  // of t √(g/H)

struct Rest {
  double gravity, density, level, depth;
};

Rest rest_of(const wavetank::Simulation& simulation) {
  const wavetank::Layout& layout = simulation.layout();
  const double lowest =
      std::min_element(layout.particles.begin(), layout.particles.end(), [](const Vector3d& a, const Vector3d& b) { return a.z() < b.z(); })
          ->z() -
      0.5 * layout.spacing;
  const double level = *std::max_element(layout.levels.begin(), layout.levels.end());
  return {-simulation.scene().gravity.z(), simulation.scene().fluid.density, level, level - lowest};
}

double pressure_error(const wavetank::ParticleCloud& fluid, const Rest& rest) {
  double sum = 0;
  for (std::size_t i = 0; i < fluid.id.size(); ++i) {
    const double hydrostatic = rest.density * rest.gravity * (rest.level - fluid.position[i].z());
    sum += std::pow(fluid.pressure[i] - hydrostatic, 2);
  }
  return std::sqrt(sum / static_cast<double>(fluid.id.size())) / (rest.density * rest.gravity * rest.depth);
}

struct Mean {
  double sum = 0, weight = 0;
  void add(double value) {
    sum += value;
    weight += 1;
  }
  double value() const { return weight > 0 ? sum / weight : 0.0; }
};

void run(const std::string& case_file, const std::string& out, double end, const std::vector<wavetank::Override>& overrides) {
  const std::unique_ptr<wavetank::Simulation> simulation = wavetank::validation::make_simulation(case_file, overrides);
  std::printf("%s", simulation->summary().c_str());
  std::fflush(stdout);
  const Rest rest = rest_of(*simulation);
  const double unit = std::sqrt(rest.depth / rest.gravity);
  const double duration = end == 0 ? simulation->scene().duration : end * unit;
  std::FILE* file = std::fopen(out.c_str(), "w");
  if (file == nullptr) throw wavetank::Error("'" + out + "' cannot be written.");
  std::fprintf(file, "time,kinetic_over_potential,pressure_error,guard_hits\n");

  const double potential_at_start = simulation->energies().potential;
  double greatest_error = 0, greatest_energy = 0;
  Mean error;
  std::vector<Mean> forces(simulation->scene().bodies.size());
  std::string outcome = "to the end";
  double next = 0;
  while (simulation->state().time < duration) {
    try {
      simulation->advance();
    } catch (const wavetank::Error& violation) {  // the end of this method in this tank: a result too
      outcome = violation.what();
      break;
    }
    const double time = simulation->state().time;
    for (const wavetank::WrenchSample& sample : simulation->take_samples().wrenches)
      for (std::size_t b = 0; b < forces.size() && sample.time > 0.5 * duration; ++b)
        forces[b].add(sample.wrenches[1 + b].pressure_force.z() + sample.wrenches[1 + b].viscous_force.z());
    if (time < next * unit) continue;
    next += sample_interval;
    const auto energies = simulation->energies();
    const double energy = energies.kinetic / energies.potential, now = pressure_error(simulation->particles(), rest);
    std::fprintf(file, "%.4f,%.6g,%.6g,%llu\n", time / unit, energy, now, static_cast<unsigned long long>(simulation->state().guard_hits));
    std::fflush(file);
    greatest_error = std::max(greatest_error, now);
    greatest_energy = std::max(greatest_energy, energy);
    if (time > 0.5 * duration) error.add(now);
  }
  std::fclose(file);
  if (error.weight == 0) outcome += "; there is no second half";
  std::printf("t sqrt(g/H) = %.2f (%.2f s): %s\n", simulation->state().time / unit, simulation->state().time, outcome.c_str());
  std::printf("L2 error of the pressure over rho g H: %.4f at the most, %.4f in the mean of the second half\n", greatest_error,
              error.value());
  std::printf("kinetic over potential energy: %.2g at the most; potential energy changed by %+.3f %%; guard hits: %llu\n", greatest_energy,
              100 * (simulation->energies().potential / potential_at_start - 1),
              static_cast<unsigned long long>(simulation->state().guard_hits));
  for (std::size_t b = 0; b < forces.size(); ++b) {
    const double displaced = rest.density * rest.gravity * simulation->layout().meshes[1 + b].signed_volume();
    std::printf("%s: vertical force %.3f N in the mean of the second half, Archimedes' %.3f N, %+.2f %%\n",
                simulation->scene().bodies[b].name.c_str(), forces[b].value(), displaced, 100 * (forces[b].value() / displaced - 1));
  }
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 4) {
    std::fprintf(stderr, "usage: tank_at_rest CASE.yaml OUT.csv END [KEY=VALUE]...\n");
    return 2;
  }
  try {
    run(arguments[1], arguments[2], std::atof(arguments[3]), wavetank::validation::overrides_of(count - 4, arguments + 4));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
