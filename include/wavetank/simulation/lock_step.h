#pragma once

#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Goes on by spans of simulated time, for whoever controls what is simulated at a rate of his own. Steps stay whole and as long as they
/// would be: a run has the same bits however it is parted into spans. A span is over with the first step that ends at or after the instant
/// that was asked for, and the next one counts from that instant, not from the step's end, so that spans add up.
class LockStep {
 public:
  /// Asks for `seconds` more from the instant that was asked for last; from `now` at first, and where anything else has moved the
  /// simulation since. Throws Error for a span that is not finite or negative, or that ends after `duration` (s), and asks for nothing
  /// then.
  void ask(const SolverState& now, double seconds, double duration);
  /// The same for an instant, s. One that is over already asks for no step, and the next span counts from where it would have without.
  /// Throws Error for one that is negative, not finite or after `duration`.
  void ask_until(const SolverState& now, double time, double duration);
  /// Whether the simulation is where it was asked to come to. To be asked after every step, and first of all before any.
  bool is_reached(const SolverState& now);

 private:
  double asked_ = 0;     ///< s
  double reached_ = -1;  ///< s, time of the simulation when it was found to be there; negative: it was not yet
};

}  // namespace wavetank
