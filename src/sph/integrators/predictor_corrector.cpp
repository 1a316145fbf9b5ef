#include "integrator.h"

namespace wavetank {

/// The predictor and corrector of the MLS paper, §4, of second order, with two evaluations of both rates a step: u* = u + Δt f*, x* = x +
/// Δt u*, and u += Δt (f* + f**)/2. Positions go with the mean of the velocities before and after; the paper's x += Δt u, with the one
/// after, goes Δt² f/2 too far. Δt is that of the step's start: the paper's smaller one of both evaluations would come when bodies have
/// moved.
Schedule predictor_corrector(StepEngine* engine) {
  return {"predictor_corrector",
          state_of("now") + at("now", {"walls"}),
          {{"rates of the start", state_of("now") + at("now", {"walls"}),
            at("now", {"acceleration", "compression rate"}) + at("step", {"wrenches"}),
            [engine] {
              engine->find_rates(Slot::now);
              engine->add_wrenches(Slot::now, 0.5);
            },
            0, true},
           {"prediction of the end", state_of("now") + at("now", {"acceleration", "compression rate"}),
            state_of("end") + at("step", {"sum of rates"}), [engine] { engine->predict_end(); }, 1},
           {"walls to where the end is expected", {}, at("end", {"walls"}), [engine] { engine->walls_at(1.0); }},
           {"rates of the end", state_of("end") + at("end", {"walls"}) + at("step", {"wrenches"}),
            at("end", {"acceleration", "compression rate", "clearance"}) + at("step", {"wrenches"}),
            [engine] {
              engine->find_rates(Slot::trial);
              engine->add_wrenches(Slot::trial, 0.5);
            },
            1, true},
           {"walls to the end", at("step", {"wrenches"}), at("now", {"walls"}), [engine] { engine->walls_to_end(); }},
           {"correction", state_of("now") + at("step", {"sum of rates"}) + at("end", {"acceleration", "compression rate", "position"}),
            state_of("now") + at("start", {"position"}), [engine] { engine->correct_end(); }, 1},
           guard_stage(engine, at("start", {"position"}) + at("end", {"clearance"})),
           sort_stage(engine)}};
}

}  // namespace wavetank
