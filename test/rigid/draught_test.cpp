// How deep bodies float, beside what is known.
#include "wavetank/rigid/draught.h"

#include "rigid_fixture.h"

namespace wavetank::draught_test {
namespace {

TEST(Draught, OfABox) {
  const TriangleMesh box = box_mesh({{1, 2, 3}, {1.4, 2.2, 3.1}}, false, "box");
  EXPECT_NEAR(*draught(box, 0.5 * 0.4 * 0.2 * 0.1, 3), 0.05, 1e-3);
  EXPECT_NEAR(*draught(box, 0.99 * 0.4 * 0.2 * 0.1, 3), 0.099, 1e-3);
  EXPECT_FALSE(draught(box, 1.01 * 0.4 * 0.2 * 0.1, 3));
}

TEST(Draught, OfASectionIn2D) {
  const TriangleMesh box = box_mesh({{-1, -0.2, 3}, {-0.6, 0.2, 3.1}}, false, "box");
  EXPECT_NEAR(*draught(box, 0.3 * 0.4 * 0.1, 2), 0.03, 1e-3);
  // a wedge, point down: half its area is √½ of its height
  const TriangleMesh wedge = prism_mesh({{0, 0, 0}, {0.2, 0, 0.2}, {-0.2, 0, 0.2}}, -0.1, 0.1);
  EXPECT_NEAR(*draught(wedge, 0.5 * 0.04, 2), 0.2 * std::sqrt(0.5), 2e-3);
  EXPECT_FALSE(draught(wedge, 0.041, 2));
}

TEST(Draught, OfASphere) {
  MeshSource source;
  source.uri = "shape://sphere?radius=0.5&facets=64";
  const TriangleMesh sphere = read_mesh(source, "", {});
  EXPECT_NEAR(*draught(sphere, 0.5 * sphere.signed_volume(), 3), 0.5, 0.01);
  // a cap as high as half the radius has 5/32 of the volume
  EXPECT_NEAR(*draught(sphere, 5.0 / 32 * sphere.signed_volume(), 3), 0.25, 0.01);
}

/// An open boat: a box with a skin, here as a prism's section, closed at both ends.
TriangleMesh open_boat(double length, double width, double height, double skin) {
  TriangleMesh boat = box_mesh({{0, 0, 0}, {length, width, height}}, true, "boat");
  TriangleMesh inner = box_mesh({{skin, skin, skin}, {length - skin, width - skin, height}}, true, "boat");
  const int first = static_cast<int>(boat.vertices.size());
  for (const Vector3d& vertex : inner.vertices) boat.vertices.push_back(vertex);
  for (const Vector3i& t : inner.triangles) boat.triangles.emplace_back(t[0] + first, t[2] + first, t[1] + first);
  // the rim, from the outer upper corners to the inner ones
  const auto corner = [&](double x, double y) {
    for (std::size_t v = 0; v < boat.vertices.size(); ++v)
      if ((boat.vertices[v] - Vector3d(x, y, height)).norm() < 1e-9) return static_cast<int>(v);
    return -1;
  };
  const int outer[4] = {corner(0, 0), corner(length, 0), corner(length, width), corner(0, width)};
  const int inside[4] = {corner(skin, skin), corner(length - skin, skin), corner(length - skin, width - skin), corner(skin, width - skin)};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    boat.triangles.emplace_back(outer[k], outer[next], inside[next]);
    boat.triangles.emplace_back(outer[k], inside[next], inside[k]);
  }
  return boat;
}

TEST(Draught, OfAnOpenBoatWhoseCockpitStaysDry) {
  for (const double skin : {0.02, 0.002}) {
    TriangleMesh boat = open_boat(0.5, 0.3, 0.15, skin);
    check_closed(boat);
    const std::optional<double> found = draught(boat, 0.5 * 0.3 * 0.06, 3);
    ASSERT_TRUE(found) << skin;
    EXPECT_NEAR(*found, 0.06, 0.004) << skin;
    EXPECT_FALSE(draught(boat, 0.5 * 0.3 * 0.151, 3)) << "water comes over the rim";
  }
}

TEST(Draught, OfARingWhoseHoleFillsFromBelow) {
  TriangleMesh ring = open_boat(0.5, 0.3, 0.1, 0.05);
  // floors of boat and cockpit away: a frame
  const auto is_floor = [&](const Vector3i& t) {
    const double z = ring.vertices[t[0]].z();
    return z < 0.06 && ring.vertices[t[1]].z() == z && ring.vertices[t[2]].z() == z;
  };
  ring.triangles.erase(std::remove_if(ring.triangles.begin(), ring.triangles.end(), is_floor), ring.triangles.end());
  const auto at = [&](double x, double y, double z) {
    for (std::size_t v = 0; v < ring.vertices.size(); ++v)
      if ((ring.vertices[v] - Vector3d(x, y, z)).norm() < 1e-9) return static_cast<int>(v);
    return -1;
  };
  for (Vector3d& vertex : ring.vertices)
    if (vertex.z() == 0.05) vertex.z() = 0;
  const int outer[4] = {at(0, 0, 0), at(0.5, 0, 0), at(0.5, 0.3, 0), at(0, 0.3, 0)};
  const int inside[4] = {at(0.05, 0.05, 0), at(0.45, 0.05, 0), at(0.45, 0.25, 0), at(0.05, 0.25, 0)};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    ring.triangles.emplace_back(outer[next], outer[k], inside[next]);
    ring.triangles.emplace_back(inside[next], outer[k], inside[k]);
  }
  check_closed(ring);
  const double area = 0.5 * 0.3 - 0.4 * 0.2;
  EXPECT_NEAR(ring.signed_volume(), area * 0.1, 1e-9);
  EXPECT_NEAR(*draught(ring, 0.04 * area, 3), 0.04, 0.002);
}

}  // namespace
}  // namespace wavetank::draught_test
