#pragma once

#include "section.h"
#include "wavetank/scene/case.h"

namespace wavetank::scene {

/// The keys of a mesh; `declare(name, member, codec, unit, description)` adds one to a section and returns its description.
template <class Declare>
void declare_mesh_keys(Declare declare) {
  declare(
      "mesh", &MeshSource::uri, nonempty_text(), "",
      "Mesh file (STL, OBJ, DAE, ...): package://, file://, an absolute path, or one relative to the case file. Or a closed shape about "
      "its own origin: `shape://box?size=X,Y,Z`, `shape://sphere?radius=R`, `shape://cylinder?radius=R&length=L` (axis z; m), of the last "
      "two also `&facets=N` round a circle, a multiple of 4 from 8 to 512, 24 unless given: the volume is exact, the surface with 24 "
      "within 1.5 % of a sphere's radius and 0.6 % of a cylinder's; facets much smaller than Δx cost time. Within { } a shape needs "
      "quotes.")
      .required = true;
  declare("scale", &MeshSource::scale, scale(), "",
          "Metres per unit of the mesh file; three numbers along its axes stretch it, and a negative one of them mirrors it.");
  declare("translation", &MeshSource::translation, vector(), "m", "Moves the mesh; applied last.");
  declare("rotation", &MeshSource::rotation, angles(), "°", "Roll, pitch and yaw about the fixed axes x, y, z; applied after the scale.");
}

}  // namespace wavetank::scene
