#include "steered_simulation.h"

#include <utility>

namespace wavetank {
namespace {

SimulationOptions options_of(const ResourceResolver& resolve, const std::function<void()>& interrupted) {
  SimulationOptions options;
  options.resolve = resolve;
  options.progress = [interrupted](const std::string&, double) { interrupted(); };
  return options;
}

}  // namespace

SteeredSimulation::SteeredSimulation(const Case& checked, const ResourceResolver& resolve, const std::string& restore,
                                     std::function<void()> interrupted)
    : simulation_(checked, options_of(resolve, interrupted)), interrupted_(std::move(interrupted)), rows_(simulation_.bodies()) {
  if (!restore.empty()) simulation_.restore(restore);
  rows_.add(simulation_.take_samples());
}

void SteeredSimulation::advance(double seconds) {
  lock_step_.ask(simulation_.state(), seconds, simulation_.scene().duration);
  go_on();
}

void SteeredSimulation::advance_to(double time) {
  lock_step_.ask_until(simulation_.state(), time, simulation_.scene().duration);
  go_on();
}

void SteeredSimulation::go_on() {
  if (!stopped_.empty()) throw Violation(stopped_);
  while (!lock_step_.is_reached(simulation_.state())) {
    try {
      simulation_.advance();
    } catch (const Violation& violation) {
      stopped_ = violation.what();
      rows_.add(simulation_.take_samples());
      throw;
    }
    rows_.add(simulation_.take_samples());
    interrupted_();
  }
}

void SteeredSimulation::reset() {
  simulation_.reset();
  stopped_.clear();
  lock_step_ = LockStep();
  rows_.clear();
  rows_.add(simulation_.take_samples());
}

}  // namespace wavetank
