#include "wavetank/geometry/layout.h"

#include <algorithm>
#include <cmath>

#include "fluid_filling.h"
#include "instrument_checks.h"
#include "mesh_topology.h"
#include "polygon.h"
#include "wall_facing.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double touching = 1e-4;  // of the spacing: a way that comes so near to a wall crosses it

/// One part of the case: the tank or a body, before the spacing is known.
struct Part {
  TriangleMesh mesh;
  Outline outline;  ///< in 2-D
};

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
    part.mesh = read_mesh(std::get<MeshSource>(checked.tank.shape), checked.directory, resolve);
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
    part.mesh = read_mesh(std::get<MeshSource>(body.shape), checked.directory, resolve);
    check_closed(part.mesh);
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

/// Of the parts that are wanted; empty = all.
TriangleGrid make_grid(const std::vector<Part>& parts, int dimensions, double spacing, const std::vector<bool>& wanted = {}) {
  std::vector<WallTriangle> triangles;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (!wanted.empty() && !wanted[p]) continue;
    const int owner = static_cast<int>(p);
    if (dimensions == 2) {
      const std::vector<WallTriangle> wall = ribbons(parts[p].outline, 2 * spacing, owner);
      triangles.insert(triangles.end(), wall.begin(), wall.end());
      continue;
    }
    const TriangleMesh& mesh = parts[p].mesh;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), owner});
  }
  return TriangleGrid(triangles, spacing, touching * spacing);
}

Basin make_basin(const Case& checked, const std::vector<Part>& parts, const Box& domain) {
  Basin basin;
  basin.dimensions = checked.dimensions;
  basin.domain = domain;
  basin.up = upward(checked);
  basin.top = top_of(checked);
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) {
    basin.solids.push_back({checked.bodies[b].name, &parts[b + 1].mesh, parts[b + 1].outline, checked.dimensions});
  }
  return basin;
}

std::vector<FilledRegion> fill(const Case& checked, const Basin& basin, double spacing) {
  std::vector<FilledRegion> regions;
  for (std::size_t f = 0; f < checked.fluid.fill.size(); ++f) {
    const std::string key = "fluid/fill/" + std::to_string(f);
    const FillRegion& region = checked.fluid.fill[f];
    if (const auto* box = std::get_if<Box>(&region)) {
      regions.push_back(fill_box(basin, *box, spacing, key));
    } else {
      regions.push_back(fill_flood(basin, std::get<FloodFill>(region), spacing, key));
    }
    keep_off_walls(basin, spacing, regions.back());
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

void find_levels(const Case& checked, const std::vector<FilledRegion>& regions, Layout& layout) {
  for (std::size_t f = 0; f < regions.size(); ++f)
    for (std::size_t c = 0; c < regions[f].filled.size(); ++c)
      if (regions[f].filled[c])
        layout.levels.push_back(level_over(regions[f].position[c], checked.fluid.fill[f], regions[f].surface, layout.up));
}

void add_particles(const std::vector<FilledRegion>& regions, Layout& layout) {
  for (const FilledRegion& region : regions) {
    for (std::size_t c = 0; c < region.filled.size(); ++c) {
      if (!region.filled[c]) continue;
      layout.particles.push_back(region.position[c]);
      layout.volumes.push_back(region.volume);
    }
  }
}

/// Samples one part's walls where `open`, the space about it, wets them; `grid` has what may stand before them.
void add_walls_of(const Part& part, int owner, const OpenSpace& open, const TriangleGrid& grid, const Case& checked, Layout& layout) {
  const int dimensions = checked.dimensions;
  const std::vector<WallPatch> patches =
      dimensions == 2 ? sample_outline(part.outline, layout.spacing) : sample_mesh(part.mesh, layout.spacing);
  std::vector<WallElement> walls = face_walls(patches, owner, open, grid, layout.spacing);
  if (dimensions == 2) {
    for (WallElement& wall : walls) {
      wall.area /= layout.spacing;                               // the ribbons' width
      wall.centre.y() = wall.normal.y() = wall.tangent.y() = 0;  // free of rounding
    }
  }
  layout.walls.insert(layout.walls.end(), walls.begin(), walls.end());
  const auto add = [&](const std::vector<WallPatch>& from, std::vector<Facet>& to) {
    const std::vector<Facet> facets = face_facets(from, owner, open, grid, layout.spacing, dimensions);
    to.insert(to.end(), facets.begin(), facets.end());
  };
  add(dimensions == 2 ? whole_facets(part.outline, layout.spacing) : whole_facets(part.mesh), layout.facets);
  if (checked.numerics.walls.elements == WallElements::semi_analytical) add(patches, layout.triangles);
}

/// All of its outside, as water all round it would wet it.
void add_moving_walls(const std::vector<Part>& parts, std::size_t p, const Case& checked, Layout& layout) {
  std::vector<bool> alone(parts.size(), false);
  alone[p] = true;
  const TriangleGrid grid = make_grid(parts, checked.dimensions, layout.spacing, alone);
  Box room = checked.dimensions == 2 ? bounding_box(parts[p].outline) : parts[p].mesh.bounding_box();
  Vector3d margin = Vector3d::Constant(3 * layout.spacing);
  if (checked.dimensions == 2) margin.y() = 0;
  room.min -= margin;
  room.max += margin;
  OpenSpace outside(room, checked.dimensions, layout.spacing, grid, Walls::all);
  outside.flood({room.min + margin / 6, room.max - margin / 6});
  add_walls_of(parts[p], static_cast<int>(p), outside, grid, checked, layout);
}

void add_walls(const std::vector<Part>& parts, const OpenSpace& open, const TriangleGrid& grid, const Case& checked, Layout& layout) {
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (layout.moving[p])
      add_moving_walls(parts, p, checked, layout);
    else
      add_walls_of(parts[p], static_cast<int>(p), open, grid, checked, layout);
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

}  // namespace

Layout lay_out(const Case& checked, const ResourceResolver& resolve) {
  std::vector<Part> parts = read_parts(checked, resolve);
  Layout layout;
  layout.domain = checked.dimensions == 2 ? bounding_box(parts[0].outline) : parts[0].mesh.bounding_box();

  Basin basin = make_basin(checked, parts, layout.domain);
  layout.spacing = choose_spacing(checked, parts, basin);
  const TriangleGrid grid = make_grid(parts, checked.dimensions, layout.spacing);
  basin.grid = &grid;

  const std::vector<FilledRegion> regions = fill(checked, basin, layout.spacing);
  for (const FilledRegion& region : regions) check_watertight(basin, layout.spacing, region);
  check_overlap(regions, layout.spacing);
  add_particles(regions, layout);
  if (layout.particles.empty()) throw Error("fluid/fill has no room for a single particle of spacing " + describe(layout.spacing) + " m");

  layout.moving.assign(parts.size(), false);  // the tank never does: the fluid is solved in its frame
  for (std::size_t b = 0; b < checked.bodies.size(); ++b) layout.moving[b + 1] = checked.bodies[b].motion != Motion::fixed;
  std::vector<bool> standing = layout.moving;
  standing.flip();
  const TriangleGrid standing_grid = make_grid(parts, checked.dimensions, layout.spacing, standing);
  OpenSpace open(layout.domain, checked.dimensions, layout.spacing, standing_grid, Walls::all, basin.top);
  open.flood(layout.particles);
  layout.open_top = open.open_top();
  add_walls(parts, open, standing_grid, checked, layout);
  open_periodic_ends(checked.tank.periodic, layout);
  layout.lid = make_lid(basin, layout.spacing, regions);
  layout.up = hydrostatic_direction(checked, basin, layout);
  find_levels(checked, regions, layout);
  check_instruments(checked.instruments, basin, open, layout.spacing);

  for (Part& part : parts) {
    layout.meshes.push_back(std::move(part.mesh));
  }
  return layout;
}

}  // namespace wavetank
