#include "integrator.h"

#include "../tables/device_sizes.h"
#include "wavetank/sph/schedule_page.h"

namespace wavetank {

std::vector<Access> state_of(const std::string& instant) {
  return at(instant, {"position", "velocity", "compression", "followers", "pressure", "volume"});
}

double greatest_drift(const Schedule& schedule, const Case& scene, const Discretisation& d) {
  const double shift = scene.numerics.shifting == Shifting::none ? 0 : field::shift_most * d.spacing;
  return schedule.drift() * (0.5 * scene.numerics.courant * d.smoothing_length + shift);
}

Stage guard_stage(StepEngine* engine, const std::vector<Access>& came) {
  return {"guard", at("now", {"position", "velocity", "walls"}) + came, at("now", {"position", "velocity"}), [engine] { engine->guard(); },
          1};
}

Stage sort_stage(StepEngine* engine) {
  return {"neighbour grid", state_of("now"), state_of("now") + at("now", {"walls"}), [engine] { engine->sort(); }, 0, false, true};
}

namespace {

Schedule of_integrator(Integrator integrator, StepEngine* engine) {
  switch (integrator) {
    case Integrator::runge_kutta_4:
      return runge_kutta_4(engine);
    case Integrator::predictor_corrector:
      return predictor_corrector(engine);
    case Integrator::symplectic:
      break;
  }
  return symplectic(engine);
}

}  // namespace

Schedule schedule_of(const Case& scene, StepEngine* engine) {
  Schedule schedule = of_integrator(scene.numerics.integrator, engine);
  if (scene.numerics.shifting != Shifting::none) {
    // where volumes follow the shifts, a step does not begin with rates by the last one's
    const bool anew = scene.numerics.scheme == Scheme::riemann_ale && scene.numerics.integrator == Integrator::symplectic;
    schedule.begin_with({"shifts by " + word_of(scene.numerics.shifting), state_of("now") + at("now", {"walls"}),
                         at("now", anew ? std::vector<std::string>{"shift", "compression rate"} : std::vector<std::string>{"shift"}),
                         [engine] { engine->find_shifts(); }, 0, true});
  }
  if (!scene.openings.empty())
    schedule.begin_with({"water behind openings", state_of("now"), at("now", {"velocity", "compression", "pressure", "volume"}),
                         [engine] { engine->impose_zones(); }});
  if (!scene.fluid.damping.empty())
    schedule.begin_with(
        {"damping zones", at("now", {"position", "velocity"}), at("now", {"velocity"}), [engine] { engine->damp_velocities(); }});
  return schedule;
}

std::string schedule_page(const Case& scene) { return schedule_of(scene, nullptr).page(); }

}  // namespace wavetank
