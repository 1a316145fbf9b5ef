#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "../common/box_case.h"
#include "../common/error_of.h"
#include "../common/scratch_directory.h"
#include "wavetank/common/log.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/rigid/rigid_world.h"

namespace wavetank {

constexpr double pi = 3.14159265358979323846;
constexpr double gravity = 9.81;

/// A box tank with a little water in a corner, for the layout's sake, and no bodies yet.
inline Case dry_case(const Vector3d& size, double spacing) {
  Case result = box_case(size, spacing, spacing);
  result.fluid.fill = {Box{Vector3d::Zero(), Vector3d(2 * spacing, size.y() > 0 ? 2 * spacing : 0.0, spacing)}};
  return result;
}

/// A free box of density 500 kg/m³, about a place.
inline BodyCase free_box(const std::string& name, const Vector3d& centre, const Vector3d& size) {
  BodyCase body;
  body.name = name;
  body.shape = Box{centre - 0.5 * size, centre + 0.5 * size};
  body.motion = Motion::free;
  body.rigid.density = 500;
  return body;
}

/// A mesh as an OBJ file.
inline std::string obj_text(const TriangleMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  for (const Vector3d& v : mesh.vertices) text << "v " << v.x() << " " << v.y() << " " << v.z() << "\n";
  for (const Vector3i& t : mesh.triangles) text << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
  return text.str();
}

/// A polygon in the x–z plane, anticlockwise as x goes right and z up, drawn out along y and closed by fans from its first corner: from
/// there every other corner must be seen.
inline TriangleMesh prism_mesh(const std::vector<Vector3d>& polygon, double from, double to) {
  TriangleMesh mesh;
  const int count = static_cast<int>(polygon.size());
  for (const double y : {from, to})
    for (const Vector3d& corner : polygon) mesh.vertices.emplace_back(corner.x(), y, corner.z());
  for (int k = 0; k < count; ++k) {
    const int next = (k + 1) % count;
    mesh.triangles.emplace_back(k, next, count + k);
    mesh.triangles.emplace_back(next, count + next, count + k);
  }
  for (int k = 1; k + 1 < count; ++k) {
    mesh.triangles.emplace_back(0, k + 1, k);
    mesh.triangles.emplace_back(count, count + k, count + k + 1);
  }
  for (Vector3i& triangle : mesh.triangles)
    std::swap(triangle[1], triangle[2]);  // so that they are wound outwards, whatever the polygon's y
  return mesh;
}

/// A world that steps itself.
class Trial {
 public:
  Trial(const Case& scene, double step) : layout(lay_out(scene)), world(scene, layout), time_step(step), none(world.count()) {}

  void steps(int count, const std::function<void()>& after = {}) {
    for (int k = 0; k < count; ++k) {
      world.advance(time, time_step, load ? load() : none);
      ++taken;
      time = taken * time_step;
      if (after) after();
    }
  }
  void until(double end, const std::function<void()>& after = {}) { steps(static_cast<int>(std::lround((end - time) / time_step)), after); }

  Layout layout;
  RigidWorld world;
  double time_step, time = 0;
  long taken = 0;
  std::vector<RigidLoad> none;
  std::function<std::vector<RigidLoad>()> load;  ///< the fluid's; none = nothing
};

/// What is logged while it lives.
class Logged {
 public:
  Logged() {
    set_log_sink([this](LogLevel, const std::string& line) { lines.push_back(line); });
  }
  ~Logged() {
    set_log_sink([](LogLevel, const std::string&) {});
  }
  std::vector<std::string> lines;
};

}  // namespace wavetank
