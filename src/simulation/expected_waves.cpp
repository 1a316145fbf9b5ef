#include "expected_waves.h"

#include <algorithm>
#include <cmath>

#include "texts.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/scene/file_path.h"
#include "wavetank/scene/initial_state.h"

namespace wavetank {
namespace {

constexpr double fewest_over_height = 8;   // spacings
constexpr double greatest_ursell = 26;     // beyond it a second-order wave has crests of its own in its troughs
constexpr double greatest_of_a_sea = 1.9;  // of a thousand waves, over the significant one
constexpr double depth_tolerance = 0.03;   // of the depth

/// Where the waves go: a unit vector along the floor.
Vector3d way_of(const WaveCase& wave, const PrescribedCase& prescribed, const Vector3d& up) {
  Vector3d way = Vector3d::UnitX();
  if (wave.direction == Direction::sway) way = Vector3d::UnitY();
  if (wave.direction == Direction::stroke) way = prescribed.axis.normalized();
  if (wave.direction == Direction::angle) way = prescribed.axis.cross(up).normalized();
  return wave.reversed ? Vector3d(-way) : way;
}

/// The farthest corner of a box along a direction, m.
double farthest(const Box& box, const Vector3d& way) { return way.cwiseMax(0.0).dot(box.max) + way.cwiseMin(0.0).dot(box.min); }

/// Level and floor, m along `up`.
std::pair<double, double> water_of(const Layout& layout) {
  double top = layout.up.dot(layout.particles.front()), bottom = top;
  for (std::size_t i = 0; i < layout.particles.size(); ++i) {
    top = std::max(top, layout.levels[i]);
    bottom = std::min(bottom, layout.up.dot(layout.particles[i]) - 0.5 * layout.spacing);
  }
  return {top, bottom};
}

/// Of those that are there at the start.
void tell_of_initial_waves(const Case& checked, const Layout& layout) {
  const InitialWaveCase& wave = *checked.fluid.initial.waves;
  const auto warn = [](const std::string& text) { log(LogLevel::warning, "fluid/initial/waves " + text); };
  if (layout.particles.empty()) return;
  const double depth = filled_to(checked.fluid.fill.front(), checked) - water_of(layout).second;
  if (std::abs(depth - wave.depth) > depth_tolerance * wave.depth)
    warn("are made for a depth of " + number(wave.depth) + " m, but the water is " + number(depth) + " m deep");
  if (wave.height < fewest_over_height * layout.spacing)
    warn("are only " + number(wave.height / layout.spacing) + " spacings high: fewer than " + number(fewest_over_height) +
         " decay faster than water does; choose a smaller fluid/spacing than " + number(layout.spacing) + " m");
  const double k = wave_number_of(wave, checked.gravity.norm());
  const double ursell = k > 0 ? wave.height * std::pow(2.0 * M_PI / k, 2) / std::pow(wave.depth, 3) : 0.0;
  if (ursell > greatest_ursell)
    warn("have an Ursell number of " + number(ursell) + ": beyond " + number(greatest_ursell) +
         " neither first- nor second-order theory holds, and they change on their way");
}

}  // namespace

std::vector<ExpectedWaves> expected_waves(const Case& checked, const Layout& layout, const ResourceResolver& resolve) {
  std::vector<ExpectedWaves> all;
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) {
    const BodyCase& body = checked.bodies[b];
    if (body.motion != Motion::prescribed || !body.rigid.prescribed.waves) continue;
    const WaveCase& wave = *body.rigid.prescribed.waves;
    const std::string path =
        wave.kind == WaveKind::record ? file_path("wave record", wave.record.file, checked.directory, resolve) : std::string();
    ExpectedWaves waves;
    waves.body = body.name;
    waves.facts = wave_facts(wave, checked.gravity.norm(), path, "body '" + body.name + "'");
    const Vector3d way = way_of(wave, body.rigid.prescribed, layout.up);
    const Box box = layout.meshes[b + 1].bounding_box();
    waves.to_end = farthest(layout.domain, way) - farthest(box, way);
    waves.behind = farthest(layout.domain, -way) - farthest(box, -way);
    all.push_back(waves);
  }
  return all;
}

void tell_of_waves(const Case& checked, const Layout& layout, const ResourceResolver& resolve) {
  const InitialCase& initial = checked.fluid.initial;
  const bool level_at_start = initial.elevation.empty() && !initial.waves;
  if (initial.waves) tell_of_initial_waves(checked, layout);
  const std::vector<ExpectedWaves> all = expected_waves(checked, layout, resolve);
  for (const ExpectedWaves& waves : all) {
    const auto body = std::find_if(checked.bodies.begin(), checked.bodies.end(), [&](const BodyCase& it) { return it.name == waves.body; });
    const WaveCase& wave = *body->rigid.prescribed.waves;
    const WaveFacts& facts = waves.facts;
    const auto warn = [&](const std::string& text) { log(LogLevel::warning, "the waves of body " + waves.body + " " + text); };
    if (!facts.breaking.empty()) warn("will break: they are " + number(facts.height) + " m high, " + facts.breaking);
    if (facts.height < fewest_over_height * layout.spacing)
      warn("are only " + number(facts.height / layout.spacing) + " spacings high: fewer than " + number(fewest_over_height) +
           " decay faster than water does; choose a smaller fluid/spacing than " + number(layout.spacing) + " m");
    if (wave.kind == WaveKind::regular && facts.ursell > greatest_ursell)
      warn("have an Ursell number of " + number(facts.ursell) + ": beyond " + number(greatest_ursell) +
           " neither first- nor second-order theory holds, and they change on their way");
    const bool is_sea = wave.kind == WaveKind::irregular || wave.kind == WaveKind::record;
    const double half = 0.5 * (is_sea ? greatest_of_a_sea : 1.0) * facts.stroke;
    const double stroke = wave.kind == WaveKind::solitary ? facts.stroke : half, back = wave.kind == WaveKind::solitary ? 0.0 : half;
    if (stroke > waves.to_end || back > waves.behind)
      warn("take a stroke of " + number(facts.stroke) + " m, which carries the paddle out of the tank: there are " + number(waves.to_end) +
           " m before it and " + number(waves.behind) + " m behind");
    if (layout.particles.empty()) continue;
    const auto [level, floor] = water_of(layout);
    const double depth = level - floor;
    if (level_at_start && std::abs(depth - wave.depth) > depth_tolerance * wave.depth)
      warn("are made for a depth of " + number(wave.depth) + " m, but the water is " + number(depth) + " m deep");
    if (wave.direction != Direction::pitch && wave.direction != Direction::angle) continue;
    const double hinge = layout.up.dot(*body->rigid.prescribed.point) - floor;
    if (std::abs(hinge - wave.hinge) > depth_tolerance * wave.depth)
      warn("are made for a hinge " + number(wave.hinge) + " m over the floor, but prescribed/point is " + number(hinge) + " m over it");
  }
}

}  // namespace wavetank
