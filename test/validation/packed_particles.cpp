// The particles of a case at time 0, packed, as CSV: x, y, z (m), γ.
//   packed_particles CASE.yaml OUT.csv [KEY=VALUE]...
#include <cstdio>
#include <exception>

#include "validation_case.h"
#include "wavetank/common/error.h"
#include "wavetank/simulation/simulation.h"

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: packed_particles CASE.yaml OUT.csv [KEY=VALUE]...\n");
    return 2;
  }
  try {
    auto overrides = wavetank::validation::overrides_of(count - 3, arguments + 3);
    overrides.push_back({"numerics/packing/settling", "0"});
    const auto simulation = wavetank::validation::make_simulation(arguments[1], overrides);
    std::printf("%s", simulation->summary().c_str());
    const wavetank::ParticleCloud cloud = simulation->particles();
    std::FILE* file = std::fopen(arguments[2], "w");
    if (file == nullptr) throw wavetank::Error(std::string("'") + arguments[2] + "' cannot be written.");
    std::fprintf(file, "x,y,z,shepard\n");
    for (std::size_t i = 0; i < cloud.id.size(); ++i)
      std::fprintf(file, "%.6f,%.6f,%.6f,%.4f\n", cloud.position[i].x(), cloud.position[i].y(), cloud.position[i].z(), cloud.shepard[i]);
    std::fclose(file);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
