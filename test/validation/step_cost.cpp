// The median time of a step of a case from its lattice, in ms; nothing else may run meanwhile. One case a process: with several, the later
// ones are slower.
//   step_cost CASE.yaml STEPS [KEY=VALUE]...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

#include "validation_case.h"
#include "wavetank/common/error.h"
#include "wavetank/simulation/simulation.h"

int main(int count, char** arguments) {
  const int steps = count > 2 ? std::atoi(arguments[2]) : 0;
  if (steps < 1) {
    std::fprintf(stderr, "usage: step_cost CASE.yaml STEPS [KEY=VALUE]...\n");
    return 2;
  }
  try {
    auto overrides = wavetank::validation::overrides_of(count - 3, arguments + 3);
    overrides.push_back({"numerics/packing/iterations", "0"});
    overrides.push_back({"numerics/packing/settling", "0"});
    const auto simulation = wavetank::validation::make_simulation(arguments[1], overrides);
    simulation->advance();  // the first launch of a kernel may still compile it
    std::vector<double> milliseconds;
    for (int step = 0; step < steps; ++step) {
      const auto begin = std::chrono::steady_clock::now();
      simulation->advance();
      milliseconds.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::sort(milliseconds.begin(), milliseconds.end());
    std::printf("%.2f\n", milliseconds[milliseconds.size() / 2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
