#include "wave_keys.h"

#include <algorithm>

#include "motion_values.h"

namespace wavetank::scene {
namespace {

std::string word_of(WaveKind kind) {
  switch (kind) {
    case WaveKind::regular:
      return "regular";
    case WaveKind::irregular:
      return "irregular";
    case WaveKind::focused:
      return "focused";
    case WaveKind::solitary:
      return "solitary";
    default:
      return "record";
  }
}

/// Keys that only some kinds have, and those of them that they cannot do without.
struct KindKey {
  const char* name;
  std::vector<WaveKind> kinds;
  bool required;
};

const std::vector<KindKey>& kind_keys() {
  static const std::vector<KindKey> keys{
      {"height", {WaveKind::regular, WaveKind::focused, WaveKind::solitary}, true},
      {"period", {WaveKind::regular}, true},
      {"order", {WaveKind::regular}, false},
      {"spectrum", {WaveKind::irregular, WaveKind::focused}, false},
      {"significant_height", {WaveKind::irregular}, true},
      {"peak_period", {WaveKind::irregular, WaveKind::focused}, true},
      {"peak_enhancement", {WaveKind::irregular, WaveKind::focused}, false},
      {"components", {WaveKind::irregular, WaveKind::focused}, false},
      {"seed", {WaveKind::irregular}, false},
      {"focus", {WaveKind::focused}, true},
      {"record", {WaveKind::record}, true},
      {"rise", {WaveKind::regular, WaveKind::irregular, WaveKind::focused, WaveKind::record}, false},
  };
  return keys;
}

bool has(const KindKey& key, WaveKind kind) { return std::find(key.kinds.begin(), key.kinds.end(), kind) != key.kinds.end(); }

std::function<bool(const WaveCase&)> belongs(const std::string& name) {
  const auto& keys = kind_keys();
  const KindKey key = *std::find_if(keys.begin(), keys.end(), [&](const KindKey& known) { return known.name == name; });
  return [key](const WaveCase& wave) { return has(key, wave.kind); };
}

bool turns(const WaveCase& wave) { return is_rotation(wave.direction); }

Section<WaveFocusCase> focus_section() {
  Section<WaveFocusCase> section;
  section.key("distance", &WaveFocusCase::distance, number(greater_than(0)), "m", "From the paddle's face at rest.").required = true;
  section.key("time", &WaveFocusCase::time, number(greater_than(0)), "s", "When.").required = true;
  return section;
}

Section<WaveRecordCase> wave_record_section() {
  Section<WaveRecordCase> section;
  section
      .key(
          "file", &WaveRecordCase::file, nonempty_text(), "",
          "Comma-separated values below one line of column names: package://, file://, an absolute path, or one relative to the case file. "
          "The waves are its Fourier sum, and begin again at its end.")
      .required = true;
  section.key("time_column", &WaveRecordCase::time_column, nonempty_text(), "", "Name of the column of times (s), which increase.");
  section.key("column", &WaveRecordCase::column, nonempty_text(), "", "Name of the column of the surface's elevations.");
  section.key("factor", &WaveRecordCase::factor, number({}), "m", "By which the column is multiplied.");
  section.key("delay", &WaveRecordCase::delay, number({}), "s", "Added to the file's times.");
  section.key("distance", &WaveRecordCase::distance, number(at_least(0)), "m",
              "From the paddle's face at rest to where the elevations are to be seen.");
  return section;
}

Section<WaveAbsorptionCase> absorption_section() {
  Section<WaveAbsorptionCase> section;
  section
      .key("gauge", &WaveAbsorptionCase::gauge, nonempty_text(), "",
           "Name of the wave gauge by which waves that come back are seen: before the paddle, by no more than 0.15 of a wavelength; a "
           "tenth or less is well.")
      .required = true;
  section.key("recall", &WaveAbsorptionCase::recall, number_if_given(greater_than(0)), "s",
              "Time in which the paddle comes back to where the theory has it; if it is left out, four periods, or those of the peak.");
  section.key("reach", &WaveAbsorptionCase::reach, number_if_given(greater_than(0)), "m",
              "Farthest that absorption takes the paddle from where the theory has it, at most, and if it is left out, what the tank and "
              "the gauge leave.");
  return section;
}

void check_kind(const WaveCase& wave, const Setting& map, const std::string& path, const Context&) {
  const std::string kind = word_of(wave.kind);
  for (const KindKey& key : kind_keys()) {
    const bool given = map.find(key.name) != nullptr, belongs = has(key, wave.kind);
    if (given && !belongs) refuse_key(map, path, key.name, "is not for waves of kind " + kind + "; leave it out");
    if (!given && belongs && key.required) refuse_key(map, path, key.name, "is missing; waves of kind " + kind + " need it");
  }
  const auto& directions = {Direction::surge, Direction::sway, Direction::stroke, Direction::pitch, Direction::angle};
  if (std::find(directions.begin(), directions.end(), wave.direction) == directions.end())
    refuse_key(map, path, "direction",
               "makes no waves; it must be one of surge, sway and stroke, of a piston, or pitch and angle, of a flap");
  if (!turns(wave) && map.find("hinge") != nullptr) refuse_key(map, path, "hinge", "is for a flap, whose direction is pitch or angle");
  if (turns(wave) && wave.hinge >= wave.depth)
    refuse(*map.find("hinge"), {join_path(path, "hinge"), "m"}, "less than " + join_path(path, "depth"));
  if (turns(wave) && wave.order == 2)
    refuse_key(map, path, "order", "is 2, which is for pistons: Madsen's theory; leave it out, or choose the direction surge");
  if (turns(wave) && wave.kind == WaveKind::solitary)
    refuse_key(map, path, "kind", "is solitary, which is for pistons; choose the direction surge");
  if (turns(wave) && wave.absorption) refuse_key(map, path, "absorption", "is for pistons; leave it out, or choose the direction surge");
}

void check_initial_kind(const InitialWaveCase& wave, const Setting& map, const std::string& path, const Context&) {
  const bool solitary = wave.kind == InitialWaveKind::solitary;
  for (const char* key : {"wavelength", "period", "standing"})
    if (solitary && map.find(key) != nullptr) refuse_key(map, path, key, "is not for a solitary wave; leave it out");
  if (wave.standing && wave.kind == InitialWaveKind::stokes_2)
    refuse_key(map, path, "standing", "is of linear theory only; leave it out, or set " + join_path(path, "kind") + " to linear");
  if (!solitary && !wave.wavelength && !wave.period)
    refuse_key(map, path, "wavelength", "is missing; waves that repeat themselves need it, or a period");
  if (wave.wavelength && wave.period)
    refuse_key(map, path, "period", "is given beside " + join_path(path, "wavelength") + ", from which it follows; leave one of them out");
  if (wave.direction.head<2>().isZero(0.0) || wave.direction.z() != 0.0)
    refuse_vector(map, path, "direction", wave.direction, "level and not all 0: [1, 0, 0], say, in 2-D [1, 0] or [-1, 0]");
}

}  // namespace

Section<WaveCase> wave_section() {
  Section<WaveCase> section;
  section
      .key("kind", &WaveCase::kind,
           choice<WaveKind>({{"regular", WaveKind::regular},
                             {"irregular", WaveKind::irregular},
                             {"focused", WaveKind::focused},
                             {"solitary", WaveKind::solitary},
                             {"record", WaveKind::record}}),
           "",
           "`regular`, of one period; `irregular`, a sea of a spectrum; `focused`, the same whose crests meet at one place and time; "
           "`solitary`; `record`, of a surface's elevation.")
      .required = true;
  section.key("direction", &WaveCase::direction, direction(), "",
              "How the paddle moves: surge, sway or stroke, a piston; pitch or angle, a flap that turns about `prescribed/point`. Waves go "
              "the way that the paddle's top goes when it moves positively.");
  section.key("reversed", &WaveCase::reversed, flag(), "", "They go the other way.");
  section.key("depth", &WaveCase::depth, number(greater_than(0)), "m", "Of the still water before the paddle, over a level floor.")
      .required = true;
  section.key_where(turns, "hinge", &WaveCase::hinge, number({}), "m", "Height of a flap's hinge over the floor; negative: below it.");
  section.key_where(belongs("height"), "height", &WaveCase::height, number(greater_than(0)), "m",
                    "From trough to crest; of focused and solitary waves that of the crest over the still level.");
  section.key_where(belongs("period"), "period", &WaveCase::period, number(greater_than(0)), "s", "Of regular waves.");
  section.key_where(belongs("order"), "order", &WaveCase::order, whole_number(between(1, 2)), "",
                    "Of a piston's motion for regular waves: 2 leaves out the free waves of half the period that 1 makes.");
  section.key_where(belongs("spectrum"), "spectrum", &WaveCase::spectrum,
                    choice<WaveSpectrum>({{"jonswap", WaveSpectrum::jonswap}, {"pierson_moskowitz", WaveSpectrum::pierson_moskowitz}}), "",
                    "Of irregular and focused waves.");
  section.key_where(belongs("significant_height"), "significant_height", &WaveCase::significant_height, number(greater_than(0)), "m",
                    "Of irregular waves: four standard deviations of the surface.");
  section.key_where(belongs("peak_period"), "peak_period", &WaveCase::peak_period, number(greater_than(0)), "s", "Of the spectrum's peak.");
  section.key_where(belongs("peak_enhancement"), "peak_enhancement", &WaveCase::peak_enhancement, number(between(1, 10)), "",
                    "γ of `jonswap`.");
  section.key_where(belongs("components"), "components", &WaveCase::components, whole_number(between(1, 5000)), "",
                    "Small waves that the sea is the sum of, from half to three times the peak's frequency.");
  section.key_where(belongs("seed"), "seed", &WaveCase::seed, whole_number(between(0, 2147483647)), "",
                    "Of the components' frequencies and phases.");
  section.key_where(belongs("focus"), "focus", &WaveCase::focus, section_of(focus_section()), "", "Where and when the crests meet.");
  section.key_where(belongs("record"), "record", &WaveCase::record, section_of(wave_record_section()), "", "The surface's elevation.");
  section.key_where(
      belongs("rise"), "rise", &WaveCase::rise, number_if_given(greater_than(0)), "s",
      "Time from the start in which the motion rises smoothly to its full size; if it is left out, one period, or that of the "
      "peak.");
  section.key("absorption", &WaveCase::absorption, section_if_given(absorption_section()), "",
              "Of a piston: it takes away the waves that come back to it, by a gauge before it.");
  section.rule(check_kind);
  return section;
}

Section<InitialWaveCase> initial_wave_section() {
  Section<InitialWaveCase> section;
  section
      .key("kind", &InitialWaveCase::kind,
           choice<InitialWaveKind>(
               {{"linear", InitialWaveKind::linear}, {"stokes_2", InitialWaveKind::stokes_2}, {"solitary", InitialWaveKind::solitary}}),
           "", "`linear`, small regular waves; `stokes_2`, regular waves to the second order; `solitary`, Rayleigh's wave.")
      .required = true;
  section.key("depth", &InitialWaveCase::depth, number(greater_than(0)), "m", "Of the still water, over a level floor.").required = true;
  section
      .key("height", &InitialWaveCase::height, number(greater_than(0)), "m",
           "From trough to crest; of a solitary wave that of the crest over the still level.")
      .required = true;
  section.key("wavelength", &InitialWaveCase::wavelength, number_if_given(greater_than(0)), "m", "Of regular waves ...");
  section.key("period", &InitialWaveCase::period, number_if_given(greater_than(0)), "s", "... or else their period.");
  section.key_where([](const InitialWaveCase& wave) { return wave.kind == InitialWaveKind::linear; }, "standing",
                    &InitialWaveCase::standing, flag(), "", "Of `linear`: a standing wave, at rest and highest.");
  section.key("direction", &InitialWaveCase::direction, vector(), "", "In which they go: level.");
  section.key("crest", &InitialWaveCase::crest, number({}), "m", "Where there is a crest: along `direction`, from the case's origin.");
  section.rule(check_initial_kind);
  return section;
}

}  // namespace wavetank::scene
