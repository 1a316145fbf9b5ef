#include "motion_terms.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "number_text.h"
#include "wave_maker.h"
#include "wavetank/common/error.h"
#include "wavetank/common/record_file.h"
#include "wavetank/scene/file_path.h"

namespace wavetank {
namespace {

const std::pair<const char*, Direction> directions[] = {
    {"surge", Direction::surge}, {"sway", Direction::sway}, {"heave", Direction::heave},   {"roll", Direction::roll},
    {"pitch", Direction::pitch}, {"yaw", Direction::yaw},   {"stroke", Direction::stroke}, {"angle", Direction::angle}};

constexpr double samples_per_period = 40;  // the greatest speed is then found to 0.3 %

bool exists_in_2d(Direction direction) {
  return direction != Direction::sway && direction != Direction::roll && direction != Direction::yaw;
}

std::string name_of(Direction wanted) {
  for (const auto& [name, direction] : directions) {
    if (direction == wanted) return name;
  }
  return "";
}

std::optional<Direction> direction_named(const std::string& wanted) {
  for (const auto& [name, direction] : directions) {
    if (wanted == name) return direction;
  }
  return std::nullopt;
}

std::string allowed_names(int dimensions) {
  std::string list;
  for (const auto& [name, direction] : directions) {
    if (dimensions == 3 || exists_in_2d(direction)) list += (list.empty() ? "" : ", ") + std::string(name);
  }
  return list;
}

/// From 0 to 1 as `fraction` does, with no velocity and no acceleration at either end.
Change smooth_step(double fraction) {
  if (fraction <= 0) return {0.0, 0.0, 0.0};
  if (fraction >= 1) return {1.0, 0.0, 0.0};
  const double s = fraction;
  return {s * s * s * (10.0 + s * (6.0 * s - 15.0)), 30.0 * s * s * (1.0 - s) * (1.0 - s), 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s)};
}

void need(bool fulfilled, const std::string& what, const std::string& message) {
  if (!fulfilled) throw Error(what + ": " + message);
}

MotionTerm harmonic_term(const HarmonicCase& harmonic, const std::string& what) {
  const std::string name = "the harmonic in " + name_of(harmonic.direction);
  need(std::isfinite(harmonic.amplitude) && std::isfinite(harmonic.phase), what, name + " has an amplitude or phase that is not finite");
  need(harmonic.frequency >= 0 && std::isfinite(harmonic.frequency), what,
       name + " has a frequency of " + number_text(harmonic.frequency) + " Hz; it must be at least 0");
  need(harmonic.rise >= 0 && std::isfinite(harmonic.rise), what,
       name + " has a rise of " + number_text(harmonic.rise) + " s; it must be at least 0");
  const auto at = [harmonic](double time) {
    const double rate = 2.0 * M_PI * harmonic.frequency, angle = rate * time + harmonic.phase;
    const Change wave{harmonic.amplitude * (std::sin(angle) - std::sin(harmonic.phase)), harmonic.amplitude * rate * std::cos(angle),
                      -harmonic.amplitude * rate * rate * std::sin(angle)};
    if (!(time < harmonic.rise)) return wave;
    const Change rise = smooth_rise(time, 0.0, harmonic.rise);
    return Change{wave.value * rise.value, wave.rate * rise.value + wave.value * rise.rate,
                  wave.acceleration * rise.value + 2.0 * wave.rate * rise.rate + wave.value * rise.acceleration};
  };
  double resolution = 1.0 / (samples_per_period * std::max(harmonic.frequency, 1e-300));
  if (harmonic.rise > 0) resolution = std::min(resolution, harmonic.rise / samples_per_period);
  return {harmonic.direction, at, resolution};
}

MotionTerm ramp_term(const RampCase& ramp, const std::string& what) {
  const std::string name = "the ramp in " + name_of(ramp.direction);
  need(std::isfinite(ramp.change), what, name + " has a change that is not finite");
  need(ramp.from >= 0 && ramp.to > ramp.from && std::isfinite(ramp.to), what,
       name + " goes from " + number_text(ramp.from) + " s to " + number_text(ramp.to) +
           " s; it must start at 0 s or later and end after that");
  const auto at = [ramp](double time) {
    const Change rise = smooth_rise(time, ramp.from, ramp.to - ramp.from);
    return Change{ramp.change * rise.value, ramp.change * rise.rate, ramp.change * rise.acceleration};
  };
  return {ramp.direction, at, (ramp.to - ramp.from) / samples_per_period};
}

/// Which columns are followed, and in which directions they move.
std::vector<std::pair<std::string, Direction>> followed_columns(const RecordCase& record, const RecordFile& file, int dimensions) {
  if (!record.column.empty()) {
    const std::optional<Direction> direction = record.direction ? record.direction : direction_named(record.column);
    if (!direction) {
      throw Error(file.place(0) + ": the column '" + record.column + "' is not named after a direction; give its direction, one of " +
                  allowed_names(dimensions));
    }
    return {{record.column, *direction}};
  }
  std::vector<std::pair<std::string, Direction>> result;
  for (const auto& [name, direction] : directions) {
    if (file.has(name)) result.emplace_back(name, direction);
  }
  if (result.empty()) {
    throw Error(file.place(0) + ": no column is named after a direction (" + allowed_names(dimensions) + "); it has " +
                file.listed_columns() + "; give column and direction");
  }
  return result;
}

std::string record_path(const std::string& file, const std::string& kind, const std::string& case_directory,
                        const ResourceResolver& resolve, const std::string& what) {
  try {
    const std::string path = file_path(kind + " record", file, case_directory, resolve);
    check_file(kind + " record", path);
    return path;
  } catch (const Error& error) {
    throw Error(what + ": " + error.what());
  }
}

void add_record(const RecordCase& record, int dimensions, const std::string& case_directory, const ResourceResolver& resolve,
                const std::string& what, std::vector<MotionTerm>& terms) {
  need(!record.column.empty() || !record.direction, what,
       "the record '" + record.file + "' has a direction but no column; give the column that moves in this direction too");
  need(std::isfinite(record.factor) && std::isfinite(record.delay), what,
       "the record '" + record.file + "' has a factor or delay that is not finite");
  const RecordFile file(record_path(record.file, "motion", case_directory, resolve, what), what, "motion");
  std::vector<double> times = file.times(record.time_column);
  double least_gap = times[1] - times[0];
  for (std::size_t k = 2; k < times.size(); ++k) least_gap = std::min(least_gap, times[k] - times[k - 1]);
  for (double& time : times) time += record.delay;
  for (const auto& [column, direction] : followed_columns(record, file, dimensions)) {
    std::vector<double> values = file.numbers(column);
    for (double& value : values) value *= record.factor;
    const NaturalSpline spline(times, std::move(values));
    const double start = spline.at(0.0).value;
    const auto at = [spline, start](double time) {
      Change change = spline.at(time);
      change.value -= start;
      return change;
    };
    terms.push_back({direction, at, 0.25 * least_gap});
  }
}

}  // namespace

Change smooth_rise(double time, double from, double length) {
  const Change step = smooth_step((time - from) / length);
  return {step.value, step.rate / length, step.acceleration / (length * length)};
}

std::vector<MotionTerm> motion_terms(const PrescribedCase& prescribed, int dimensions, double gravity, const std::string& case_directory,
                                     const ResourceResolver& resolve, const std::string& what) {
  std::vector<MotionTerm> terms;
  for (const HarmonicCase& harmonic : prescribed.harmonics) terms.push_back(harmonic_term(harmonic, what));
  for (const RampCase& ramp : prescribed.ramps) terms.push_back(ramp_term(ramp, what));
  for (const RecordCase& record : prescribed.records) add_record(record, dimensions, case_directory, resolve, what, terms);
  if (prescribed.waves) {
    const WaveCase& waves = *prescribed.waves;
    const std::string path =
        waves.kind == WaveKind::record ? record_path(waves.record.file, "wave", case_directory, resolve, what) : std::string();
    terms.push_back(wave_term(waves, gravity, path, what));
  }
  for (const MotionTerm& term : terms) {
    need(
        dimensions == 3 || exists_in_2d(term.direction), what,
        "a two-dimensional case has no " + name_of(term.direction) + "; a motion's direction there is one of " + allowed_names(dimensions));
  }
  return terms;
}

}  // namespace wavetank
