#include "wavetank/node/markers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "wavetank/geometry/opening_picture.h"
#include "wavetank/node/geometry_messages.h"

namespace wavetank {

namespace {

using visualization_msgs::Marker;

std_msgs::ColorRGBA colour(float red, float green, float blue, float opacity) {
  std_msgs::ColorRGBA result;
  result.r = red;
  result.g = green;
  result.b = blue;
  result.a = opacity;
  return result;
}

Marker marker(const Case& checked, const std::string& group, int id, int type, const std_msgs::ColorRGBA& shade) {
  Marker result;
  result.header.frame_id = checked.publishing.world_frame;
  result.ns = group;
  result.id = id;
  result.type = type;
  result.action = Marker::ADD;
  result.pose.orientation.w = 1.0;
  result.scale.x = result.scale.y = result.scale.z = 1.0;
  result.color = shade;
  result.frame_locked = true;
  return result;
}

bool rviz_reads(const std::string& uri) {
  const std::size_t dot = uri.find_last_of('.');
  if (uri.rfind("package://", 0) != 0 || dot == std::string::npos) return false;
  std::string extension = uri.substr(dot);
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".stl" || extension == ".dae" || extension == ".obj";
}

void place_resource(Marker& result, const MeshSource& source) {
  result.type = Marker::MESH_RESOURCE;
  result.mesh_resource = source.uri;
  result.scale.x = source.scale.x();
  result.scale.y = source.scale.y();
  result.scale.z = source.scale.z();
  result.pose.position = point_message(source.translation);
  const Eigen::Quaterniond turn = Eigen::AngleAxisd(source.rotation.z(), Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(source.rotation.y(), Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(source.rotation.x(), Vector3d::UnitX());
  result.pose.orientation = quaternion_message(turn);
}

/// `source`: the mesh file that the layout's mesh was read from, null for a parametric shape, or where triangles are wanted.
Marker surface_marker(const Case& checked, const std::string& group, int id, const TriangleMesh& mesh, const MeshSource* source,
                      const std_msgs::ColorRGBA& shade) {
  Marker result = marker(checked, group, id, Marker::TRIANGLE_LIST, shade);
  const bool mirrored = source != nullptr && (source->scale.array() < 0).any();  // which rviz would show inside out
  if (source != nullptr && !mirrored && rviz_reads(source->uri)) {
    place_resource(result, *source);
    return result;
  }
  result.points.reserve(3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner) result.points.push_back(point_message(mesh.corner(i, corner)));
  return result;
}

Marker edge_marker(const Case& checked, const std::string& group, int id, const TriangleMesh& mesh, double width,
                   const std_msgs::ColorRGBA& shade) {
  Marker result = marker(checked, group, id, Marker::LINE_LIST, shade);
  result.scale.x = width;
  for (const Vector3d& end : feature_edges(mesh, M_PI / 6.0)) result.points.push_back(point_message(end));
  return result;
}

Marker label(const Case& checked, const std::string& group, int id, const std::string& text, const Vector3d& at, double height) {
  Marker result = marker(checked, group, id, Marker::TEXT_VIEW_FACING, colour(1.0F, 1.0F, 1.0F, 1.0F));
  result.text = text;
  result.pose.position = point_message(at);
  result.scale.z = height;
  return result;
}

std_msgs::ColorRGBA colour_of(OpeningKind kind) {
  if (kind == OpeningKind::inlet) return colour(0.1F, 0.75F, 0.3F, 1.0F);
  if (kind == OpeningKind::outlet) return colour(0.9F, 0.25F, 0.15F, 1.0F);
  return colour(0.55F, 0.3F, 0.9F, 1.0F);
}

/// The wall with its openings cut out; a mesh file is sent as triangles then, since rviz would draw it whole.
Marker wall_marker(const Case& checked, const Layout& layout, std::size_t owner, const std::string& group, int id, const MeshSource* source,
                   const std_msgs::ColorRGBA& shade) {
  const TriangleMesh& mesh = layout.meshes[owner];
  const bool opened = std::any_of(layout.openings.begin(), layout.openings.end(),
                                  [owner](const Opening& opening) { return opening.owner == static_cast<int>(owner); });
  if (!opened) return surface_marker(checked, group, id, mesh, source, shade);
  return surface_marker(checked, group, id, without_openings(mesh, static_cast<int>(owner), layout.openings, layout.spacing), nullptr,
                        shade);
}

/// A marker that is drawn where the case's geometry has the body, in the frame of a body that moves.
Marker moving_with(const BodyFrame& frame, Marker drawn) {
  if (!frame.moves) return drawn;
  drawn.header.frame_id = frame.name;
  drawn.pose.position.x -= frame.origin.x();
  drawn.pose.position.y -= frame.origin.y();
  drawn.pose.position.z -= frame.origin.z();
  return drawn;
}

}  // namespace

std::vector<Vector3d> feature_edges(const TriangleMesh& mesh, double angle) {
  std::map<std::pair<int, int>, std::vector<Vector3d>> normals_at;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vector3d normal = (mesh.corner(i, 1) - mesh.corner(i, 0)).cross(mesh.corner(i, 2) - mesh.corner(i, 0)).normalized();
    for (int side = 0; side < 3; ++side) {
      const int from = mesh.triangles[i][side], to = mesh.triangles[i][(side + 1) % 3];
      normals_at[std::minmax(from, to)].push_back(normal);
    }
  }
  std::vector<Vector3d> ends;
  for (const auto& [edge, normals] : normals_at) {
    // Either side may be wound the other way round, so only the planes count.
    if (normals.size() == 2 && std::abs(normals[0].dot(normals[1])) > std::cos(angle)) continue;
    ends.push_back(mesh.vertices[edge.first]);
    ends.push_back(mesh.vertices[edge.second]);
  }
  return ends;
}

visualization_msgs::MarkerArray markers(const Case& checked, const Layout& layout, const std::vector<BodyFrame>& frames, bool resources) {
  const double size = (layout.domain.max - layout.domain.min).norm();
  const auto source_of = [resources](const auto& shape) { return resources ? std::get_if<MeshSource>(&shape) : nullptr; };
  visualization_msgs::MarkerArray drawing;
  Marker erase = marker(checked, "", 0, Marker::CUBE, colour(0, 0, 0, 0));
  erase.action = Marker::DELETEALL;
  drawing.markers.push_back(erase);

  drawing.markers.push_back(wall_marker(checked, layout, 0, "tank", 0, source_of(checked.tank.shape), colour(0.55F, 0.7F, 0.8F, 0.12F)));
  drawing.markers.push_back(edge_marker(checked, "tank edges", 0, layout.meshes[0], 0.0015 * size, colour(0.75F, 0.8F, 0.85F, 0.9F)));
  for (std::size_t i = 0; i < checked.bodies.size(); ++i) {
    const int id = static_cast<int>(i);
    const TriangleMesh& mesh = layout.meshes[i + 1];
    const auto* source = source_of(checked.bodies[i].shape);
    drawing.markers.push_back(
        moving_with(frames[i + 1], wall_marker(checked, layout, i + 1, "bodies", id, source, colour(0.95F, 0.6F, 0.15F, 1.0F))));
    drawing.markers.push_back(
        moving_with(frames[i + 1], edge_marker(checked, "body edges", id, mesh, 0.0015 * size, colour(0.35F, 0.2F, 0.05F, 1.0F))));
  }

  const double text_height = 0.014 * size;
  for (std::size_t k = 0; k < layout.openings.size(); ++k) {
    const Opening& opening = layout.openings[k];
    const int id = static_cast<int>(k);
    const BodyFrame& frame = frames[opening.owner];
    Marker edge = marker(checked, "openings", id, Marker::LINE_STRIP, colour_of(checked.openings[k].kind));
    edge.scale.x = 0.003 * size;
    const std::vector<Vector3d> corners = drawn_outline(opening, layout.meshes[opening.owner]);
    for (const Vector3d& corner : corners) edge.points.push_back(point_message(corner));
    edge.points.push_back(edge.points.front());
    drawing.markers.push_back(moving_with(frame, edge));
    const Vector3d highest = *std::max_element(corners.begin(), corners.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
    drawing.markers.push_back(
        moving_with(frame, label(checked, "opening names", id, opening.name, highest + Vector3d(0, 0, text_height), text_height)));
  }
  const auto add_probe = [&](const auto& probe, const std::string& kind, int id, const std_msgs::ColorRGBA& shade) {
    Marker sphere = marker(checked, kind + "s", id, Marker::SPHERE, shade);
    const BodyFrame& frame = frames[owner_of(checked, probe.body)];
    sphere.pose.position = point_message(probe.position);
    sphere.scale.x = sphere.scale.y = sphere.scale.z = 0.006 * size;
    drawing.markers.push_back(moving_with(frame, sphere));
    drawing.markers.push_back(
        moving_with(frame, label(checked, kind + " names", id, probe.name, probe.position + Vector3d(0, 0, text_height), text_height)));
  };
  int id = 0;
  for (const PressureProbeCase& probe : checked.instruments.pressure_probes)
    add_probe(probe, "probe", id++, colour(0.9F, 0.1F, 0.1F, 1.0F));
  id = 0;
  for (const VelocityProbeCase& probe : checked.instruments.velocity_probes)
    add_probe(probe, "velocity probe", id++, colour(0.2F, 0.3F, 0.95F, 1.0F));
  for (std::size_t k = 0; k < layout.sections.size(); ++k) {
    const std::vector<Vector3d>& outline = layout.sections[k].outline;
    Marker line = marker(checked, "sections", static_cast<int>(k), Marker::LINE_STRIP, colour(0.2F, 0.3F, 0.95F, 0.9F));
    line.scale.x = 0.001 * size;
    for (const Vector3d& corner : outline) line.points.push_back(point_message(corner));
    line.points.push_back(line.points.front());
    drawing.markers.push_back(line);
    drawing.markers.push_back(label(checked, "section names", static_cast<int>(k), checked.instruments.sections[k].name,
                                    outline.back() + Vector3d(0, 0, text_height), text_height));
  }
  id = 0;
  for (const WaveGaugeCase& gauge : checked.instruments.wave_gauges) {
    const Top over = top_of(checked);
    Vector3d foot = gauge.position, top = foot;
    foot[over.axis] = over.bottom_of(layout.domain);
    top[over.axis] = over.of(layout.domain);
    Marker line = marker(checked, "gauges", id, Marker::LINE_LIST, colour(0.2F, 0.9F, 0.3F, 0.9F));
    line.scale.x = 0.001 * size;
    line.points = {point_message(foot), point_message(top)};
    drawing.markers.push_back(line);
    drawing.markers.push_back(label(checked, "gauge names", id, gauge.name, top + Vector3d(0, 0, text_height), text_height));
    ++id;
  }
  return drawing;
}

}  // namespace wavetank
