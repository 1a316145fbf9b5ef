#include "wavetank/simulation/lock_step.h"

#include <algorithm>
#include <cmath>

#include "texts.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double rounding = 1e-9;  ///< s, of sums of spans; below any step

}  // namespace

void LockStep::ask(const SolverState& now, double seconds, double duration) {
  if (!std::isfinite(seconds) || seconds < 0)
    throw Error("a span to advance by must be a finite number of seconds, at least 0, not " + number(seconds));
  ask_until(now, (now.time == reached_ ? asked_ : now.time) + seconds, duration);
}

void LockStep::ask_until(const SolverState& now, double time, double duration) {
  if (!std::isfinite(time) || time < 0)
    throw Error("an instant to advance to must be a finite number of seconds, at least 0, not " + number(time));
  if (time > duration + rounding)
    throw Error("from " + number(now.time) + " s it cannot be advanced to " + number(time) + " s: the run ends at " + number(duration) +
                " s, its case's duration");
  // What is over takes nothing back: spans go on to add up from the latest instant that was asked for.
  const bool is_over = now.time >= time - rounding;
  const double latest = now.time == reached_ ? asked_ : now.time;
  asked_ = is_over ? std::max(latest, time) : time;
  reached_ = -1;
}

bool LockStep::is_reached(const SolverState& now) {
  if (now.time < asked_ - rounding) return false;
  reached_ = now.time;
  return true;
}

}  // namespace wavetank
