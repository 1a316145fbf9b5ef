#include "integrator.h"

namespace wavetank {

/// The classical scheme of fourth order: rates k₁ of the start, k₂ and k₃ of two trial states of the middle, k₄ of one of the end;
/// y += Δt (k₁ + 2 k₂ + 2 k₃ + k₄)/6. Four evaluations of both rates a step. Neighbours are those of the start throughout.
Schedule runge_kutta_4(StepEngine* engine) {
  const std::vector<std::string> rates{"acceleration", "compression rate"};
  const auto stage = [&](const std::string& name, double fraction, double weight) {
    return Stage{name,
                 state_of("trial") + at("trial", {"walls"}),
                 at("trial", {"acceleration", "compression rate", "clearance"}) + at("step", {"wrenches"}),
                 [engine, weight] {
                   engine->find_rates(Slot::trial);
                   engine->add_wrenches(Slot::trial, weight);
                 },
                 fraction,
                 true};
  };
  const auto trial = [&](const std::string& name, const std::string& of, bool first, double weight, double part) {
    const Slot slot = first ? Slot::now : Slot::trial;
    return Stage{name,
                 state_of("now") + at(of, rates) + at(of, {"velocity"}) +
                     at("step", first ? std::vector<std::string>() : std::vector<std::string>{"sum of rates"}),
                 state_of("trial") + at("step", {"sum of rates"}),
                 [engine, slot, first, weight, part] { engine->go_on_trial(slot, first, weight, part); }, part};
  };
  const auto walls = [&](const std::string& name, double fraction) {
    return Stage{name, {}, at("trial", {"walls"}), [engine, fraction] { engine->walls_at(fraction); }};
  };
  return {"runge_kutta_4",
          state_of("now") + at("now", {"walls"}),
          {{"rates of the start", state_of("now") + at("now", {"walls"}),
            at("now", {"acceleration", "compression rate"}) + at("step", {"wrenches"}),
            [engine] {
              engine->find_rates(Slot::now);
              engine->add_wrenches(Slot::now, 1.0 / 6);
            },
            0, true},
           trial("to the middle with k1", "now", true, 1.0 / 6, 0.5),
           walls("walls to the middle", 0.5),
           stage("rates of the middle, k2", 0.5, 2.0 / 6),
           trial("to the middle with k2", "trial", false, 2.0 / 6, 0.5),
           stage("rates of the middle, k3", 0.5, 2.0 / 6),
           trial("to the end with k3", "trial", false, 2.0 / 6, 1.0),
           walls("walls to where the end is expected", 1.0),
           stage("rates of the end, k4", 1.0, 1.0 / 6),
           {"walls to the end", at("step", {"wrenches"}), at("now", {"walls"}), [engine] { engine->walls_to_end(); }},
           {"to the end", state_of("now") + at("step", {"sum of rates"}) + at("trial", {"velocity", "acceleration", "compression rate"}),
            state_of("now") + at("start", {"position"}), [engine] { engine->take_sum(1.0 / 6); }, 1},
           guard_stage(engine, at("start", {"position"}) + at("trial", {"clearance"})),
           sort_stage(engine)}};
}

}  // namespace wavetank
