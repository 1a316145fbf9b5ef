// Particles that come into the water and leave it in the course of a run.
#include <limits>
#include <set>

#include "sph_fixture.h"

namespace wavetank::population_test {
namespace {

constexpr double spacing = 0.02;
constexpr double longest_step = 2e-4;  // s, below what the water asks for, so that one column does not set the other's step

Box column_from(double x) { return {Vector3d(x, 0, 0), Vector3d(x + 0.4, 0, 0.3)}; }

/// Columns that begin to fall, too far apart to feel each other.
Case columns(const std::vector<double>& places, Integrator integrator) {
  Case scene = box_case(Vector3d(2.0, 0, 0.6), 0.3, spacing);
  scene.fluid.fill.clear();
  for (const double x : places) scene.fluid.fill.push_back(column_from(x));
  scene.numerics.integrator = integrator;
  scene.fluid.sound_speed = 25;
  return scene;
}

struct Water : Tank {
  explicit Water(const std::vector<double>& places, Integrator integrator = Integrator::symplectic) : Tank(columns(places, integrator)) {
    solver->limit_time_step(longest_step);
    solver->start();
  }
  void step(int steps = 1) {
    for (int k = 0; k < steps; ++k) {
      const StepReport report = solver->advance();
      ASSERT_TRUE(report.valid());
      ASSERT_EQ(report.time_step, static_cast<double>(static_cast<float>(longest_step)));
    }
  }
};

const double ends[2] = {0.0, 1.6};  // of the tank, where the columns stand

/// By id.
struct ById {
  explicit ById(const FluidState& fluid) {
    for (std::size_t i = 0; i < fluid.id.size(); ++i)
      particles[fluid.id[i]] = {fluid.position[i], fluid.velocity[i], Vector3d(fluid.pressure[i], fluid.compression[i], fluid.mass[i])};
  }
  std::map<std::uint32_t, std::array<Vector3d, 3>> particles;
};

/// The particles beyond a place along the tank.
NewParticles beyond(double x, const FluidState& fluid, double density) {
  NewParticles found;
  std::map<std::uint32_t, std::size_t> by_id;
  for (std::size_t i = 0; i < fluid.id.size(); ++i)
    if (fluid.position[i].x() > x) by_id[fluid.id[i]] = i;
  for (const auto& [id, i] : by_id) {
    found.position.push_back(fluid.position[i]);
    found.velocity.push_back(fluid.velocity[i]);
    found.pressure.push_back(fluid.pressure[i]);
    found.volume.push_back(fluid.mass[i] / (density * (1 + fluid.compression[i])));
  }
  return found;
}

Drain half_of_the_tank() { return {Vector3d(1.5, 0, 0.3), Vector3d(0.5, 1, 0.4).asDiagonal()}; }

/// Within rounding: a tile may have other members, so that sums go in another order; the last digit of a place is 1.2e-7 m, of a pressure
/// 1e-7 ρc².
void expect_same(const std::array<Vector3d, 3>& particle, const std::array<Vector3d, 3>& expected, std::uint32_t id, double slack = 1) {
  EXPECT_LT((particle[0] - expected[0]).norm(), 5e-7 * slack) << "particle " << id;
  EXPECT_LT((particle[1] - expected[1]).norm(), 1e-5 * slack) << "particle " << id;
  EXPECT_NEAR(particle[2][0], expected[2][0], 1e-6 * 1000 * 25 * 25 * slack) << "particle " << id;
  EXPECT_NEAR(particle[2][2], expected[2][2], 1e-6 * 0.4) << "particle " << id;
}

class Population : public ::testing::TestWithParam<Integrator> {};

TEST_P(Population, WhatLeavesDoesNotTouchWhatStays) {
  Water both({ends[0], ends[1]}, GetParam()), drained({ends[0], ends[1]}, GetParam());
  const std::size_t half = both.solver->particle_count() / 2;
  both.step(3);
  drained.step(2);
  drained.solver->set_drains({half_of_the_tank()});
  drained.step();
  ASSERT_EQ(drained.solver->particle_count(), half);
  both.step(5);
  drained.step(5);
  const ById expected(both.solver->download()), found(drained.solver->download());
  ASSERT_EQ(found.particles.size(), half);
  for (const auto& [id, particle] : found.particles) expect_same(particle, expected.particles.at(id), id);
  EXPECT_NEAR(drained.solver->energies().mass, both.solver->energies().mass / 2, 1e-5 * both.solver->energies().mass);
  EXPECT_EQ(drained.solver->find_surface().on_surface.size(), half);
  EXPECT_GT(drained.solver->count_pairs().pairs, half);
}

TEST_P(Population, WhatComesInGoesOnAsIfItHadBeenThere) {
  Water both({ends[0], ends[1]}, GetParam()), filled({ends[0]}, GetParam());
  const std::size_t half = filled.solver->particle_count();
  both.step(3);
  filled.step(2);
  filled.solver->let_in(beyond(1.0, both.solver->download(), filled.scene.fluid.density));
  EXPECT_EQ(filled.solver->particle_count(), half) << "they come in at the step's end";
  filled.step();
  ASSERT_EQ(filled.solver->particle_count(), 2 * half);
  both.step(5);
  filled.step(5);
  const ById expected(both.solver->download()), found(filled.solver->download());
  ASSERT_EQ(found.particles.size(), 2 * half);
  // symplectic: the compressions of those that come in, which are of the step's end, go on by half a step as all others do
  const double slack = GetParam() == Integrator::symplectic ? 300 : 1;
  for (const auto& [id, particle] : found.particles) expect_same(particle, expected.particles.at(id), id, id < half ? 1 : slack);
}

INSTANTIATE_TEST_SUITE_P(WithEveryIntegrator, Population,
                         ::testing::Values(Integrator::symplectic, Integrator::runge_kutta_4, Integrator::predictor_corrector));

/// Some in a row above the water.
NewParticles row(int count, double z) {
  NewParticles particles;
  for (int k = 0; k < count; ++k) {
    particles.position.emplace_back(0.5 + spacing * k, 0, z);
    particles.velocity.emplace_back(0, 0, -1);
    particles.volume.push_back(spacing * spacing);
    particles.pressure.push_back(0);
  }
  return particles;
}

TEST(PopulationOfATank, GrowsBeyondTheRoomThatThereWasAndKeepsItsIdsApart) {
  Water tank({ends[0]});
  const std::size_t first = tank.solver->particle_count();
  std::set<std::uint32_t> left;
  for (int k = 0; k < 8; ++k) {  // 60 at a time come in at the height where those of four steps before are drained
    tank.solver->let_in(row(60, 0.5));
    if (k == 4) {
      for (const auto& [id, particle] : ById(tank.solver->download()).particles)
        if (particle[0].z() > 0.4) left.insert(id);
      tank.solver->set_drains({Drain{Vector3d(1, 0, 0.5), Vector3d(1.0, 1, 0.05).asDiagonal()}});
    }
    tank.step();
    if (k == 4) {
      // those that come in at a drain never are in the water
      EXPECT_EQ(tank.solver->particle_count(), first);
      tank.solver->set_drains({});
    }
  }
  EXPECT_EQ(left.size(), 4 * 60U);
  const FluidState fluid = tank.solver->download();
  EXPECT_EQ(fluid.id.size(), first + 3 * 60);
  const std::set<std::uint32_t> ids(fluid.id.begin(), fluid.id.end());
  EXPECT_EQ(ids.size(), fluid.id.size());
  for (const std::uint32_t id : left) EXPECT_EQ(ids.count(id), 0U) << "a particle has the id of one that left";
  EXPECT_EQ(*ids.rbegin(), first + 8 * 60 - 1);
  EXPECT_NEAR(total(fluid.mass), 1000 * (0.4 * 0.3 + 180 * spacing * spacing), 0.05);
  EXPECT_NEAR(tank.solver->energies().mass, total(fluid.mass), 1e-6 * total(fluid.mass));
  EXPECT_TRUE(all_finite(fluid));
}

TEST(PopulationOfATank, MayBeNobody) {
  Water tank({ends[0]});
  tank.solver->set_drains({Drain{Vector3d(1, 0, 0.3), Vector3d(2, 1, 2).asDiagonal()}});
  tank.step(3);
  EXPECT_EQ(tank.solver->particle_count(), 0U);
  EXPECT_EQ(tank.solver->energies().mass, 0.0);
  EXPECT_TRUE(tank.solver->download().id.empty());
  tank.solver->set_drains({});
  tank.solver->let_in(row(3, 0.3));
  tank.step(2);
  EXPECT_EQ(tank.solver->particle_count(), 3U);
}

/// A drain whose edges lie across the axes.
TEST(PopulationOfATank, IsDrainedWhereADrainIs) {
  Water tank({ends[0]});
  const double turn = 0.5;
  Eigen::Matrix3d half_edges;
  half_edges.col(0) = 0.1 * Vector3d(std::cos(turn), 0, std::sin(turn));
  half_edges.col(1) = Vector3d(0, 1, 0);
  half_edges.col(2) = 0.05 * Vector3d(-std::sin(turn), 0, std::cos(turn));
  const Drain drain{Vector3d(0.2, 0, 0.15), half_edges};
  const auto inside = [&](const Vector3d& place) {
    const Vector3d arm = place - drain.centre;
    return std::abs(arm.dot(half_edges.col(0))) < 0.01 && std::abs(arm.dot(half_edges.col(2))) < 0.0025;
  };
  Water whole({ends[0]});
  whole.step();
  tank.solver->set_drains({drain});
  tank.step();
  const ById expected(whole.solver->download()), found(tank.solver->download());
  std::size_t drained = 0;
  for (const auto& [id, particle] : expected.particles) {
    EXPECT_EQ(found.particles.count(id), inside(particle[0]) ? 0U : 1U) << "particle " << id;
    drained += inside(particle[0]);
  }
  EXPECT_NEAR(static_cast<double>(drained), 0.2 * 0.1 / (spacing * spacing), 8);
}

TEST(PopulationOfATank, GoesOnToTheSameBitsFromASnapshot) {
  Water tank({ends[0], ends[1]});
  tank.solver->set_drains({Drain{Vector3d(1.8, 0, 0.1), Vector3d(0.1, 1, 0.1).asDiagonal()}});
  tank.solver->let_in(row(50, 0.5));
  tank.step(2);
  const std::vector<char> saved = tank.solver->save();
  Water other({ends[0], ends[1]});
  const std::vector<char> before = other.solver->save();
  EXPECT_THROW(other.solver->restore(saved), Error) << "where no particle may come or go there are as many as before";
  EXPECT_EQ(other.solver->save(), before);
  other.solver->set_drains({Drain{Vector3d(1.8, 0, 0.1), Vector3d(0.1, 1, 0.1).asDiagonal()}});
  other.solver->restore(saved);
  EXPECT_EQ(other.solver->particle_count(), tank.solver->particle_count());
  for (Water* water : {&tank, &other}) {
    water->solver->let_in(row(50, 0.55));
    water->step(3);
  }
  EXPECT_EQ(other.solver->save(), tank.solver->save());
}

TEST(PopulationOfATank, IsNotRidOfParticlesWithoutAPlace) {
  Water tank({ends[0]});
  StateBytes<float> state(*tank.solver);
  state.set("u", 7, std::numeric_limits<float>::quiet_NaN());
  tank.solver->restore(state.bytes());
  tank.solver->set_drains({Drain{Vector3d(1.8, 0, 0.1), Vector3d(0.1, 1, 0.1).asDiagonal()}});
  const StepReport report = tank.solver->advance();
  EXPECT_EQ(report.not_finite, 1) << "a drain has taken what the watchdog must see";
  EXPECT_EQ(report.offender_id, 7U);
}

TEST(PopulationOfATank, RefusesDrainsThatAreNone) {
  Water tank({ends[0]});
  Drain drain{Vector3d(1, 0, 0.3), Vector3d(0.5, 1, 0).asDiagonal()};
  EXPECT_THROW(tank.solver->set_drains({drain}), Error) << "it has no height";
  drain.half_edges = Vector3d(0.5, 1, 0.4).asDiagonal();
  drain.half_edges(2, 0) = 0.2;
  EXPECT_THROW(tank.solver->set_drains({drain}), Error) << "its edges are not at right angles";
}

/// More than a limbo may hold in no order: the same bits again.
TEST(PopulationOfATank, RepeatsToTheBit) {
  const auto run = [] {
    Water tank({ends[0], ends[1]});
    tank.solver->set_drains({half_of_the_tank()});
    tank.solver->let_in(row(50, 0.5));
    tank.step(4);
    return tank.solver->save();
  };
  EXPECT_EQ(run(), run());
}

TEST(PopulationOfATank, RefusesParticlesThatAreNone) {
  Water tank({ends[0]});
  NewParticles particles = row(2, 0.5);
  particles.volume[1] = 0;
  EXPECT_THROW(tank.solver->let_in(particles), Error);
  particles = row(2, 0.5);
  particles.velocity[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tank.solver->let_in(particles), Error);
  particles = row(2, 0.5);
  particles.pressure.pop_back();
  EXPECT_THROW(tank.solver->let_in(particles), Error);
  tank.step();
  EXPECT_EQ(tank.solver->particle_count(), tank.layout.particles.size());
}

}  // namespace
}  // namespace wavetank::population_test
