// Water in parts on several devices has the bits of water in one part, whatever the cuts.
#include "wavetank/sph/parted_solver.h"

#include "../common/error_of.h"
#include "sph_fixture.h"

namespace wavetank::parted_solver_test {
namespace {

/// Water that runs out along a tank, over a step.
Case running_out(int dimensions, double spacing) {
  const double across = dimensions == 3 ? 0.36 : 0;
  Case scene = box_case(Vector3d(1.2, across, 0.8), 0.4, spacing);
  scene.dimensions = dimensions;
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.5, across, 0.4)}};
  scene.numerics.artificial_viscosity = 0.05;
  return scene;
}

Case running_out(int dimensions) { return running_out(dimensions, dimensions == 3 ? 0.04 : 0.02); }

struct PartedTank {
  PartedTank(const Case& checked, int parts, const PartedSolverOptions& options = {})
      : layout(lay_out(checked)), scene(settled(checked, layout)), discretisation(discretise(scene, layout)) {
    for (int k = 0; k < parts; ++k) devices.emplace_back(test_device().info());
    std::vector<Vector3d> centres(1, Vector3d::Zero());
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
      const Box box = layout.meshes[b + 1].bounding_box();
      centres.push_back(0.5 * (box.min + box.max));
    }
    solver = make_parted_solver(devices, scene, layout, discretisation, centres, options);
    solver->pack(10, {});
    solver->start();
  }
  /// False when a step is in violation.
  bool run(int steps, WallMover* mover = nullptr) {
    for (int k = 0; k < steps; ++k)
      if (!solver->advance(mover).valid()) return false;
    return true;
  }

  Layout layout;
  Case scene;
  Discretisation discretisation;
  std::vector<compute::Device> devices;
  std::unique_ptr<Solver> solver;
};

/// Bodies that the water's own forces move and turn, as if each had this mass and a radius of gyration of 0.1 m, in a tank that is shaken.
class Afloat final : public WallMover {
 public:
  Afloat(std::size_t bodies, double mass, const Vector3d& shake) : mass_(mass), shake_(shake) {
    now_.owners.resize(1 + bodies);
    if (!shake.isZero()) now_.frame = FrameMotion{Vector3d(0, 0, -9.81)};
  }

  std::vector<int> coupled() const override {
    std::vector<int> all;
    for (std::size_t body = 1; body < now_.owners.size(); ++body) all.push_back(static_cast<int>(body));
    return all;
  }
  WallMotions at(double time_step, double fraction) override {
    WallMotions there = now_;
    for (WallMotion& body : there.owners) body.displacement += fraction * time_step * body.velocity;
    return there;
  }
  WallMotions to_end(double time_step, const std::vector<WallWrench>& wrenches) override {
    for (std::size_t k = 0; k < wrenches.size(); ++k) {
      WallMotion& body = now_.owners[1 + k];
      body.acceleration = (wrenches[k][0] + wrenches[k][1]) / mass_ + Vector3d(0, 0, -9.81);
      body.velocity += time_step * body.acceleration;
      body.displacement += time_step * body.velocity;
      body.angular_velocity += time_step * (wrenches[k][2] + wrenches[k][3]) / (mass_ * 0.01);
      const Vector3d turn = time_step * body.angular_velocity;
      if (turn.norm() > 0) body.orientation = (Eigen::AngleAxisd(turn.norm(), turn.normalized()) * body.orientation).normalized();
    }
    ++step_;
    if (now_.frame) now_.frame->gravity = Vector3d(0, 0, -9.81) + std::sin(0.1 * step_) * shake_;
    return now_;
  }
  const WallMotion& body(std::size_t k) const { return now_.owners[1 + k]; }

 private:
  double mass_;
  Vector3d shake_;
  WallMotions now_;
  int step_ = 0;
};

/// What is left of the water and of the bodies in it, as bytes.
std::vector<char> afloat_after(const Case& scene, int parts, int steps, double mass, const Vector3d& shake,
                               const PartedSolverOptions& options = {}) {
  PartedTank tank(scene, parts, options);
  Afloat bodies(scene.bodies.size(), mass, shake);
  EXPECT_TRUE(tank.run(steps, &bodies));
  EXPECT_GT(bodies.body(0).displacement.norm(), 0.1 * *scene.fluid.spacing) << "nothing has moved";
  std::vector<char> state = tank.solver->save();
  for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
    const WallMotion& body = bodies.body(k);
    const double numbers[] = {body.displacement.x(), body.displacement.y(), body.displacement.z(), body.orientation.x(),
                              body.orientation.y(),  body.orientation.z(),  body.orientation.w()};
    state.insert(state.end(), reinterpret_cast<const char*>(numbers), reinterpret_cast<const char*>(numbers + 7));
  }
  const std::vector<WallWrench> wrenches = tank.solver->wrenches();
  const char* const first = reinterpret_cast<const char*>(wrenches.data());
  state.insert(state.end(), first, first + wrenches.size() * sizeof(WallWrench));
  return state;
}

BodyCase afloat(const std::string& name, const Box& box) {
  BodyCase body;
  body.name = name;
  body.shape = box;
  body.motion = Motion::free;
  return body;
}

std::vector<char> state_after(const Case& scene, int parts, int steps, const PartedSolverOptions& options = {}) {
  PartedTank tank(scene, parts, options);
  EXPECT_TRUE(tank.run(steps));
  return tank.solver->save();
}

PartedSolverOptions spoiled() {
  PartedSolverOptions options;
  options.spoils = true;
  return options;
}

/// After so many steps in one part and in others, whose halos are no numbers until they are sent.
void expect_same_bits(const Case& scene, int steps, const std::vector<int>& parts = {2, 3}) {
  const std::vector<char> one = state_after(scene, 1, steps);
  for (const int count : parts) EXPECT_TRUE(state_after(scene, count, steps, spoiled()) == one) << count << " parts";
}

TEST(PartedSolver, HasTheSameBitsForAnyNumberOfParts) { expect_same_bits(running_out(2), 200); }

/// Longest along y, across which rows are cut.
TEST(PartedSolver, AlsoIn3D) {
  Case scene = running_out(3);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.36, 0.5, 0.4)}};
  scene.tank.shape = BoxTank{Vector3d(0.36, 1.2, 0.8), Vector3d::Zero(), false};
  expect_same_bits(scene, 30, {3});
}

/// A thin plate in the water's way, a belt, and water that is damped.
TEST(PartedSolver, AlsoWithBodies) {
  Case scene = running_out(2, 0.04);
  scene.bodies.resize(2);
  scene.bodies[0].name = "plate";
  scene.bodies[0].shape = Box{Vector3d(0.7, 0, 0), Vector3d(0.72, 0, 0.2)};
  scene.bodies[1].name = "belt";
  scene.bodies[1].shape = Box{Vector3d(0.9, 0, 0.1), Vector3d(1.1, 0, 0.2)};
  scene.bodies[1].surface_velocity = Vector3d(0.5, 0, 0);
  DampingCase damping;
  damping.box = Box{Vector3d(0, 0, 0), Vector3d(0.6, 0, 0.8)};
  damping.strength = 10;
  scene.fluid.damping = {damping};
  expect_same_bits(scene, 150, {2});
}

/// What sweeps ask of each other's results is exchanged, whatever the case has chosen.
TEST(PartedSolver, AlsoByOtherMethods) {
  Case scene = running_out(2, 0.04);
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.density_diffusion = DensityDiffusion::antuono;
  scene.numerics.shifting = Shifting::sun;
  expect_same_bits(scene, 60, {2});
}

TEST(PartedSolver, AlsoByRiemannProblemsInDoublePrecision) {
  Case scene = running_out(2, 0.04);
  scene.numerics.integrator = Integrator::predictor_corrector;
  scene.numerics.scheme = Scheme::riemann_parshikov;
  if (has_precision(Precision::double_)) scene.numerics.precision = Precision::double_;
  expect_same_bits(scene, 60, {2});
}

/// Two bodies beside the cut and over it, with a gap of half a spacing between them.
Case two_afloat() {
  Case scene = running_out(2, 0.04);
  scene.tank.motion = Motion::commanded;
  scene.bodies = {afloat("left", Box{Vector3d(0.16, 0, 0.2), Vector3d(0.32, 0, 0.44)}),
                  afloat("right", Box{Vector3d(0.34, 0, 0.2), Vector3d(0.46, 0, 0.44)})};
  return scene;
}

/// In a tank that is shaken along.
TEST(PartedSolver, AlsoWithBodiesThatTheWaterMoves) {
  Case scene = two_afloat();
  const Vector3d shake(2, 0, 0);
  const std::vector<char> one = afloat_after(scene, 1, 120, 30, shake);
  EXPECT_TRUE(afloat_after(scene, 2, 120, 30, shake, spoiled()) == one);
  PartedSolverOptions options = spoiled();
  options.cut_every = 5;
  options.uneven = 1;
  EXPECT_TRUE(afloat_after(scene, 2, 120, 30, shake, options) == one) << "cut anew";
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.scheme = Scheme::riemann_parshikov;
  EXPECT_TRUE(afloat_after(scene, 2, 40, 30, shake, spoiled()) == afloat_after(scene, 1, 40, 30, shake)) << "another scheme";
}

/// Across rows, over the corner of the water.
TEST(PartedSolver, AlsoWithABodyIn3D) {
  Case scene = running_out(3);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.36, 0.5, 0.4)}};
  scene.tank.shape = BoxTank{Vector3d(0.36, 1.2, 0.8), Vector3d::Zero(), false};
  scene.bodies = {afloat("box", Box{Vector3d(0.08, 0.3, 0.24), Vector3d(0.24, 0.56, 0.44)})};
  EXPECT_TRUE(afloat_after(scene, 3, 45, 4, Vector3d::Zero(), spoiled()) == afloat_after(scene, 1, 45, 4, Vector3d::Zero()));
}

/// Elements have pressures of their own, from particles twice as far away.
TEST(PartedSolver, AlsoByOtherWalls) {
  Case scene = running_out(2);
  scene.numerics.walls.elements = WallElements::numerical;
  expect_same_bits(scene, 60, {2});
  scene.fluid.spacing = 0.04;
  scene.numerics.walls.method = WallMethod::ghost;
  expect_same_bits(scene, 60, {2});
}

/// Volumes that follow what moves the particles, with gradients and rates found anew before a step.
TEST(PartedSolver, AlsoWhereVolumesEvolve) {
  Case scene = running_out(2, 0.04);
  scene.numerics.scheme = Scheme::riemann_ale;
  scene.numerics.shifting = Shifting::michel;
  expect_same_bits(scene, 60, {2});
}

TEST(PartedSolver, AlsoByLeastSquares) {
  Case scene = running_out(2, 0.04);
  scene.numerics.gradients = Gradients::mls_corrected;
  scene.numerics.integrator = Integrator::predictor_corrector;
  expect_same_bits(scene, 60, {2});
  scene.numerics.gradients = Gradients::mls;
  scene.numerics.mls.pressure = MlsPressure::adjoint;
  scene.numerics.walls.method = WallMethod::ghost;
  expect_same_bits(scene, 60, {2});
}

/// Beyond its last part the first follows; of two, either has the other on both sides. The grid is longer than the tank by most of a
/// support.
TEST(PartedSolver, AlsoInAPeriodicTank) {
  Case scene = box_case(Vector3d(1.6, 0, 0.4), 0.3, 0.02);
  scene.gravity = Vector3d(3, 0, -9.81);
  scene.tank.periodic = {true, false, false};
  expect_same_bits(scene, 150, {2, 3});
  PartedSolverOptions options = spoiled();
  options.cut_every = 7;
  options.uneven = 1;
  EXPECT_TRUE(state_after(scene, 2, 50, options) == state_after(scene, 1, 50));
}

/// A ring of rows.
TEST(PartedSolver, AlsoInATankThatIsPeriodicAcrossRows) {
  Case scene = box_case(Vector3d(0.28, 2.4, 0.4), 0.2, 0.04);
  scene.gravity = Vector3d(0, 3, -9.81);
  scene.tank.periodic = {false, true, false};
  expect_same_bits(scene, 25, {3});
}

std::vector<double> readings(Solver& solver, const PointSet& points) {
  std::vector<double> numbers;
  const auto add = [&numbers](const Vector3d& vector) { numbers.insert(numbers.end(), vector.data(), vector.data() + 3); };
  for (const PointValue& value : solver.evaluate(points)) {
    numbers.insert(numbers.end(), {value.pressure, value.filling, value.shepard});
    add(value.velocity);
  }
  for (const WallWrench& wrench : solver.wrenches())
    for (const Vector3d& part : wrench) add(part);
  const FluidEnergies energies = solver.energies();
  numbers.insert(numbers.end(), {energies.kinetic, energies.potential, energies.compression, energies.mass});
  add(energies.mass_centre);
  const LostVolume volume = solver.lost_volume();
  numbers.insert(numbers.end(), {volume.lost, volume.whole});
  add(volume.place);
  numbers.push_back(static_cast<double>(solver.count_pairs().pairs));
  const FluidState fluid = solver.download();
  numbers.insert(numbers.end(), fluid.id.begin(), fluid.id.end());
  for (const Vector3d& place : fluid.position) add(place);
  const FluidSurface surface = solver.find_surface();
  numbers.insert(numbers.end(), surface.on_surface.begin(), surface.on_surface.end());
  numbers.insert(numbers.end(), surface.eigenvalue.begin(), surface.eigenvalue.end());
  return numbers;
}

/// Rows of particles that come in above the water, over the cut, and a drain at the tank's end.
TEST(PartedSolver, AlsoWhereWaterComesAndGoes) {
  Case scene = running_out(2);
  const auto run = [&scene](int parts, const PartedSolverOptions& options) {
    PartedTank tank(scene, parts, options);
    tank.solver->set_drains({{Vector3d(0.9, 0, 0.2), Vector3d(0.3, 1, 0.4).asDiagonal()}});
    std::size_t came = 0, left = 0;
    std::vector<std::uint32_t> who;
    for (int step = 0; step < 400; ++step) {
      NewParticles row;  // so many that every part needs more room, at other times
      for (int k = 0; step % 20 == 0 && k < 36; ++k) {
        row.position.emplace_back(0.03 + 0.02 * k, 0, 0.6);
        row.velocity.emplace_back(0, 0, -2);
        row.volume.push_back(4e-4);
        row.pressure.push_back(0);
      }
      tank.solver->let_in(row);
      const StepReport report = tank.solver->advance();
      EXPECT_TRUE(report.valid());
      came += report.let_in.size();
      left += report.left.size();
      for (const LeftParticle& one : report.left) who.push_back(one.id);
    }
    EXPECT_EQ(tank.solver->particle_count(), tank.layout.particles.size() + came - left);
    EXPECT_EQ(came, 720u);
    EXPECT_GT(left, 10u);
    return std::make_pair(who, tank.solver->save());
  };
  const auto one = run(1, {});
  for (const int parts : {2, 3}) {
    const auto several = run(parts, spoiled());
    EXPECT_TRUE(several.first == one.first) << parts << " parts: others have left";
    EXPECT_TRUE(several.second == one.second) << parts << " parts";
  }
}

/// Points, forces, energies, the free surface; and no step depends on it.
TEST(PartedSolver, PartsReadTheSame) {
  Case scene = two_afloat();
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.scheme = Scheme::riemann_parshikov;
  std::vector<Vector3d> places;
  for (double x = 0; x <= 1.2; x += 0.013)
    for (double z = 0; z <= 0.4; z += 0.05) places.emplace_back(x, 0, z);
  std::vector<std::vector<double>> read;
  for (const int parts : {1, 2}) {
    PartedTank tank(scene, parts, spoiled());
    for (int k = 0; k < 3; ++k) tank.solver->evaluate(*tank.solver->make_points(places, PointValues::pressure));  // and let go
    const std::unique_ptr<PointSet> points = tank.solver->make_points({Vector3d(0.1, 0, 0.1)}, PointValues::velocity);
    ASSERT_TRUE(tank.run(40));
    EXPECT_GT(tank.solver->evaluate(*points)[0].pressure, 0);
    points->set(places);
    read.push_back(readings(*tank.solver, *points));
    ASSERT_TRUE(tank.run(10));
    EXPECT_FALSE(readings(*tank.solver, *points) == read.back());
    EXPECT_TRUE(tank.solver->save() == state_after(scene, 2, 50));
  }
  EXPECT_TRUE(read[0] == read[1]);
}

/// Also by water that is cut anew just then.
TEST(PartedSolver, AShortenedStepStaysShort) {
  Case scene = running_out(2, 0.04);
  PartedSolverOptions options;
  options.cut_every = 10;
  PartedTank tank(scene, 2, options);
  ASSERT_TRUE(tank.run(10));
  tank.solver->save();
  const double before = tank.solver->energies().mass_centre.x();
  tank.solver->shorten_step(1e-9);
  ASSERT_TRUE(tank.run(1));
  EXPECT_NEAR(tank.solver->energies().mass_centre.x(), before, 1e-8);
}

/// Packing, and water that comes to rest, are the parts' own too: whatever walls they go by then.
TEST(PartedSolver, AlsoBeforeTheFirstStep) {
  Case scene = running_out(2, 0.04);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1.2, 0, 0.4)}};
  scene.bodies = {afloat("box", Box{Vector3d(0.5, 0, 0.2), Vector3d(0.72, 0, 0.5)})};
  const auto rested = [&scene](int parts) {
    PartedTank tank(scene, parts, spoiled());
    double told = 0;
    EXPECT_GT(tank.solver->pack(20, [&told](double fraction) { told = fraction; }).first_error, 0);
    EXPECT_EQ(told, 1);
    std::vector<char> states;
    for (const StepReport& report : {tank.solver->start(), tank.solver->settle(0.5, {})}) {
      EXPECT_TRUE(report.valid());
      const double numbers[] = {report.time_step, report.greatest_speed, report.greatest_acceleration, 1.0 * report.guard_hits,
                                1.0 * report.shepard_bounded};
      states.insert(states.end(), reinterpret_cast<const char*>(numbers), reinterpret_cast<const char*>(numbers + 5));
      for (const auto& [name, value] : report.more)
        states.insert(states.end(), reinterpret_cast<const char*>(&value), reinterpret_cast<const char*>(&value + 1));
    }
    const std::vector<char> rested_state = tank.solver->save();
    states.insert(states.end(), rested_state.begin(), rested_state.end());
    EXPECT_TRUE(tank.run(10));
    const std::vector<char> later = tank.solver->save();
    states.insert(states.end(), later.begin(), later.end());
    return states;
  };
  const auto expect_the_same = [&](const std::vector<int>& counts) {
    const std::vector<char> one = rested(1);
    for (const int parts : counts) EXPECT_TRUE(rested(parts) == one) << parts << " parts";
  };
  expect_the_same({2, 3});
  scene.numerics.integrator = Integrator::runge_kutta_4;
  scene.numerics.scheme = Scheme::riemann_ale;
  scene.numerics.shifting = Shifting::michel;
  expect_the_same({2});
  scene.numerics.integrator = Integrator::symplectic;
  scene.numerics.walls.elements = WallElements::numerical;
  scene.bodies.clear();
  expect_the_same({2});
}

/// A snapshot of another case leaves the water as it was.
TEST(PartedSolver, RefusesAStateOfOtherWater) {
  PartedTank tank(running_out(2, 0.04), 2), other(running_out(2, 0.05), 1);
  ASSERT_TRUE(tank.run(3));
  const std::vector<char> before = tank.solver->save();
  EXPECT_NE(error_of([&] { tank.solver->restore(other.solver->save()); }), "");
  EXPECT_TRUE(tank.solver->save() == before);
}

TEST(PartedSolver, CutsDoNotMatter) {
  Case scene = running_out(2, 0.04);
  const std::vector<char> one = state_after(scene, 1, 100);
  PartedSolverOptions options = spoiled();
  options.cut_every = 5;
  PartedTank tank(scene, 2, options);
  ASSERT_TRUE(tank.run(100));
  EXPECT_TRUE(tank.solver->save() == one);
  EXPECT_EQ(tank.solver->parts().count, 2);
  EXPECT_EQ(tank.solver->parts().cuts, 20u);
  EXPECT_GE(tank.solver->parts().imbalance, 1);
  EXPECT_LT(tank.solver->parts().imbalance, 1.3);
  options.uneven = 1;
  EXPECT_TRUE(state_after(scene, 2, 100, options) == one);
}

TEST(PartedSolver, AHaloOneSlotTooNarrowHasOtherBits) {
  const Case scene = running_out(2);
  PartedSolverOptions narrow;
  narrow.halo_less = 1;
  EXPECT_FALSE(state_after(scene, 2, 50, narrow) == state_after(scene, 2, 50));
}

TEST(PartedSolver, OnlyLastBitsDifferFromOneDevice) {
  const Case scene = running_out(2);
  PartedTank parted(scene, 2);
  Tank one(scene);
  one.pack_and_start(10);
  ASSERT_TRUE(parted.run(20));
  for (int k = 0; k < 20; ++k) one.solver->advance();
  const FluidState a = parted.solver->download(), b = one.solver->download();
  std::map<std::uint32_t, Vector3d> places;
  for (std::size_t i = 0; i < b.id.size(); ++i) places[b.id[i]] = b.position[i];
  ASSERT_EQ(a.id.size(), b.id.size());
  for (std::size_t i = 0; i < a.id.size(); ++i) EXPECT_LT((a.position[i] - places[a.id[i]]).norm(), 1e-5 * scene.fluid.spacing.value());
}

TEST(PartedSolver, StopsInTheSameStepWithTheSameReport) {
  Case scene = running_out(2, 0.04);
  scene.fluid.sound_speed = 4.0;  // of which the water soon has half
  const auto stop = [&](int parts) {
    PartedTank tank(scene, parts);
    int steps = 0;
    StepReport report = tank.solver->advance();
    for (; report.valid() && steps < 2000; ++steps) report = tank.solver->advance();
    EXPECT_FALSE(report.valid());
    return std::make_tuple(steps, report.offender_id, report.too_fast, report.offender_velocity.x(), report.time_step, report.guard_hits);
  };
  EXPECT_EQ(stop(1), stop(2));
}

/// Of a particle that is nowhere the watchdog tells, wherever halos expect it.
TEST(PartedSolver, TellsOfAParticleThatIsNowhere) {
  for (const bool ring : {false, true}) {
    Case scene = box_case(Vector3d(1.6, 0, 0.4), 0.3, 0.02);
    scene.tank.periodic = {ring, false, false};
    PartedTank tank(scene, 3);
    ASSERT_TRUE(tank.run(3));
    NewParticles wild;
    wild.position.emplace_back(0.8, 0, 0.35);
    wild.velocity.emplace_back(1e30, 0, 1e30);
    wild.volume.push_back(4e-4);
    wild.pressure.push_back(0);
    tank.solver->let_in(wild);
    StepReport report = tank.solver->advance();
    for (int k = 0; k < 3 && report.valid(); ++k) report = tank.solver->advance();
    EXPECT_FALSE(report.valid()) << ring;
    EXPECT_EQ(report.offender_id, tank.layout.particles.size()) << ring;
  }
}

TEST(PartedSolver, RefusesWaterThatIsTooShort) {
  const Case scene = running_out(2);
  EXPECT_NE(error_of([&] { PartedTank(scene, 30); }).find("choose fewer devices"), std::string::npos);
}

}  // namespace
}  // namespace wavetank::parted_solver_test
