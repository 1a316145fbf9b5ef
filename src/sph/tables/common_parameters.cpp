#include <cmath>

#include "parameters.h"

namespace wavetank {
namespace {

using Source = ParameterSource;

constexpr double everywhere = 1e30;  // m, higher than any rim

double rim(const Source& s) {
  const Discretisation& d = s.discretisation;
  return d.splash_guard ? d.top.way * (d.rim - d.origin[d.top.axis]) : everywhere;
}

double period(const Source& s, int axis) {
  return s.scene.tank.periodic[axis] ? s.layout.domain.max[axis] - s.layout.domain.min[axis] : 0.0;
}

ParameterRow integer(const char* name, const char* meaning, std::function<double(const Source&)> value) {
  return {name, "", meaning, std::move(value), ParameterRow::Kind::integer};
}

/// A vector as three rows NAME_x, NAME_y, NAME_z.
void add_vector(std::vector<ParameterRow>& rows, const char* name, const char* unit, const char* meaning,
                const std::function<double(const Source&, int axis)>& value) {
  for (int axis = 0; axis < 3; ++axis)
    rows.push_back({std::string(name) + "_" + "xyz"[axis], unit, meaning, [value, axis](const Source& s) { return value(s, axis); }});
}

std::vector<ParameterRow> make_rows() {
  std::vector<ParameterRow> rows{
      {"spacing", "m", "Δx", [](const Source& s) { return s.discretisation.spacing; }},
      {"smoothing_length", "m", "h", [](const Source& s) { return s.discretisation.smoothing_length; }},
      {"inverse_smoothing", "1/m", "1/h", [](const Source& s) { return 1.0 / s.discretisation.smoothing_length; }},
      {"support", "m", "R = 2h", [](const Source& s) { return s.discretisation.support; }},
      {"support_squared", "m²", "R²", [](const Source& s) { return s.discretisation.support * s.discretisation.support; }},
      {"inverse_support", "1/m", "1/R", [](const Source& s) { return 1.0 / s.discretisation.support; }},
      {"kernel_scale", "1/m^d", "α of W = α (1−q/2)⁴ (1+2q)", [](const Source& s) { return kernel_scale(s.discretisation); }},
      {"slope_scale", "1/m^(d+2)", "5α/h² of F = 5α/h² (1−q/2)³",
       [](const Source& s) {
         const double h = s.discretisation.smoothing_length;
         return 5.0 * kernel_scale(s.discretisation) / (h * h);
       }},
      {"inverse_cell", "1/m", "1/side of a walls' cell; the side is R", [](const Source& s) { return 1.0 / s.discretisation.support; }},
      {"density", "kg/m³", "ρ₀", [](const Source& s) { return s.scene.fluid.density; }},
      {"bulk_modulus", "Pa", "ρ₀ c₀²",
       [](const Source& s) {
         const double c = s.discretisation.sound_speed;
         return s.scene.fluid.density * c * c;
       }},
      {"sound_speed", "m/s", "c₀", [](const Source& s) { return s.discretisation.sound_speed; }},
      {"guard_distance", "m", "nearer to a wall, a particle loses its approaching normal velocity",
       [](const Source& s) { return s.scene.numerics.walls.guard_distance * s.discretisation.spacing; }},
      {"courant", "", "of h/(c₀ + |u|)", [](const Source& s) { return s.scene.numerics.courant; }},
      {"viscous_time", "s", "bound on Δt from viscosity", [](const Source& s) { return s.discretisation.viscous_time; }},
      {"greatest_speed", "m/s", "the watchdog's: c₀/2", [](const Source& s) { return 0.5 * s.discretisation.sound_speed; }},
      {"rim", "m", "top_way times the rim's coordinate along top_axis: above it, the splash guard keeps particles over the tank", rim},
      {"row_side", "m", "of the particles' rows along x, across", [](const Source& s) { return s.grid.row_side; }},
      {"inverse_row", "1/m", "1/row_side", [](const Source& s) { return 1.0 / s.grid.row_side; }},
      {"inverse_slot", "1/m", "1/length of a slot of a row", [](const Source& s) { return 1.0 / s.grid.slot_length; }},
      {"damping", "1/s", "of the velocities: only before the start", [](const Source&) { return 0.0; }},
      {"repulsion", "(m/s)²", "of ghosts: short-range force by the wall",
       [](const Source& s) {
         const double c = s.discretisation.sound_speed;
         return s.scene.numerics.walls.repulsion * 0.01 * c * c;
       }},
      integer("cells", "the walls' cells, a border of one empty cell included in each direction",
              [](const Source& s) {
                const int* cells = s.discretisation.cells;
                return cells[0] * cells[1] * cells[2];
              }),
      integer("rows_y", "the particles' rows, and slots of each, a border of one empty one included in each direction",
              [](const Source& s) { return s.grid.rows_y; }),
      integer("rows_z", "likewise", [](const Source& s) { return s.grid.rows_z; }),
      integer("slots_x", "likewise", [](const Source& s) { return s.grid.slots_x; }),
      integer("top_axis", "of the tank's top: 0, 1, 2", [](const Source& s) { return s.discretisation.top.axis; }),
      integer("top_way", "1: it is on the side of the greatest coordinates, −1: of the least",
              [](const Source& s) { return s.discretisation.top.way; }),
      integer("images", "of the tank: periodic shifts and ghosts", [](const Source& s) { return s.images; }),
  };
  add_vector(rows, "gravity", "m/s²", "g", [](const Source& s, int axis) { return s.scene.gravity[axis]; });
  add_vector(rows, "hydrostatic", "1/m", "g/c₀²: the gradient of the hydrostatic compression, linearised", [](const Source& s, int axis) {
    const double c = s.discretisation.sound_speed;
    return s.scene.gravity[axis] / (c * c);
  });
  add_vector(rows, "lower", "m", "the watchdog's box: outside it, a particle is lost",
             [](const Source& s, int axis) { return s.discretisation.lower[axis] - s.discretisation.origin[axis]; });
  add_vector(rows, "upper", "m", "likewise",
             [](const Source& s, int axis) { return s.discretisation.upper[axis] - s.discretisation.origin[axis]; });
  add_vector(rows, "tank_lower", "m", "the tank's bounding box, without the pockets behind openings",
             [](const Source& s, int axis) { return s.discretisation.tank.min[axis] - s.discretisation.origin[axis]; });
  add_vector(rows, "tank_upper", "m", "likewise",
             [](const Source& s, int axis) { return s.discretisation.tank.max[axis] - s.discretisation.origin[axis]; });
  add_vector(rows, "period", "m", "of a periodic tank, else 0", period);
  for (int axis = 0; axis < 3; ++axis)
    rows.push_back(integer("cells_", "in one direction", [axis](const Source& s) { return s.discretisation.cells[axis]; }));
  for (int axis = 0; axis < 3; ++axis) rows[rows.size() - 3 + axis].name += "xyz"[axis];
  return rows;
}

}  // namespace

double kernel_scale(const Discretisation& d) {
  const double h = d.smoothing_length, pi = std::acos(-1.0);
  return d.dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
}

const std::vector<ParameterRow>& common_parameters() {
  static const std::vector<ParameterRow> rows = make_rows();
  return rows;
}

}  // namespace wavetank
