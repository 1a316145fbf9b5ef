#include "wavetank/node/markers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "example_case.h"

namespace wavetank {

using test::example_case;
using test::example_frames;
using test::example_layout;
using visualization_msgs::Marker;

namespace {

Marker find(const visualization_msgs::MarkerArray& drawing, const std::string& group) {
  const auto found = std::find_if(drawing.markers.begin(), drawing.markers.end(), [&](const Marker& m) { return m.ns == group; });
  if (found == drawing.markers.end()) throw std::runtime_error("no marker of " + group);
  return *found;
}

}  // namespace

TEST(Markers, DrawTankBodiesProbesAndGauges) {
  const auto drawing = markers(example_case(), example_layout(), example_frames());
  EXPECT_EQ(drawing.markers.front().action, Marker::DELETEALL);
  const Marker tank = find(drawing, "tank");
  EXPECT_EQ(tank.type, Marker::TRIANGLE_LIST);
  EXPECT_EQ(tank.points.size(), 30U) << "ten triangles of an open box";
  EXPECT_LT(tank.color.a, 0.5F);
  EXPECT_EQ(find(drawing, "bodies").points.size(), 36U);
  EXPECT_EQ(find(drawing, "bodies").color.a, 1.0F);
  EXPECT_EQ(find(drawing, "probe names").text, "P1");
  EXPECT_EQ(find(drawing, "probes").pose.position.z, 3.1);
  const Marker gauge = find(drawing, "gauges");
  ASSERT_EQ(gauge.points.size(), 2U);
  EXPECT_EQ(gauge.points[0].z, 3.0);
  EXPECT_EQ(gauge.points[1].z, 4.0);
  std::set<std::pair<std::string, int>> names;
  for (const Marker& marker : drawing.markers) {
    EXPECT_EQ(marker.header.frame_id, "basin");
    EXPECT_TRUE(marker.header.stamp.isZero());
    EXPECT_TRUE(names.emplace(marker.ns, marker.id).second) << marker.ns << " " << marker.id << " twice";
  }
}

TEST(Markers, DrawVelocityProbesAndSections) {
  Case example = example_case();
  example.instruments.velocity_probes = {{"V1", {2.5, 2.5, 3.1}}};
  example.instruments.sections = {{"gap", {2.5, 2.5, 3.2}, {1, 0, 0}}};
  Layout layout = example_layout();
  FlowSection section;
  section.outline = {{2.5, 2, 3}, {2.5, 3, 3}, {2.5, 3, 3.4}, {2.5, 2, 3.4}};
  layout.sections = {section};
  const auto drawing = markers(example, layout, example_frames());
  EXPECT_EQ(find(drawing, "velocity probe names").text, "V1");
  EXPECT_EQ(find(drawing, "velocity probes").pose.position.z, 3.1);
  EXPECT_EQ(find(drawing, "section names").text, "gap");
  EXPECT_EQ(find(drawing, "sections").points.size(), 5U) << "closed";
}

/// An opening of 0.4 m × 0.2 m in a wall of the example: the tank's end at x = 1, or the box's side at x = 2.
Opening opening_in(int owner) {
  Opening opening;
  opening.name = "pipe";
  opening.owner = owner;
  opening.centre = owner == 0 ? Vector3d(1, 2.5, 3.5) : Vector3d(2, 2.5, 3.25);
  opening.width = 0.4;
  opening.height = 0.2;
  for (const auto& [across, up] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
    opening.outline.push_back(opening.centre + Vector3d(0, 0.2 * across, 0.1 * up));
  opening.area = 0.08;
  opening.pocket = 0.3;
  return opening;
}

double area_of(const Marker& triangles) {
  const auto at = [&](std::size_t k) { return Vector3d(triangles.points[k].x, triangles.points[k].y, triangles.points[k].z); };
  double area = 0;
  for (std::size_t k = 0; k < triangles.points.size(); k += 3) area += 0.5 * (at(k + 1) - at(k)).cross(at(k + 2) - at(k)).norm();
  return area;
}

TEST(Markers, DrawAnOpeningAsAHoleWithARim) {
  for (const int owner : {0, 1}) {
    const std::string group = owner == 0 ? "tank" : "bodies";
    Case example = test::moving_box_case();
    MeshSource source;
    source.uri = "package://somewhere/hull.stl";  // which rviz would draw whole
    example.bodies[0].shape = source;
    example.openings.resize(1);
    example.openings[0].kind = owner == 0 ? OpeningKind::outlet : OpeningKind::inlet;
    Layout layout = example_layout();
    layout.spacing = 0.05;
    const double whole = area_of(find(markers(example, layout, example_frames(example), false), group));
    layout.openings = {opening_in(owner)};
    const auto drawing = markers(example, layout, example_frames(example));
    EXPECT_NEAR(area_of(find(drawing, group)), whole - 0.08, 1e-9) << group;
    const Marker rim = find(drawing, "openings");
    EXPECT_EQ(rim.type, Marker::LINE_STRIP);
    EXPECT_EQ(rim.points.size(), 5U) << "closed";
    EXPECT_EQ(rim.header.frame_id, owner == 0 ? "basin" : "basin/bodies/box");
    EXPECT_GT(owner == 0 ? rim.color.r : rim.color.g, 0.7F);
    EXPECT_NEAR(rim.points[0].x + rim.pose.position.x, owner == 0 ? 1 : 2 - 1.75, 1e-12);
    EXPECT_EQ(find(drawing, "opening names").text, "pipe");
  }
}

TEST(Markers, DrawASlotOfTwoDimensionsOverItsWallsWidth) {
  Layout layout = example_layout();
  layout.spacing = 0.05;
  layout.openings = {opening_in(0)};
  layout.openings[0].width = 0;
  layout.openings[0].outline = {Vector3d(1, 0, 3.4), Vector3d(1, 0, 3.6)};
  layout.openings[0].area = 0.2;
  Case example = example_case();
  example.openings.resize(1);
  const auto drawing = markers(example, layout, example_frames());
  EXPECT_NEAR(area_of(find(drawing, "tank")), 2 * 1 + 2 * 2 + 2 * 1 - 0.2 * 1, 1e-4) << "a hair of the sides too";
  const Marker rim = find(drawing, "openings");
  EXPECT_EQ(rim.points[0].y, 2.0);
  EXPECT_EQ(rim.points[2].y, 3.0);
}

TEST(Markers, KeepAPackageMeshAsAResource) {
  Case example = example_case();
  MeshSource source;
  source.uri = "package://somewhere/hull.STL";
  source.scale = Vector3d::Constant(0.001);
  source.translation = {1, 2, 3};
  source.rotation = {0, 0, M_PI / 2};
  example.bodies[0].shape = source;
  const Marker body = find(markers(example, example_layout(), example_frames(example)), "bodies");
  EXPECT_EQ(body.type, Marker::MESH_RESOURCE);
  EXPECT_EQ(body.mesh_resource, source.uri);
  EXPECT_EQ(body.scale.y, 0.001);
  EXPECT_EQ(body.pose.position.y, 2.0);
  EXPECT_NEAR(body.pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(body.points.empty());
  const Marker recorded = find(markers(example, example_layout(), example_frames(example), false), "bodies");
  EXPECT_EQ(recorded.type, Marker::TRIANGLE_LIST) << "a bag needs no file beside it";
  EXPECT_EQ(recorded.points.size(), 3 * example_layout().meshes[1].triangles.size());
}

TEST(Markers, SendAMirroredMeshAsTriangles) {
  Case example = example_case();
  MeshSource source;
  source.uri = "package://somewhere/hull.stl";
  source.scale = Vector3d(0.001, -0.001, 0.001);
  example.bodies[0].shape = source;
  EXPECT_EQ(find(markers(example, example_layout(), example_frames(example)), "bodies").type, Marker::TRIANGLE_LIST);
}

TEST(Markers, SendOtherMeshesAsTriangles) {
  Case example = example_case();
  MeshSource source;
  source.uri = "hull.stl";
  example.bodies[0].shape = source;
  EXPECT_EQ(find(markers(example, example_layout(), example_frames(example)), "bodies").type, Marker::TRIANGLE_LIST);
}

TEST(Markers, OfAMovingBodyLieInItsFrameWhereTheGeometryHasIt) {
  const auto drawing = markers(test::moving_tank_case(), example_layout(), example_frames(test::moving_tank_case()));
  for (const char* group : {"bodies", "body edges"}) {
    const Marker body = find(drawing, group);
    EXPECT_EQ(body.header.frame_id, "basin/bodies/box");
    EXPECT_TRUE(body.frame_locked);
    // At the start the frame stands at (1.75, 2.5, 3.2) of the case's coordinates, its axes parallel to theirs.
    double least = 1e9, greatest = -1e9;
    for (const auto& point : body.points) {
      least = std::min(least, 3.2 + body.pose.position.z + point.z);
      greatest = std::max(greatest, 3.2 + body.pose.position.z + point.z);
    }
    EXPECT_NEAR(least, 3.0, 1e-12) << group;
    EXPECT_NEAR(greatest, 3.5, 1e-12) << group;
    EXPECT_NEAR(body.pose.position.x, -1.75, 1e-12);
  }
  for (const char* group : {"tank", "tank edges", "probes", "probe names", "gauges"})
    EXPECT_EQ(find(drawing, group).header.frame_id, "basin");
}

TEST(Markers, PlaceAMovingPackageMeshByItsOwnTransform) {
  Case example = test::moving_box_case();
  MeshSource source;
  source.uri = "package://somewhere/hull.stl";
  source.translation = {1, 2, 3};
  source.rotation = {0, 0, M_PI / 2};
  example.bodies[0].shape = source;
  const Marker body = find(markers(example, example_layout(), example_frames(example)), "bodies");
  EXPECT_EQ(body.header.frame_id, "basin/bodies/box");
  EXPECT_NEAR(body.pose.position.x, 1 - 1.75, 1e-12);
  EXPECT_NEAR(body.pose.position.y, 2 - 2.5, 1e-12);
  EXPECT_NEAR(body.pose.position.z, 3 - 3.2, 1e-12);
  EXPECT_NEAR(body.pose.orientation.z, std::sqrt(0.5), 1e-12);
}

TEST(FeatureEdges, OfABoxAreItsTwelveEdges) { EXPECT_EQ(feature_edges(box_mesh({{0, 0, 0}, {1, 2, 3}}, false, "box"), 0.5).size(), 24U); }

TEST(FeatureEdges, OfAnOpenBoxHaveItsRim) { EXPECT_EQ(feature_edges(box_mesh({{0, 0, 0}, {1, 2, 3}}, true, "box"), 0.5).size(), 24U); }

}  // namespace wavetank
