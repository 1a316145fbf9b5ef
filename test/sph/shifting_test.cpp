// The shifting laws' properties (Table 2 of the particle shifting paper), and what they do at free surfaces.
#include <random>

#include "sph_fixture.h"

namespace wavetank::shifting_test {
namespace {

/// Particles without gravity and walls, of which velocities are set and the first step's shifts found.
struct Shifted {
  Shifted(Shifting law, const std::vector<Vector3d>& particles, double spacing, bool periodic,
          const std::function<Vector3d(const Vector3d&)>& velocity) {
    scene = box_case(Vector3d(1, 0, 1), 1, spacing);
    scene.gravity = Vector3d::Zero();
    scene.tank.periodic = {periodic, false, periodic};
    scene.fluid.sound_speed = 10;
    scene.fluid.viscosity = 0;
    scene.numerics.shifting = law;
    scene.numerics.precision = Precision::double_;
    scene.numerics.artificial_viscosity = 0;
    layout = loose_particles({Vector3d::Zero(), Vector3d(1, 0, 1)}, spacing, particles, 2);
    layout.open_top = false;
    scene = settled(scene, layout);
    solver = make_solver(test_device(), scene, layout, discretise(scene, layout), {Vector3d::Zero()});
    solver->start();
    StateBytes<double> state(*solver);
    for (std::size_t i = 0; i < state.count; ++i) {
      const Vector3d u = velocity(particles[i]);
      state.set("u", i, u.x());
      state.set("w", i, u.z());
    }
    solver->restore(state.bytes());
    EXPECT_TRUE(solver->advance().valid());
    StateBytes<double> after(*solver);
    for (std::size_t i = 0; i < after.count; ++i) {
      shifts.emplace_back(after.get("shift_x", i), after.get("shift_y", i), after.get("shift_z", i));
      greatest = std::max(greatest, shifts.back().norm());
    }
  }

  Case scene;
  Layout layout;
  std::unique_ptr<Solver> solver;
  std::vector<Vector3d> shifts;  ///< by id, m/s
  double greatest = 0;
};

std::vector<Vector3d> disordered(double spacing, unsigned seed, double by) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-by * spacing, by * spacing);
  std::vector<Vector3d> particles;
  for (double x = 0.5 * spacing; x < 1; x += spacing)
    for (double z = 0.5 * spacing; z < 1; z += spacing) particles.emplace_back(x + any(random), 0, z + any(random));
  return particles;
}

constexpr unsigned seed = 11;
Vector3d vortices(const Vector3d& x) {
  const double way = 2 * M_PI;
  return {std::sin(way * x.x()) * std::cos(way * x.z()), 0, -std::cos(way * x.x()) * std::sin(way * x.z())};
}

double greatest_difference(const Shifted& a, const Shifted& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.shifts.size(); ++i) most = std::max(most, (a.shifts[i] - b.shifts[i]).norm());
  return most;
}

bool tells(Shifting law, std::initializer_list<Shifting> laws) { return std::find(laws.begin(), laws.end(), law) != laws.end(); }

class ShiftingLaws : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_precision(Precision::double_)) GTEST_SKIP() << "needs double precision";
  }
  template <class Check>
  static void each(const Check& check) {
    for (const MethodWord<Shifting>& known : method_words<Shifting>()) {
      SCOPED_TRACE(known.word);
      if (known.choice != Shifting::none) check(known.choice, known.word);
    }
  }
};

TEST_F(ShiftingLaws, AreInvariantWhereThePaperSaysSo) {
  const std::vector<Vector3d> particles = disordered(0.05, seed, 0.2);
  std::printf("seed %u\n", seed);
  each([&](Shifting law, const char* word) {
    const Shifted still(law, particles, 0.05, true, vortices);
    const Shifted carried(law, particles, 0.05, true, [](const Vector3d& x) { return Vector3d(vortices(x) + Vector3d(2, 0, 0)); });
    const double change = greatest_difference(still, carried) / still.greatest;
    std::printf("%-9s greatest shift %.3f m/s, in a frame that moves another by %.1e of it\n", word, still.greatest, change);
    ASSERT_GT(still.greatest, 1e-3);
    if (law == Shifting::oger)
      EXPECT_GT(change, 0.05);
    else if (law == Shifting::lind)
      EXPECT_LT(change, 0.2) << "but for the time step, which knows the speed";
    else
      EXPECT_LT(change, 1e-9);
  });
}

TEST_F(ShiftingLaws, VanishInASolidRotationWhereThePaperSaysSo) {
  const std::vector<Vector3d> all = disordered(0.05, seed, 0.2);
  each([&](Shifting law, const char* word) {
    const Shifted turning(law, all, 0.05, false, [](const Vector3d& x) { return Vector3d(x.z() - 0.5, 0, 0.5 - x.x()); });
    std::printf("%-9s shifts by %.1e m/s in water that turns at up to 0.7 m/s\n", word, turning.greatest);
    if (law == Shifting::michel)
      EXPECT_LT(turning.greatest, 1e-9);
    else
      EXPECT_GT(turning.greatest, 1e-3);
  });
}

TEST_F(ShiftingLaws, LeaveALatticeAsItIs) {
  const std::vector<Vector3d> lattice = disordered(0.05, seed, 0);
  each([&](Shifting law, const char*) {
    if (law == Shifting::monaghan) return;  // goes by velocities alone
    EXPECT_LT(Shifted(law, lattice, 0.05, true, vortices).greatest, 1e-9);
  });
}

TEST_F(ShiftingLaws, DriveApartWhatComesClose) {
  std::vector<Vector3d> particles = disordered(0.05, seed, 0);
  const std::size_t moved = 10 * 20 + 10;
  particles[moved].x() += 0.02;
  each([&](Shifting law, const char*) {
    if (tells(law, {Shifting::monaghan})) return;
    const Shifted found(law, particles, 0.05, true, vortices);
    EXPECT_LT(found.shifts[moved].x(), 0) << "back to where it was";
    if (tells(law, {Shifting::lind, Shifting::sun, Shifting::michel}))
      EXPECT_GT(found.shifts[moved + 20].x(), 0) << "and its neighbour away from it, by the tensile part";
  });
}

/// A flat surface at z = 0.5: nothing across it in the upper half of the support under it, but for the normals of disordered water.
TEST_F(ShiftingLaws, DoNotMoveAFreeSurface) {
  std::vector<Vector3d> particles;
  for (const Vector3d& place : disordered(0.05, seed, 0.1))
    if (place.z() < 0.5) particles.push_back(place);
  each([&](Shifting law, const char*) {
    const Shifted found(law, particles, 0.05, false, vortices);
    double across = 0, inside = 0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      const Vector3d& at = particles[i];
      if (std::abs(at.x() - 0.5) > 0.25) continue;  // off the sides, which are surfaces too
      if (at.z() > 0.46)
        EXPECT_LE(std::abs(found.shifts[i].z()), 0.3 * found.shifts[i].norm()) << "of the first row, which may go along it";
      if (at.z() > 0.41) across = std::max(across, std::abs(found.shifts[i].z()));
      if (std::abs(at.z() - 0.25) < 0.05) inside = std::max(inside, std::abs(found.shifts[i].z()));
    }
    EXPECT_GT(inside, 0);
    EXPECT_LT(across, 0.35 * found.greatest) << "the disordered rows' normals are off the vertical by some degrees";
  });
}

TEST_F(ShiftingLaws, NeverMoveAParticleFartherThanAFifthOfTheSpacing) {
  const std::vector<Vector3d> particles = disordered(0.05, seed, 0.4);
  each([&](Shifting law, const char*) {
    const Shifted found(law, particles, 0.05, true, [](const Vector3d& x) { return Vector3d(4 * vortices(x)); });
    // the step of that shift is that of the start, when nothing moves yet: courant h/c₀
    const double step = found.scene.numerics.courant * 0.1 / 10;
    EXPECT_LE(found.greatest * step, 0.2 * 0.05 * (1 + 1e-9));
  });
}

}  // namespace
}  // namespace wavetank::shifting_test
