#include "motion_keys.h"

#include "motion_values.h"
#include "wave_keys.h"

namespace wavetank::scene {
namespace {

const char* const length_or_angle = "m or °";  // which of them follows from the direction

/// Puts a number of a section into degrees in the file and radians in the case where the section's direction is a rotation.
template <class T>
void measure_by_direction(Section<T>& section, double T::*number) {
  section.converts(
      [number](T& value) {
        if (is_rotation(value.direction)) value.*number *= degree;
      },
      [number](T& value) {
        if (is_rotation(value.direction)) value.*number = in_degrees(value.*number);
      });
}

Section<HarmonicCase> harmonic_section() {
  Section<HarmonicCase> section;
  section.key("direction", &HarmonicCase::direction, direction(), "", "What oscillates; in 2-D there is no sway, roll and yaw.").required =
      true;
  section
      .key("amplitude", &HarmonicCase::amplitude, number({}), length_or_angle,
           "a in a sin(2π f t + φ), less its value at t = 0; of a rotation in degrees.")
      .required = true;
  section.key("frequency", &HarmonicCase::frequency, number(greater_than(0)), "Hz", "f.").required = true;
  section.key("phase", &HarmonicCase::phase, angle(), "°", "φ.");
  section.key("rise", &HarmonicCase::rise, number(at_least(0)), "s", "Time from the start in which it rises smoothly to its full size.");
  measure_by_direction(section, &HarmonicCase::amplitude);
  return section;
}

Section<RampCase> ramp_section() {
  Section<RampCase> section;
  section.key("direction", &RampCase::direction, direction(), "", "What changes; in 2-D there is no sway, roll and yaw.").required = true;
  section.key("change", &RampCase::change, number({}), length_or_angle, "By so much, smoothly; of a rotation in degrees.").required = true;
  section.key("from", &RampCase::from, number(at_least(0)), "s", "When the change begins.");
  section.key("to", &RampCase::to, number(greater_than(0)), "s", "When it is complete, later than `from`.").required = true;
  measure_by_direction(section, &RampCase::change);
  section.rule([](const RampCase& ramp, const Setting& map, const std::string& path, const Context&) {
    if (ramp.to <= ramp.from) refuse(*map.find("to"), {join_path(path, "to"), "s"}, "later than " + join_path(path, "from"));
  });
  return section;
}

std::optional<Direction> direction_of(const RecordCase& record) {
  return record.direction ? record.direction : direction_named(record.column);
}

Section<RecordCase> motion_record_section() {
  Section<RecordCase> section;
  section
      .key(
          "file", &RecordCase::file, nonempty_text(), "",
          "Comma-separated values below one line of column names: package://, file://, an absolute path, or one relative to the case file.")
      .required = true;
  section.key("time_column", &RecordCase::time_column, nonempty_text(), "", "Name of the column of times (s), which increase.");
  section.key("column", &RecordCase::column, text(), "",
              "Name of the column that is followed; empty: every column that is named as a direction.");
  section.key("direction", &RecordCase::direction, if_given(direction()), "",
              "What follows `column`; if it is left out, the direction that the column is named after.");
  section.key("factor", &RecordCase::factor, number({}), "m or rad", "By which the column is multiplied; negative turns it round.");
  section.key("delay", &RecordCase::delay, number({}), "s", "Added to the file's times.");
  section.rule([](const RecordCase& record, const Setting& map, const std::string& path, const Context& context) {
    if (record.column.empty()) {
      if (record.direction) refuse_key(map, path, "direction", "is for a record with a column; give column too, or leave direction out");
      return;
    }
    if (!direction_of(record)) {
      refuse_key(map, path, "direction", "is missing; it must be given, as column " + record.column + " is not named as a direction");
    }
    Context copy = context;
    if (!record.direction) direction().read(*map.find("column"), {join_path(path, "column"), ""}, copy);
  });
  return section;
}

// In 2-D nothing leaves the plane: strokes are in it, and what turns does so about y.
void check_motion_plane(const PrescribedCase& prescribed, const Setting& map, const std::string& path, const Context& context) {
  if (context.dimensions != 2) return;
  const std::set<Direction> used = directions_of(prescribed);
  const Vector3d& axis = prescribed.axis;
  if (used.count(Direction::stroke) > 0 && axis.y() != 0)
    refuse_vector(map, path, "axis", axis, "within the x–z plane for a stroke in a 2-D case, [x, z]");
  if (used.count(Direction::angle) > 0 && (axis.x() != 0 || axis.z() != 0))
    refuse_vector(map, path, "axis", axis, "[0, 1, 0] or [0, -1, 0] for an angle in a 2-D case");
}

}  // namespace

std::set<Direction> directions_of(const PrescribedCase& prescribed) {
  std::set<Direction> directions;
  for (const HarmonicCase& harmonic : prescribed.harmonics) directions.insert(harmonic.direction);
  for (const RampCase& ramp : prescribed.ramps) directions.insert(ramp.direction);
  for (const RecordCase& record : prescribed.records) {
    if (const auto direction = direction_of(record)) directions.insert(*direction);
  }
  if (prescribed.waves) directions.insert(prescribed.waves->direction);
  return directions;
}

Section<PrescribedCase> prescribed_section() {
  Section<PrescribedCase> section;
  section.key("point", &PrescribedCase::point, if_given(position()), "m",
              "That rotations are about, where it is at the start; if it is left out, the centre of mass, for the tank the case's origin.");
  section.key("axis", &PrescribedCase::axis, axis(), "", "Of stroke, which is along it, and angle, which is about it through `point`.");
  section.key("harmonics", &PrescribedCase::harmonics, list_of(harmonic_section()), "",
              "Oscillations; harmonics, ramps, records and waves are added up, direction by direction.");
  section.key("ramps", &PrescribedCase::ramps, list_of(ramp_section()), "", "Smooth changes between two times.");
  section.key("records", &PrescribedCase::records, list_of(motion_record_section()), "", "Motions from files, joined by a cubic spline.");
  section.key("waves", &PrescribedCase::waves, section_if_given(wave_section()), "", "The motion of a paddle that makes waves by theory.");
  section.rule(check_motion_plane);
  section.rule([](const PrescribedCase& prescribed, const Setting& map, const std::string& path, const Context&) {
    if (prescribed.waves && is_rotation(prescribed.waves->direction) && !prescribed.point)
      refuse_key(map, path, "point", "is missing; a flap that makes waves needs it: its hinge");
  });
  return section;
}

Section<CommandCase> command_section() {
  Section<CommandCase> section;
  section.key("greatest_speed", &CommandCase::greatest_speed, number_or_none(greater_than(0)), "m/s", "Limit of the velocity.");
  section.key("greatest_angular_speed", &CommandCase::greatest_angular_speed, number_or_none(greater_than(0)), "rad/s",
              "Limit of the angular velocity.");
  section.key("greatest_acceleration", &CommandCase::greatest_acceleration, number_or_none(greater_than(0)), "m/s²",
              "At which the velocity goes over to the one commanded; `none`: at once.");
  section.key("greatest_angular_acceleration", &CommandCase::greatest_angular_acceleration, number_or_none(greater_than(0)), "rad/s²",
              "Likewise of the angular velocity.");
  section.key("timeout", &CommandCase::timeout, number(at_least(0)), "s",
              "Of simulated time without a command, after which it brakes to a stop; 0 = never.");
  return section;
}

}  // namespace wavetank::scene
