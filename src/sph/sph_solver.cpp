#include "sph_solver.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <sstream>

#include "tank_images.h"
#include "wavetank/common/error.h"
#include "wavetank/sph/kernel_sources.h"

namespace wavetank {
namespace {

bool moves(const WallMotion& motion) {
  return !(motion.velocity.isZero(0) && motion.angular_velocity.isZero(0) && motion.acceleration.isZero(0) &&
           motion.angular_acceleration.isZero(0) && motion.surface_velocity.isZero(0));
}

WallKind kind_of(const WallCase& walls) {
  if (walls.method == WallMethod::ghost || walls.elements == WallElements::facet) return WallKind::facets;
  return walls.elements == WallElements::semi_analytical ? WallKind::triangles : WallKind::rectangles;
}

// Of the spacing, how far a wall may move in a step: the guard looks a quarter of the spacing far.
constexpr double wall_reach = 0.2;

/// Something that what the guard takes can push.
bool anything_free(const Case& scene) {
  return scene.tank.motion == Motion::free ||
         std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyCase& body) { return body.motion == Motion::free; });
}

bool all_finite(const std::vector<WallWrench>& wrenches) {
  for (const WallWrench& wrench : wrenches)
    for (const Eigen::Vector3d& part : wrench)
      if (!part.allFinite()) return false;
  return true;
}

std::string build_options(const Case& scene, bool use_double, bool images, bool moving, bool moving_frame, bool thin) {
  const NumericsCase& n = scene.numerics;
  const ShepardFactor shepard = n.walls.method == WallMethod::ghost ? ShepardFactor::none : n.walls.shepard;
  std::ostringstream options;
  options << "-DDIMENSIONS=" << scene.dimensions << " -DUSE_DOUBLE=" << use_double
          << " -DDIFFUSION_FOURTAKAS=" << (n.density_diffusion == DensityDiffusion::fourtakas)
          << " -DDIFFUSION_ANTUONO=" << (n.density_diffusion == DensityDiffusion::antuono)
          << " -DVISCOSITY_MORRIS=" << (n.viscosity_model == ViscosityModel::morris) << " -DNO_SLIP=" << (n.walls.slip == Slip::no_slip)
          << " -DCOLE=" << (n.equation_of_state == EquationOfState::cole)
          << " -DCLAMP_PRESSURE=" << (n.negative_pressure == NegativePressure::clamped)
          << " -DFACETS=" << (kind_of(n.walls) == WallKind::facets) << " -DTRIANGLES=" << (kind_of(n.walls) == WallKind::triangles)
          << " -DGHOSTS=" << (n.walls.method == WallMethod::ghost) << " -DIMAGES=" << images << " -DMOVING_WALLS=" << moving
          << " -DMOVING_FRAME=" << moving_frame << " -DTHIN_WALLS=" << thin << " -DGUARD_IMPULSES=" << anything_free(scene)
          << " -DSHEPARD_GEOMETRIC=" << (shepard == ShepardFactor::geometric || shepard == ShepardFactor::monolithic)
          << " -DSHEPARD_MONOLITHIC=" << (shepard == ShepardFactor::monolithic)
          << " -DSHEPARD_VOLUMETRIC=" << (shepard == ShepardFactor::volumetric)
          << " -DRENORMALISE_DIVERGENCE=" << n.walls.renormalise_divergence;
  return options.str();
}

/// The images as neighbours.cl reads them.
template <class Real>
std::vector<Real> image_values(const std::vector<TankImage>& images) {
  std::vector<Real> values;
  const auto add = [&values](double value) { values.push_back(static_cast<Real>(value)); };
  const auto add_matrix = [&add](const Eigen::Matrix3d& matrix) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) add(matrix(row, column));
  };
  for (const TankImage& image : images) {
    add_matrix(image.matrix);
    for (int axis = 0; axis < 3; ++axis) add(image.offset[axis]);
    add_matrix(image.velocity_matrix);
    for (int axis = 0; axis < 3; ++axis) add(image.velocity_offset[axis]);
    for (const TankPlane& plane : image.seen_near) {
      for (int axis = 0; axis < 3; ++axis) add(plane.normal[axis]);
      add(plane.offset);
    }
    add(image.mirrored ? 1.0 : 0.0);
  }
  if (values.empty()) values.push_back(Real(0));
  return values;
}

Layout walls_and_lid(const Layout& layout) {
  Layout result;
  result.walls = layout.walls;
  result.facets = layout.facets;
  result.triangles = layout.triangles;
  result.lid = layout.lid;
  return result;
}

int padded(int count) { return (count + 15) / 16 * 16; }

}  // namespace

template <class Real>
struct SphSolver<Real>::DevicePoints final : PointSet {
  int count = 0;
  Buffer points;
  mutable Buffer results;
};

template <class Real>
SphSolver<Real>::SphSolver(const compute::Device& device, const Case& scene, const Layout& layout, const Discretisation& discretisation,
                           const std::vector<Eigen::Vector3d>& centres)
    : device_(device),
      case_(scene),
      discretisation_(discretisation),
      count_(static_cast<int>(layout.particles.size())),
      stride_(padded(count_)),
      chunks_((count_ + field::reduce_chunk - 1) / field::reduce_chunk),
      sources_(kernel_sources()),
      state_(device, static_cast<std::size_t>(field::state_count) * stride_),
      spare_(device, static_cast<std::size_t>(field::state_count) * stride_),
      half_(device, static_cast<std::size_t>(field::swept) * stride_),
      rates_(device, static_cast<std::size_t>(field::rate_count) * stride_),
      gradient_(device, scene.numerics.density_diffusion == DensityDiffusion::antuono ? 3 * static_cast<std::size_t>(stride_) : 0),
      id_(device, count_),
      spare_id_(device, count_),
      kind_(kind_of(scene.numerics.walls)),
      thin_(find_thin_parts(layout, scene.dimensions, discretisation.support)),
      closed_(walls_and_lid(layout)),
      walls_(make_walls(true, {})),
      motions_(device, field::frame_count + centres.size() * field::motion_count),
      motion_centres_(device, 3 * centres.size()),
      loads_(device, kind_ == WallKind::facets ? 1 : walls_.stride),
      wrench_totals_(device, centres.size() * field::wrench_count),
      regions_(device, centres.size() * field::region_count),
      time_step_(device, 3),
      watches_(device, static_cast<std::size_t>(chunks_) * field::watch_count),
      energy_parts_(device, static_cast<std::size_t>(chunks_) * field::energy_count),
      energy_total_(device, field::energy_count),
      guard_hits_(device, count_),
      guard_takers_(device, anything_free(scene) ? field::guard_owners * static_cast<std::size_t>(stride_) : 1),
      alarms_(device, static_cast<std::size_t>(chunks_) * field::alarm_count),
      alarm_(device, field::alarm_count),
      guard_lost_(device, anything_free(scene) ? 3 * field::guard_owners * static_cast<std::size_t>(stride_) : 1) {
  centres_ = centres;
  guard_gives_ = anything_free(scene);
  guard_impulses_.assign(guard_gives_ ? centres.size() * field::impulse_count : 0, 0.0);
  guard_parts_ = Buffer(device, guard_impulses_.size() * chunks_);
  guard_totals_ = Buffer(device, guard_impulses_.size());
  ghosts_ = scene.numerics.walls.method == WallMethod::ghost;
  elements_ = kind_ != WallKind::facets;
  for (std::size_t f = 0; f < layout.facets.size(); ++f)
    if (thin_.facets[f]) thin_facets_.push_back(layout.facets[f]);
  barriers_ = Barriers<Real>(device, thin_facets_, thin_.brims, discretisation_);
  const std::vector<TankImage> images = tank_images(case_, layout, discretisation_);
  images_ = Buffer(device, image_values<Real>(images));
  values_ = kernel_parameters<Real>(case_, layout, discretisation_, static_cast<int>(images.size()));
  upload_parameters(values_);
  moving_ = layout.moving;
  moving_.resize(centres.size(), false);
  moving_frame_ = scene.tank.motion != Motion::fixed;
  const bool moving = moving_frame_ || std::find(moving_.begin(), moving_.end(), true) != moving_.end();
  if (ghosts_ && moving)
    throw Error("numerics/walls/method is ghost, whose mirror images stand still: walls that move need boundary_integral.");
  options_ = build_options(scene, std::is_same_v<Real, double>, !images.empty(), moving, moving_frame_, thin_.thinnest.has_value());
  find_boxes(layout);
  if (std::find(moving_.begin(), moving_.end(), true) != moving_.end())
    moving_walls_.emplace(device, sources_, options_, walls_, moving_, centres_, discretisation_);
  grid_ = ParticleGrid(device, sources_, options_, discretisation.cells[0] * discretisation.cells[1] * discretisation.cells[2], count_);
  build_kernels();
  WallMotions motions;
  motions.owners.resize(centres.size());
  for (std::size_t b = 0; b < scene.bodies.size() && b + 1 < motions.owners.size(); ++b)
    motions.owners[b + 1].surface_velocity = scene.bodies[b].surface_velocity;
  if (moving_frame_) motions.frame = FrameMotion{scene.gravity};
  set_wall_motions(motions);
  upload_particles(layout);
  stages_ = symplectic();
}

template <class Real>
void SphSolver<Real>::find_boxes(const Layout& layout) {
  boxes_.assign(centres_.size(), Box{centres_[0], centres_[0]});
  std::vector<bool> found(centres_.size(), false);
  for (const Facet& facet : layout.facets) {
    Box& box = boxes_.at(facet.owner);
    for (const Eigen::Vector3d& corner : facet.corners) {
      box.min = found[facet.owner] ? Eigen::Vector3d(box.min.cwiseMin(corner)) : corner;
      box.max = found[facet.owner] ? Eigen::Vector3d(box.max.cwiseMax(corner)) : corner;
      found[facet.owner] = true;
    }
  }
}

template <class Real>
void SphSolver<Real>::find_fastest_wall(const WallMotions& motions) {
  fastest_wall_ = 0;
  for (std::size_t o = 1; o < centres_.size(); ++o) {
    const Eigen::Vector3d reach = (boxes_[o].max - centres_[o]).cwiseAbs().cwiseMax((boxes_[o].min - centres_[o]).cwiseAbs());
    const WallMotion& motion = motions.owners[o];
    fastest_wall_ = std::max(fastest_wall_, motion.velocity.norm() + motion.angular_velocity.norm() * reach.norm());
  }
}

/// Thin plates that move, which are few: made anew.
template <class Real>
void SphSolver<Real>::place_barriers() {
  const auto moves_with = [this](const Facet& facet) { return static_cast<bool>(moving_[facet.owner]); };
  if (std::none_of(thin_facets_.begin(), thin_facets_.end(), moves_with)) return;
  std::vector<Facet> facets = thin_facets_;
  for (Facet& facet : facets) {
    const WallPose& pose = poses_[facet.owner];
    for (Eigen::Vector3d& corner : facet.corners) corner = pose.of(corner);
    facet.normal = pose.rotation * facet.normal;
    facet.plane_point = pose.of(facet.plane_point);
  }
  std::vector<Brim> brims = thin_.brims;
  for (Brim& brim : brims) {
    const WallPose& pose = poses_[brim.owner];
    brim.from = pose.of(brim.from);
    brim.to = pose.of(brim.to);
    for (Eigen::Vector3d* vector : {&brim.face_normal, &brim.inwards, &brim.other_normal}) *vector = pose.rotation * *vector;
  }
  barriers_ = Barriers<Real>(device_, facets, brims, discretisation_);
}

template <class Real>
void SphSolver<Real>::upload_parameters(const KernelParameters<Real>& values) {
  std::vector<char> bytes(sizeof values);
  std::memcpy(bytes.data(), &values, sizeof values);
  parameters_ = compute::Buffer<char>(device_, bytes);
}

template <class Real>
WallArrays<Real> SphSolver<Real>::make_walls(bool own, const std::vector<WallElement>& lid) const {
  if (kind_ == WallKind::rectangles) {
    std::vector<WallElement> elements = closed_.walls;
    elements.insert(elements.end(), lid.begin(), lid.end());
    return WallArrays<Real>(device_, elements, thin_.walls, discretisation_);
  }
  std::vector<Facet> facets;
  if (own) facets = kind_ == WallKind::facets ? closed_.facets : closed_.triangles;
  for (const WallElement& element : lid) {
    const std::vector<Facet> parts = facets_of(element, case_.dimensions);
    facets.insert(facets.end(), parts.begin(), parts.end());
  }
  const std::vector<bool> none;
  const std::vector<bool>& thin = kind_ == WallKind::facets ? thin_.facets : thin_.triangles;
  return WallArrays<Real>(device_, facets, own ? thin : none, kind_, discretisation_);
}

template <class Real>
WallArrays<Real> SphSolver<Real>::make_supported_walls() const {
  std::vector<WallElement> lid;
  for (const WallElement& element : closed_.lid)
    if (element.normal.z() < 0.5) lid.push_back(element);
  if (ghosts_ && !lid.empty())
    throw Error(
        "numerics/packing/settling needs the tank's walls on all sides of the water where numerics/walls/method is ghost; "
        "set it to 0, or choose boundary_integral.");
  return make_walls(true, lid);
}

template <class Real>
void SphSolver<Real>::set_wall_motions(const WallMotions& motions) {
  place_walls(motions);
  bool moving = false;
  for (const WallMotion& motion : motions.owners) moving = moving || moves(motion);
  if (!moving || options_.find("-DMOVING_WALLS=0") == std::string::npos) return;
  if (ghosts_) throw Error("numerics/walls/method is ghost, whose mirror images stand still: walls that move need boundary_integral.");
  options_.replace(options_.find("-DMOVING_WALLS=0"), std::strlen("-DMOVING_WALLS=0"), "-DMOVING_WALLS=1");
  build_kernels();
}

template <class Real>
void SphSolver<Real>::place_walls(const WallMotions& motions) {
  std::vector<Real> values, centres;
  const auto add = [](std::vector<Real>& to, const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) to.push_back(static_cast<Real>(vector[axis]));
  };
  const FrameMotion frame = motions.frame.value_or(FrameMotion{case_.gravity});
  for (const Eigen::Vector3d& vector :
       {frame.gravity, frame.angular_velocity, frame.angular_acceleration, Eigen::Vector3d(frame.origin - discretisation_.origin)})
    add(values, vector);
  poses_.assign(centres_.size(), WallPose());
  for (std::size_t o = 0; o < centres_.size(); ++o) {
    const WallMotion& motion = motions.owners.at(o);
    poses_[o] = {centres_[o], centres_[o] + motion.displacement, motion.orientation.toRotationMatrix()};
    add(centres, poses_[o].place - discretisation_.origin);
    for (const Eigen::Vector3d& vector :
         {Eigen::Vector3d(poses_[o].place - discretisation_.origin), motion.velocity, motion.angular_velocity, motion.acceleration,
          motion.angular_acceleration, motion.surface_velocity})
      add(values, vector);
  }
  motions_.upload(values);
  motion_centres_.upload(centres);
  find_fastest_wall(motions);
  region_owners_.clear();
  if (!moving_walls_) return;
  moving_walls_->place(walls_, poses_);
  place_barriers();
}

template <class Real>
void SphSolver<Real>::build_kernels() {
  const std::string fast = options_ + " -cl-fast-relaxed-math";
  const auto kernel_of = [&](const char* file, const char* name, const std::string& options) {
    return compute::Program(device_, sources_, file, options).kernel(name);
  };
  continuity_kernel_ = kernel_of("continuity.cl", "continuity", fast);
  momentum_kernel_ = kernel_of("momentum.cl", "momentum", fast + " -DWALL_FORCES=0");
  forces_kernel_ = kernel_of("momentum.cl", "wall_forces", fast + " -DWALL_FORCES=1");
  gradient_kernel_ = kernel_of("density_gradient.cl", "density_gradient", fast);
  if (elements_) loads_kernel_ = kernel_of("wall_loads.cl", "wall_loads", fast);
  packing_kernel_ = kernel_of("packing.cl", "packing", fast);
  guard_kernel_ = kernel_of("guard.cl", "guard", options_);
  const compute::Program points(device_, sources_, "points.cl", fast);
  points_kernel_ = points.kernel("points");
  surface_kernel_ = points.kernel("surface");
  const compute::Program time(device_, sources_, "time_step.cl", options_);
  derive_ = time.kernel("derive_state");
  predict_ = time.kernel("predict");
  correct_ = time.kernel("correct");
  compress_ = time.kernel("compress");
  move_packed_ = time.kernel("move_packed");
  const compute::Program reduce(device_, sources_, "reduce.cl", options_);
  watch_chunks_ = reduce.kernel("watch_chunks");
  watch_total_ = reduce.kernel("watch_total");
  guard_chunks_ = reduce.kernel("guard_chunks");
  guard_sums_ = reduce.kernel("guard_totals");
  energy_chunks_ = reduce.kernel("energy_chunks");
  energy_sum_ = reduce.kernel("energy_total");
  wrench_sums_ = reduce.kernel("wrench_totals");
  packing_total_ = reduce.kernel("packing_total");
}

template <class Real>
void SphSolver<Real>::upload_particles(const Layout& layout) {
  std::vector<Real> state(state_.size(), Real(0));
  std::vector<std::uint32_t> id(count_);
  for (int i = 0; i < count_; ++i) {
    id[i] = static_cast<std::uint32_t>(i);
    const Eigen::Vector3d relative = layout.particles[i] - discretisation_.origin;
    for (int axis = 0; axis < 3; ++axis) state[static_cast<std::size_t>(field::x + axis) * stride_ + i] = static_cast<Real>(relative[axis]);
    state[static_cast<std::size_t>(field::mass) * stride_ + i] = static_cast<Real>(case_.fluid.density * layout.volumes[i]);
  }
  levels_ = layout.levels;
  state_.upload(state);
  id_.upload(id);
  derive_.launch(count_, parameters_, count_, state_, stride_);
  sort();
}

template <class Real>
void SphSolver<Real>::sort() {
  grid_.sort(parameters_, state_, spare_, stride_, id_, spare_id_);
}

template <class Real>
template <class... Others>
void SphSolver<Real>::sweep(const compute::Kernel& kernel, int count, const Buffer& state, const WallArrays<Real>& walls,
                            const Others&... others) {
  kernel.launch(count, parameters_, count, grid_.starts(), state, stride_, walls.starts, walls.list, walls.fields, walls.stride, motions_,
                barriers_.starts, barriers_.list, barriers_.planes, barriers_.brim_starts, barriers_.brim_list, barriers_.brims, images_,
                others...);
}

template <class Real>
void SphSolver<Real>::load_walls(const Buffer& state) {
  if (!elements_) return;  // a facet's pressure is that of the particle that feels it
  sweep(loads_kernel_, walls_.count, state, walls_, loads_);
}

template <class Real>
void SphSolver<Real>::find_compression_rates() {
  if (case_.numerics.density_diffusion == DensityDiffusion::antuono) sweep(gradient_kernel_, count_, state_, walls_, gradient_);
  sweep(continuity_kernel_, count_, state_, walls_, gradient_, rates_);
}

template <class Real>
void SphSolver<Real>::find_accelerations(const Buffer& state) {
  sweep(momentum_kernel_, count_, state, walls_, loads_, rates_);
}

template <class Real>
void SphSolver<Real>::guard() {
  sweep(guard_kernel_, count_, state_, walls_, rates_, half_, time_step_, guard_hits_, guard_takers_, guard_lost_);
  if (guard_gives_ && mover_ != nullptr) gather_guard_impulses();
}

template <class Real>
void SphSolver<Real>::gather_guard_impulses() {
  const int owners = static_cast<int>(centres_.size()), values = static_cast<int>(guard_impulses_.size());
  guard_chunks_.launch(chunks_, count_, state_, stride_, guard_hits_, guard_takers_, guard_lost_, owners, motion_centres_, guard_parts_);
  guard_sums_.launch(values, values, chunks_, guard_parts_, guard_totals_);
  const std::vector<Real> totals = guard_totals_.download();
  std::copy(totals.begin(), totals.end(), guard_impulses_.begin());
}

template <class Real>
std::vector<WallWrench> SphSolver<Real>::wrenches_in_step() {
  const std::vector<int> owners = mover_->coupled();
  std::vector<WallWrench> wrenches = wrenches_at(half_, owners);
  for (std::size_t k = 0; guard_gives_ && k < owners.size(); ++k) {
    const double* impulse = &guard_impulses_[owners[k] * field::impulse_count];
    wrenches[k][0] += Eigen::Vector3d(impulse) / step_;
    wrenches[k][2] += Eigen::Vector3d(impulse + 3) / step_;
  }
  return wrenches;
}

template <class Real>
std::vector<Stage> SphSolver<Real>::symplectic() {
  return {
      {"drift to the middle", [this] { predict_.launch(count_, parameters_, count_, state_, half_, stride_, rates_, time_step_); }},
      {"walls to the middle",
       [this] {
         if (mover_ != nullptr) place_walls(mover_->to_middle(step_));
       }},
      {"wall pressures", [this] { load_walls(half_); }},
      {"accelerations", [this] { find_accelerations(half_); }},
      {"walls to the end",
       [this] {
         if (mover_ == nullptr) return;
         const std::vector<WallWrench> wrenches = wrenches_in_step();
         load_lost_ = !all_finite(wrenches);
         if (!load_lost_) place_walls(mover_->to_end(step_, wrenches));
       }},
      {"kick, and drift to the end", [this] { correct_.launch(count_, parameters_, count_, state_, half_, stride_, rates_, time_step_); }},
      {"guard", [this] { guard(); }},
      {"neighbour grid", [this] { sort(); }},
      {"compression rates", [this] { find_compression_rates(); }},
      {"compressions to the end", [this] { compress_.launch(count_, parameters_, count_, state_, stride_, rates_, time_step_); }},
  };
}

template <class Real>
StepReport SphSolver<Real>::advance(WallMover* mover) {
  mover_ = mover;
  load_lost_ = false;
  if (mover != nullptr) step_ = time_step_.download()[0];
  try {
    for (const Stage& stage : stages_) stage.run();
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
StepReport SphSolver<Real>::watch() {
  watch_chunks_.launch(chunks_, parameters_, count_, state_, rates_, stride_, guard_hits_, watches_, alarms_);
  watch_total_.launch(1, parameters_, chunks_, watches_, alarms_, time_step_, alarm_);
  std::vector<Real> step = time_step_.download();
  const double limit = std::min(time_step_limit_, wall_reach * discretisation_.spacing / fastest_wall_);
  if (step[0] > static_cast<Real>(limit)) {
    step[0] = static_cast<Real>(limit);
    time_step_.upload(step);
  }
  const std::vector<int> alarm = alarm_.download();
  StepReport report;
  report.time_step = step[0];
  report.greatest_speed = step[1];
  report.greatest_acceleration = step[2];
  report.not_finite = alarm[field::alarm_not_finite];
  report.outside = alarm[field::alarm_outside];
  report.too_fast = alarm[field::alarm_fast];
  report.guard_hits = alarm[field::alarm_guard];
  report.shepard_bounded = alarm[field::alarm_shepard];
  if (report.not_finite + report.outside + report.too_fast > 0) {
    report.offender = alarm[field::alarm_first];
    report.offender_id = id_.download()[report.offender];
    const std::vector<Real> state = state_.download();
    for (int axis = 0; axis < 3; ++axis) {
      report.offender_position[axis] =
          state[static_cast<std::size_t>(field::x + axis) * stride_ + report.offender] + discretisation_.origin[axis];
      report.offender_velocity[axis] = state[static_cast<std::size_t>(field::u + axis) * stride_ + report.offender];
    }
  }
  return report;
}

template <class Real>
StepReport SphSolver<Real>::start() {
  set_hydrostatic();
  return start_at_rest();
}

template <class Real>
void SphSolver<Real>::set_hydrostatic() {
  // below the free surface that the particle was filled under, along the gravity's vertical component
  std::vector<Real> state = state_.download();
  const std::vector<std::uint32_t> id = id_.download();
  const double c2 = discretisation_.sound_speed * discretisation_.sound_speed;
  const double g = -case_.gravity.z();
  for (int i = 0; i < count_; ++i) {
    const double z = state[static_cast<std::size_t>(field::z) * stride_ + i] + discretisation_.origin.z();
    const double head = g * std::max(levels_[id[i]] - z, 0.0) / c2;  // p/(ρ₀c₀²)
    const double compression =
        case_.numerics.equation_of_state == EquationOfState::cole ? std::pow(1.0 + 7.0 * head, 1.0 / 7.0) - 1.0 : head;
    state[static_cast<std::size_t>(field::compression) * stride_ + i] = static_cast<Real>(compression);
  }
  state_.upload(state);
}

template <class Real>
StepReport SphSolver<Real>::start_at_rest() {
  std::vector<Real> state = state_.download();
  for (const int f : {field::u, field::v, field::w, field::rest_x, field::rest_y, field::rest_z})
    std::fill_n(state.begin() + static_cast<std::ptrdiff_t>(f) * stride_, stride_, Real(0));
  state_.upload(state);
  derive_.launch(count_, parameters_, count_, state_, stride_);
  load_walls(state_);
  find_accelerations(state_);
  find_compression_rates();
  guard_hits_.fill_zero();
  std::fill(guard_impulses_.begin(), guard_impulses_.end(), 0.0);
  return watch();
}

template <class Real>
StepReport SphSolver<Real>::settle(double periods, const std::function<void(double)>& progress) {
  StepReport report = start();
  const double duration = periods * discretisation_.sound_period;
  if (duration == 0) return report;
  WallArrays<Real> supported = make_supported_walls();

  KernelParameters<Real> damped = values_;
  damped.damping = static_cast<Real>(4.0 * std::acos(-1.0) / discretisation_.sound_period);
  damped.gravity_x = damped.gravity_y = damped.hydrostatic_x = damped.hydrostatic_y = Real(0);
  const std::vector<Real> moving = motions_.download();
  std::vector<Real> still = moving;
  for (int k = 0; k < 9; ++k) still[k] = k == 2 ? damped.gravity_z : Real(0);  // of the frame
  for (std::size_t k = field::frame_count; k < still.size(); ++k)
    if ((k - field::frame_count) % field::motion_count >= 3) still[k] = Real(0);
  upload_parameters(damped);
  motions_.upload(still);
  std::swap(walls_, supported);
  Buffer loads(device_, elements_ ? walls_.stride : 1);
  std::swap(loads_, loads);
  const auto end_settling = [&] {
    std::swap(loads_, loads);
    std::swap(walls_, supported);
    motions_.upload(moving);
    upload_parameters(values_);
  };
  const auto may_go_on = [&] { return report.valid() && report.time_step >= discretisation_.least_time_step; };
  try {
    report = start_at_rest();
    for (double time = 0; time < duration && may_go_on();) {
      time += report.time_step;
      report = advance(nullptr);
      if (progress) progress(std::min(time / duration, 1.0));
    }
  } catch (...) {
    end_settling();
    throw;
  }
  end_settling();
  return may_go_on() ? start_at_rest() : report;
}

template <class Real>
PackingReport SphSolver<Real>::pack(int iterations, const std::function<void(double)>& progress) {
  PackingReport report;
  const WallArrays<Real> closed = make_walls(!ghosts_, closed_.lid);  // the ghosts themselves are the walls
  const WallArrays<Real> of_guard = ghosts_ ? make_walls(true, closed_.lid) : WallArrays<Real>();
  const WallArrays<Real>& guarded = ghosts_ ? of_guard : closed;
  Buffer total(device_, 2);
  const int report_interval = 10;
  for (int k = 0; k <= iterations; ++k) {
    sweep(packing_kernel_, count_, state_, closed, rates_);
    if (k % report_interval == 0 || k == iterations) {
      packing_total_.launch(1, count_, rates_, stride_, total);
      report.last_error = total.download()[0];
      if (k == 0) report.first_error = report.last_error;
      if (progress) progress(iterations == 0 ? 1.0 : static_cast<double>(k) / iterations);
    }
    report.iterations = k;
    if (k == iterations) break;
    move_packed_.launch(count_, parameters_, count_, state_, half_, stride_, rates_);
    sweep(guard_kernel_, count_, state_, guarded, rates_, half_, time_step_, guard_hits_, guard_takers_, guard_lost_);
    sort();
  }
  return report;
}

template <class Real>
std::unique_ptr<PointSet> SphSolver<Real>::make_points(const std::vector<Eigen::Vector3d>& points) const {
  auto set = std::make_unique<DevicePoints>();
  set->count = static_cast<int>(points.size());
  std::vector<Real> values(points.size() * 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      values[axis * points.size() + i] = static_cast<Real>(points[i][axis] - discretisation_.origin[axis]);
  set->points = Buffer(device_, values);
  set->results = Buffer(device_, values.size());
  return set;
}

template <class Real>
std::vector<PointValue> SphSolver<Real>::evaluate(const PointSet& set) {
  const auto& points = dynamic_cast<const DevicePoints&>(set);
  sweep(points_kernel_, points.count, state_, walls_, points.points, points.results);
  const std::vector<Real> results = points.results.download();
  std::vector<PointValue> values(points.count);
  for (int i = 0; i < points.count; ++i) values[i] = {results[i], results[points.count + i], results[2 * points.count + i]};
  return values;
}

template <class Real>
std::vector<WallWrench> SphSolver<Real>::wrenches() {
  load_walls(state_);  // at this instant; the step found its own in its middle
  std::vector<int> owners(centres_.size());
  std::iota(owners.begin(), owners.end(), 0);
  return wrenches_at(state_, owners);
}

/// The cells in which particles may touch each owner's walls where they are now, as common.cl has regions.
template <class Real>
void SphSolver<Real>::find_regions(const std::vector<int>& owners) {
  std::vector<int> values;
  region_items_ = 0;
  const Discretisation& d = discretisation_;
  const double margin = d.support + 0.25 * d.spacing;  // particles have moved by less since they were sorted
  for (const int owner : owners) {
    int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    Box now{Eigen::Vector3d::Constant(std::numeric_limits<double>::max()),
            Eigen::Vector3d::Constant(std::numeric_limits<double>::lowest())};
    for (int k = 0; k < 8; ++k) {
      const Box& box = boxes_[owner];
      const Eigen::Vector3d corner =
          poses_[owner].of({k & 1 ? box.max.x() : box.min.x(), k & 2 ? box.max.y() : box.min.y(), k & 4 ? box.max.z() : box.min.z()});
      now.min = now.min.cwiseMin(corner);
      now.max = now.max.cwiseMax(corner);
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (d.cells[axis] == 1) continue;
      const auto at = [&](double place) {
        const double cell = std::floor((place - d.origin[axis]) / d.support) + 1;
        return static_cast<int>(std::clamp(cell, 1.0, d.cells[axis] - 2.0));
      };
      // images and ghosts bring an owner's walls to particles far from it
      const bool everywhere = images_.size() > 1;
      low[axis] = everywhere ? 1 : at(now.min[axis] - margin);
      high[axis] = everywhere ? d.cells[axis] - 2 : at(now.max[axis] + margin);
    }
    const int runs = (high[0] - low[0]) / field::region_run + 1, rows = high[1] - low[1] + 1;
    for (const int value : {owner, region_items_, low[0], low[1], low[2], high[0] + 1, runs, rows}) values.push_back(value);
    region_items_ += runs * rows * (high[2] - low[2] + 1);
  }
  regions_.upload(values);
  const std::size_t parts = static_cast<std::size_t>(region_items_) * field::wrench_count;
  if (wrench_parts_.size() < parts) wrench_parts_ = Buffer(device_, 2 * parts);
  region_owners_ = owners;
}

template <class Real>
std::vector<WallWrench> SphSolver<Real>::wrenches_at(const Buffer& state, const std::vector<int>& owners) {
  if (owners.empty()) return {};
  if (region_owners_ != owners) find_regions(owners);
  const int regions = static_cast<int>(owners.size());
  sweep(forces_kernel_, region_items_, state, walls_, loads_, regions, regions_, motion_centres_, wrench_parts_);
  wrench_sums_.launch(regions, regions, region_items_, regions_, wrench_parts_, wrench_totals_);
  const std::vector<Real> totals = wrench_totals_.download();
  std::vector<WallWrench> result(owners.size());
  for (std::size_t k = 0; k < owners.size(); ++k)
    for (int part = 0; part < 4; ++part)
      for (int axis = 0; axis < 3; ++axis) result[k][part][axis] = totals[k * field::wrench_count + 3 * part + axis];
  return result;
}

template <class Real>
FluidEnergies SphSolver<Real>::energies() {
  energy_chunks_.launch(chunks_, parameters_, count_, state_, stride_, energy_parts_);
  energy_sum_.launch(1, chunks_, energy_parts_, energy_total_);
  const std::vector<Real> total = energy_total_.download();
  FluidEnergies energies{total[0], total[1], total[2], total[3], discretisation_.origin};
  if (energies.mass > 0) energies.mass_centre += Eigen::Vector3d(total[4], total[5], total[6]) / energies.mass;
  // from the grid's origin to the tank's floor
  const Eigen::Vector3d floor = discretisation_.lower + Eigen::Vector3d::Constant(0.5 * discretisation_.spacing) - discretisation_.origin;
  energies.potential += energies.mass * case_.gravity.z() * floor.z();
  return energies;
}

template <class Real>
FluidState SphSolver<Real>::download() {
  const std::vector<Real> state = state_.download();
  Buffer results(device_, 2 * static_cast<std::size_t>(stride_));
  sweep(surface_kernel_, count_, state_, walls_, results);
  const std::vector<Real> surface = results.download();
  FluidState fluid;
  fluid.id = id_.download();
  const auto value = [&](int f, int i) { return static_cast<double>(state[static_cast<std::size_t>(f) * stride_ + i]); };
  for (int i = 0; i < count_; ++i) {
    fluid.position.push_back(Eigen::Vector3d(value(field::x, i), value(field::y, i), value(field::z, i)) + discretisation_.origin);
    fluid.velocity.emplace_back(value(field::u, i), value(field::v, i), value(field::w, i));
    fluid.pressure.push_back(value(field::pressure, i));
    fluid.compression.push_back(value(field::compression, i));
    fluid.mass.push_back(value(field::mass, i));
    fluid.surface.push_back(surface[i] > Real(0.5) ? 1 : 0);
    fluid.shepard.push_back(surface[stride_ + i]);
  }
  return fluid;
}

template <class Real>
std::vector<char> SphSolver<Real>::save() const {
  const std::vector<Real> state = state_.download();
  const std::vector<Real> rates = rates_.download();
  const std::vector<Real> step = time_step_.download();
  const std::vector<std::uint32_t> id = id_.download();
  std::vector<char> bytes;
  const auto append = [&](const void* from, std::size_t size) {
    const char* begin = static_cast<const char*>(from);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  append(state.data(), state.size() * sizeof(Real));
  append(&rates[static_cast<std::size_t>(field::rate_compression) * stride_], stride_ * sizeof(Real));  // the next drift begins with these
  append(step.data(), step.size() * sizeof(Real));
  const std::vector<double> listed = moving_walls_ ? moving_walls_->listed() : std::vector<double>();
  append(listed.data(), listed.size() * sizeof(double));
  append(guard_impulses_.data(), guard_impulses_.size() * sizeof(double));
  append(id.data(), id.size() * sizeof(std::uint32_t));
  return bytes;
}

template <class Real>
void SphSolver<Real>::restore(const std::vector<char>& bytes) {
  std::vector<Real> state(state_.size()), rates(rates_.size(), Real(0)), step(time_step_.size());
  std::vector<std::uint32_t> id(count_);
  std::vector<double> listed = moving_walls_ ? moving_walls_->listed() : std::vector<double>();
  const std::size_t expected = (state.size() + stride_ + step.size()) * sizeof(Real) + id.size() * sizeof(std::uint32_t) +
                               (listed.size() + guard_impulses_.size()) * sizeof(double);
  if (bytes.size() != expected)
    throw Error("the snapshot's fluid has " + std::to_string(bytes.size()) + " bytes, but this case's has " + std::to_string(expected) +
                ".");
  const char* next = bytes.data();
  const auto take = [&](void* to, std::size_t size) {
    std::memcpy(to, next, size);
    next += size;
  };
  take(state.data(), state.size() * sizeof(Real));
  take(&rates[static_cast<std::size_t>(field::rate_compression) * stride_], stride_ * sizeof(Real));
  take(step.data(), step.size() * sizeof(Real));
  take(listed.data(), listed.size() * sizeof(double));
  take(guard_impulses_.data(), guard_impulses_.size() * sizeof(double));
  take(id.data(), id.size() * sizeof(std::uint32_t));
  if (moving_walls_) moving_walls_->list_for(walls_, listed);
  state_.upload(state);
  rates_.upload(rates);
  time_step_.upload(step);
  id_.upload(id);
  sort();  // already sorted, so this changes nothing but finds the cells
}

template class SphSolver<float>;
template class SphSolver<double>;

}  // namespace wavetank
