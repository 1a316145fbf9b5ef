// Reductions over the particles, in a fixed order or as sums of whole numbers: chunks of REDUCE_CHUNK by one work-item each, as many chunks of those while there are more than that, and
// the last ones' results by one. Built without fast-math, and non-finite values are found by their bits all the same.
#include "common.cl"
#include "cells.cl"
#include "equation_of_state.cl"
#include "damping_rate.cl"
#include "exact_sums.cl"

// What the watchdog finds of one particle, of which the rows of src/sph/tables make the step's report.
typedef struct {
  int here;      // in the water: 0 of one that has left in this step, whose last state and rates these are
  int own;       // 0 of a part's halo, and of what has left a part
  int broken;    // a place or a velocity is not finite
  int infected;  // the compression or γ alone is not
  int sound;     // neither
  int outside, fast;
  int guarded;  // guard hits
  real speed2, acceleration2, shepard;
} watched_t;

#include "report.cl"

INLINE watched_t watched(__constant const parameters_t* p, __global const real* state, __global const real* rates, long stride, int here, int guarded, int i) {
  const real x = state[FIELD_X * stride + i], y = state[FIELD_Y * stride + i], z = state[FIELD_Z * stride + i];
  const real u = state[FIELD_U * stride + i], v = state[FIELD_V * stride + i], w = state[FIELD_W * stride + i];
  const real a = rates[RATE_U * stride + i], b = rates[RATE_V * stride + i], c = rates[RATE_W * stride + i];
  watched_t found;
  found.speed2 = u * u + v * v + w * w;
  found.acceleration2 = a * a + b * b + c * c;
  found.shepard = rates[RATE_SHEPARD * stride + i];
  found.broken = not_finite(x) || not_finite(y) || not_finite(z) || not_finite(found.speed2) ? 1 : 0;
  found.infected = !found.broken && (not_finite(state[FIELD_COMPRESSION * stride + i]) || not_finite(found.shepard)) ? 1 : 0;
  found.sound = !found.broken && !found.infected ? 1 : 0;
  const bool beyond = x < p->lower_x || x > p->upper_x || y < p->lower_y || y > p->upper_y || z < p->lower_z || z > p->upper_z;
  found.outside = here && found.sound && beyond ? 1 : 0;
  found.fast = found.sound && found.speed2 > p->greatest_speed * p->greatest_speed ? 1 : 0;
  found.guarded = guarded;
  found.here = here;
  found.own = 1;
#ifdef PARTED
  // of others the state is watched by others; rates and hits of them are stilled
  const int place = place_in_parts(p, x, y, z);
  if (!here || state[FIELD_OWN * stride + i] == R(0.0)) {
    found.here = found.own = found.broken = found.outside = found.fast = 0;
    found.infected = not_finite(found.shepard) ? 1 : 0;
    found.speed2 = R(0.0);
  } else if (found.sound && is_astray(p, x, y, z, place)) {
    found.outside = 1;
  }
#endif
  return found;
}

__kernel void watch_chunks(__constant const parameters_t* p, int count, __global const real* state, __global const real* rates, long stride,
                           __global const int* slot_start, int slots, __global const int* guard_hits, __global real* watches, __global int* alarms) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= max(count, 1)) return;
  real greatest[GREATEST_COUNT];
  int counted[COUNTED_COUNT];
  for (int k = 0; k < GREATEST_COUNT; ++k) greatest[k] = R(0.0);
  for (int k = 0; k < COUNTED_COUNT; ++k) counted[k] = is_first(k) ? NOBODY : 0;
  // with those that have just left: rates and hits may still be in the order of before the sort
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    const watched_t found = watched(p, state, rates, stride, i < slot_start[slots] ? 1 : 0, guard_hits[i], i);
    watch_particle(&found, p, state, rates, stride, i, greatest, counted);
  }
  for (int k = 0; k < GREATEST_COUNT; ++k) watches[chunk * GREATEST_COUNT + k] = greatest[k];
  for (int k = 0; k < COUNTED_COUNT; ++k) alarms[chunk * COUNTED_COUNT + k] = counted[k];
}

// Chunks of what chunks have found.
__kernel void watch_groups(int chunks, __global const real* watches, __global const int* alarms, __global real* group_watches, __global int* group_alarms) {
  const int group = get_global_id(0);
  if (group * REDUCE_CHUNK >= chunks) return;
  const int first = group * REDUCE_CHUNK, end = min(chunks, first + REDUCE_CHUNK);
  for (int k = 0; k < GREATEST_COUNT; ++k) {
    real most = watches[first * GREATEST_COUNT + k];
    for (int chunk = first + 1; chunk < end; ++chunk) most = fmax(most, watches[chunk * GREATEST_COUNT + k]);
    group_watches[group * GREATEST_COUNT + k] = most;
  }
  for (int k = 0; k < COUNTED_COUNT; ++k) {
    int found = alarms[first * COUNTED_COUNT + k];
    for (int chunk = first + 1; chunk < end; ++chunk) {
      const int more = alarms[chunk * COUNTED_COUNT + k];
      found = is_first(k) ? min(found, more) : found + more;
    }
    group_alarms[group * COUNTED_COUNT + k] = found;
  }
}

// longest: bound on Δt from what moves besides the fluid, s.
__kernel void watch_total(__constant const parameters_t* p, int chunks, __global const real* watches, __global const int* alarms, real longest,
                          __global real* report) {
  if (get_global_id(0) != 0) return;
  for (int k = 0; k < GREATEST_COUNT; ++k) {
    real most = R(0.0);
    for (int chunk = 0; chunk < chunks; ++chunk) most = fmax(most, watches[chunk * GREATEST_COUNT + k]);
    report[REPORT_GREATEST + k] = end_of(k, most);
  }
  int counted[COUNTED_COUNT];
  for (int k = 0; k < COUNTED_COUNT; ++k) {
    counted[k] = is_first(k) ? NOBODY : 0;
    for (int chunk = 0; chunk < chunks; ++chunk) {
      const int more = alarms[chunk * COUNTED_COUNT + k];
      counted[k] = is_first(k) ? min(counted[k], more) : counted[k] + more;
    }
  }
#ifndef PARTED  // the host knows of the other parts
  if (counted[COUNTED_NOT_FINITE] == 0 && counted[COUNTED_INFECTED] > 0) {  // without another to blame
    counted[COUNTED_NOT_FINITE] = counted[COUNTED_INFECTED];
    counted[COUNTED_OFFENDER] = min(counted[COUNTED_OFFENDER], counted[COUNTED_FIRST_INFECTED]);
  }
#endif
  __global int* integers = (__global int*)(report + REPORT_COUNTED);
  for (int k = 0; k < COUNTED_COUNT; ++k) integers[k] = counted[k];
  const real h = p->smoothing_length;
  real step = p->courant * h / (p->sound_speed + report[REPORT_GREATEST + GREATEST_SPEED]);
  step = fmin(step, p->courant * sqrt(h / fmax(report[REPORT_GREATEST + GREATEST_ACCELERATION], R(1.0e-20))));
  step = fmin(step, p->viscous_time);
  report[REPORT_STEP] = fmin(step, longest);
}

// Water whose tension is taken away stores none.
INLINE real stored_energy(real s) { return stored_energy_of(CLAMP_PRESSURE ? fmax(s, R(0.0)) : s); }

#if ACOUSTIC_DAMPER
EQUATION_OF_STATE(real, stated)

// What the damper adds to the pressure that moves the water: less than its own where that would be tension.
INLINE real damper_pressure(__constant const parameters_t* p, real s, real rate) {
  const real without = stated_pressure(p, s), with = without + p->bulk_viscosity * rate;
  return CLAMP_PRESSURE ? fmax(with, R(0.0)) - fmax(without, R(0.0)) : with - without;
}
#endif

INLINE void add_compensated(real value, real* sum, real* rest) {
  const real wanted = value - *rest;
  const real total = *sum + wanted;
  *rest = (total - *sum) - wanted;
  *sum = total;
}

// Sums over chunks of rows of an array, column by column.
__kernel void sum_rows(int rows, int columns, __global const real* from, __global real* to) {
  const int item = get_global_id(0);
  const int group = item / columns, column = item % columns;
  if (group * REDUCE_CHUNK >= rows) return;
  real sum = R(0.0), rest = R(0.0);
  for (int row = group * REDUCE_CHUNK; row < min(rows, (group + 1) * REDUCE_CHUNK); ++row) add_compensated(from[(long)row * columns + column], &sum, &rest);
  to[item] = sum;
}

// The same of whole numbers.
__kernel void sum_exact_rows(int rows, int columns, __global const long* from, __global long* to) {
  const int item = get_global_id(0);
  const int group = item / columns, column = item % columns;
  if (group * REDUCE_CHUNK >= rows) return;
  long sum = 0;
  for (int row = group * REDUCE_CHUNK; row < min(rows, (group + 1) * REDUCE_CHUNK); ++row) sum += from[(long)row * columns + column];
  to[item] = sum;
}

// Energies and moments of a particle.
INLINE void find_energies(real* values, __constant const parameters_t* p, int i, __global const real* state, long stride, __global const real* rates,
                          int damping_count, __global const real* dampings) {
  for (int k = 0; k < ENERGY_COUNT; ++k) values[k] = R(0.0);
  const real mass = state[FIELD_MASS * stride + i];
  const real u = state[FIELD_U * stride + i], v = state[FIELD_V * stride + i], w = state[FIELD_W * stride + i];
  const real s = state[FIELD_COMPRESSION * stride + i];
  const real fall = p->gravity_x * state[FIELD_X * stride + i] + p->gravity_y * state[FIELD_Y * stride + i] + p->gravity_z * state[FIELD_Z * stride + i];
  values[ENERGY_KINETIC] = R(0.5) * mass * (u * u + v * v + w * w);
  values[ENERGY_POTENTIAL] = -mass * fall;
  values[ENERGY_COMPRESSION] = p->sound_speed * p->sound_speed * mass * stored_energy(s);
  values[ENERGY_MASS] = mass;
  for (int axis = 0; axis < 3; ++axis) values[ENERGY_MOMENT + axis] = mass * state[(FIELD_X + axis) * stride + i];
#if ACOUSTIC_DAMPER
  const real compressing = rates[RATE_COMPRESSION * stride + i];
  values[ENERGY_DAMPER] = state[FIELD_VOLUME * stride + i] * compressing * damper_pressure(p, s, compressing);
#endif
  for (int k = 0; k < damping_count; ++k) {
    __global const real* zone = dampings + k * DAMPING_COUNT;
    const real rate = mass * damping_rate(zone, state, stride, i);
    if (rate == R(0.0)) continue;
    real force[3];
    for (int axis = 0; axis < 3; ++axis) force[axis] = rate * (state[(FIELD_U + axis) * stride + i] - zone[DAMPING_VELOCITY + axis]);
    for (int axis = 0; axis < 3; ++axis) {
      const int next = (axis + 1) % 3, last = (axis + 2) % 3;
      values[ENERGY_ZONE_FORCE + axis] += force[axis];
      values[ENERGY_ZONE_MOMENT + axis] += state[(FIELD_X + next) * stride + i] * force[last] - state[(FIELD_X + last) * stride + i] * force[next];
    }
  }
}

// One of `pieces` of each row, every pieces-th segment of it: each segment, which no cut divides, in floating point, and segments in whole numbers.
// `quanta`: of each of these sums, a unit.
__kernel void energy_pieces(__constant const parameters_t* p, int rows, int pieces, int segment, __global const int* slot_start, __global const real* state,
                            long stride, __global const real* rates, int damping_count, __global const real* dampings, __global const real* quanta,
                            __global long* energies) {
  const int item = get_global_id(0);
  if (item >= rows * pieces) return;
  const int places = EXACT(ENERGY_COUNT);
  const int summed = damping_count > 0 ? ENERGY_COUNT : (ACOUSTIC_DAMPER ? ENERGY_DAMPER + 1 : ENERGY_DAMPER);
  long totals[EXACT(ENERGY_COUNT)] = {0};
  __global const int* starts = slot_start + (long)(item / pieces) * SLOTS_OF_ROW(p);
  for (int slot = 1 + item % pieces * segment; slot < p->slots_x - 1; slot += pieces * segment) {
    const int begin = starts[SLOT_HERE(p, slot)], end = starts[SLOT_HERE(p, min(slot + segment, p->slots_x - 1) - 1) + 1];
#ifdef PARTED
    if (begin >= end || state[FIELD_OWN * stride + begin] == R(0.0)) continue;
#else
    if (begin == end) continue;
#endif
    real sums[ENERGY_COUNT], rests[ENERGY_COUNT], values[ENERGY_COUNT];
    for (int k = 0; k < ENERGY_COUNT; ++k) sums[k] = rests[k] = R(0.0);
    for (int i = begin; i < end; ++i) {
      find_energies(values, p, i, state, stride, rates, damping_count, dampings);
      for (int k = 0; k < summed; ++k) add_compensated(values[k], &sums[k], &rests[k]);
    }
    for (int k = 0; k < summed; ++k) add_exact_less(totals, k, ENERGY_COUNT, quanta[k] * sums[k], quanta[k] * rests[k]);
  }
  carry_rests(totals, ENERGY_COUNT);
  for (int k = 0; k < places; ++k) energies[(long)item * places + k] = totals[k];
}

// Packing's report: Σ (h |E|)².
__kernel void packing_chunks(int count, __global const real* state, __global const real* rates, long stride, __global real* sums) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= max(count, 1)) return;
  real sum = R(0.0), rest = R(0.0);
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
#ifdef PARTED
    if (state[FIELD_OWN * stride + i] == R(0.0)) continue;
#endif
    const real error = rates[RATE_COMPRESSION * stride + i];
    add_compensated(error * error, &sum, &rest);
  }
  sums[chunk] = sum;
}

// Impulse and its moment about the owner's centre that the guard has taken from the particles for each owner, in quanta of either.
__kernel void guard_chunks(int count, __global const real* state, long stride, __global const int* guard_hits,
                           __global const int* takers, __global const real* lost, int owners, __global const real* motions, real per_impulse,
                           real per_moment, __global long* impulses) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= max(count, 1)) return;
  const int places = EXACT(IMPULSE_COUNT);
  __global long* row = impulses + (long)chunk * owners * places;
  for (int k = 0; k < owners * places; ++k) row[k] = 0;
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    if (guard_hits[i] == 0) continue;
#ifdef PARTED
    if (state[FIELD_OWN * stride + i] == R(0.0)) continue;
#endif
    const real mass = state[FIELD_MASS * stride + i];
    for (int slot = 0; slot < GUARD_OWNERS; ++slot) {
      const int owner = takers[slot * stride + i];
      if (owner == NO_OWNER) continue;
      __global const real* velocity = lost + 3 * slot * stride;
      const real px = mass * velocity[i], py = mass * velocity[stride + i], pz = mass * velocity[2 * stride + i];
      __global const real* centre = OWNER_MOTION(motions, owner);
      const real rx = state[FIELD_X * stride + i] - centre[0], ry = state[FIELD_Y * stride + i] - centre[1],
                 rz = state[FIELD_Z * stride + i] - centre[2];
      long sums[EXACT(IMPULSE_COUNT)] = {0};
      add_exact_force(sums, IMPULSE_COUNT, per_impulse, per_moment, px, py, pz, rx, ry, rz);
      for (int k = 0; k < places; ++k) row[owner * places + k] += sums[k];
    }
  }
}

// Force and torque on each owner of walls, in quanta of either, from what the runs of slots of its region do to it: first of chunks of runs, of which each
// region has as many, some of them empty.
__kernel void wrench_chunks(int count, int chunks, int regions, int items, __global const int* region_values, __global const real* wrenches,
                            real per_force, real per_moment, __global long* sums) {
  const int k = get_global_id(0);
  if (k >= count) return;
  const int region = k / chunks, chunk = k % chunks;
  const int first = region_values[region * REGION_COUNT + REGION_ITEM] + chunk * REDUCE_CHUNK;
  const int end = min(first + REDUCE_CHUNK, region + 1 < regions ? region_values[(region + 1) * REGION_COUNT + REGION_ITEM] : items);
  const int places = EXACT(WRENCH_COUNT);
  long sum[EXACT(WRENCH_COUNT)] = {0};
  for (int item = first; item < end; ++item)
    for (int part = 0; part < WRENCH_COUNT; ++part) {
      const real value = wrenches[item * WRENCH_COUNT + part];
      if (value == R(0.0)) continue;  // of most runs: far from the owner
      add_exact(sum, part, WRENCH_COUNT, (part < WRENCH_COUNT / 2 ? per_force : per_moment) * value);
    }
  carry_rests(sum, WRENCH_COUNT);
  for (int part = 0; part < places; ++part) sums[k * places + part] = sum[part];
}

__kernel void wrench_totals(int regions, int chunks, __global const long* sums, __global long* totals) {
  const int item = get_global_id(0);
  const int places = EXACT(WRENCH_COUNT);
  if (item >= regions * places) return;
  const int k = item / places, part = item % places;
  long sum = 0;
  for (int chunk = 0; chunk < chunks; ++chunk) sum += sums[(k * chunks + chunk) * places + part];
  totals[item] = sum;
}

// What chunks of the pieces of wall that face another owner's (facing_walls.cl) add to the listed owners' pressure forces and torques.
__kernel void facing_chunks(int items, int chunks, int count, __global const int* region_values, __global const real* motions, __global const int* owners,
                            __global const real* places, __global const int* others, __global const real* forces, real per_force, real per_moment,
                            __global long* sums) {
  const int item = get_global_id(0);
  if (item >= items) return;
  const int owner = region_values[item / chunks * REGION_COUNT + REGION_OWNER];
  const int chunk = item % chunks;
  __global const real* centre = OWNER_MOTION(motions, owner);
  long sum[EXACT(FACING_COUNT)] = {0};
  for (int s = chunk * REDUCE_CHUNK; s < min(count, (chunk + 1) * REDUCE_CHUNK); ++s)
    for (int slot = 0; slot < FACING_OWNERS; ++slot) {
      const int other = others[slot * count + s];
      if (other == NO_OWNER || (owners[s] != owner && other != owner)) continue;
      const real sign = owners[s] == owner ? R(1.0) : R(-1.0);
      const real fx = sign * forces[3 * slot * count + s], fy = sign * forces[(3 * slot + 1) * count + s], fz = sign * forces[(3 * slot + 2) * count + s];
      const real rx = places[s] - centre[0], ry = places[count + s] - centre[1], rz = places[2 * count + s] - centre[2];
      add_exact_force(sum, FACING_COUNT, per_force, per_moment, fx, fy, fz, rx, ry, rz);
    }
  carry_rests(sum, FACING_COUNT);
  for (int k = 0; k < EXACT(FACING_COUNT); ++k) sums[EXACT(FACING_COUNT) * item + k] = sum[k];
}

__kernel void facing_totals(int regions, int chunks, __global const long* sums, __global long* totals) {
  const int k = get_global_id(0);
  if (k >= regions) return;
  __global long* row = totals + k * EXACT(WRENCH_COUNT);
  for (int chunk = 0; chunk < chunks; ++chunk) {
    __global const long* added = sums + EXACT(FACING_COUNT) * (k * chunks + chunk);
    for (int part = 0; part < FACING_COUNT; ++part) {
      const int to = part < 3 ? part : part + 3;
      row[to] += added[part];
      row[WRENCH_COUNT + to] += added[FACING_COUNT + part];
    }
    row[EXACT(WRENCH_COUNT) - 1] += added[EXACT(FACING_COUNT) - 1];
  }
}
