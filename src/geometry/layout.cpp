#include "wavetank/geometry/layout.h"

#include <algorithm>
#include <cmath>

#include "assemblies.h"
#include "flow_sections.h"
#include "fluid_filling.h"
#include "instrument_checks.h"
#include "intruding_walls.h"
#include "mesh_scale.h"
#include "mesh_topology.h"
#include "opening_pockets.h"
#include "openings.h"
#include "polygon.h"
#include "wall_facing.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/geometry/solid_surface.h"

namespace wavetank {
namespace {

constexpr double touching = 1e-4;  // of the spacing: a way that comes so near to a wall crosses it

/// One part of the case: the tank or a body, before the spacing is known.
struct Part {
  TriangleMesh mesh;
  Outline outline;                     ///< in 2-D
  std::vector<TriangleMesh> surfaces;  ///< where solids of the mesh touch or overlap: those that it is made of
};

Box bounds_of(const Part& part, int dimensions) { return dimensions == 2 ? bounding_box(part.outline) : part.mesh.bounding_box(); }

/// Errors of a mesh say whose it is.
template <class Make>
Part named(const std::string& what, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(what + ": " + error.what());
  }
}

/// In 2-D a box without width gets some for the sake of its picture: a tenth of its longest side.
Box with_width(Box box, int dimensions) {
  if (dimensions == 2 && !(box.max.y() > box.min.y())) {
    const double half = 0.05 * (box.max - box.min).maxCoeff();
    box.min.y() = -half;
    box.max.y() = half;
  }
  return box;
}

/// Of the owner's mesh, that openings are to be.
std::vector<std::string> parts_for_openings(const Case& checked, const std::string& body) {
  std::vector<std::string> names;
  for (const OpeningCase& opening : checked.openings)
    if (opening.body == body && !opening.part.empty()) names.push_back(opening.part);
  return names;
}

Part read_tank(const Case& checked, const ResourceResolver& resolve) {
  Part part;
  if (const auto* tank = std::get_if<BoxTank>(&checked.tank.shape)) {
    const Box box{tank->origin, tank->origin + tank->size};
    for (int axis = 0; axis < 3; ++axis) {
      if ((checked.dimensions == 3 || axis != 1) && !(tank->size[axis] > 0))
        throw Error(std::string("the box has no extent along ") + "xyz"[axis]);
    }
    const Top top = top_of(checked);
    part.mesh = box_mesh(with_width(box, checked.dimensions), !tank->closed, "tank", top);
    if (checked.dimensions == 2) part.outline = box_outline(box, !tank->closed, top);
  } else {
    part.mesh = read_mesh(std::get<MeshSource>(checked.tank.shape), checked.directory, resolve, parts_for_openings(checked, ""));
    check_surface(part.mesh);
    if (checked.dimensions == 2) part.outline = cut_mesh(part.mesh);
  }
  return part;
}

Part read_body(const BodyCase& body, const Case& checked, const ResourceResolver& resolve) {
  Part part;
  if (const auto* box = std::get_if<Box>(&body.shape)) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((checked.dimensions == 3 || axis != 1) && !(box->max[axis] > box->min[axis]))
        throw Error(std::string("the box has no extent along ") + "xyz"[axis]);
    }
    part.mesh = box_mesh(with_width(*box, checked.dimensions), false, body.name);
    if (checked.dimensions == 2) part.outline = box_outline(*box, false);
  } else {
    part.mesh = read_mesh(std::get<MeshSource>(body.shape), checked.directory, resolve, parts_for_openings(checked, body.name));
    check_closed(part.mesh);
    if (!solid_surface(part.mesh).empty()) part.surfaces = closed_surfaces(part.mesh);
    if (checked.dimensions == 2) part.outline = cut_mesh(part.mesh);
  }
  return part;
}

std::vector<Part> read_parts(const Case& checked, const ResourceResolver& resolve) {
  std::vector<Part> parts;
  parts.push_back(named("tank", [&] { return read_tank(checked, resolve); }));
  for (const BodyCase& body : checked.bodies) {
    parts.push_back(named("body '" + body.name + "'", [&] { return read_body(body, checked, resolve); }));
  }
  return parts;
}

/// Each surface of a part for itself, in a fixed order.
std::vector<Part> surfaces_of(const Part& part, int dimensions) {
  std::vector<Part> surfaces;
  if (dimensions == 2) {
    for (const Polyline& line : part.outline) surfaces.push_back({{}, {line}, {}});
  } else {
    for (const TriangleMesh& mesh : part.surfaces) surfaces.push_back({mesh, {}, {}});
  }
  if (surfaces.size() < 2) return {part};
  return surfaces;
}

/// Of the parts that are wanted; empty = all.
TriangleGrid make_grid(const std::vector<Part>& parts, int dimensions, double spacing, const std::vector<bool>& wanted = {}) {
  std::vector<WallTriangle> triangles;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!wanted.empty() && !wanted[p]) continue;
    const int owner = static_cast<int>(p);
    int surface = 0;
    for (const Part& alone : surfaces_of(parts[p], dimensions)) {
      if (dimensions == 2) {
        for (WallTriangle& wall : ribbons(alone.outline, 2 * spacing, owner)) {
          wall.surface = surface;
          triangles.push_back(wall);
        }
      } else {
        const TriangleMesh& mesh = alone.mesh;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
          triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), owner, surface});
      }
      ++surface;
    }
  }
  return TriangleGrid(triangles, touching * spacing);
}

Basin make_basin(const Case& checked, const std::vector<Part>& parts, const Box& domain) {
  Basin basin;
  basin.dimensions = checked.dimensions;
  basin.domain = domain;
  basin.up = upward(checked);
  basin.top = top_of(checked);
  basin.periodic = checked.tank.periodic;
  basin.has_films = checked.numerics.gradients == Gradients::sph;
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) {
    basin.solids.push_back(
        {checked.bodies[b].name, &parts[b + 1].mesh, parts[b + 1].outline, checked.dimensions, checked.bodies[b].motion == Motion::free});
  }
  return basin;
}

std::vector<FilledRegion> fill(const Case& checked, const Basin& basin, double spacing) {
  std::vector<FilledRegion> regions;
  const InitialState initial(checked);
  for (std::size_t f = 0; f < checked.fluid.fill.size(); ++f) {
    const std::string key = "fluid/fill/" + std::to_string(f);
    const FillRegion& region = checked.fluid.fill[f];
    if (const auto* box = std::get_if<Box>(&region)) {
      regions.push_back(fill_box(basin, *box, spacing, key));
    } else {
      regions.push_back(fill_flood(basin, std::get<FloodFill>(region), spacing, key));
    }
    if (initial.has_elevation()) raise_surface(basin, initial, regions.back());
    keep_off_walls(basin, spacing, regions.back());
    share_cells(basin, regions.back());
    keep_out_of_gaps(basin, regions.back());
  }
  return regions;
}

double volume_of(const std::vector<FilledRegion>& regions) {
  double volume = 0;
  for (const FilledRegion& region : regions)
    volume += region.volume * static_cast<double>(std::count(region.filled.begin(), region.filled.end(), 1));
  return volume;
}

/// A volume that certainly holds the fluid: of the boxes, and of the domain below the levels.
double volume_bound(const Case& checked, const Box& domain) {
  double volume = 0;
  for (const FillRegion& region : checked.fluid.fill) {
    Vector3d size;
    if (const auto* box = std::get_if<Box>(&region)) {
      size = box->max - box->min;
    } else {
      size = domain.max - domain.min;
      const Top top = top_of(checked);
      const double depth = top.way * (std::get<FloodFill>(region).level - top.bottom_of(domain));
      if (upward(checked) == top.normal()) size[top.axis] = std::min(size[top.axis], depth);
    }
    volume += size.x() * size.z() * (checked.dimensions == 2 ? 1.0 : size.y());
  }
  return volume;
}

/// A particle must fit into the tank: else a single one may stand for all of its water.
void check_spacing(double spacing, const Box& domain, const Case& checked) {
  const std::string given = checked.fluid.spacing ? "fluid/spacing is " : "fluid/particles gives a spacing of ";
  for (int axis = 0; axis < 3; ++axis) {
    const double length = domain.max[axis] - domain.min[axis];
    if ((checked.dimensions == 2 && axis == 1) || spacing <= length * (1 + 1e-6)) continue;
    throw Error(given + describe(spacing) + " m, larger than the tank, which is " + describe(length) + " m along " + "xyz"[axis] +
                "; there must be several particles over the water's depth");
  }
}

double choose_spacing(const Case& checked, const std::vector<Part>& parts, Basin basin) {
  if (checked.fluid.spacing) {
    if (!(*checked.fluid.spacing > 0)) throw Error("fluid/spacing must be positive");
    return *checked.fluid.spacing;
  }
  if (!checked.fluid.particles || *checked.fluid.particles == 0)
    throw Error("give fluid/spacing in m or a positive number of fluid/particles");
  const double number = static_cast<double>(*checked.fluid.particles), power = 1.0 / checked.dimensions;
  const double bound = volume_bound(checked, basin.domain);
  if (!(bound > 0)) throw Error("fluid/fill has no volume, so that fluid/particles gives no spacing");
  double spacing = std::pow(bound / number, power);
  // Floods and bodies leave less than the bound: fill with what it gives, and correct.
  const TriangleGrid grid = make_grid(parts, checked.dimensions, spacing);
  basin.grid = &grid;
  const double volume = volume_of(fill(checked, basin, spacing));
  return volume > 0 ? std::pow(volume / number, power) : spacing;
}

/// Whether the lid has elements on the box's faces that look up.
bool is_open_above(const Box& box, const std::vector<WallElement>& lid, const Basin& basin, double spacing) {
  const Vector3d margin = Vector3d::Constant(0.1 * spacing);
  return std::any_of(lid.begin(), lid.end(), [&](const WallElement& element) {
    if (!(element.normal.dot(basin.up) > 0.05)) return false;
    for (int axis = 0; axis < 3; ++axis) {
      if (basin.dimensions == 2 && axis == 1) continue;
      if (element.centre[axis] < box.min[axis] - margin[axis] || element.centre[axis] > box.max[axis] + margin[axis]) return false;
    }
    return true;
  });
}

/// Of the layout: see there.
Vector3d hydrostatic_direction(const Case& checked, const Basin& basin, const Layout& layout) {
  if (basin.up == basin.top.normal()) return basin.up;
  for (const FillRegion& region : checked.fluid.fill) {
    const auto* box = std::get_if<Box>(&region);
    if (box != nullptr && is_open_above(*box, layout.lid, basin, layout.spacing)) return basin.top.normal();
  }
  return basin.up;
}

double level_over(const Vector3d& place, const FillRegion& fill, const FreeSurface& surface, const Vector3d& up) {
  if (surface.normal == up) return surface.height;
  if (const auto* full = std::get_if<Box>(&fill)) return highest_of(*full, up);
  return up.dot(place) + (surface.height - surface.normal.dot(place)) / surface.normal.dot(up);
}

/// Of the surface over a cell.
double level_over(const FilledRegion& region, std::size_t cell, const FillRegion& fill, const Vector3d& up) {
  if (!region.curved.height.empty()) return region.curved.height[cell % region.curved.height.size()];
  return level_over(region.position[cell], fill, region.surface, up);
}

void find_levels(const Case& checked, const std::vector<FilledRegion>& regions, Layout& layout) {
  for (std::size_t f = 0; f < regions.size(); ++f)
    for (std::size_t c = 0; c < regions[f].filled.size(); ++c)
      if (regions[f].filled[c]) layout.levels.push_back(level_over(regions[f], c, checked.fluid.fill[f], layout.up));
}

void add_particles(const std::vector<FilledRegion>& regions, Layout& layout) {
  for (const FilledRegion& region : regions) {
    for (std::size_t c = 0; c < region.filled.size(); ++c) {
      if (!region.filled[c]) continue;
      layout.particles.push_back(region.position[c]);
      layout.volumes.push_back(region.share[c] * region.volume);
      if (!region.curved.stretch.empty()) layout.volumes.back() *= region.curved.stretch[c];
    }
  }
}

/// Samples one surface's walls where `open`, the space about it, wets them; `grid` has what may stand before them.
/// `within`: what lies outside of it is not wetted.
void add_walls_of_surface(const Part& part, WallSource source, const OpenSpace& open, const TriangleGrid& grid, const Case& checked,
                          const Box& within, Layout& layout) {
  const int dimensions = checked.dimensions;
  const std::vector<WallPatch> patches =
      dimensions == 2 ? sample_outline(part.outline, layout.spacing, within) : sample_mesh(part.mesh, layout.spacing, within);
  std::vector<WallElement> walls = face_walls(patches, source, open, grid, layout.spacing);
  if (dimensions == 2) {
    for (WallElement& wall : walls) {
      wall.area /= layout.spacing;                               // the ribbons' width
      wall.centre.y() = wall.normal.y() = wall.tangent.y() = 0;  // free of rounding
    }
  }
  layout.walls.insert(layout.walls.end(), walls.begin(), walls.end());
  const auto add = [&](const std::vector<WallPatch>& from, std::vector<Facet>& to) {
    const std::vector<Facet> facets = face_facets(from, source, open, grid, layout.spacing, dimensions);
    to.insert(to.end(), facets.begin(), facets.end());
  };
  add(dimensions == 2 ? whole_facets(part.outline, layout.spacing) : whole_facets(part.mesh), layout.facets);
  if (checked.numerics.walls.elements == WallElements::semi_analytical) add(patches, layout.triangles);
}

void add_walls_of(const Part& part, int owner, const OpenSpace& open, const TriangleGrid& grid, const Case& checked, const Box& within,
                  Layout& layout) {
  WallSource source{owner, 0};
  for (const Part& surface : surfaces_of(part, checked.dimensions)) {
    add_walls_of_surface(surface, source, open, grid, checked, within, layout);
    ++source.surface;
  }
}

/// All of the outside of what it is part of, as water all round that would wet it: `assembly` are the parts that move as it does.
void add_moving_walls(const std::vector<Part>& parts, std::size_t p, const std::vector<bool>& assembly, const Case& checked,
                      Layout& layout) {
  const TriangleGrid grid = make_grid(parts, checked.dimensions, layout.spacing, assembly);
  Box room = bounds_of(parts[p], checked.dimensions);
  const Box own = room;
  for (std::size_t other = 0; other < parts.size(); ++other) {
    if (!assembly[other]) continue;
    const Box box = bounds_of(parts[other], checked.dimensions);
    if ((box.min.array() > own.max.array()).any() || (box.max.array() < own.min.array()).any()) continue;
    room.min = room.min.cwiseMin(box.min);
    room.max = room.max.cwiseMax(box.max);
  }
  Vector3d margin = Vector3d::Constant(3 * layout.spacing);
  if (checked.dimensions == 2) margin.y() = 0;
  room.min -= margin;
  room.max += margin;
  OpenSpace outside(room, checked.dimensions, layout.spacing, grid, Walls::all);
  outside.flood({room.min + margin / 6, room.max - margin / 6});
  add_walls_of(parts[p], static_cast<int>(p), outside, grid, checked, room, layout);
}

/// A body of any size may stand in a tank; but not one of any number of cells of the spacing.
void check_sizes(const Case& checked, const std::vector<Part>& parts, const Layout& layout) {
  constexpr double most_cells = 1e8, many_tanks = 10;
  const double tank = (layout.domain.max - layout.domain.min).maxCoeff();
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) {
    const Box box = bounds_of(parts[b + 1], checked.dimensions);
    const Vector3d size = box.max - box.min;
    const std::string reaches =
        "body '" + checked.bodies[b].name + "' reaches from " + describe(box.min) + " to " + describe(box.max) + " m";
    double cells = (size / layout.spacing).maxCoeff();
    if (layout.moving[b + 1]) cells = (size / layout.spacing).array().max(1).prod();
    if (cells > most_cells) {
      throw Error(reaches + ", too far for a particle spacing of " + describe(layout.spacing) + " m: " + describe(cells) +
                  " cells, and 1e8 at most are allowed; make it smaller, or check the scale of its mesh");
    }
    const double beyond = std::max((layout.domain.min - box.min).maxCoeff(), (box.max - layout.domain.max).maxCoeff());
    if (beyond > many_tanks * tank)
      log(LogLevel::warning,
          reaches + ", far out of the tank, which is " + describe(tank) + " m long; the water meets only what is in the tank");
  }
}

/// Of a tank that a slip of the pen has made endless, before minutes go into its walls.
void tell_of_endless_tank(const Case& checked, const Layout& layout) {
  constexpr double many_cells = 3e6, many_times = 300;
  Vector3d size = layout.domain.max - layout.domain.min;
  if (checked.dimensions == 2) size.y() = 1;
  Vector3d cells = (size / layout.spacing).cwiseMax(1);
  if (checked.dimensions == 2) cells.y() = 1;
  const double water = volume_bound(checked, layout.domain), times = size.prod() / water;
  if (!(water > 0 && cells.prod() > many_cells && times > many_times)) return;
  log(LogLevel::warning, "the tank reaches from " + describe(layout.domain.min) + " to " + describe(layout.domain.max) + " m, " +
                             describe(std::round(times)) + " times as large as its water, and takes " + describe(std::round(cells.prod())) +
                             " cells of the particle spacing of " + describe(layout.spacing) + " m: check its size");
}

void add_walls(const std::vector<Part>& parts, const std::vector<int>& assemblies, const OpenSpace& open, const TriangleGrid& grid,
               const Case& checked, Layout& layout) {
  const Vector3d margin = Vector3d::Constant(2 * layout.spacing);
  const Box reach = with_pockets(layout.domain, layout.openings, checked.dimensions);
  const Box near{reach.min - margin, reach.max + margin};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!layout.moving[p]) {
      add_walls_of(parts[p], static_cast<int>(p), open, grid, checked, near, layout);
      continue;
    }
    std::vector<bool> assembly(parts.size());
    for (std::size_t other = 1; other < parts.size(); ++other) assembly[other] = assemblies[other] == assemblies[p];
    add_moving_walls(parts, p, assembly, checked, layout);
  }
}

/// Takes out the walls at the ends of a periodic tank.
void open_periodic_ends(const std::array<bool, 3>& periodic, Layout& layout) {
  const double tolerance = 1e-3 * layout.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    if (!periodic[axis]) continue;
    const auto at_end = [&](const Vector3d& place, const Vector3d& normal) {
      const double end = normal[axis] < 0 ? layout.domain.min[axis] : layout.domain.max[axis];
      return std::abs(normal[axis]) > 0.999 && std::abs(place[axis] - end) < tolerance;
    };
    const auto facet_at_end = [&](const Facet& facet) { return at_end(facet.plane_point, facet.normal); };
    const auto element_at_end = [&](const WallElement& wall) { return at_end(wall.centre, wall.normal); };
    layout.walls.erase(std::remove_if(layout.walls.begin(), layout.walls.end(), element_at_end), layout.walls.end());
    layout.facets.erase(std::remove_if(layout.facets.begin(), layout.facets.end(), facet_at_end), layout.facets.end());
    layout.triangles.erase(std::remove_if(layout.triangles.begin(), layout.triangles.end(), facet_at_end), layout.triangles.end());
  }
}

std::string name_of_part(const Case& checked, std::size_t part) {
  return part == 0 ? "the tank" : "body '" + checked.bodies[part - 1].name + "'";
}

/// The parts with the holes that openings make in them.
std::vector<Part> opened_parts(const Case& checked, const std::vector<Part>& parts, const Layout& layout) {
  std::vector<Part> opened = parts;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<Opening> of_part;
    for (const Opening& opening : layout.openings)
      if (opening.owner == static_cast<int>(p)) of_part.push_back(opening);
    if (of_part.empty()) continue;
    const std::string whose = name_of_part(checked, p);
    if (checked.dimensions == 2) {
      open_outline(opened[p].outline, of_part, layout.spacing, whose);
      continue;
    }
    if (!parts[p].surfaces.empty())
      throw Error("opening '" + of_part.front().name + "' is in " + whose +
                  ", whose mesh has solids that touch or overlap; openings are for bodies of one closed surface");
    open_mesh(opened[p].mesh, of_part, layout.spacing, whose);
  }
  return opened;
}

void check_periods(const Case& checked, const Layout& layout) {
  const Box reach = with_pockets(layout.domain, layout.openings, checked.dimensions);
  for (int axis = 0; axis < 3; ++axis) {
    const bool grown = reach.min[axis] < layout.domain.min[axis] || reach.max[axis] > layout.domain.max[axis];
    if (checked.tank.periodic[axis] && grown)
      throw Error(std::string("an opening's pocket reaches beyond the tank along ") + "xyz"[axis] +
                  ", along which tank/periodic repeats it; put openings elsewhere, or leave that axis out of tank/periodic");
  }
}

/// The case's openings, the water beyond them, and the parts with holes.
std::vector<Part> add_openings(const Case& checked, const std::vector<Part>& parts, const Basin& basin,
                               const std::vector<FilledRegion>& regions, Layout& layout) {
  std::vector<const TriangleMesh*> meshes;
  for (const Part& part : parts) meshes.push_back(&part.mesh);
  layout.openings = place_openings(checked, basin, layout.spacing, regions, meshes);
  check_overlaps(layout.openings, layout.spacing);
  std::vector<Part> opened = opened_parts(checked, parts, layout);
  if (layout.openings.empty()) return opened;
  check_periods(checked, layout);
  OpenSpace closed(layout.domain, checked.dimensions, layout.spacing, *basin.grid, Walls::all, basin.top);
  std::vector<Vector3d> water = layout.particles;
  for (std::size_t o = 0; o < layout.openings.size(); ++o) {
    if (!layout.particles.empty() && checked.openings[o].kind == OpeningKind::outlet) continue;
    const std::vector<Vector3d> fronts = fronts_of({layout.openings[o]}, layout.spacing);
    water.insert(water.end(), fronts.begin(), fronts.end());
  }
  closed.flood(water);
  check_openings(layout.openings, basin, closed, layout.spacing);
  add_water_beyond(regions, layout);
  if (layout.particles.empty()) throw Error("there is no water at the start, neither by fluid/fill nor behind an opening");
  return opened;
}

/// Leaves the parts their meshes.
Layout lay_out_parts(const Case& checked, const std::vector<Part>& parts) {
  Layout layout;
  layout.domain = bounds_of(parts[0], checked.dimensions);

  Basin basin = make_basin(checked, parts, layout.domain);
  layout.spacing = choose_spacing(checked, parts, basin);
  check_spacing(layout.spacing, layout.domain, checked);
  const TriangleGrid grid = make_grid(parts, checked.dimensions, layout.spacing);
  basin.grid = &grid;
  layout.moving.assign(parts.size(), false);  // the tank never does: the fluid is solved in its frame
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) layout.moving[b + 1] = checked.bodies[b].motion != Motion::fixed;
  check_sizes(checked, parts, layout);
  tell_of_endless_tank(checked, layout);

  const std::vector<FilledRegion> regions = fill(checked, basin, layout.spacing);
  for (const FilledRegion& region : regions) check_watertight(basin, layout.spacing, region);
  check_overlap(regions, layout.spacing);
  tell_of_parted_water(checked, basin, layout.spacing, regions);
  add_particles(regions, layout);
  if (layout.particles.empty() && !checked.fluid.fill.empty())
    throw Error("fluid/fill has no room for a single particle of spacing " + describe(layout.spacing) + " m");

  layout.lid = make_lid(basin, layout.spacing, regions);
  layout.up = hydrostatic_direction(checked, basin, layout);
  find_levels(checked, regions, layout);
  const std::vector<Part> opened = add_openings(checked, parts, basin, regions, layout);

  const std::vector<int> assemblies = rigid_assemblies(checked);
  std::vector<bool> standing = layout.moving;
  standing.flip();
  for (std::size_t p = 1; p < parts.size(); ++p) standing[p] = standing[p] || assemblies[p] == 0;
  const TriangleGrid standing_grid = make_grid(opened, checked.dimensions, layout.spacing, standing);
  OpenSpace open(with_pockets(layout.domain, layout.openings, checked.dimensions), checked.dimensions, layout.spacing, standing_grid,
                 Walls::all, basin.top);
  open.flood(layout.particles);
  layout.open_top = open.open_top();
  add_walls(opened, assemblies, open, standing_grid, checked, layout);
  open_periodic_ends(checked.tank.periodic, layout);
  std::vector<TriangleMesh> meshes;
  for (const Part& part : parts) meshes.push_back(part.mesh);
  find_intruding(checked, meshes, assemblies, layout);
  check_instruments(checked.instruments, basin, open, layout.spacing);
  layout.disc_normals = disc_normals(checked.instruments, basin, layout.openings, layout.spacing);
  layout.sections = place_sections(checked.instruments.sections, basin, open, layout.spacing);
  return layout;
}

double depth_of(const Layout& layout) {
  double deepest = 0, shallowest = layout.spacing;
  for (std::size_t i = 0; i < layout.particles.size(); ++i) {
    deepest = std::max(deepest, layout.levels[i] - layout.particles[i].z());
    shallowest = std::min(shallowest, layout.levels[i] - layout.particles[i].z());
  }
  return deepest + shallowest;
}

}  // namespace

Layout lay_out(const Case& checked, const ResourceResolver& resolve) {
  std::vector<Part> parts = read_parts(checked, resolve);
  std::vector<const TriangleMesh*> meshes;
  for (const Part& part : parts) meshes.push_back(&part.mesh);
  const MeshScale scale(checked, meshes);
  scale.check_bodies();
  Layout layout;
  try {
    layout = lay_out_parts(checked, parts);
  } catch (const Error& error) {  // whatever does not fit may do so for a mesh of the wrong size
    throw Error(error.what() + scale.doubts());
  }
  const std::string doubts = scale.doubts_of_a_sound_case(depth_of(layout));
  if (!doubts.empty()) log(LogLevel::warning, doubts);

  for (Part& part : parts) {
    layout.meshes.push_back(std::move(part.mesh));
  }
  return layout;
}

}  // namespace wavetank
