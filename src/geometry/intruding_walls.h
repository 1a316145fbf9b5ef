#pragma once

#include <vector>

#include "wavetank/geometry/layout.h"

namespace wavetank {

/// Finds the bodies that overlap or touch at the start and will go on to, because a joint holds them together or nothing keeps them apart,
/// though they may move against each other. Their pairs go into layout.intruding, and their facets, cut where they can meet into pieces of
/// half a spacing, into layout.pieces, so that a solver can hide those whose middle lies in the other.
void find_intruding(const Case& checked, const std::vector<TriangleMesh>& meshes, const std::vector<int>& assemblies, Layout& layout);

}  // namespace wavetank
