#include "opening_flows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "texts.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"

namespace wavetank {
namespace {

constexpr double least_filling = 0.45;    // of what walls leave of the kernel: less is above the water
constexpr double drain_behind = 0.25;     // spacings behind the last row, where particles leave: none that comes in is so far back
constexpr double past_the_back = 0.05;    // spacings behind the pocket's back, to where drains reach
constexpr double fastest_of_sound = 0.1;  // of the speed of sound
constexpr double slow_return = 20;        // fillings of an inlet's pocket, in which it makes good what it is behind,
constexpr double usual_of_sound = 0.05;   // at a speed of so much of the speed of sound
constexpr char not_of_this_case[] = "the snapshot's openings are not those of this case.";

/// Where a wall's motion has carried it.
Opening moved(Opening opening, const WallMotion& wall, const Vector3d& reference) {
  const auto place = [&](Vector3d& point) { point = reference + wall.displacement + wall.orientation * (point - reference); };
  for (Vector3d* direction : {&opening.normal, &opening.across, &opening.up}) *direction = wall.orientation * *direction;
  place(opening.centre);
  for (Vector3d& corner : opening.outline) place(corner);
  for (Opening::Column& column : opening.columns) place(column.place);
  return opening;
}

}  // namespace

double fastest_at(std::size_t o, const std::vector<OpeningCase>& cases, const std::vector<Opening>& openings,
                  const std::vector<FlowLaw>& laws, double duration) {
  double returned = 0;
  for (std::size_t by = 0; by < cases.size(); ++by)
    if (cases[by].returns_to == cases[o].name) returned += greatest_discharge(cases[by], openings[by], laws[by], duration);
  if (returned > 0) return fastest_of_discharge(cases[o], openings[o], returned);
  return fastest_flow(cases[o], openings[o], laws[o], duration);
}

void WaterBefore::add(double time, Values values, double longest) {
  times_.push_back(time);
  values_.push_back(std::move(values));
  std::size_t old = 0;  // all before the last that is older than what is asked for
  while (old + 1 < times_.size() && times_[old + 1] < time - longest) ++old;
  times_.erase(times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(old));
  values_.erase(values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(old));
}

WaterBefore::Values WaterBefore::at(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) return values_.front();
  if (after == times_.end()) return values_.back();
  const auto k = static_cast<std::size_t>(after - times_.begin());
  const double share = (time - times_[k - 1]) / (times_[k] - times_[k - 1]);
  Values values = values_[k - 1];
  for (std::size_t c = 0; c < values.speed.size(); ++c) {
    values.speed[c] += share * (values_[k].speed[c] - values.speed[c]);
    values.pressure[c] += share * (values_[k].pressure[c] - values.pressure[c]);
  }
  return values;
}

void WaterBefore::save(std::vector<double>& to) const {
  to.push_back(static_cast<double>(times_.size()));
  for (std::size_t k = 0; k < times_.size(); ++k) {
    to.push_back(times_[k]);
    to.insert(to.end(), values_[k].speed.begin(), values_[k].speed.end());
    to.insert(to.end(), values_[k].pressure.begin(), values_[k].pressure.end());
  }
}

void WaterBefore::restore(std::vector<double>::const_iterator& from, std::vector<double>::const_iterator end, std::size_t columns) {
  const std::size_t left = static_cast<std::size_t>(end - from), each = 1 + 2 * columns;
  if (left == 0 || !(*from >= 0) || *from > static_cast<double>((left - 1) / each)) throw Error(not_of_this_case);
  const auto count = static_cast<std::size_t>(*from++);
  std::vector<double> times;
  std::vector<Values> all;
  for (std::size_t k = 0; k < count; ++k) {
    times.push_back(*from++);
    Values values;
    for (std::vector<double>* of : {&values.speed, &values.pressure}) {
      of->assign(from, from + static_cast<std::ptrdiff_t>(columns));
      from += static_cast<std::ptrdiff_t>(columns);
    }
    all.push_back(std::move(values));
  }
  if (!std::is_sorted(times.begin(), times.end())) throw Error(not_of_this_case);
  times_ = std::move(times);
  values_ = std::move(all);
}

OpeningFlows::OpeningFlows(const Case& scene, const Layout& layout, const Discretisation& discretisation, std::vector<FlowLaw> laws,
                           std::vector<Vector3d> references)
    : cases_(scene.openings),
      openings_(layout.openings),
      laws_(std::move(laws)),
      references_(std::move(references)),
      spacing_(layout.spacing),
      support_(discretisation.support),
      density_(scene.fluid.density),
      sound_speed_(discretisation.sound_speed),
      gravity_(-scene.gravity.dot(layout.up)),
      dimensions_(scene.dimensions),
      single_(scene.numerics.precision == Precision::single),
      up_(layout.up),
      way_(top_of(scene).way),
      room_(with_pockets(layout.domain, layout.openings, scene.dimensions)) {
  room_.min.array() -= 0.25 * spacing_;  // the watchdog's box is larger by a little more
  room_.max.array() += 0.25 * spacing_;
  for (std::size_t o = 0; o < openings_.size(); ++o) {
    const double fastest = fastest_at(o, cases_, openings_, laws_, scene.duration);
    const double most = fastest_of_sound * sound_speed_;
    if (fastest > most * (1 + 1e-9))
      throw Error("opening '" + openings_[o].name + "': its water moves at up to " + number(fastest) +
                  " m/s; it must be at most a tenth of the speed of sound, " + number(most) + " m/s: give a larger fluid/sound_speed");
    Place place;
    place.phase.assign(openings_[o].columns.size(), 0.0);
    places_.push_back(std::move(place));
  }
  states_.resize(openings_.size());
  returned_by_.resize(openings_.size());
  for (std::size_t o = 0; o < openings_.size(); ++o) {
    shapes_.push_back(shape_of_profile(cases_[o], openings_[o]));
    fastest_of_one_.push_back(fastest_of_discharge(cases_[o], openings_[o], 1.0));
    any_moves_ = any_moves_ || layout.moving[openings_[o].owner];
    for (std::size_t other = 0; other < openings_.size(); ++other)
      if (cases_[other].returns_to == cases_[o].name) returned_by_[o].push_back(other);
  }
  for (const bool last : {false, true})
    for (std::size_t o = 0; o < openings_.size(); ++o)
      if (returned_by_[o].empty() != last) in_order_.push_back(o);
  for (const Opening& opening : openings_) poses_.push_back({opening, opening, {}, references_[opening.owner]});
}

void OpeningFlows::find_poses(const WallMotions& begin, const WallMotions& end) {
  for (std::size_t o = 0; o < openings_.size(); ++o) {
    const auto owner = static_cast<std::size_t>(openings_[o].owner);
    const Vector3d& reference = references_[owner];
    poses_[o].wall = begin.owners[owner];
    poses_[o].reference = reference + begin.owners[owner].displacement;
    poses_[o].begin = moved(openings_[o], begin.owners[owner], reference);
    poses_[o].end = moved(openings_[o], end.owners[owner], reference);
    const Vector3d back = -poses_[o].end.pocket * poses_[o].end.normal;
    for (const Vector3d& corner : poses_[o].end.outline)
      for (const Vector3d& place : {corner, Vector3d(corner + back)})
        if (((place - room_.min).array() < 0).any() || ((place - room_.max).array() > 0).any())
          throw Error("opening '" + openings_[o].name + "' is carried out of the tank: its pocket, " + number(openings_[o].pocket) +
                      " m deep, reaches " + point(place) + " m; keep it within the tank's walls, and below the top of an open one");
  }
}

/// The water is carried along the chord of a step, so that it is where the lattice is at its end.
std::vector<ImposedZone> OpeningFlows::zones(double time_step) const {
  std::vector<ImposedZone> zones;
  for (const Pose& pose : poses_) {
    const Opening& opening = pose.begin;
    ImposedZone zone;
    if (any_moves_ && time_step > 0) {
      const auto axes = [](const Opening& of) {
        Eigen::Matrix3d columns;
        columns << of.normal, of.across, of.up;
        return columns;
      };
      zone.drift = (pose.end.centre - opening.centre) / time_step;
      zone.turning = (axes(pose.end) * axes(opening).transpose() - Eigen::Matrix3d::Identity()) / time_step;
    }
    zone.centre = opening.centre;
    zone.normal = opening.normal;
    zone.heading = pose.end.normal;
    zone.across = opening.across;
    zone.up = opening.up;
    zone.depth = opening.pocket;
    zone.layers = opening.rows + 1;
    zone.cells = opening.cells;
    zone.cell_size = opening.cell_size;
    zone.first_edge = opening.first_edge;
    zones.push_back(std::move(zone));
  }
  return zones;
}

void OpeningFlows::hold(Solver& solver) const {
  if (!any()) return;
  solver.set_drains(drains());
  solver.set_zones(zones(0));
}

std::vector<Drain> OpeningFlows::drains() const {
  std::vector<Drain> drains;
  for (const Pose& pose : poses_) {
    const Opening& opening = pose.end;
    const double begin = opening.depth + drain_behind * spacing_, end = opening.pocket + past_the_back * spacing_;
    const Vector3d back = 0.5 * (begin + end) * opening.normal;
    // a rectangle has one drain, other shapes one a column, which the corners of the disc or the polygon are none of
    const auto add = [&](const Vector3d& place, double across, double up) {
      Drain drain;
      drain.centre = place - back;
      drain.half_edges.col(0) = 0.5 * (end - begin) * opening.normal;
      drain.half_edges.col(1) = across * opening.across;
      drain.half_edges.col(2) = up * opening.up;
      drains.push_back(drain);
    };
    const double skin = 0.1 * spacing_, across = dimensions_ == 2 ? spacing_ : 0.5 * opening.width + skin;
    if (opening.shape == Opening::Shape::rectangle) {
      add(opening.centre, across, 0.5 * opening.height + skin);
    } else {
      for (const Opening::Column& column : opening.columns) add(column.place, 0.8 * opening.cell_size[0], 0.8 * opening.cell_size[1]);
    }
  }
  return drains;
}

double OpeningFlows::hydrostatic(double level, const Vector3d& place) const {
  return density_ * gravity_ * std::max(level - height_of(place), 0.0);
}

double OpeningFlows::commanded_discharge(std::size_t o, double time, double time_step) {
  Place& place = places_[o];
  const FlowCommandCase& limits = *cases_[o].command;
  const bool timed_out = limits.timeout > 0 && time - place.command_time > limits.timeout;
  double target = place.command_time < 0 || timed_out ? 0.0 : place.wanted;
  if (limits.greatest_discharge) target = std::min(target, *limits.greatest_discharge);
  const double change = target - place.commanded;
  const double most = limits.greatest_rate ? *limits.greatest_rate * time_step : std::abs(change);
  place.commanded += std::clamp(change, -most, most);
  return place.commanded;
}

/// `sign`: 1 into the water, −1 out of it.
void OpeningFlows::set_given_speeds(std::size_t o, double time, double value, bool is_velocity, double sign, Columns& columns) const {
  const std::vector<double> profile = profile_of(openings_[o], shapes_[o], columns.wet);
  if (laws_[o].depends_on_place()) {
    for (std::size_t c = 0; c < profile.size(); ++c)
      columns.speed[c] = columns.wet[c] ? sign * profile[c] * laws_[o].at(time, openings_[o].columns[c].place) : 0.0;
    return;
  }
  double area = 0;
  for (std::size_t c = 0; c < profile.size(); ++c)
    if (columns.wet[c]) area += openings_[o].columns[c].area;
  double mean = is_velocity ? value : area > 0 ? value / area : 0.0;
  const double peak = *std::max_element(profile.begin(), profile.end());
  // where but little of an outlet is still wet, that cannot carry what was asked for
  if (sign < 0 && mean * peak > fastest_of_sound * sound_speed_) mean = fastest_of_sound * sound_speed_ / peak;
  for (std::size_t c = 0; c < profile.size(); ++c) columns.speed[c] = sign * mean * profile[c];
}

bool OpeningFlows::lets_in(std::size_t o, std::size_t column) const {
  const OpeningCase& given = cases_[o];
  if (given.kind != OpeningKind::outlet || given.command || laws_[o].quantity()) return true;
  return given.level && height_of(openings_[o].columns[column].place) < way_ * *given.level;
}

/// Sound may move what is beyond a free outlet, or one over air, to and fro, but nothing comes in there.
void OpeningFlows::hold_back(std::size_t o, double time_step, Columns& columns) const {
  for (std::size_t c = 0; c < columns.speed.size(); ++c)
    if (!lets_in(o, c) && places_[o].phase[c] + columns.speed[c] * time_step >= 0.5 * spacing_)
      columns.speed[c] = std::min(columns.speed[c], 0.0);
}

OpeningFlows::Columns OpeningFlows::columns_of(std::size_t o, const std::vector<PointValue>& before) const {
  const Opening& opening = poses_[o].begin;
  const std::size_t count = opening.columns.size();
  Columns columns{std::vector<double>(count), std::vector<double>(count), std::vector<bool>(count), std::vector<bool>(count)};
  for (std::size_t c = 0; c < count; ++c) {
    columns.pressure[c] = before[c].pressure;
    columns.wet_before[c] = before[c].filling > least_filling * before[c].shepard;
    columns.wet[c] = cases_[o].kind == OpeningKind::inlet ? opening.columns[c].wet : columns.wet_before[c];
    const Vector3d& place = opening.columns[c].place;
    if (columns.wet_before[c]) columns.speed[c] = (before[c].velocity - poses_[o].velocity_at(place)).dot(opening.normal);
  }
  return columns;
}

double OpeningFlows::law_at(std::size_t o, double time, double time_step) {
  if (cases_[o].command) return commanded_discharge(o, time, time_step);
  if (!returned_by_[o].empty()) return returned_discharge(o);
  return laws_[o].quantity() && !laws_[o].depends_on_place() ? laws_[o].at(time) : 0.0;
}

double OpeningFlows::smooth_volume(std::size_t o) const {
  double volume = (states_[o].mass_in - states_[o].mass_out) / density_;
  for (std::size_t c = 0; c < places_[o].phase.size(); ++c) volume += places_[o].phase[c] * openings_[o].columns[c].area;
  return volume;
}

/// What leaves at present, and slowly what has left before and is not back yet.
double OpeningFlows::returned_discharge(std::size_t o) {
  double discharge = 0, behind = -smooth_volume(o);
  for (const std::size_t by : returned_by_[o]) {
    discharge -= states_[by].discharge;
    behind -= smooth_volume(by);
  }
  discharge += behind * usual_of_sound * sound_speed_ / (slow_return * openings_[o].pocket);
  const double most = fastest_of_sound * sound_speed_ / fastest_of_one_[o];
  if (discharge > most && !told_of_return_) {
    told_of_return_ = true;
    log(LogLevel::warning, "opening '" + openings_[o].name + "' is to bring back " + number(discharge) +
                               (dimensions_ == 2 ? " m²/s" : " m³/s") + ", faster than a tenth of the speed of sound: it brings " +
                               number(most) + " and the rest later; make it larger, or fluid/sound_speed");
  }
  return std::clamp(discharge, 0.0, most);
}

void OpeningFlows::apply_law(std::size_t o, double time, double value, Columns& columns) const {
  const OpeningCase& given = cases_[o];
  const Opening& opening = openings_[o];
  const std::size_t count = opening.columns.size();
  if (given.kind == OpeningKind::inlet) {
    set_given_speeds(o, time, value, laws_[o].quantity() == FlowQuantity::velocity, 1, columns);
    return;
  }
  if (given.kind == OpeningKind::outlet && (given.command || laws_[o].quantity())) {
    set_given_speeds(o, time, value, false, -1, columns);
  } else if (given.level || given.kind == OpeningKind::pressure) {
    const double level = way_ * given.level.value_or(value);
    for (std::size_t c = 0; c < count; ++c) {
      const Vector3d& place = opening.columns[c].place;
      columns.pressure[c] = hydrostatic(level, place);
      const double head = level - height_of(place);
      if (!columns.wet_before[c] && head > 0)  // into the air, as from a reservoir
        columns.speed[c] = std::min(std::sqrt(2 * gravity_ * head), fastest_of_sound * sound_speed_);
      columns.wet[c] = columns.wet_before[c] || head > 0;
    }
  }
}

void OpeningFlows::let_in(std::size_t o, const Columns& columns, double time_step, NewParticles& coming) {
  const Opening& opening = poses_[o].end;
  const Pose& pose = poses_[o];
  const double last_row = (opening.rows - 0.5) * spacing_;
  for (std::size_t c = 0; c < opening.columns.size(); ++c) {
    double& phase = places_[o].phase[c];
    if (!columns.wet[c]) continue;
    phase += columns.speed[c] * time_step;
    if (phase <= -(0.5 + drain_behind) * spacing_) phase += spacing_;  // its last row has left
    if (phase < 0.5 * spacing_) continue;
    phase -= spacing_;
    coming.position.push_back(opening.columns[c].place + (phase - last_row) * opening.normal);
    coming.velocity.push_back(columns.speed[c] * opening.normal + pose.velocity_at(coming.position.back()));
    coming.volume.push_back(opening.columns[c].area * spacing_);
    coming.pressure.push_back(columns.pressure[c]);
  }
}

std::vector<Vector3d> OpeningFlows::points_before() const {
  std::vector<Vector3d> points;
  for (const Pose& pose : poses_)
    for (const Opening::Column& column : pose.begin.columns) points.push_back(column.place + 0.5 * support_ * pose.begin.normal);
  return points;
}

void OpeningFlows::set_state(std::size_t o, double time, double time_step, const std::vector<PointValue>& values, ImposedZone& zone,
                             NewParticles& coming) {
  const Opening& opening = poses_[o].begin;
  Columns columns = columns_of(o, values);
  const double value = law_at(o, time, time_step), to_plane = 0.5 * support_;
  WaterBefore& before = places_[o].before;
  before.add(time, {columns.speed, columns.pressure}, (to_plane + opening.pocket) / sound_speed_);
  Columns last_row;
  for (int layer = 0; layer < zone.layers; ++layer) {
    const double way = to_plane + (layer + 0.5) * opening.pocket / zone.layers;
    WaterBefore::Values late = before.at(time + 0.5 * time_step - way / sound_speed_);
    columns.speed = std::move(late.speed);
    columns.pressure = std::move(late.pressure);
    apply_law(o, time, value, columns);
    hold_back(o, time_step, columns);
    if (single_)  // as the device has it
      for (double& speed : columns.speed) speed = static_cast<float>(speed);
    for (const int column : opening.column_of) {
      zone.speed.push_back(column < 0 ? 0.0 : columns.speed[column]);
      zone.pressure.push_back(column < 0 ? 0.0 : columns.pressure[column]);
      // where there is air, drops fall as they would, to where they leave
      if (layer == 0) zone.is_free.push_back(column >= 0 && columns.wet[column] ? 0 : 1);
    }
    if (layer == opening.rows - 1) last_row = columns;
    if (layer > 0) continue;
    states_[o].discharge = 0;
    for (std::size_t c = 0; c < opening.columns.size(); ++c)
      if (columns.wet[c]) states_[o].discharge += columns.speed[c] * opening.columns[c].area;
  }
  const std::size_t already = coming.position.size();
  let_in(o, last_row, time_step, coming);
  states_[o].particles_in += coming.position.size() - already;
  for (std::size_t k = already; k < coming.position.size(); ++k) coming_to_.push_back(o);
}

void OpeningFlows::before_step(Solver& solver, double time, double time_step, const WallMotions& begin, const WallMotions& end) {
  if (!any()) return;
  if (any_moves_) {
    find_poses(begin, end);
    solver.set_drains(drains());
  }
  if (!points_) {
    points_ = solver.make_points(points_before());
  } else if (any_moves_) {
    points_->set(points_before());
  }
  const std::vector<PointValue> values = solver.evaluate(*points_);
  std::vector<std::size_t> first{0};
  for (const Opening& opening : openings_) first.push_back(first.back() + opening.columns.size());
  std::vector<ImposedZone> zones = this->zones(time_step);
  NewParticles coming;
  for (const std::size_t o : in_order_) {
    const auto from = values.begin();
    set_state(o, time, time_step, {from + static_cast<std::ptrdiff_t>(first[o]), from + static_cast<std::ptrdiff_t>(first[o + 1])},
              zones[o], coming);
  }
  solver.set_zones(zones);
  if (!coming.position.empty()) solver.let_in(coming);
}

void OpeningFlows::after_step(const StepReport& report) {
  if (!any()) return;
  for (std::size_t k = 0; k < report.let_in.size() && k < coming_to_.size(); ++k) states_[coming_to_[k]].mass_in += report.let_in[k];
  coming_to_.clear();
  for (const LeftParticle& particle : report.left) {
    std::size_t by = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t o = 0; o < openings_.size(); ++o) {
      const Opening& opening = poses_[o].end;
      const Vector3d way = particle.position - opening.centre;
      // out of its pocket, by the side that is farthest off
      const double outside =
          std::max({std::abs(way.dot(opening.across)) - 0.5 * opening.width, std::abs(way.dot(opening.up)) - 0.5 * opening.height,
                    way.dot(opening.normal), -way.dot(opening.normal) - opening.pocket});
      if (outside < least) least = outside, by = o;
    }
    states_[by].mass_out += particle.mass;
    ++states_[by].particles_out;
  }
  for (OpeningState& state : states_) state.volume = (state.mass_in - state.mass_out) / density_;
}

void OpeningFlows::command(std::size_t opening, double time, double discharge) {
  const std::string what = "opening '" + openings_.at(opening).name + "' ";
  if (!cases_[opening].command) throw Error(what + "is not commanded: openings/" + std::to_string(opening) + "/command is not given");
  double area = 0;
  std::vector<bool> wet;
  for (const Opening::Column& column : openings_[opening].columns) {
    wet.push_back(column.wet || cases_[opening].kind != OpeningKind::inlet);
    if (wet.back()) area += column.area;
  }
  const std::vector<double> profile = profile_of(openings_[opening], shapes_[opening], wet);
  const double most = fastest_of_sound * sound_speed_ * area / *std::max_element(profile.begin(), profile.end());
  const double limited = std::min(discharge, cases_[opening].command->greatest_discharge.value_or(discharge));
  if (!std::isfinite(discharge) || discharge < 0 || limited > most)
    throw Error(what + "was commanded a discharge of " + number(discharge) + "; it must be from 0 to " + number(most) +
                (dimensions_ == 2 ? " m²/s" : " m³/s") + ", a tenth of the speed of sound");
  places_[opening].wanted = discharge;
  places_[opening].command_time = time;
}

std::vector<char> OpeningFlows::save() const {
  std::vector<double> values;
  for (std::size_t o = 0; o < openings_.size(); ++o) {
    const Place& place = places_[o];
    const OpeningState& state = states_[o];
    values.insert(values.end(), place.phase.begin(), place.phase.end());
    place.before.save(values);
    values.insert(values.end(), {place.commanded, place.wanted, place.command_time, state.discharge, state.volume, state.mass_in,
                                 state.mass_out, static_cast<double>(state.particles_in), static_cast<double>(state.particles_out)});
  }
  std::vector<char> bytes(values.size() * sizeof(double));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

void OpeningFlows::restore(const std::vector<char>& bytes) {
  constexpr std::ptrdiff_t numbers = 9;                // of an opening, besides its columns and the water before it
  constexpr double most_particles = 9007199254740992;  // 2⁵³, up to which a double counts one by one
  std::vector<double> values(bytes.size() / sizeof(double));
  if (bytes.size() % sizeof(double) != 0) throw Error(not_of_this_case);
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); })) throw Error(not_of_this_case);
  std::vector<Place> places = places_;
  std::vector<OpeningState> states = states_;
  auto next = values.cbegin();
  const auto need = [&](std::ptrdiff_t count) {
    if (values.cend() - next < count) throw Error(not_of_this_case);
  };
  for (std::size_t o = 0; o < openings_.size(); ++o) {
    Place& place = places[o];
    OpeningState& state = states[o];
    need(static_cast<std::ptrdiff_t>(place.phase.size()));
    for (double& phase : place.phase) phase = *next++;
    place.before.restore(next, values.cend(), place.phase.size());
    need(numbers);
    for (double* value :
         {&place.commanded, &place.wanted, &place.command_time, &state.discharge, &state.volume, &state.mass_in, &state.mass_out})
      *value = *next++;
    for (std::uint64_t* count : {&state.particles_in, &state.particles_out}) {
      if (!(*next >= 0) || *next > most_particles) throw Error(not_of_this_case);
      *count = static_cast<std::uint64_t>(*next++);
    }
    for (const double phase : place.phase)
      if (std::abs(phase) > spacing_) throw Error(not_of_this_case);
  }
  if (next != values.cend()) throw Error(not_of_this_case);
  coming_to_.clear();
  places_ = std::move(places);
  states_ = std::move(states);
}

}  // namespace wavetank
