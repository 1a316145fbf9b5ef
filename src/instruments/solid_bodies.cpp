#include "wavetank/instruments/solid_bodies.h"

#include <limits>

namespace wavetank {
namespace {

bool within(const Box& box, const Vector3d& point) {
  return (point.array() > box.min.array()).all() && (point.array() < box.max.array()).all();
}

}  // namespace

bool SolidBody::contains(const Vector3d& point) const { return within(box, point) && (is_box || inside(mesh, point)); }

std::vector<SolidBody> solid_bodies(const Case& scene, const Layout& layout) {
  std::vector<SolidBody> bodies;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Box* box = std::get_if<Box>(&scene.bodies[b].shape);
    SolidBody body{1 + b, layout.meshes[1 + b], box != nullptr, box != nullptr ? *box : layout.meshes[1 + b].bounding_box()};
    if (scene.dimensions == 2) {
      body.box.min.y() = -std::numeric_limits<double>::infinity();
      body.box.max.y() = std::numeric_limits<double>::infinity();
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

std::vector<char> without_bodies(std::vector<char> open, const std::vector<Vector3d>& places, const std::vector<SolidBody>& bodies,
                                 const RigidWorld& world) {
  for (const SolidBody& body : bodies) {
    const RigidState state = world.state_in_tank(body.owner);
    const Quaterniond back = state.orientation.conjugate();
    for (std::size_t k = 0; k < places.size(); ++k)
      if (open[k] && body.contains(back * (places[k] - state.position) + world.reference(body.owner))) open[k] = 0;
  }
  return open;
}

}  // namespace wavetank
