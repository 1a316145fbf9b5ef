#include "kernel_parameters.h"

#include <cmath>
#include <limits>

namespace wavetank {

template <class Real>
KernelParameters<Real> kernel_parameters(const Case& scene, const Layout& layout, const Discretisation& d, const GridShape& grid,
                                         int images) {
  const double h = d.smoothing_length, c = d.sound_speed, pi = std::acos(-1.0);
  const double scale = d.dimensions == 2 ? 7.0 / (4.0 * pi * h * h) : 21.0 / (16.0 * pi * h * h * h);
  const double physical =
      scene.numerics.viscosity_model == ViscosityModel::monaghan_gingold ? 2.0 * (d.dimensions + 2) * scene.fluid.viscosity : 0.0;
  const Eigen::Vector3d hydrostatic = scene.gravity / (c * c);
  const double g = scene.gravity.norm();
  KernelParameters<Real> p{};
  const auto real = [](double value) { return static_cast<Real>(value); };
  p.spacing = real(d.spacing);
  p.smoothing_length = real(h);
  p.inverse_smoothing = real(1.0 / h);
  p.support = real(d.support);
  p.support_squared = real(d.support * d.support);
  p.inverse_support = real(1.0 / d.support);
  p.kernel_scale = real(scale);
  p.slope_scale = real(5.0 * scale / (h * h));
  p.inverse_cell = real(1.0 / d.support);
  p.density = real(scene.fluid.density);
  p.bulk_modulus = real(scene.fluid.density * c * c);
  p.sound_speed = real(c);
  p.gravity_x = real(scene.gravity.x());
  p.gravity_y = real(scene.gravity.y());
  p.gravity_z = real(scene.gravity.z());
  p.hydrostatic_x = real(hydrostatic.x());
  p.hydrostatic_y = real(hydrostatic.y());
  p.hydrostatic_z = real(hydrostatic.z());
  p.viscosity = real(scene.fluid.viscosity);
  p.pair_viscosity = real(scene.numerics.artificial_viscosity * h * c * scene.fluid.density + physical);
  p.density_diffusion = real(scene.numerics.density_diffusion_coefficient * h * c);
  p.steady_rate = real(g / c);
  p.steady_limit = real(1.5 * scene.numerics.density_diffusion_coefficient * g * d.spacing / (h * c));
  p.guard_distance = real(scene.numerics.walls.guard_distance * d.spacing);
  p.courant = real(scene.numerics.courant);
  p.viscous_time = real(d.viscous_time);
  p.greatest_speed = real(0.5 * c);
  p.lower_x = real(d.lower.x() - d.origin.x());
  p.lower_y = real(d.lower.y() - d.origin.y());
  p.lower_z = real(d.lower.z() - d.origin.z());
  p.upper_x = real(d.upper.x() - d.origin.x());
  p.upper_y = real(d.upper.y() - d.origin.y());
  p.upper_z = real(d.upper.z() - d.origin.z());
  const auto period = [&](int axis) {
    return scene.tank.periodic[axis] ? real(layout.domain.max[axis] - layout.domain.min[axis]) : Real(0);
  };
  p.period_x = period(0);
  p.period_y = period(1);
  p.period_z = period(2);
  p.rim = d.splash_guard ? real(d.top.way * (d.rim - d.origin[d.top.axis])) : std::numeric_limits<Real>::max();
  p.cells_x = d.cells[0];
  p.cells_y = d.cells[1];
  p.cells_z = d.cells[2];
  p.cells = d.cells[0] * d.cells[1] * d.cells[2];
  p.row_side = real(grid.row_side);
  p.inverse_row = real(1.0 / grid.row_side);
  p.inverse_slot = real(1.0 / grid.slot_length);
  p.rows_y = grid.rows_y;
  p.rows_z = grid.rows_z;
  p.slots_x = grid.slots_x;
  p.top_axis = d.top.axis;
  p.top_way = d.top.way;
  p.images = images;
  p.repulsion = real(scene.numerics.walls.repulsion * 0.01 * c * c);
  return p;
}

template KernelParameters<float> kernel_parameters<float>(const Case&, const Layout&, const Discretisation&, const GridShape&, int);
template KernelParameters<double> kernel_parameters<double>(const Case&, const Layout&, const Discretisation&, const GridShape&, int);

}  // namespace wavetank
