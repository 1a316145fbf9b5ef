#include "wavetank/scene/initial_state.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "wavetank/common/error.h"
#include "wavetank/common/expression.h"
#include "wavetank/common/water_waves.h"
#include "wavetank/scene/upward.h"

namespace wavetank {

struct InitialState::Parts {
  std::optional<Expression> elevation, velocity[3], pressure;
  std::optional<WaveField> waves;
  Vector3d way = Vector3d::UnitX();  ///< unit
  double crest = 0, level = 0;       ///< m
  double density = 0;                ///< kg/m³

  double along(const Vector3d& place) const { return way.dot(place) - crest; }
};

namespace {

void make(std::optional<Expression>& expression, const std::string& text) {
  if (!text.empty()) expression.emplace(text);
}

double finite_at(const Expression& expression, const Vector3d& place, const char* key) {
  const double value = expression.at(place);
  if (std::isfinite(value)) return value;
  char text[120];
  std::snprintf(text, sizeof text, "%g, %g, %g", place.x(), place.y(), place.z());
  throw Error("fluid/initial/" + std::string(key) + " is not finite at (" + text + ") m, where there is water at the start.");
}

WaveField field_of(const InitialWaveCase& wave, double gravity) {
  WaveField field;
  field.kind = wave.kind == InitialWaveKind::solitary ? WaveField::Kind::solitary
               : wave.standing                        ? WaveField::Kind::standing
                                                      : WaveField::Kind::progressive;
  field.second_order = wave.kind == InitialWaveKind::stokes_2;
  field.depth = wave.depth;
  field.height = wave.height;
  field.gravity = gravity;
  field.wave_number = wave_number_of(wave, gravity);
  return field;
}

}  // namespace

InitialState::InitialState(const Case& checked) : parts_(std::make_unique<Parts>()) {
  Parts& parts = *parts_;
  const InitialCase& initial = checked.fluid.initial;
  make(parts.elevation, initial.elevation);
  make(parts.velocity[0], initial.u);
  if (checked.dimensions == 3) make(parts.velocity[1], initial.v);
  make(parts.velocity[2], initial.w);
  make(parts.pressure, initial.pressure);
  if (!initial.waves) return;
  parts.waves = field_of(*initial.waves, checked.gravity.norm());
  parts.way = initial.waves->direction.normalized();
  parts.crest = initial.waves->crest;
  parts.level = filled_to(checked.fluid.fill.at(0), checked);
  parts.density = checked.fluid.density;
}

InitialState::~InitialState() = default;

bool InitialState::has_elevation() const { return parts_->elevation || parts_->waves; }
bool InitialState::has_velocity(int axis) const { return parts_->velocity[axis] || parts_->waves; }
bool InitialState::has_pressure() const { return parts_->pressure || parts_->waves; }

double InitialState::elevation(const Vector3d& place) const {
  if (parts_->waves) return parts_->waves->elevation(parts_->along(place));
  return parts_->elevation ? finite_at(*parts_->elevation, place, "elevation") : 0.0;
}

double InitialState::velocity(int axis, const Vector3d& place) const {
  if (parts_->waves) {
    const Eigen::Vector2d velocity = parts_->waves->velocity(parts_->along(place), place.z() - parts_->level);
    return axis == 2 ? velocity.y() : velocity.x() * parts_->way[axis];
  }
  const char* const keys[3] = {"u", "v", "w"};
  return parts_->velocity[axis] ? finite_at(*parts_->velocity[axis], place, keys[axis]) : 0.0;
}

double InitialState::pressure(const Vector3d& place) const {
  if (parts_->waves) return parts_->density * parts_->waves->pressure_over_density(parts_->along(place), place.z() - parts_->level);
  return parts_->pressure ? finite_at(*parts_->pressure, place, "pressure") : 0.0;
}

double filled_to(const FillRegion& region, const Case& checked) {
  const auto* box = std::get_if<Box>(&region);
  return box != nullptr ? top_of(checked).of(*box) : std::get<FloodFill>(region).level;
}

double wave_number_of(const InitialWaveCase& wave, double gravity) {
  if (wave.wavelength) return 2.0 * M_PI / *wave.wavelength;
  return wave.period ? wave_number(2.0 * M_PI / *wave.period, wave.depth, gravity) : 0.0;
}

}  // namespace wavetank
