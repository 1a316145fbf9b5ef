#include "absorbing_paddles.h"

#include <algorithm>

#include "texts.h"
#include "wavetank/common/log.h"

namespace wavetank {
namespace {

constexpr double nearly_all = 0.8;  // of the way that a paddle may take

}  // namespace

AbsorbingPaddles::AbsorbingPaddles(const Case& scene, const Layout& layout, const Solver& solver, RigidWorld& world) : world_(world) {
  Case with_gauges = scene;
  with_gauges.instruments.wave_gauges.clear();
  for (std::size_t o = 1; o < world.count(); ++o) {
    if (!world.absorbs(o)) continue;
    owners_.push_back(o);
    names_.push_back(scene.bodies[o - 1].name);
    const std::string& wanted = scene.bodies[o - 1].rigid.prescribed.waves->absorption->gauge;
    const auto& gauges = scene.instruments.wave_gauges;
    with_gauges.instruments.wave_gauges.push_back(
        *std::find_if(gauges.begin(), gauges.end(), [&](const WaveGaugeCase& gauge) { return gauge.name == wanted; }));
  }
  told_.assign(owners_.size(), false);
  if (!owners_.empty()) gauges_ = std::make_unique<WaveGauges>(with_gauges, layout, solver, world);
}

void AbsorbingPaddles::look(Solver& solver, double time) {
  if (owners_.empty()) return;
  const std::vector<double> levels = gauges_->read(solver);
  for (std::size_t k = 0; k < owners_.size(); ++k) {
    world_.see_waves(owners_[k], time, levels[k]);
    if (told_[k] || world_.absorption_taken(owners_[k]) < nearly_all) continue;
    told_[k] = true;
    log(LogLevel::warning, "the waves that come back to body " + names_[k] + " take nearly all of its way at " + number(time) +
                               " s: from here on it does not absorb them wholly; give it more room, or make the waves lower");
  }
}

void AbsorbingPaddles::reset() { told_.assign(told_.size(), false); }

}  // namespace wavetank
