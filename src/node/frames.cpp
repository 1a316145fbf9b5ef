#include "wavetank/node/frames.h"

#include "wavetank/scene/names.h"

namespace wavetank {

std::vector<BodyFrame> body_frames(const Case& checked, const std::vector<Vector3d>& references) {
  const PublishingCase& publishing = checked.publishing;
  std::vector<BodyFrame> frames;
  frames.push_back(
      {publishing.world_frame, inertial_frame(publishing), checked.tank.motion != Motion::fixed, Vector3d::Zero(), references[0]});
  for (std::size_t i = 0; i < checked.bodies.size(); ++i) {
    const BodyCase& body = checked.bodies[i];
    const Vector3d& reference = references[1 + i];
    frames.push_back({body_frame(publishing, body.name), publishing.world_frame, body.motion != Motion::fixed, reference, reference});
  }
  return frames;
}

std::size_t owner_of(const Case& checked, const std::string& body) {
  for (std::size_t i = 0; i < checked.bodies.size(); ++i)
    if (checked.bodies[i].name == body) return 1 + i;
  return 0;
}

std::vector<Vector3d> reference_points(const RigidWorld& bodies) {
  std::vector<Vector3d> references;
  for (std::size_t owner = 0; owner < bodies.count(); ++owner) references.push_back(bodies.reference(owner));
  return references;
}

}  // namespace wavetank
