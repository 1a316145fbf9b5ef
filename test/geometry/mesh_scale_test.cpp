// A forgotten scale: the refusal names the mesh, its size in metres and `scale`.
#include "geometry_fixture.h"
#include "wavetank/common/log.h"

namespace wavetank::mesh_scale_test {
namespace {

class MeshScaleTest : public GeometryTest {
 protected:
  MeshScaleTest() {
    set_log_sink([this](LogLevel level, const std::string& line) {
      if (level == LogLevel::warning) warnings += line + "\n";
    });
  }
  ~MeshScaleTest() override { set_log_sink({}); }

  MeshSource box_file(const std::string& name, const Vector3d& from, const Vector3d& to, bool open = false) const {
    return source(write(name, box_mesh({from, to}, open, name)));
  }
  static Case still_tank() { return box_case(Vector3d(1, 0.5, 0.5), 0.3, 0.05); }
  static void add_body(Case& scene, const MeshSource& mesh, Motion motion) {
    BodyCase body;
    body.name = "cube";
    body.shape = mesh;
    body.motion = motion;
    body.rigid.density = 500;
    scene.bodies.push_back(body);
  }

  std::string warnings;
};

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << word << " is not in: " << message;
}

TEST_F(MeshScaleTest, ABodyInMillimetresIsRefused) {
  for (const Motion motion : {Motion::free, Motion::fixed}) {
    Case scene = still_tank();
    MeshSource mesh = box_file("cube_mm.obj", Vector3d::Constant(-100), Vector3d::Constant(100));
    mesh.translation = Vector3d(0.5, 0.25, 0.3);
    add_body(scene, mesh, motion);
    expect_words(error_of([&] { lay_out(scene); }), {"cube_mm.obj", "200 × 200 × 200 m", "scale", "millimetres", "0.001"});
  }
}

TEST_F(MeshScaleTest, ABodyInMillimetresBesideTheWaterIsRefused) {
  Case scene = still_tank();
  add_body(scene, box_file("fin.obj", Vector3d(0.9, -50, -50), Vector3d(10.9, 50, 50)), Motion::fixed);
  expect_words(error_of([&] { lay_out(scene); }), {"fin.obj", "10 × 100 × 100 m", "scale"});
}

TEST_F(MeshScaleTest, ABodyInInchesThatLeavesNoRoomIsDoubted) {
  Case scene = still_tank();
  add_body(scene, box_file("hull.obj", Vector3d::Constant(-4), Vector3d::Constant(4)), Motion::free);
  expect_words(error_of([&] { lay_out(scene); }), {"hull.obj", "8 × 8 × 8 m", "scale"});
}

TEST_F(MeshScaleTest, ATankInMillimetresIsRefused) {
  for (const int dimensions : {2, 3}) {
    Case scene = still_tank();
    scene.dimensions = dimensions;
    scene.fluid.spacing = 0.02;
    scene.tank.shape = box_file("tank_mm.obj", Vector3d(0, -250, 0), Vector3d(1000, 250, 500), true);
    scene.fluid.fill = {FloodFill{Vector3d(0.5, dimensions == 2 ? 0 : 0.25, 0.1), 0.3}};
    expect_words(error_of([&] { lay_out(scene); }), {"tank_mm.obj", "1000 × 500 × 500 m", "scale", "0.001"});
    scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, dimensions == 2 ? 0 : 0.5, 0.3)}};
    expect_words(error_of([&] { lay_out(scene); }), {"tank_mm.obj", "1000 × 500 × 500 m", "scale", "0.001"});
  }
}

TEST_F(MeshScaleTest, ATankScaledTwiceIsRefused) {
  Case scene = still_tank();
  MeshSource mesh = box_file("tank.obj", Vector3d::Zero(), Vector3d(1, 0.5, 0.5), true);
  mesh.scale = Vector3d::Constant(0.001);
  scene.tank.shape = mesh;
  expect_words(error_of([&] { lay_out(scene); }), {"tank.obj", "0.001 × 0.0005 × 0.0005 m", "scale"});
}

TEST_F(MeshScaleTest, ATankThatCouldBeLaidOutIsDoubtedAloud) {
  Case scene = still_tank();
  scene.dimensions = 2;
  scene.fluid.spacing = 1;
  scene.tank.shape = box_file("tank_mm.obj", Vector3d(0, -250, 0), Vector3d(1000, 250, 500), true);
  scene.fluid.fill = {FloodFill{Vector3d(0.5, 0, 0.1), 3}};
  lay_out(scene);
  expect_words(warnings, {"tank_mm.obj", "1000 × 500 × 500 m", "scale"});
}

TEST_F(MeshScaleTest, MeshesOfAFittingSizeAreNotDoubted) {
  Case scene = still_tank();
  scene.tank.shape = box_file("tank.obj", Vector3d::Zero(), Vector3d(1, 0.5, 0.5), true);
  MeshSource mesh = box_file("cube_mm.obj", Vector3d::Constant(-100), Vector3d::Constant(100));
  mesh.scale = Vector3d::Constant(0.001);
  mesh.translation = Vector3d(0.5, 0.25, 0.3);
  add_body(scene, mesh, Motion::free);
  EXPECT_GT(lay_out(scene).particles.size(), 500u);
  EXPECT_EQ(warnings, "");
  // what is wrong for another reason is told as it was
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(2, 0.5, 0.3)}};
  EXPECT_EQ(error_of([&] { lay_out(scene); }).find("scale"), std::string::npos);
}

TEST_F(MeshScaleTest, ASpacingLargerThanTheTankIsRefused) {
  for (const auto& [size, spacing, along] : std::vector<std::tuple<Vector3d, double, std::string>>{{{3, 0, 3}, 5.0, "3 m along x"},
                                                                                                   {{3, 0.2, 3}, 0.25, "0.2 m along y"},
                                                                                                   {{3, 0, 0.4}, 0.5, "0.4 m along z"},
                                                                                                   {{3, 0, 3}, 1e308, "3 m"}}) {
    Case scene = box_case(size, 0.3, spacing);
    expect_words(error_of([&, &refused = scene] { lay_out(refused); }), {"fluid/spacing", "larger than the tank", along});
  }
  Case scene = box_case(Vector3d(3, 0.2, 3), 3, 1);
  scene.fluid.spacing.reset();
  scene.fluid.particles = 2;
  expect_words(error_of([&] { lay_out(scene); }), {"fluid/particles", "larger than the tank"});
}

}  // namespace
}  // namespace wavetank::mesh_scale_test
