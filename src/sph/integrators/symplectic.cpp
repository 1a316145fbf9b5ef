#include "integrator.h"

namespace wavetank {

/// Drift, kick, drift: positions and compressions go half a step with what they had, velocities a whole one with the forces of the middle,
/// positions and compressions the other half with the new velocities. Second order, one evaluation of either rate a step, and the sound
/// between a lone particle and a wall neither grows nor decays: position and velocity, compression and velocity advance as conjugate pairs.
Schedule symplectic(StepEngine* engine) {
  std::vector<Access> kept = state_of("now");
  kept.push_back({"compression rate", "now"});
  return {"symplectic",
          kept,
          {{"drift to the middle", kept, state_of("middle"), [engine] { engine->drift_to_middle(); }, 0.5},
           {"walls to the middle", {}, at("middle", {"walls"}), [engine] { engine->walls_at(0.5); }},
           {"accelerations", state_of("middle") + at("middle", {"walls"}), at("middle", {"acceleration", "clearance"}),
            [engine] { engine->find_accelerations(Slot::trial); }, 0, true},
           {"walls to the end", state_of("middle") + at("middle", {"walls"}), at("now", {"walls"}),
            [engine] {
              engine->add_wrenches(Slot::trial, 1.0);
              engine->walls_to_end();
            },
            0, true},
           {"kick, and drift to the end", state_of("now") + at("middle", {"acceleration", "compression"}),
            at("now", {"position", "velocity", "compression", "pressure", "volume"}), [engine] { engine->kick_and_drift_to_end(); }, 1},
           guard_stage(engine, at("middle", {"position", "velocity", "clearance"})),
           sort_stage(engine),
           {"compression rates", state_of("now") + at("now", {"walls"}), at("now", {"compression rate"}),
            [engine] { engine->find_compression_rates(Slot::now); }, 0, true},
           {"compressions to the end", at("now", {"compression", "followers", "compression rate"}),
            at("now", {"compression", "followers", "pressure", "volume"}), [engine] { engine->compress_to_end(); }}}};
}

}  // namespace wavetank
