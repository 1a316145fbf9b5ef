// Reductions over the particles, in a fixed order: chunks of REDUCE_CHUNK by one work-item each, as many chunks of those while there are more than that, and
// the last ones' results by one. Built without fast-math, and non-finite values are found by their bits all the same.
#include "common.cl"

#define REDUCE_CHUNK 256
#define NOBODY 0x7fffffff

// What the host reads after a step, at once.
#define REPORT_STEP 0         // Δt of the next step
#define REPORT_SPEED 1        // greatest |u|
#define REPORT_ACCELERATION 2 // greatest |du/dt|
#define REPORT_ALARMS 4       // ALARM_COUNT integers
#define REPORT_IMPULSES 12    // that the guard took from the particles, IMPULSE_COUNT for each owner of walls

#define WATCH_SPEED 0         // greatest |u|²
#define WATCH_ACCELERATION 1  // greatest |du/dt|²
#define WATCH_COUNT 2

#define ALARM_NOT_FINITE 0    // how many
#define ALARM_OUTSIDE 1
#define ALARM_FAST 2
#define ALARM_FIRST 3         // the least index of an offender
#define ALARM_GUARD 4         // guard hits of this step
#define ALARM_SHEPARD 5       // γ bounded
#define ALARM_INFECTED 6      // not finite in the compression alone, which follows from that of others, and the least index of such
#define ALARM_FIRST_INFECTED 7
#define ALARM_COUNT 8

__kernel void watch_chunks(__constant const parameters_t* p, int count, __global const real* state, __global const real* rates, long stride,
                           __global const int* guard_hits, __global real* watches, __global int* alarms) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= count) return;
  real speed = R(0.0), acceleration = R(0.0);
  int broken = 0, outside = 0, fast = 0, first = NOBODY, guarded = 0, bounded = 0, infected = 0, first_infected = NOBODY;
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    const real x = state[FIELD_X * stride + i], y = state[FIELD_Y * stride + i], z = state[FIELD_Z * stride + i];
    const real u = state[FIELD_U * stride + i], v = state[FIELD_V * stride + i], w = state[FIELD_W * stride + i];
    const real s = state[FIELD_COMPRESSION * stride + i];
    const real a = rates[RATE_U * stride + i], b = rates[RATE_V * stride + i], c = rates[RATE_W * stride + i];
    const real shepard = rates[RATE_SHEPARD * stride + i];
    const real speed2 = u * u + v * v + w * w;
    const real acceleration2 = a * a + b * b + c * c;
    int offends = 0;
    if (not_finite(x) || not_finite(y) || not_finite(z) || not_finite(speed2)) {
      ++broken;
      offends = 1;
    } else if (not_finite(s) || not_finite(shepard)) {
      ++infected;
      if (first_infected == NOBODY) first_infected = i;
    } else {
      if (x < p->lower_x || x > p->upper_x || y < p->lower_y || y > p->upper_y || z < p->lower_z || z > p->upper_z) {
        ++outside;
        offends = 1;
      }
      if (speed2 > p->greatest_speed * p->greatest_speed) {
        ++fast;
        offends = 1;
      }
      speed = fmax(speed, speed2);
    }
    // from before the sorting, so of another particle: one that is not finite shows in its own particle's velocity
    if (!not_finite(acceleration2)) acceleration = fmax(acceleration, acceleration2);
    if (offends && first == NOBODY) first = i;
    guarded += guard_hits[i];
    bounded += shepard > R(1.005) || shepard < R(0.05) ? 1 : 0;
  }
  watches[chunk * WATCH_COUNT + WATCH_SPEED] = speed;
  watches[chunk * WATCH_COUNT + WATCH_ACCELERATION] = acceleration;
  alarms[chunk * ALARM_COUNT + ALARM_NOT_FINITE] = broken;
  alarms[chunk * ALARM_COUNT + ALARM_OUTSIDE] = outside;
  alarms[chunk * ALARM_COUNT + ALARM_FAST] = fast;
  alarms[chunk * ALARM_COUNT + ALARM_FIRST] = first;
  alarms[chunk * ALARM_COUNT + ALARM_GUARD] = guarded;
  alarms[chunk * ALARM_COUNT + ALARM_SHEPARD] = bounded;
  alarms[chunk * ALARM_COUNT + ALARM_INFECTED] = infected;
  alarms[chunk * ALARM_COUNT + ALARM_FIRST_INFECTED] = first_infected;
}

// Chunks of what chunks have found.
__kernel void watch_groups(int chunks, __global const real* watches, __global const int* alarms, __global real* group_watches, __global int* group_alarms) {
  const int group = get_global_id(0);
  if (group * REDUCE_CHUNK >= chunks) return;
  __global const real* watch = watches + group * REDUCE_CHUNK * WATCH_COUNT;
  __global const int* alarm = alarms + group * REDUCE_CHUNK * ALARM_COUNT;
  const int own = min(chunks - group * REDUCE_CHUNK, REDUCE_CHUNK);
  for (int k = 0; k < WATCH_COUNT; ++k) {
    real most = watch[k];
    for (int chunk = 1; chunk < own; ++chunk) most = fmax(most, watch[chunk * WATCH_COUNT + k]);
    group_watches[group * WATCH_COUNT + k] = most;
  }
  for (int k = 0; k < ALARM_COUNT; ++k) {
    const bool least = k == ALARM_FIRST || k == ALARM_FIRST_INFECTED;
    int found = alarm[k];
    for (int chunk = 1; chunk < own; ++chunk) found = least ? min(found, alarm[chunk * ALARM_COUNT + k]) : found + alarm[chunk * ALARM_COUNT + k];
    group_alarms[group * ALARM_COUNT + k] = found;
  }
}

// longest: bound on Δt from what moves besides the fluid, s.
__kernel void watch_total(__constant const parameters_t* p, int chunks, __global const real* watches, __global const int* alarms, real longest,
                          __global real* report) {
  if (get_global_id(0) != 0) return;
  real speed = R(0.0), acceleration = R(0.0);
  int sums[ALARM_COUNT] = {0, 0, 0, 0, 0, 0, 0, 0};
  int first = NOBODY, first_infected = NOBODY;
  for (int chunk = 0; chunk < chunks; ++chunk) {
    speed = fmax(speed, watches[chunk * WATCH_COUNT + WATCH_SPEED]);
    acceleration = fmax(acceleration, watches[chunk * WATCH_COUNT + WATCH_ACCELERATION]);
    for (int k = 0; k < ALARM_COUNT; ++k) sums[k] += k == ALARM_FIRST || k == ALARM_FIRST_INFECTED ? 0 : alarms[chunk * ALARM_COUNT + k];
    first = min(first, alarms[chunk * ALARM_COUNT + ALARM_FIRST]);
    first_infected = min(first_infected, alarms[chunk * ALARM_COUNT + ALARM_FIRST_INFECTED]);
  }
  if (sums[ALARM_NOT_FINITE] == 0 && sums[ALARM_INFECTED] > 0) {  // without another to blame
    sums[ALARM_NOT_FINITE] = sums[ALARM_INFECTED];
    first = min(first, first_infected);
  }
  sums[ALARM_FIRST] = first;
  __global int* alarm = (__global int*)(report + REPORT_ALARMS);
  for (int k = 0; k < ALARM_COUNT; ++k) alarm[k] = sums[k];
  speed = sqrt(speed);
  acceleration = sqrt(acceleration);
  const real h = p->smoothing_length;
  real step = p->courant * h / (p->sound_speed + speed);
  step = fmin(step, p->courant * sqrt(h / fmax(acceleration, R(1.0e-20))));
  step = fmin(step, p->viscous_time);
  report[REPORT_STEP] = fmin(step, longest);
  report[REPORT_SPEED] = speed;
  report[REPORT_ACCELERATION] = acceleration;
}

#define ENERGY_KINETIC 0
#define ENERGY_POTENTIAL 1    // about the grid's origin
#define ENERGY_COMPRESSION 2
#define ENERGY_MASS 3
#define ENERGY_MOMENT 4       // Σ m x, m y, m z from the grid's origin
#define ENERGY_COUNT 7

// ∫ p/ρ² dρ/c₀² from rest to the compression s: what a unit of mass stores. Water whose tension is taken away stores none.
INLINE real stored_energy(real s) {
#if CLAMP_PRESSURE
  s = fmax(s, R(0.0));
#endif
  const bool small = fabs(s) < R(0.03);  // there the closed form is a small difference of large terms
#if COLE
  const real r = R(1.0) + s;
  const real series = s * s * (R(0.5) + s * (R(0.333333333333) + R(0.5) * s));
  return small ? series : ((r * r * r * r * r * r - R(1.0)) / R(6.0) - s / r) / R(7.0);
#else
  const real series = s * s * (R(0.5) + s * (R(-0.666666666667) + s * (R(0.75) + s * (R(-0.8) + s * R(0.833333333333)))));
  return small ? series : log(fmax(R(1.0) + s, R(1.0e-6))) - s / (R(1.0) + s);
#endif
}

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

__kernel void energy_chunks(__constant const parameters_t* p, int count, __global const real* state, long stride, __global real* energies) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= count) return;
  real sums[ENERGY_COUNT], rests[ENERGY_COUNT];
  for (int k = 0; k < ENERGY_COUNT; ++k) sums[k] = rests[k] = R(0.0);
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    const real mass = state[FIELD_MASS * stride + i];
    const real u = state[FIELD_U * stride + i], v = state[FIELD_V * stride + i], w = state[FIELD_W * stride + i];
    const real s = state[FIELD_COMPRESSION * stride + i];
    const real fall = p->gravity_x * state[FIELD_X * stride + i] + p->gravity_y * state[FIELD_Y * stride + i] + p->gravity_z * state[FIELD_Z * stride + i];
    add_compensated(R(0.5) * mass * (u * u + v * v + w * w), &sums[ENERGY_KINETIC], &rests[ENERGY_KINETIC]);
    add_compensated(-mass * fall, &sums[ENERGY_POTENTIAL], &rests[ENERGY_POTENTIAL]);
    add_compensated(p->sound_speed * p->sound_speed * mass * stored_energy(s), &sums[ENERGY_COMPRESSION], &rests[ENERGY_COMPRESSION]);
    add_compensated(mass, &sums[ENERGY_MASS], &rests[ENERGY_MASS]);
    for (int axis = 0; axis < 3; ++axis)
      add_compensated(mass * state[(FIELD_X + axis) * stride + i], &sums[ENERGY_MOMENT + axis], &rests[ENERGY_MOMENT + axis]);
  }
  for (int k = 0; k < ENERGY_COUNT; ++k) energies[chunk * ENERGY_COUNT + k] = sums[k];
}

// Packing's report: Σ (h |E|)².
__kernel void packing_chunks(int count, __global const real* rates, long stride, __global real* sums) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= count) return;
  real sum = R(0.0), rest = R(0.0);
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    const real error = rates[RATE_COMPRESSION * stride + i];
    add_compensated(error * error, &sum, &rest);
  }
  sums[chunk] = sum;
}

// Impulse and its moment about the owner's centre that the guard has taken from the particles for each owner: N·s, N·m·s.
__kernel void guard_chunks(int count, __global const real* state, long stride, __global const int* guard_hits, __global const int* takers,
                           __global const real* lost, int owners, __global const real* motions, __global real* impulses) {
  const int chunk = get_global_id(0);
  if (chunk * REDUCE_CHUNK >= count) return;
  __global real* sums = impulses + (long)chunk * owners * IMPULSE_COUNT;
  for (int k = 0; k < owners * IMPULSE_COUNT; ++k) sums[k] = R(0.0);
  for (int i = chunk * REDUCE_CHUNK; i < min(count, (chunk + 1) * REDUCE_CHUNK); ++i) {
    if (guard_hits[i] == 0) continue;
    const real mass = state[FIELD_MASS * stride + i];
    for (int slot = 0; slot < GUARD_OWNERS; ++slot) {
      const int owner = takers[slot * stride + i];
      if (owner == NO_OWNER) continue;
      __global const real* velocity = lost + 3 * slot * stride;
      const real px = mass * velocity[i], py = mass * velocity[stride + i], pz = mass * velocity[2 * stride + i];
      __global const real* centre = OWNER_MOTION(motions, owner);
      const real rx = state[FIELD_X * stride + i] - centre[0], ry = state[FIELD_Y * stride + i] - centre[1],
                 rz = state[FIELD_Z * stride + i] - centre[2];
      __global real* own = sums + owner * IMPULSE_COUNT;
      own[0] += px;
      own[1] += py;
      own[2] += pz;
      own[3] += ry * pz - rz * py;
      own[4] += rz * px - rx * pz;
      own[5] += rx * py - ry * px;
    }
  }
}

__kernel void guard_totals(int values, __global const real* impulses, __global real* report) {
  const int k = get_global_id(0);
  if (k < values) report[REPORT_IMPULSES + k] = impulses[k];
}

// Force and torque on each owner of walls, from what the runs of cells of its region do to it: first of chunks of runs, of which each region has as many,
// some of them empty.
__kernel void wrench_chunks(int count, int chunks, int regions, int items, __global const int* region_values, __global const real* wrenches,
                            __global real* sums) {
  const int k = get_global_id(0);
  if (k >= count) return;
  const int region = k / chunks, chunk = k % chunks;
  const int first = region_values[region * REGION_COUNT + REGION_ITEM] + chunk * REDUCE_CHUNK;
  const int end = min(first + REDUCE_CHUNK, region + 1 < regions ? region_values[(region + 1) * REGION_COUNT + REGION_ITEM] : items);
  for (int part = 0; part < WRENCH_COUNT; ++part) {
    real sum = R(0.0), rest = R(0.0);
    for (int item = first; item < end; ++item) add_compensated(wrenches[item * WRENCH_COUNT + part], &sum, &rest);
    sums[k * WRENCH_COUNT + part] = sum;
  }
}

__kernel void wrench_totals(int regions, int chunks, __global const real* sums, __global real* totals) {
  const int k = get_global_id(0);
  if (k >= regions) return;
  for (int part = 0; part < WRENCH_COUNT; ++part) {
    real sum = R(0.0), rest = R(0.0);
    for (int chunk = 0; chunk < chunks; ++chunk) add_compensated(sums[(k * chunks + chunk) * WRENCH_COUNT + part], &sum, &rest);
    totals[k * WRENCH_COUNT + part] = sum;
  }
}

// What chunks of the pieces of wall that face another owner's (facing_walls.cl) add to the listed owners' pressure forces and torques.
__kernel void facing_chunks(int items, int chunks, int count, __global const int* region_values, __global const real* motions, __global const int* owners,
                            __global const real* places, __global const int* others, __global const real* forces, __global real* sums) {
  const int item = get_global_id(0);
  if (item >= items) return;
  const int owner = region_values[item / chunks * REGION_COUNT + REGION_OWNER];
  const int chunk = item % chunks;
  __global const real* centre = OWNER_MOTION(motions, owner);
  real sum[6] = {R(0.0), R(0.0), R(0.0), R(0.0), R(0.0), R(0.0)};
  for (int s = chunk * REDUCE_CHUNK; s < min(count, (chunk + 1) * REDUCE_CHUNK); ++s)
    for (int slot = 0; slot < FACING_OWNERS; ++slot) {
      const int other = others[slot * count + s];
      if (other == NO_OWNER || (owners[s] != owner && other != owner)) continue;
      const real sign = owners[s] == owner ? R(1.0) : R(-1.0);
      const real fx = sign * forces[3 * slot * count + s], fy = sign * forces[(3 * slot + 1) * count + s], fz = sign * forces[(3 * slot + 2) * count + s];
      const real rx = places[s] - centre[0], ry = places[count + s] - centre[1], rz = places[2 * count + s] - centre[2];
      sum[0] += fx;
      sum[1] += fy;
      sum[2] += fz;
      sum[3] += ry * fz - rz * fy;
      sum[4] += rz * fx - rx * fz;
      sum[5] += rx * fy - ry * fx;
    }
  for (int k = 0; k < 6; ++k) sums[6 * item + k] = sum[k];
}

__kernel void facing_totals(int regions, int chunks, __global const real* sums, __global real* totals) {
  const int k = get_global_id(0);
  if (k >= regions) return;
  for (int part = 0; part < 6; ++part) {
    real sum = R(0.0), rest = R(0.0);
    for (int chunk = 0; chunk < chunks; ++chunk) add_compensated(sums[6 * (k * chunks + chunk) + part], &sum, &rest);
    totals[k * WRENCH_COUNT + (part < 3 ? part : part + 3)] += sum;
  }
}
