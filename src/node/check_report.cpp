#include "wavetank/node/check_report.h"

#include <cstdarg>
#include <cstdio>

#include "wavetank/common/visible_text.h"
#include "wavetank/node/progress.h"

namespace wavetank {
namespace {

/// printf into a string.
__attribute__((format(printf, 1, 2))) std::string formatted(const char* format, ...) {
  char text[600];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

std::string line(const std::string& key, const std::string& value) { return formatted("%-17s ", key.c_str()) + value + "\n"; }

std::string extent_text(const Vector3d& size, int dimensions) {
  if (dimensions == 2) return formatted("%.4g × %.4g m", size.x(), size.z());
  return formatted("%.4g × %.4g × %.4g m", size.x(), size.y(), size.z());
}

std::string volume_text(double volume, int dimensions) { return formatted("%.4g %s", volume, dimensions == 2 ? "m²" : "m³"); }

std::string mass_text(double mass, int dimensions) { return formatted("%.4g %s", mass, dimensions == 2 ? "kg/m" : "kg"); }

std::string owner_text(const OwnerSize& owner, const Case& checked, bool is_box_tank) {
  std::string text = extent_text(owner.size, checked.dimensions);
  if (owner.volume > 0) text += (is_box_tank ? ", holds " : ", ") + volume_text(owner.volume, checked.dimensions);
  if (owner.mass > 0) text += ", " + mass_text(owner.mass, checked.dimensions);
  if (!owner.floats_alone) return text;
  if (owner.draught) return text + formatted(", afloat upright its draught is %.4g m", *owner.draught);
  return text + ", sinks";
}

std::string over(double length, double spacing) { return formatted("%.4g m, %.3g particles", length, length / spacing); }

std::string waves_text(const ExpectedWaves& waves, double spacing) {
  const WaveFacts& facts = waves.facts;
  std::string text = formatted("%.4g m high, %.3g spacings", facts.height, facts.height / spacing);
  if (facts.period > 0) text += formatted(", period %.4g s", facts.period);
  text += formatted(
      ", %.4g m long, %.4g m/s, in %s water; stroke %.4g m, steepness %.3g, Ursell number %.3g; %.3g wavelengths to the tank's end",
      facts.wavelength, facts.celerity, facts.regime.c_str(), facts.stroke, facts.steepness, facts.ursell, waves.to_end / facts.wavelength);
  if (!facts.breaking.empty()) text += "; breaking: " + facts.breaking;
  return text;
}

}  // namespace

std::string check_report(const Case& checked, const Estimate& estimated) {
  const CaseSize& size = estimated.size;
  std::string text = visible_text(checked.title) + "\n";
  for (std::size_t o = 0; o < size.owners.size(); ++o) {
    const bool is_box_tank = o == 0 && std::holds_alternative<BoxTank>(checked.tank.shape);
    text += line(o == 0 ? "tank" : "body " + size.owners[o].name, owner_text(size.owners[o], checked, is_box_tank));
  }
  text += line("water", volume_text(size.water_volume, checked.dimensions) + ", " + mass_text(size.water_mass, checked.dimensions));
  text += line("least depth", over(size.least_depth, estimated.spacing));
  if (size.least_extent) text += line("least thickness", over(*size.least_extent, estimated.spacing) + ", of body " + size.thinnest_body);
  if (estimated.thinnest_wall) text += line("thinnest wall", over(*estimated.thinnest_wall, estimated.spacing));
  for (const ExpectedWaves& waves : estimated.waves) text += line("waves of " + waves.body, waves_text(waves, estimated.spacing));
  text += line("particles", formatted("%zu, spacing %.4g m", estimated.particles, estimated.spacing));
  text += line("wall elements", formatted("%zu", estimated.wall_elements));
  text += line("lid elements", formatted("%zu", estimated.lid_elements));
  text += line("device memory", formatted("%.1f MiB", estimated.device_memory / (1024.0 * 1024.0)));
  text += line("time step", formatted("%.3g s", estimated.time_step));
  text += line("simulated time", formatted("%.6g s", checked.duration));
  text += line("estimated time", duration_text(estimated.wall_seconds) + " (start " + duration_text(estimated.start_seconds) + ", steps " +
                                     duration_text(estimated.step_seconds) + ", instruments " +
                                     duration_text(estimated.instrument_seconds) + ")");
  return text;
}

std::string parts_report(const Case& checked, const PartsEstimate& estimated) {
  const PartsNeed& need = estimated.need;
  const double bytes_in_mib = 1024.0 * 1024.0;
  std::string text = visible_text(checked.title) + "\n";
  text += line("particles", formatted("%zu, spacing %.4g m", estimated.particles, estimated.spacing));
  text += line("parts", formatted("%d, the largest of %zu particles and %zu copies of others", need.parts, need.own, need.others));
  text += line("device memory", formatted("%.1f MiB at the most of a part, after a step", need.memory / bytes_in_mib));
  return text;
}

}  // namespace wavetank
