#pragma once

#include <memory>
#include <string>

#include "wavetank/simulation/simulation.h"

namespace wavetank::bench {

/// Wall clock of a start, s. Its parts follow each other without a gap.
struct StartUp {
  double layout = 0;        ///< walls and particles
  double kernel_build = 0;  ///< opening the device, building the kernels, filling its memory
  double packing = 0;       ///< the hydrostatic start; the lattice is not packed
  double first_step = 0;    ///< drivers that compile late do so here

  double total() const { return layout + kernel_build + packing + first_step; }
  double without_layout() const { return kernel_build + packing + first_step; }
};

/// A simulation that has done its first step, and what that took.
struct Started {
  std::unique_ptr<Simulation> simulation;
  StartUp time;
};

/// Kernels are timed. Throws Error as Simulation does.
Started start(const Case& scene);

/// As one line, and back. Throws Error if the text is no such line.
std::string text_of(const StartUp& time);
StartUp start_up_of(const std::string& text);

}  // namespace wavetank::bench
