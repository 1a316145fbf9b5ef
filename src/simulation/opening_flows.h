#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flow_law.h"
#include "wavetank/instruments/samples.h"
#include "wavetank/simulation/simulation.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// What the water just before an opening did lately, at a point a column: sound takes a while from there to each layer of the water beyond.
class WaterBefore {
 public:
  struct Values {
    std::vector<double> speed, pressure;  ///< m/s along the normal, Pa, of each column
  };
  /// Keeps them, and forgets what is older than `longest`, s.
  void add(double time, Values values, double longest);
  /// In straight lines between instants; before the first, that.
  Values at(double time) const;
  void save(std::vector<double>& to) const;
  /// Reads what save wrote, of so many columns. Throws Error, and stays as it was, if that ends before `end` or is no account of instants.
  void restore(std::vector<double>::const_iterator& from, std::vector<double>::const_iterator end, std::size_t columns);

 private:
  std::vector<double> times_;
  std::vector<Values> values_;
};

/// The greatest speed of the water beyond an opening by its law, or by those of outlets that return to it, m/s.
double fastest_at(std::size_t opening, const std::vector<OpeningCase>& cases, const std::vector<Opening>& openings,
                  const std::vector<FlowLaw>& laws, double duration);

/// What passes the case's openings: which velocity and pressure the water beyond each has in a step, particles that come in there, and the
/// account of what has come and gone.
///
/// Beyond an opening's plane particles move with its columns. When a column has moved by a spacing, the next particle is let in where its
/// last one began, less what it moved too far: so there is never a gap, whatever the velocity does. Its phase is kept in double.
///
/// What an opening takes from the water before it, pressure or velocity, it takes as late as sound would bring it to each layer beyond:
/// taken at once, it would reach the layers too soon, and send back a third of a pulse four supports long.
class OpeningFlows {
 public:
  /// `laws`: one an opening; `references`: what each owner of walls turns about, m. Throws Error for a law that asks for more than a tenth
  /// of the speed of sound.
  OpeningFlows(const Case& settled_case, const Layout& layout, const Discretisation& discretisation, std::vector<FlowLaw> laws,
               std::vector<Vector3d> references);

  bool any() const { return !openings_.empty(); }
  /// Before the start: the water beyond keeps its state; what leaves at the far ends is no more in the water.
  void hold(Solver& solver) const;
  /// Whether one is in a body that moves.
  bool any_moves() const { return any_moves_; }
  /// Sets what the step from `time` begins with, and lets in what comes in the course of it. `begin`, `end`: where walls are then; of a
  /// case whose openings all stand they are not read.
  void before_step(Solver& solver, double time, double time_step, const WallMotions& begin, const WallMotions& end);
  void after_step(const StepReport& report);

  /// m³/s (2-D: m²/s), of a commanded opening, from `time` on. Throws Error for another opening, and for a value that is not finite,
  /// negative, or faster than a tenth of the speed of sound.
  void command(std::size_t opening, double time, double discharge);
  const std::vector<OpeningState>& states() const { return states_; }

  std::vector<char> save() const;
  /// Throws Error, and stays as it was, for what these openings cannot have saved.
  void restore(const std::vector<char>& bytes);

 private:
  struct Place {
    std::vector<double> phase;  ///< m, by which each column has moved from where its lattice began, of less than a spacing
    WaterBefore before;
    double commanded = 0;      ///< m³/s, as limited
    double wanted = 0;         ///< m³/s, the last command
    double command_time = -1;  ///< s; none before the first
  };
  /// Where an opening is in a step.
  struct Pose {
    Opening begin, end;
    WallMotion wall;                        ///< at the beginning
    Vector3d reference = Vector3d::Zero();  ///< m, that the wall turns about, then
    Vector3d velocity_at(const Vector3d& place) const { return wall.velocity + wall.angular_velocity.cross(place - reference); }
  };
  struct Columns {
    std::vector<double> speed, pressure;  ///< of each column, in one layer
    std::vector<bool> wet, wet_before;    ///< beyond, and before the opening
  };

  void find_poses(const WallMotions& begin, const WallMotions& end);
  std::vector<Drain> drains() const;
  /// Before the columns, where what is beyond takes values from, m.
  std::vector<Vector3d> points_before() const;
  Columns columns_of(std::size_t o, const std::vector<PointValue>& before) const;
  /// What the law makes of the columns of a layer that have the speed and pressure of before the opening.
  void apply_law(std::size_t o, double time, double value, Columns& columns) const;
  /// One opening's part of before_step. `before`: what is before its columns.
  void set_state(std::size_t o, double time, double time_step, const std::vector<PointValue>& before, ImposedZone& zone,
                 NewParticles& coming);
  /// Of the opening, at a time, s.
  double law_at(std::size_t o, double time, double time_step);
  void set_given_speeds(std::size_t o, double time, double value, bool is_velocity, double sign, Columns& columns) const;
  /// m³/s, by an inlet, of what leaves at others.
  double returned_discharge(std::size_t o);
  /// m³ that have come in, as if water did so smoothly and not by particles.
  double smooth_volume(std::size_t o) const;
  double commanded_discharge(std::size_t o, double time, double time_step);
  void let_in(std::size_t o, const Columns& columns, double time_step, NewParticles& coming);
  /// Whether water may come in by a column.
  bool lets_in(std::size_t o, std::size_t column) const;
  void hold_back(std::size_t o, double time_step, Columns& columns) const;
  std::vector<ImposedZone> zones(double time_step) const;
  double height_of(const Vector3d& place) const { return up_.dot(place); }
  double hydrostatic(double level, const Vector3d& place) const;

  std::vector<OpeningCase> cases_;
  std::vector<Opening> openings_;
  std::vector<FlowLaw> laws_;
  std::vector<Vector3d> references_;
  std::vector<double> fastest_of_one_;                 ///< m/s, of a discharge of 1 m³/s by each opening
  std::vector<std::vector<double>> shapes_;            ///< of each opening's profile
  std::vector<std::vector<std::size_t>> returned_by_;  ///< of each opening those that return to it
  std::vector<std::size_t> in_order_;                  ///< those that others return to last
  bool any_moves_ = false;
  bool told_of_return_ = false;
  std::vector<Pose> poses_;
  double spacing_, support_, density_, sound_speed_, gravity_;
  int dimensions_;
  bool single_;
  Vector3d up_;
  int way_;   ///< of `up_` along its axis
  Box room_;  ///< m, that openings which move must stay in
  std::shared_ptr<PointSet> points_;
  std::vector<Place> places_;
  std::vector<OpeningState> states_;
  std::vector<std::size_t> coming_to_;  ///< openings of the particles that come in this step
};

}  // namespace wavetank
