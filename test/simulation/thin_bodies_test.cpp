// Bodies thinner than the support, sharp ones, and thin gates that may move, in water at rest; heavy ones that sink to the floor.
#include <algorithm>
#include <cstdlib>

#include "simulation_fixture.h"

namespace wavetank::thin_bodies_test {
namespace {

constexpr double density = 1000, gravity = 9.81;

/// Triangles of a prism across y from -1 to 1 over a convex polygon in x and z, turning left as seen from -y, as an STL file.
void write_prism(const std::string& file, const std::vector<Vector3d>& polygon) {
  std::ofstream stream(file);
  stream << "solid prism\n";
  const auto triangle = [&](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    stream << "facet normal 0 0 0\nouter loop\n";
    for (const Vector3d* corner : {&a, &b, &c}) stream << "vertex " << corner->x() << " " << corner->y() << " " << corner->z() << "\n";
    stream << "endloop\nendfacet\n";
  };
  const Vector3d front(0, -1, 0), back(0, 1, 0);
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector3d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    triangle(a + front, b + front, b + back);
    triangle(a + front, b + back, a + back);
    if (k == 0 || k + 1 == polygon.size()) continue;
    triangle(polygon[0] + front, a + front, b + front);
    triangle(polygon[0] + back, b + back, a + back);
  }
  stream << "endsolid prism\n";
}

class ThinBodies : public SimulationTest {
 protected:
  /// A body under 0.35 m of water in 2-D.
  static Case tank_with(const BodyCase& body, double spacing = 0.025) {
    Case scene = box_case(Vector3d(0.8, 0, 0.5), 0.35, spacing);
    scene.fluid.density = density;
    scene.bodies.push_back(body);
    scene.numerics.packing.settling = 3;
    scene.instruments.rate = 50;
    return scene;
  }

  /// Every sample from 0.1 s on is within the share of Archimedes' force, and the water hardly moves.
  static void rests(const char* name, const Case& scene, double area, double share) {
    Simulation simulation(scene);
    // `scripts/validate reported` asks for the long run
    const Samples samples = run_to(simulation, std::getenv("WAVETANK_LONG_TESTS") != nullptr ? 20.0 : 0.5);
    const double archimedes = density * gravity * area;
    double least = 1e300, most = -1e300, sideways = 0, fastest = 0;
    for (const WrenchSample& sample : samples.wrenches) {
      if (sample.time < 0.1) continue;
      const Vector3d& force = sample.wrenches[1].pressure_force;
      least = std::min(least, force.z());
      most = std::max(most, force.z());
      sideways = std::max(sideways, std::abs(force.x()));
    }
    for (const Eigen::Vector3f& velocity : simulation.particles().velocity)
      fastest = std::max(fastest, static_cast<double>(velocity.norm()));
    std::printf("%s: %+.1f to %+.1f %% of Archimedes' %.1f N, at most %.1f %% of it sideways; water at %.3f m/s\n", name,
                100 * (least / archimedes - 1), 100 * (most / archimedes - 1), archimedes, 100 * sideways / archimedes, fastest);
    EXPECT_GT(least, (1 - share) * archimedes) << name;
    EXPECT_LT(most, (1 + share) * archimedes) << name;
    EXPECT_LT(sideways, 0.05 * archimedes) << name;
    EXPECT_LT(fastest, 0.05) << name;
  }
};

TEST_F(ThinBodies, BarsFeelArchimedesForce) {
  for (const double thickness : {1.0, 2.0, 3.0, 3.5, 4.1}) {
    const double half = 0.5 * thickness * 0.025;
    const std::string name = "bar " + std::to_string(thickness).substr(0, 3) + " spacings thick";
    rests(name.c_str(), tank_with({"bar", Box{Vector3d(0.2, 0, 0.17 - half), Vector3d(0.6, 0, 0.17 + half)}}), 0.4 * 2 * half, 0.1);
  }
}

/// At spacings of which the wedge of 15° is 2.3 to 5.4 thick, and down to nearly nothing at its tip, its back thinner than the support and
/// not; the coarsest are nearer to the floor than the support.
TEST_F(ThinBodies, WedgesFeelArchimedesForce) {
  for (const double degrees : {15.0, 27.0}) {
    const double height = 0.3 * std::tan(degrees * M_PI / 180);
    write_prism(path("wedge.stl"), {Vector3d(0, 0, 0), Vector3d(0.3, 0, 0), Vector3d(0.3, 0, height)});
    MeshSource mesh;
    mesh.uri = path("wedge.stl");
    mesh.translation = Vector3d(0.25, 0, 0.1);
    // `scripts/validate reported` asks for all
    const bool all = std::getenv("WAVETANK_LONG_TESTS") != nullptr;
    for (const double spacing :
         all ? std::vector<double>{0.035, 0.03, 0.025, 0.022, 0.018, 0.015} : std::vector<double>{0.03, 0.022, 0.018}) {
      const std::string name = "wedge of " + std::to_string(static_cast<int>(degrees)) + " degrees at " + std::to_string(spacing) + " m";
      rests(name.c_str(), tank_with({"wedge", mesh}, spacing), 0.5 * 0.3 * height, 0.08);
    }
  }
}

/// NACA 0012, 16 spacings long and 1.9 thick: the facets of either side fall away behind each other's planes.
TEST_F(ThinBodies, AFoilFeelsArchimedesForce) {
  constexpr double chord = 0.4, thickness = 0.12;
  constexpr int stations = 16;
  const auto half = [](double x) {
    return 5 * thickness * (0.2969 * std::sqrt(x) - 0.126 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
  };
  std::vector<Vector3d> outline;
  double area = 0;
  for (int k = 0; k <= 2 * stations - 1; ++k) {  // along the lower side and back along the upper one
    const double x = 0.5 * (1 - std::cos(M_PI * k / stations)), z = k < stations ? -half(x) : half(x);
    outline.emplace_back(chord * x, 0, k == 0 || k == stations ? 0 : chord * z);
  }
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vector3d &a = outline[k], &b = outline[(k + 1) % outline.size()];
    area += 0.5 * (a.x() * b.z() - b.x() * a.z());
  }
  write_prism(path("foil.stl"), outline);
  MeshSource mesh;
  mesh.uri = path("foil.stl");
  mesh.translation = Vector3d(0.2, 0, 0.15);
  rests("foil", tank_with({"foil", mesh}), area, 0.1);
}

/// Water of 0.3 m behind a gate 1.3 spacings thick that stands on the floor.
Case gate(Motion motion) {
  Case scene = box_case(Vector3d(0.6, 0, 0.5), 0.3, 0.015);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.3, 0, 0.3)}};
  scene.fluid.density = density;
  scene.fluid.sound_speed = 20;
  scene.bodies.push_back({"gate", Box{Vector3d(0.3, 0, 0), Vector3d(0.32, 0, 0.4)}, motion});
  scene.numerics.packing.settling = 3;
  scene.instruments.rate = 50;
  scene.instruments.pressure_probes = {{"corner", Vector3d::Zero()}};
  return scene;
}

TEST_F(ThinBodies, AGateThatMayMoveIsAsTightAsAFixedOne) {
  double forces[2], pressures[2];
  for (const Motion motion : {Motion::fixed, Motion::commanded}) {
    Simulation simulation(gate(motion));
    const Samples samples = run_to(simulation, 0.2);
    const int which = motion == Motion::fixed ? 0 : 1;
    forces[which] = samples.wrenches.back().wrenches[1].pressure_force.x();
    pressures[which] = samples.pressures.back().pressures[0];
    std::printf("%s gate: %.1f N of %.1f N, corner at %.0f Pa of 2943 Pa, %llu guard hits\n", which == 0 ? "fixed" : "commanded",
                forces[which], 0.5 * density * gravity * 0.09, pressures[which],
                static_cast<unsigned long long>(simulation.state().guard_hits));
    EXPECT_NEAR(forces[which], 0.5 * density * gravity * 0.09, 0.02 * 441);
    EXPECT_NEAR(pressures[which], 2943, 30);
    EXPECT_EQ(simulation.state().guard_hits, 0u);
  }
  EXPECT_NEAR(forces[1], forces[0], 10);  // the fixed one's floor is cut out below it
  EXPECT_NEAR(pressures[1], pressures[0], 4);
}

TEST_F(ThinBodies, HeavyOnesComeToLieOnTheFloor) {
  for (const double ratio : {1.5, 2.5}) {
    Case scene = box_case(Vector3d(0.8, 0, 0.6), 0.4, 0.02);
    scene.fluid.density = density;
    BodyCase stone{"stone", Box{Vector3d(0.3, 0, 0.16), Vector3d(0.5, 0, 0.28)}, Motion::free};
    stone.rigid.density = ratio * density;
    scene.bodies.push_back(stone);
    scene.duration = 2;
    Simulation simulation(scene);
    double farthest = 0;
    while (simulation.state().time < 2) {
      simulation.advance();
      if (simulation.state().time > 1.5) farthest = std::max(farthest, std::abs(simulation.bodies().state(1).position.z() - 0.06));
    }
    std::printf("%.1f times as heavy as water: at most %.3f spacings off the floor from 1.5 s on\n", ratio, farthest / 0.02);
    EXPECT_LT(farthest, 0.1 * 0.02);
  }
}

}  // namespace
}  // namespace wavetank::thin_bodies_test
