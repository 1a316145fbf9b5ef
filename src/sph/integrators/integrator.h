#pragma once

#include "../schedule/schedule.h"
#include "wavetank/scene/case.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// Where a solver keeps a state of the particles during a step: the one that lasts, and one that is only of this step.
enum class Slot { now, trial };

/// What a solver can do within a time step Δt: what integrators are made of. The rates are those of u, and, as `compression rates`, of
/// s = ρ/ρ₀ − 1 and all else that evolves; x changes by u.
class StepEngine {
 public:
  virtual ~StepEngine() = default;

  /// Walls as they are expected at a fraction of the step.
  virtual void walls_at(double fraction) = 0;
  /// Rates of u, with the pressures of wall elements; and of s and all else that evolves.
  virtual void find_accelerations(Slot state) = 0;
  virtual void find_compression_rates(Slot state) = 0;
  /// Both.
  virtual void find_rates(Slot state) = 0;
  /// Adds the water's wrench on bodies there, times `weight`, to that of the step; the weights of a step add up to 1.
  virtual void add_wrenches(Slot state, double weight) = 0;
  /// Bodies make the step under those wrenches, and walls go with them.
  virtual void walls_to_end() = 0;
  /// Particles nearer to a wall than the guard distance stop approaching it. The trial state holds how they came: a place, and a velocity
  /// with which they were half a step before at the start of the step.
  virtual void guard() = 0;
  virtual void sort() = 0;
  /// δu of the state that is now, with which x changes beside u; held for the whole step.
  virtual void find_shifts() = 0;
  /// The water behind openings gets the velocity and pressure that it is given.
  virtual void impose_zones() = 0;
  /// Velocities in damping zones go towards those that they are given.
  virtual void damp_velocities() = 0;

  // of the symplectic scheme
  virtual void drift_to_middle() = 0;
  virtual void kick_and_drift_to_end() = 0;
  virtual void compress_to_end() = 0;

  // of Runge and Kutta's
  /// Adds the rates, of `state`, times `weight` to the sum, which `first` begins; then trial = now + `part` Δt rates.
  virtual void go_on_trial(Slot state, bool first, double weight, double part) = 0;
  /// Adds the rates of the trial state times `weight` to the sum, and now += Δt sum.
  virtual void take_sum(double weight) = 0;

  // of the predictor and corrector of the MLS paper, §4
  /// trial: u* = u + Δt f*, x* = x + Δt u*, s* = s + Δt r*; the rates are kept.
  virtual void predict_end() = 0;
  /// now: u += Δt (f* + f**)/2 and s likewise, x += Δt (u before + u after)/2.
  virtual void correct_end() = 0;
};

/// Stages that every integrator has: the guard, which also reads how the particles came, and the sort.
Stage guard_stage(StepEngine* engine, const std::vector<Access>& came);
Stage sort_stage(StepEngine* engine);

/// One page each. `engine` may be null in a schedule that is not run.
Schedule symplectic(StepEngine* engine);
Schedule runge_kutta_4(StepEngine* engine);
Schedule predictor_corrector(StepEngine* engine);

/// The case's, with its shifting law and its openings.
Schedule schedule_of(const Case& scene, StepEngine* engine);

/// How far a particle, at the most, is from where it was sorted when its neighbours are gone over, m: a step is courant h/c₀ at the most,
/// and at half the speed of sound the watchdog ends the run.
double greatest_drift(const Schedule& schedule, const Case& scene, const Discretisation& discretisation);

/// What a state consists of, and what follows from it.
std::vector<Access> state_of(const std::string& instant);

}  // namespace wavetank
