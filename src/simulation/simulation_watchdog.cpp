#include <utility>

#include "simulation_parts.h"
#include "texts.h"
#include "wavetank/common/log.h"

namespace wavetank {

void Simulation::Parts::check(const StepReport& r) {
  if (r.offender >= 0) {
    std::string what;
    const auto add = [&](int count, const std::string& text) {
      if (count > 0) what += (what.empty() ? "" : ", ") + std::to_string(count) + text;
    };
    add(r.not_finite, " with values that are not finite");
    add(r.outside, " outside the tank");
    add(r.too_fast, " faster than half the speed of sound (" + number(0.5 * discretisation.sound_speed) + " m/s)");
    throw Violation("particles in violation: " + what + "; the first is particle " + std::to_string(r.offender_id) + " at " +
                    point(r.offender_position) + " m with velocity " + point(r.offender_velocity) + " m/s," + when());
  }
  if (!(r.time_step >= discretisation.least_time_step))
    throw Violation("the time step collapsed to " + number(r.time_step) + " s (greatest speed " + number(r.greatest_speed) +
                    " m/s, greatest acceleration " + number(r.greatest_acceleration) + " m/s²)," + when());
  tell_of_speed(r.greatest_speed);
  check_bodies();
}

void Simulation::Parts::check_start() {
  try {
    check(report);
  } catch (const Violation& violation) {
    throw Violation("before the start (numerics/packing/settling is " + number(scene.numerics.packing.settling) + "): " + violation.what());
  }
}

void Simulation::Parts::tell_of_speed(double greatest) {
  constexpr double most = 0.15;  // Mach number: densities then change by about its square
  const double mach = greatest / discretisation.sound_speed;
  if (!(mach > most) || std::exchange(told_of_speed, true)) return;
  log(LogLevel::warning, "the fastest particle moves at " + number(greatest) + " m/s, Mach " + number(mach, "%.3f") + " at t = " +
                             number(time) + " s, where water is no longer as good as incompressible: choose a fluid/sound_speed above " +
                             number(discretisation.sound_speed) + " m/s if that is more than spray.");
}

void Simulation::Parts::check_volume() {
  constexpr std::uint64_t interval = 200;    // steps: it takes long to come about, and a look at it as long as half a step
  constexpr double told = 0.03, most = 0.1;  // of the volume; dam breaks stay at 0.01
  if (step % interval != 0) return;
  const LostVolume volume = solver->lost_volume();
  if (!(volume.lost > told * volume.whole)) return;
  const std::string unit = scene.dimensions == 2 ? " m²" : " m³";
  const std::string what = "of the water's volume of " + number(volume.whole) + unit + " by its density, " + number(volume.lost, "%.3g") +
                           unit + " are missing: particles lie upon each other, most of all at " + point(volume.place) + " m";
  if (volume.lost > most * volume.whole) throw Violation(what + "," + when());
  if (!std::exchange(told_of_loss, true)) log(LogLevel::warning, what + ", at t = " + number(time) + " s.");
}

void Simulation::Parts::check_bodies() {
  for (std::size_t o = 1; o < world.count(); ++o) {
    if (!world.moves(o)) continue;
    const std::string what = "body '" + scene.bodies[o - 1].name + "'";
    const RigidState state = world.state_in_tank(o);
    const double speed = state.velocity.norm() + state.angular_velocity.norm() * reaches[o];
    if (!(speed < 0.5 * discretisation.sound_speed))
      throw Violation(what + " moves at " + number(speed) + " m/s, faster than half the speed of sound (" +
                      number(0.5 * discretisation.sound_speed) + " m/s)," + when());
    const Vector3d beyond = (layout.domain.min - state.position).cwiseMax(state.position - layout.domain.max);
    const double farthest = std::max({beyond.x(), beyond.z(), scene.dimensions == 3 ? beyond.y() : -1.0});
    if (left_tank[o] || farthest < reaches[o]) continue;
    left_tank[o] = true;
    log(LogLevel::warning, what + " has left the tank: it is at " + point(state.position) + " m at t = " + number(time) + " s.");
  }
}

std::string Simulation::Parts::when() const {
  return " at t = " + number(time) + " s, step " + std::to_string(step) + ": the simulation stops";
}

}  // namespace wavetank
