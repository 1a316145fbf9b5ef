#include "sph_solver.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "build_options.h"
#include "film_values.h"
#include "owner_boxes.h"
#include "wavetank/common/error.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank {
namespace {

/// As field::motion_friction has them: the law, and its roughness or coefficient.
std::array<double, 2> friction_values(const FrictionCase& friction) {
  switch (friction.law) {
    case FrictionLaw::viscous:
      return {field::friction_viscous, 0};
    case FrictionLaw::law_of_the_wall:
      return {field::friction_of_the_wall, friction.roughness};
    case FrictionLaw::coefficient:
      return {field::friction_coefficient, friction.coefficient};
    case FrictionLaw::none:
    case FrictionLaw::as_case:
      break;
  }
  return {field::friction_none, 0};
}

bool moves(const WallMotion& motion) {
  return !(motion.velocity.isZero(0) && motion.angular_velocity.isZero(0) && motion.acceleration.isZero(0) &&
           motion.angular_acceleration.isZero(0) && motion.surface_velocity.isZero(0));
}

/// How far a particle may be from where it was sorted when wrenches are found, m.
double farthest_drift(const Schedule& schedule, const Case& scene, const Discretisation& d) {
  return std::max(0.25 * d.spacing, greatest_drift(schedule, scene, d));
}

/// Of the force on a particle of the water, N, whose pressure is that of the speed of sound.
ExactScale scale_of_forces(const Case& scene, const Discretisation& d) {
  return {scene.fluid.density * d.sound_speed * d.sound_speed * std::pow(d.spacing, d.dimensions - 1), d.spacing};
}

/// Of its momentum at that speed, N·s.
ExactScale scale_of_impulses(const Case& scene, const Discretisation& d) {
  return {scene.fluid.density * std::pow(d.spacing, d.dimensions) * d.sound_speed, d.spacing};
}

/// Of what energies() sums, each.
std::vector<double> quanta_of_energies(const Case& scene, const Discretisation& d) {
  const double mass = scene.fluid.density * std::pow(d.spacing, d.dimensions), energy = mass * d.sound_speed * d.sound_speed;
  std::vector<double> typical(field::energy_count, energy);
  typical[field::energy_mass] = mass;
  std::fill_n(typical.begin() + field::energy_moment, 3, mass * d.spacing);
  typical[field::energy_damper] = energy * d.sound_speed / d.spacing;
  std::fill_n(typical.begin() + field::energy_zone_force, 3, energy / d.spacing);
  std::transform(typical.begin(), typical.end(), typical.begin(), quanta_per_unit);
  return typical;
}

/// Of a tile: about as many as a particle has neighbours in a lattice, which is half as much again as tiles of four with four candidates
/// have.
int blocks_with_room(const Discretisation& d) {
  const double ratio = d.support / d.spacing;
  return static_cast<int>(d.dimensions == 3 ? 4.19 * ratio * ratio * ratio : 3.15 * ratio * ratio);
}

/// Least squares have images of the water in walls, for which one on the other side of an edge, or of a thin wall, would be in the water.
void check_walls_of_least_squares(const Case& scene, const Layout& layout, bool thin_walls) {
  const std::string chosen = "numerics/gradients is " + word_of(scene.numerics.gradients);
  if (thin_walls)
    throw Error(
        chosen +
        ", which knows no thin walls, with water nearer on both sides than the support: choose sph, or make fluid/spacing smaller.");
  tank_planes(layout, {}, chosen, "sph");
}

}  // namespace

template <class Real>
SphSolver<Real>::SphSolver(const SolverRows& rows, const compute::Device& device, const Case& scene, const Layout& layout,
                           const Discretisation& discretisation, const std::vector<Eigen::Vector3d>& centres)
    : device_(device),
      case_(scene),
      discretisation_(discretisation),
      count_(static_cast<int>(layout.particles.size())),
      given_(rows.parting ? static_cast<int>(rows.parting->given) : count_),
      room_(rows.parting ? rows.parting->room : room_for(scene, layout)),
      next_id_(given_),
      stride_(stride_for(count_)),
      chunks_(chunks_of(count_)),
      groups_(chunks_of(chunks_)),
      sources_(kernel_sources()),
      fields_(rows.fields),
      reports_(rows.reports),
      first_{fields_.at(ParticleArray::state, "x"), fields_.at(ParticleArray::state, "rest_x"), fields_.at(ParticleArray::state, "u")},
      centres_(centres),
      boxes_(owner_boxes(layout, centres)),
      moving_(layout.moving),
      moving_frame_(scene.tank.motion != Motion::fixed),
      ghosts_(scene.numerics.walls.method == WallMethod::ghost),
      elements_(kind_of(scene.numerics.walls) != WallKind::facets),
      long_axes_(long_axes(discretisation, scene.numerics.precision)),
      case_walls_(scene, layout, discretisation),
      tiling_(tiling_for(device.info(), scene.numerics.precision, ghosts_)),
      grid_shape_(grid_shape(discretisation, tiling_, room_)),
      state_(make_array(ParticleArray::state)),
      rates_(make_array(ParticleArray::rates)),
      gradient_(device, gradient_components(rows.methods(scene)) * static_cast<std::size_t>(stride_)),
      blocks_(device, 0),
      half_(make_array(ParticleArray::state)),
      sum_(rows.integrator(scene, nullptr).writes("sum of rates") ? make_array(ParticleArray::sums) : Buffer(device, 0)),
      id_(device, stride_),
      spare_id_(device, stride_),
      images_(tank_images(scene, layout, discretisation)),
      walls_(case_walls_.arrays<Real>(device)),
      loads_(device, elements_ ? walls_.stride : 1),
      wrenches_(device, discretisation, grid_shape_, boxes_, facing_pieces(), !images_.empty(),
                farthest_drift(rows.integrator(scene, nullptr), scene, discretisation), scale_of_forces(scene, discretisation)),
      guarded_(device, anything_free(scene), stride_, centres.size(), scale_of_impulses(scene, discretisation),
               rows.parting ? rows.parting->group : nullptr),
      report_(device, reports_.size()),
      watches_(device, static_cast<std::size_t>(chunks_) * reports_.greatest_count()),
      fillings_(device, stride_),
      group_watches_(device, static_cast<std::size_t>(groups_) * reports_.greatest_count()),
      alarms_(device, static_cast<std::size_t>(chunks_) * reports_.integer_count()),
      group_alarms_(device, static_cast<std::size_t>(groups_) * reports_.integer_count()),
      energy_rows_(grid_shape_.rows_y * grid_shape_.rows_z),
      energy_pieces_(std::clamp(1024 / energy_rows_, 1, 64)),
      energy_segment_(slots_of_segment(discretisation, grid_shape_)),
      energy_parts_(device,  // a part's by set_cuts()
                    rows.parting ? 1 : static_cast<std::size_t>(energy_rows_) * energy_pieces_ * exact_places(field::energy_count)),
      energy_quanta_(quanta_of_energies(scene, discretisation)),
      energy_quanta_on_device_(device, std::vector<Real>(energy_quanta_.begin(), energy_quanta_.end())) {
  up_ = layout.up;
  levels_ = layout.levels;
  volumes_ = layout.volumes;
  moving_.resize(centres.size(), false);
  const bool owners_move = std::find(moving_.begin(), moving_.end(), true) != moving_.end();
  if (scene.numerics.gradients != Gradients::sph) check_walls_of_least_squares(scene, layout, thinnest_wall().has_value());
  const WallMotions at_start = motions_at_start();
  const bool belts = std::any_of(at_start.owners.begin(), at_start.owners.end(), moves);
  const bool moving = moving_frame_ || owners_move || belts;
  if (ghosts_ && moving)
    throw Error("numerics/walls/method is ghost, whose mirror images stand still: walls that move need boundary_integral.");
  options_ = build_options(
      scene, {std::is_same_v<Real, double>, !images_.empty(), moving, moving_frame_, thinnest_wall().has_value(), long_axes_});
  if (rows.parting) options_["PARTED"] = 1;
  values_.emplace(rows.parameters, ParameterSource{case_, layout, discretisation_, grid_shape_, static_cast<int>(images_.size())});
  accelerates_by_gradients_ = accelerate_by_gradients(rows.methods(scene));
  compresses_by_gradients_ = compress_by_gradients(rows.methods(scene));
  // least squares are exact at the places alone that they were found for
  holds_gradients_ = accelerates_by_gradients_ && compresses_by_gradients_ && scene.numerics.gradients == Gradients::sph &&
                     scene.numerics.integrator == Integrator::symplectic;
  joins_surface_ = shifts() && accelerates_by_gradients_ && scene.numerics.gradients == Gradients::sph;
  begins_with_gradients_ = shifts() && scene.numerics.integrator == Integrator::symplectic && fields_.has(ParticleArray::rates, "volume");
  add_options(rows.methods(scene), options_);
  // a list must be of the very state that a sweep goes over: where gradients are found for both rates
  if (accelerates_by_gradients_ && compresses_by_gradients_ && scene.numerics.gradients == Gradients::sph && tiling_.particles.near > 1 &&
      !ghosts_ && options_.at("THIN_WALLS") == 0)
    options_["BLOCK_LIST"] = listed_blocks_ = blocks_with_room(discretisation_);
  add_sources(rows.methods(scene), sources_);
  sources_["parameters.cl"] = parameters_header(rows.parameters);
  sources_["sizes.cl"] = sizes_header();
  sources_["fields.cl"] = fields_.header();
  sources_["report.cl"] = reports_.header();
  upload_parameters(*values_);
  surroundings_.stride = stride_;
  surroundings_.reach = static_cast<Real>(discretisation_.support);
  surroundings_.grid = ParticleGrid(device, rows.parting ? 1 : grid_shape_.slots(), static_cast<int>(stride_));  // a part's by set_cuts()
  if (rows.parting) part_ = std::make_unique<WaterPart<Real>>(device, *rows.parting, tiling_.particles.own);
  surroundings_.barriers.place(device, case_walls_.thin_facets(), case_walls_.thin().free_edges, case_walls_.facets(), discretisation_);
  surroundings_.images = Buffer(device, image_values<Real>(images_));
  SphSolver::set_film({});
  drains_.set(device, {}, discretisation_.origin);
  damping_.set(device, case_, discretisation_.origin);
  if (owners_move) moving_walls_.emplace(device, walls_, moving_, centres_, layout, discretisation_);
  bind_kernels();
  set_wall_motions(at_start);
  if (!part_) upload_particles(layout);  // parts are given theirs by restore()
  schedule_ = rows.integrator(scene, this);
  schedule_.check();
  if (part_) part_->exchanges = schedule_.exchanges();
}

/// Images bring walls to others far from them.
template <class Real>
std::vector<WallElement> SphSolver<Real>::facing_pieces() const {
  if (ghosts_) return {};
  if (!images_.empty()) return case_walls_.pieces();
  std::vector<bool> moving = moving_;
  moving.resize(centres_.size(), false);
  return pieces_that_may_face(case_walls_.pieces(), moving, discretisation_.support);
}

/// Belts run from the start; all else stands.
template <class Real>
WallMotions SphSolver<Real>::motions_at_start() const {
  WallMotions motions;
  motions.owners.resize(centres_.size());
  for (std::size_t b = 0; b < case_.bodies.size() && b + 1 < motions.owners.size(); ++b)
    motions.owners[b + 1].surface_velocity = case_.bodies[b].surface_velocity;
  if (moving_frame_) motions.frame = FrameMotion{case_.gravity};
  return motions;
}

template <class Real>
void SphSolver<Real>::upload_parameters(const ParameterBlock& values) {
  surroundings_.parameters = compute::Buffer<char>(device_, values.bytes<Real>());
}

template <class Real>
void SphSolver<Real>::upload_particles(const Layout& layout) {
  std::vector<Real> state(state_.size(), Real(0));
  std::vector<std::uint32_t> id(stride_);
  for (int i = 0; i < count_; ++i) {
    id[i] = static_cast<std::uint32_t>(i);
    put_laid_out(state, stride_, i, layout);
  }
  state_.upload(state);
  id_.upload(id);
  kernels_.derive.launch(count_);
  sort();
}

template <class Real>
void SphSolver<Real>::put_laid_out(std::vector<Real>& state, Stride stride, int i, const Layout& layout) const {
  set_place(state, stride, i, layout.particles[i]);
  state[fields_.at(ParticleArray::state, "mass") * stride + i] = static_cast<Real>(case_.fluid.density * layout.volumes[i]);
  state[fields_.at(ParticleArray::state, "volume") * stride + i] = static_cast<Real>(layout.volumes[i]);
}

template <class Real>
void SphSolver<Real>::set_place(std::vector<Real>& state, Stride stride, int i, const Eigen::Vector3d& place) const {
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = place[axis] - discretisation_.origin[axis];
    const Real stored = static_cast<Real>(wanted);
    state[(first_.place + axis) * stride + i] = stored;
    if ((long_axes_ >> axis & 1) != 0) state[(first_.rest + axis) * stride + i] = static_cast<Real>(stored - wanted);
  }
}

template <class Real>
Eigen::Vector3d SphSolver<Real>::place_of(const std::vector<Real>& state, int i) const {
  Eigen::Vector3d place = discretisation_.origin;
  for (int axis = 0; axis < 3; ++axis) {
    place[axis] += state[(first_.place + axis) * stride_ + i];
    if ((long_axes_ >> axis & 1) != 0) place[axis] -= state[(first_.rest + axis) * stride_ + i];
  }
  return place;
}

template <class Real>
Eigen::Vector3d SphSolver<Real>::velocity_of(const std::vector<Real>& state, int i) const {
  Eigen::Vector3d velocity;
  for (int axis = 0; axis < 3; ++axis) velocity[axis] = state[(first_.velocity + axis) * stride_ + i];
  return velocity;
}

template <class Real>
void SphSolver<Real>::set_wall_motions(const WallMotions& motions) {
  place_walls(motions);
  if (options_.at("MOVING_WALLS") != 0 || std::none_of(motions.owners.begin(), motions.owners.end(), moves)) return;
  if (ghosts_) throw Error("numerics/walls/method is ghost, whose mirror images stand still: walls that move need boundary_integral.");
  options_["MOVING_WALLS"] = 1;
  bind_kernels();
}

template <class Real>
void SphSolver<Real>::place_walls(const WallMotions& motions) {
  std::vector<Real> values;
  const auto add = [&values](const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) values.push_back(static_cast<Real>(vector[axis]));
  };
  const FrameMotion frame = motions.frame.value_or(FrameMotion{case_.gravity});
  for (const Eigen::Vector3d& vector :
       {frame.gravity, frame.angular_velocity, frame.angular_acceleration, Eigen::Vector3d(frame.origin - discretisation_.origin)})
    add(vector);
  poses_.assign(centres_.size(), WallPose());
  for (std::size_t o = 0; o < centres_.size(); ++o) {
    const WallMotion& motion = motions.owners.at(o);
    poses_[o] = {centres_[o], centres_[o] + motion.displacement, motion.orientation.toRotationMatrix()};
    for (const Eigen::Vector3d& vector :
         {Eigen::Vector3d(poses_[o].place - discretisation_.origin), motion.velocity, motion.angular_velocity, motion.acceleration,
          motion.angular_acceleration, motion.surface_velocity})
      add(vector);
    for (const double value : friction_values(friction_of(case_, o))) values.push_back(static_cast<Real>(value));
  }
  surroundings_.motions.set(device_, values);
  fastest_wall_ = fastest_wall(boxes_, centres_, motions);
  wrenches_.set_poses(poses_);
  if (!moving_walls_) return;
  moving_walls_->place(walls_, poses_);
  place_barriers();
}

/// Thin plates that move.
template <class Real>
void SphSolver<Real>::place_barriers() {
  const std::vector<Facet>& plates = case_walls_.thin_facets();
  if (std::none_of(plates.begin(), plates.end(), [this](const Facet& plate) { return static_cast<bool>(moving_[plate.owner]); })) return;
  surroundings_.barriers.place(device_, moved(plates, poses_), moved(case_walls_.thin().free_edges, poses_),
                               moved(case_walls_.facets(), poses_), discretisation_);
}

template <class Real>
void SphSolver<Real>::set_film(const std::vector<FilmLump>& lumps) {
  surroundings_.film.set(device_, film_values<Real>(lumps, discretisation_));
}

template <class Real>
void SphSolver<Real>::sort() {
  if (part_) {
    sort_part();
    return;
  }
  add_waiting();
  surroundings_.grid.sort(count_);
  forget_gradients();
  std::swap(state_, half_);
  std::swap(id_, spare_id_);
  surroundings_.reach = static_cast<Real>(discretisation_.support);
}

template <class Real>
void SphSolver<Real>::widen_reach(double part, double speed) {
  constexpr double for_rounding = 1.0 + 1e-5;
  const double shift = shifts() ? field::shift_most * discretisation_.spacing : 0;
  surroundings_.reach = static_cast<Real>((discretisation_.support + part * (step_ * speed + shift)) * for_rounding);
}

template <class Real>
void SphSolver<Real>::load_walls(Slot state) {
  if (elements_) kernels_.loads[state].launch(walls_.count);  // a facet's pressure is that of the particle that feels it
}

template <class Real>
StepReport SphSolver<Real>::advance(WallMover* mover) {
  mover_ = mover;
  step_wrenches_.clear();
  load_lost_ = false;
  try {
    if (part_)
      run_with_exchanges();
    else
      schedule_.run();
  } catch (...) {
    mover_ = nullptr;
    throw;
  }
  mover_ = nullptr;
  StepReport report = watch();
  if (load_lost_ && report.valid()) throw Error("the force of the water on a body is not finite, though all of its particles are");
  return report;
}

template <class Real>
double SphSolver<Real>::shorten_step(double longest) {
  if (!(longest < step_)) return step_;
  const Real step = static_cast<Real>(longest);
  report_.memory().write(&step, sizeof step);  // its first value
  return step_ = step;
}

template <class Real>
StepReport SphSolver<Real>::watch() {
  longest_step_ = static_cast<Real>(std::min(time_step_limit_, Discretisation::wall_reach * discretisation_.spacing / fastest_wall_));
  const int in_part = count_;
  if (part_) set_count(part_->watched());
  kernels_.watch_chunks.launch(chunks_);
  kernels_.watch_groups.launch(groups_);
  kernels_.watch_total.launch(1);
  const std::vector<Real> values = report_.download();
  std::vector<int> counted(reports_.integer_count());
  std::memcpy(counted.data(), &values[reports_.integers()], counted.size() * sizeof(int));
  if (part_) {
    set_count(in_part);
    return watch_parts(values, counted);
  }
  const auto greatest = [&](const char* name) { return static_cast<double>(values[reports_.greatest(name)]); };
  const auto count = [&](const char* name) { return counted[reports_.integer(name)]; };
  StepReport report;
  report.time_step = step_ = values[0];
  report.greatest_speed = greatest_speed_ = greatest("speed");
  report.greatest_acceleration = greatest_acceleration_ = greatest("acceleration");
  report.not_finite = count("not_finite");
  report.outside = count("outside");
  report.too_fast = count("fast");
  report.guard_hits = count("guarded");
  guarded_.read(report.guard_hits > 0);
  report.shepard_bounded = count("bounded");
  report.let_in = std::exchange(masses_let_in_, {});
  const int with_those_that_leave = count_;
  set_count(count("particles"));
  report.left = find_left(with_those_that_leave);
  for (std::size_t k = common_reports().size(); k < reports_.rows().size(); ++k) {
    const ReportRow& row = reports_.rows()[k];
    report.more[row.name] = row.kind == ReportRow::Kind::greatest ? greatest(row.name.c_str()) : count(row.name.c_str());
  }
  if (report.not_finite + report.outside + report.too_fast > 0) describe_offender(report, count("offender"));
  return report;
}

template <class Real>
std::vector<LeftParticle> SphSolver<Real>::find_left(int before) const {
  std::vector<LeftParticle> left(before - count_);
  if (left.empty()) return left;
  const auto read = [&](const char* name) {
    std::vector<Real> values(left.size());
    state_.memory().read(values.data(), values.size() * sizeof(Real), index_of(name, count_) * sizeof(Real));
    return values;
  };
  std::vector<std::uint32_t> id(left.size());
  id_.memory().read(id.data(), id.size() * sizeof(std::uint32_t), count_ * sizeof(std::uint32_t));
  const std::vector<Real> mass = read("mass"), x = read("x"), y = read("y"), z = read("z");
  for (std::size_t k = 0; k < left.size(); ++k) left[k] = {id[k], mass[k], discretisation_.origin + Eigen::Vector3d(x[k], y[k], z[k])};
  std::sort(left.begin(), left.end(), [](const LeftParticle& a, const LeftParticle& b) { return a.id < b.id; });
  return left;
}

template <class Real>
void SphSolver<Real>::describe_offender(StepReport& report, int first) const {
  report.offender = first;
  report.offender_id = id_.download()[report.offender];
  const std::vector<Real> state = state_.download();
  report.offender_position = place_of(state, first);
  report.offender_velocity = velocity_of(state, first);
}

template class SphSolver<float>;
template class SphSolver<double>;

}  // namespace wavetank
