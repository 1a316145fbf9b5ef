#pragma once

#include "fluid_filling.h"
#include "open_space.h"
#include "outline.h"
#include "wavetank/geometry/opening.h"

namespace wavetank {

/// The case's openings with their lattices, and which columns stand in water at the start. Throws Error for one that is narrower than two
/// spacings, or under a level where gravity is along no axis.
/// `meshes`: of the owners of walls.
std::vector<Opening> place_openings(const Case& checked, const Basin& basin, double spacing, const std::vector<FilledRegion>& regions,
                                    const std::vector<const TriangleMesh*>& meshes);

/// Throws Error for two openings that overlap, or whose pockets do.
void check_overlaps(const std::vector<Opening>& openings, double spacing);

/// Throws Error for an opening that no water can come to from its front, for a pocket that meets the space that water can reach or a body.
/// `closed`: the space without openings.
void check_openings(const std::vector<Opening>& openings, const Basin& basin, const OpenSpace& closed, double spacing);

/// Where water from them comes out, half a spacing before each column, m.
std::vector<Vector3d> fronts_of(const std::vector<Opening>& openings, double spacing);

/// The water beyond the openings: particles, volumes and levels, after all others of the layout.
void add_water_beyond(const std::vector<FilledRegion>& regions, Layout& layout);

}  // namespace wavetank
