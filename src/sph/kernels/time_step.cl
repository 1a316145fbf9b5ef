// Advancing the state. Built without fast-math: it would delete the compensated sum of the positions.
#include "common.cl"
#include "equation_of_state.cl"

EQUATION_OF_STATE(real, particle)

#if defined(RATE_VOLUME) && CLAMP_PRESSURE
// Water that is drawn apart feels nothing of it, and what opens in it is no room of its own. Where masses evolve too, a particle in a hole would else keep the
// hole's volume while its mass flows off, until a pressure beside it throws what is left away at any speed. Its mass stays as it is.
#define LEAST_COMPRESSION R(-0.1)
INLINE void close_holes(__global real* state, long stride, int i) {
  const real compression = state[FIELD_COMPRESSION * stride + i];
  if (!(compression < LEAST_COMPRESSION)) return;
  state[FIELD_VOLUME * stride + i] *= (R(1.0) + compression) / (R(1.0) + LEAST_COMPRESSION);
  state[FIELD_COMPRESSION * stride + i] = LEAST_COMPRESSION;
}
#endif

// What follows from the fields that evolve, and what the neighbour loop needs beside them. A particle keeps its mass, or else, where the scheme has a rate
// of the volume, what its compression and volume make of it. `damper`: of the pressure, that of the acoustic damper, Pa.
INLINE void derive(__constant const parameters_t* p, __global real* state, long stride, int i, real mass, real damper) {
#if defined(RATE_VOLUME) && CLAMP_PRESSURE
  close_holes(state, stride, i);
#endif
  const real compression = state[FIELD_COMPRESSION * stride + i];
#if ACOUSTIC_DAMPER
  const real pressure = particle_pressure(p, compression) + damper;
#else
  const real pressure = particle_pressure(p, compression);
#endif
  state[FIELD_PRESSURE * stride + i] = CLAMP_PRESSURE ? fmax(pressure, R(0.0)) : pressure;
#ifdef RATE_VOLUME
  state[FIELD_MASS * stride + i] = p->density * (R(1.0) + compression) * state[FIELD_VOLUME * stride + i];
#else
  state[FIELD_VOLUME * stride + i] = mass / (p->density * (R(1.0) + compression));
#endif
}

INLINE bool is_lost(__global const real* state, long stride, int i) {
  bool lost = not_finite(state[FIELD_COMPRESSION * stride + i]) || not_finite(state[FIELD_VOLUME * stride + i]);
  for (int axis = 0; axis < 3; ++axis) lost = lost || not_finite(state[(FIELD_X + axis) * stride + i]) || not_finite(state[(FIELD_U + axis) * stride + i]);
  return lost;
}

// A particle with a value that is not finite ends the run. Until the watchdog has seen it, it must not hide among others that it has made so too: others in
// its tile, however far, since nothing times what is not finite is not finite.
INLINE void leave_out(__global real* half_state, long stride, int i) {
  for (int axis = 0; axis < 3; ++axis) {
    half_state[(FIELD_X + axis) * stride + i] = R(0.0);
    half_state[(FIELD_U + axis) * stride + i] = R(0.0);
    if (IS_LONG(axis)) half_state[(FIELD_REST_X + axis) * stride + i] = R(0.0);
  }
  for (int axis = 0; axis < 3; ++axis) FORGET_SHIFT(half_state, axis, i);
#define NOTHING(NAME) half_state[FIELD_##NAME * stride + i] = R(0.0);
  EACH_CONJUGATE(NOTHING)
  EACH_FOLLOWER(NOTHING)
  half_state[FIELD_PRESSURE * stride + i] = R(0.0);
  half_state[FIELD_VOLUME * stride + i] = R(0.0);
}

__kernel void derive_state(__constant const parameters_t* p, int count, __global real* state, long stride) {
  const int i = get_global_id(0);
  if (i < count) derive(p, state, stride, i, state[FIELD_MASS * stride + i], R(0.0));
}

// Symplectic (drift, kick, drift): positions and compressions go half a step with what they had, velocities a whole one with the forces of the middle,
// positions and compressions the other half with the new velocities. Position and velocity, compression and velocity then advance as conjugate pairs, and
// the sound between a lone particle and a wall neither grows nor decays: the explicit midpoint rule lets it grow by (ω Δt)⁴/8 a step.
__kernel void predict(__constant const parameters_t* p, int count, __global const real* state, __global real* half_state, long stride,
                      __global const real* rates, __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real half_step = R(0.5) * time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
    const real speed = state[(FIELD_U + axis) * stride + i];
    const real motion = WITH_SHIFT(speed, state, axis, i);
    half_state[(FIELD_X + axis) * stride + i] = state[(FIELD_X + axis) * stride + i] + half_step * motion;
    if (IS_LONG(axis)) move_from(state, half_state, stride, axis, i, half_step * motion);
    half_state[(FIELD_U + axis) * stride + i] = speed;
    KEEP_SHIFT(state, half_state, axis, i);
  }
#define DRIFT(NAME) half_state[FIELD_##NAME * stride + i] = state[FIELD_##NAME * stride + i] + half_step * rates[RATE_##NAME * stride + i];
  EACH_CONJUGATE(DRIFT)
  // only of the middle, whose pressures move the water: by the rate that the last step's continuity left
  derive(p, half_state, stride, i, state[FIELD_MASS * stride + i], p->bulk_viscosity * rates[RATE_COMPRESSION * stride + i]);
  if (is_lost(half_state, stride, i)) leave_out(half_state, stride, i);
}

// What leaves a periodic tank at one end comes in at the other. The rest of the compensated sum goes with it.
INLINE void wrap(__constant const parameters_t* p, __global real* state, long stride, int i) {
  const real period[3] = {p->period_x, p->period_y, p->period_z};
  const real lower[3] = {p->lower_x, p->lower_y, p->lower_z};
  for (int axis = 0; axis < 3; ++axis) {
    if (period[axis] == R(0.0)) continue;
    __global real* position = state + (FIELD_X + axis) * stride + i;
    const real start = lower[axis] + R(0.5) * p->spacing;  // the watchdog's box is larger by this
    if (IS_LONG(axis)) {
      const real way = *position < start ? period[axis] : *position >= start + period[axis] ? -period[axis] : R(0.0);
      // the way is as large as the position: a sum of two whose rounding is found whichever is larger
      const real before = *position, sum = before + way, part = sum - before;
      *position = sum;
      state[(FIELD_REST_X + axis) * stride + i] -= (before - (sum - part)) + (way - part);
      continue;
    }
    if (*position < start) *position += period[axis];
    if (*position >= start + period[axis]) *position -= period[axis];
  }
}

// The kick, and the second drift of the positions; compressions wait at the middle for the continuity of the new positions and velocities.
__kernel void correct(__constant const parameters_t* p, int count, __global real* state, __global const real* half_state, long stride,
                      __global const real* rates, __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
#if DIMENSIONS == 2
    if (axis == 1) continue;
#endif
    const real before = state[(FIELD_U + axis) * stride + i];
    const real after = (before + step * rates[(RATE_U + axis) * stride + i]) / (R(1.0) + step * p->damping);
    state[(FIELD_U + axis) * stride + i] = after;
    move(state, stride, axis, i, R(0.5) * step * (before + after) AND_SHIFT(step, state, axis, i));
  }
  wrap(p, state, stride, i);
  // lost in all: of the middle nothing is left to tell it by
#define TELL(NAME)                                                                                          \
  {                                                                                                         \
    const real drifted = state[FIELD_##NAME * stride + i] + R(0.5) * step * rates[RATE_##NAME * stride + i]; \
    if (not_finite(drifted)) state[FIELD_U * stride + i] = drifted;                                         \
  }
  EACH_CONJUGATE(TELL)
#define TAKE(NAME) state[FIELD_##NAME * stride + i] = half_state[FIELD_##NAME * stride + i];
  EACH_CONJUGATE(TAKE)
  derive(p, state, stride, i, state[FIELD_MASS * stride + i], R(0.0));
}

// The second drift of the compressions, and a step of what follows them.
__kernel void compress(__constant const parameters_t* p, int count, __global real* state, long stride, __global const real* rates,
                       __global const real* time_step) {
  const int i = get_global_id(0);
  if (i >= count) return;
#define DRIFT_ON(NAME) state[FIELD_##NAME * stride + i] += R(0.5) * time_step[0] * rates[RATE_##NAME * stride + i];
  EACH_CONJUGATE(DRIFT_ON)
#define FOLLOW(NAME) state[FIELD_##NAME * stride + i] += time_step[0] * rates[RATE_##NAME * stride + i];
  EACH_FOLLOWER(FOLLOW)
  derive(p, state, stride, i, state[FIELD_MASS * stride + i], R(0.0));
}

// Runge and Kutta's, and the predictor and corrector: a sum of weighted rates of several states.

#define EACH_EVOLVED(DO) EACH_CONJUGATE(DO) EACH_FOLLOWER(DO)

// Trial state: positions, velocities and what else evolves of a particle are set already.
INLINE void finish_trial(__constant const parameters_t* p, __global const real* now, __global real* trial, long stride, int i) {
  derive(p, trial, stride, i, now[FIELD_MASS * stride + i], R(0.0));
  if (is_lost(trial, stride, i)) leave_out(trial, stride, i);  // the sums have what was lost
}

// sum (+)= weight rates, of the trial state or, first, of that which is now; trial = now + part Δt rates.
__kernel void go_on_trial(__constant const parameters_t* p, int count, __global const real* now, __global real* trial, long stride, __global const real* rates,
                          __global const real* time_step, __global real* sum, int first, real weight, real part) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = part * time_step[0];
  __global const real* of = first ? now : trial;
  for (int axis = 0; axis < 3; ++axis) {
    const real speed = of[(FIELD_U + axis) * stride + i];
    const real acceleration = rates[(RATE_U + axis) * stride + i] - p->damping * speed;
    __global real* sum_x = sum + (SUM_X + axis) * stride + i;
    __global real* sum_u = sum + (SUM_U + axis) * stride + i;
    const real motion = WITH_SHIFT(speed, now, axis, i);
    *sum_x = (first ? R(0.0) : *sum_x) + weight * motion;
    *sum_u = (first ? R(0.0) : *sum_u) + weight * acceleration;
    trial[(FIELD_X + axis) * stride + i] = now[(FIELD_X + axis) * stride + i] + step * motion;
    if (IS_LONG(axis)) move_from(now, trial, stride, axis, i, step * motion);
    KEEP_SHIFT(now, trial, axis, i);
    trial[(FIELD_U + axis) * stride + i] = now[(FIELD_U + axis) * stride + i] + step * acceleration;
  }
#define GO_ON(NAME)                                                                                                                           \
  sum[SUM_##NAME * stride + i] = (first ? R(0.0) : sum[SUM_##NAME * stride + i]) + weight * rates[RATE_##NAME * stride + i];                  \
  trial[FIELD_##NAME * stride + i] = now[FIELD_##NAME * stride + i] + step * rates[RATE_##NAME * stride + i];
  EACH_EVOLVED(GO_ON)
  finish_trial(p, now, trial, stride, i);
}

// The rest of a step that began at the given place: what evolves by the sum and the weighted rates of the trial state, and what the guard and the next step
// need. What was found of the walls' distance at the trial state's place counts from the start.
INLINE void end_step(__constant const parameters_t* p, __global real* now, __global real* trial, long stride, int i, __global real* rates, const real* start,
                     real step, __global const real* sum, real weight) {
#define END(NAME) now[FIELD_##NAME * stride + i] += step * (sum[SUM_##NAME * stride + i] + weight * rates[RATE_##NAME * stride + i]);
  EACH_EVOLVED(END)
  real way = R(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    const real back = trial[(FIELD_X + axis) * stride + i] - start[axis];
    way += back * back;
    trial[(FIELD_X + axis) * stride + i] = start[axis];
    trial[(FIELD_U + axis) * stride + i] = R(0.0);
    FORGET_SHIFT(trial, axis, i);
  }
  rates[RATE_CLEARANCE * stride + i] -= sqrt(way);
  wrap(p, now, stride, i);
  if (not_finite(now[FIELD_COMPRESSION * stride + i])) now[FIELD_U * stride + i] = now[FIELD_COMPRESSION * stride + i];  // lost in all
  derive(p, now, stride, i, now[FIELD_MASS * stride + i], R(0.0));
}

// now += Δt (sum + weight rates), of the trial state.
__kernel void take_sum(__constant const parameters_t* p, int count, __global real* now, __global real* trial, long stride, __global real* rates,
                       __global const real* time_step, __global const real* sum, real weight) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = time_step[0];
  real start[3];
  for (int axis = 0; axis < 3; ++axis) {
    start[axis] = now[(FIELD_X + axis) * stride + i];
    const real speed = trial[(FIELD_U + axis) * stride + i];
    const real acceleration = rates[(RATE_U + axis) * stride + i] - p->damping * speed;
    move(now, stride, axis, i, step * (sum[(SUM_X + axis) * stride + i] + weight * WITH_SHIFT(speed, now, axis, i)));
    now[(FIELD_U + axis) * stride + i] += step * (sum[(SUM_U + axis) * stride + i] + weight * acceleration);
  }
  end_step(p, now, trial, stride, i, rates, start, step, sum, weight);
}

// trial: u* = u + Δt f*, x* = x + Δt u*, s* = s + Δt r*; half of the rates go into the sum.
__kernel void predict_end(__constant const parameters_t* p, int count, __global const real* now, __global real* trial, long stride, __global const real* rates,
                          __global const real* time_step, __global real* sum) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = time_step[0];
  for (int axis = 0; axis < 3; ++axis) {
    const real speed = now[(FIELD_U + axis) * stride + i];
    const real acceleration = rates[(RATE_U + axis) * stride + i] - p->damping * speed;
    sum[(SUM_U + axis) * stride + i] = R(0.5) * acceleration;
    trial[(FIELD_U + axis) * stride + i] = speed + step * acceleration;
    const real motion = WITH_SHIFT(speed + step * acceleration, now, axis, i);
    trial[(FIELD_X + axis) * stride + i] = now[(FIELD_X + axis) * stride + i] + step * motion;
    if (IS_LONG(axis)) move_from(now, trial, stride, axis, i, step * motion);
    KEEP_SHIFT(now, trial, axis, i);
  }
#define PREDICT(NAME)                                                          \
  sum[SUM_##NAME * stride + i] = R(0.5) * rates[RATE_##NAME * stride + i];     \
  trial[FIELD_##NAME * stride + i] = now[FIELD_##NAME * stride + i] + step * rates[RATE_##NAME * stride + i];
  EACH_EVOLVED(PREDICT)
  finish_trial(p, now, trial, stride, i);
}

// now: u += Δt (sum + f**/2), s likewise, x += Δt (u before + u after)/2.
__kernel void correct_end(__constant const parameters_t* p, int count, __global real* now, __global real* trial, long stride, __global real* rates,
                          __global const real* time_step, __global const real* sum) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const real step = time_step[0];
  real start[3];
  for (int axis = 0; axis < 3; ++axis) {
    start[axis] = now[(FIELD_X + axis) * stride + i];
    const real before = now[(FIELD_U + axis) * stride + i];
    const real acceleration = rates[(RATE_U + axis) * stride + i] - p->damping * trial[(FIELD_U + axis) * stride + i];
    const real after = before + step * (sum[(SUM_U + axis) * stride + i] + R(0.5) * acceleration);
    now[(FIELD_U + axis) * stride + i] = after;
    move(now, stride, axis, i, R(0.5) * step * (before + after) AND_SHIFT(step, now, axis, i));
  }
  end_step(p, now, trial, stride, i, rates, start, step, sum, R(0.5));
}

// One iteration of packing: the rates hold displacements.
__kernel void move_packed(__constant const parameters_t* p, int count, __global real* state, __global real* half_state, long stride,
                          __global const real* rates) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int axis = 0; axis < 3; ++axis) {
    half_state[(FIELD_X + axis) * stride + i] = state[(FIELD_X + axis) * stride + i];  // for the guard: where it was
    half_state[(FIELD_U + axis) * stride + i] = R(0.0);
    FORGET_SHIFT(half_state, axis, i);
    const real way = rates[(RATE_U + axis) * stride + i];
    if (IS_LONG(axis)) {
      move(state, stride, axis, i, way);
    } else {
      state[(FIELD_X + axis) * stride + i] += way;
    }
    state[(FIELD_U + axis) * stride + i] = R(0.0);
  }
  wrap(p, state, stride, i);
}
