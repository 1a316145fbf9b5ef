#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of a mesh; `declare(name, member, codec, unit, description)` adds one to a section and returns its description.
template <class Declare>
void declare_mesh_keys(Declare declare) {
  declare("mesh", &MeshSource::uri, nonempty_text(), "",
          "Mesh file (STL, OBJ, DAE, ...): package://, file://, an absolute path, or one relative to the case file.")
      .required = true;
  declare("scale", &MeshSource::scale, number(greater_than(0)), "", "Metres per unit of the mesh file.");
  declare("translation", &MeshSource::translation, vector(), "m", "Moves the mesh; applied last.");
  declare("rotation", &MeshSource::rotation, angles(), "°", "Roll, pitch and yaw about the fixed axes x, y, z; applied after the scale.");
}

}  // namespace wavetank::scene
