#pragma once

#include <string>
#include <vector>

#include "outline.h"
#include "wavetank/geometry/mesh.h"
#include "wavetank/geometry/opening.h"

namespace wavetank {

/// A side of the space that an opening and its pocket take: n·x < o within it.
struct PocketSide {
  Vector3d normal;  ///< out of the pocket
  double offset;    ///< m
};

/// All of them, front and back included.
std::vector<PocketSide> sides_of_pocket(const Opening& opening, double spacing);

/// Opens a message: which opening, and where.
std::string called(const Opening& opening);

/// Cuts what of a wall lies in the openings and their pockets out of it, and adds the pockets' walls. Throws Error for an opening that lies
/// in no plane of the wall; `whose` is for the message.
void open_outline(Outline& outline, const std::vector<Opening>& openings, double spacing, const std::string& whose);
void open_mesh(TriangleMesh& mesh, const std::vector<Opening>& openings, double spacing, const std::string& whose);

}  // namespace wavetank
