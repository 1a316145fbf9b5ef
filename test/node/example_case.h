#pragma once

#include "wavetank/geometry/layout.h"
#include "wavetank/node/frames.h"
#include "wavetank/scene/case.h"

namespace wavetank::test {

/// A tank of 2 × 1 × 1 m with its corner at (1, 2, 3) and one box in it, two probes and a gauge.
inline Case example_case() {
  Case example;
  example.title = "an example";
  example.duration = 2.0;
  BoxTank tank;
  tank.size = {2, 1, 1};
  tank.origin = {1, 2, 3};
  example.tank.shape = tank;
  BodyCase body;
  body.name = "box";
  body.shape = Box{{1.5, 2.25, 3.0}, {2.0, 2.75, 3.5}};
  example.bodies = {body};
  example.instruments.pressure_probes = {{"P1", {1.5, 2.5, 3.1}}, {"P2", {2.0, 2.5, 3.2}}};
  example.instruments.wave_gauges = {{"H1", {2.5, 2.5, 0}}};
  example.publishing.world_frame = "basin";
  example.publishing.reference_pressure = 101325.0;
  return example;
}

/// The part of that case's layout that messages are made from.
inline Layout example_layout() {
  Layout layout;
  layout.domain = {{1, 2, 3}, {3, 3, 4}};
  layout.meshes = {box_mesh(layout.domain, true, "tank"), box_mesh({{1.5, 2.25, 3.0}, {2.0, 2.75, 3.5}}, false, "box")};
  return layout;
}

/// Its frames: the box's reference point lies off the middle of its volume.
inline std::vector<BodyFrame> example_frames(const Case& example = example_case()) {
  return body_frames(example, {{0, 0, 0}, {1.75, 2.5, 3.2}});
}

/// The same case with a box that moves.
inline Case moving_box_case() {
  Case example = example_case();
  example.bodies[0].motion = Motion::free;
  return example;
}

/// The same in a tank that moves too.
inline Case moving_tank_case() {
  Case example = moving_box_case();
  example.tank.motion = Motion::commanded;
  return example;
}

}  // namespace wavetank::test
