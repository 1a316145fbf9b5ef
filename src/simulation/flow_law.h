#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wavetank/common/expression.h"
#include "wavetank/geometry/opening.h"
#include "wavetank/scene/case.h"

namespace wavetank {

/// What the case gives of an opening's flow as a function of time; nothing for a free outlet, one with a level, and a commanded opening.
class FlowLaw {
 public:
  /// Throws Error for a record that cannot be read, or whose times do not increase, with the opening's name.
  FlowLaw(const OpeningCase& opening, const std::string& case_directory, const ResourceResolver& resolve);

  std::optional<FlowQuantity> quantity() const { return quantity_; }
  /// m³/s (2-D: m²/s), m/s or m. Throws Error where it is not finite, or a discharge or velocity is negative.
  double at(double time) const;
  /// Likewise, of a velocity that depends on the place, m.
  double at(double time, const Vector3d& place) const;
  bool depends_on_place() const { return by_place_ != nullptr; }
  /// Of a record all of it, of an expression that at a thousand times from the start to `duration`, s, at the places of the columns that
  /// carry water.
  double greatest(double duration, const Opening& opening, const std::vector<bool>& wet) const;
  /// Whether it is a function of time alone.
  bool is_of_time() const { return static_cast<bool>(value_); }
  /// The same whatever it is; only where it is one.
  double unchecked_at(double time) const { return value_(time); }

 private:
  double checked(double value, double time) const;

  std::string name_;
  std::optional<FlowQuantity> quantity_;
  std::function<double(double)> value_;
  std::optional<double> greatest_recorded_;
  std::shared_ptr<Expression> by_place_;  ///< of a velocity
};

/// Which columns may carry water: of an inlet those below its level.
std::vector<bool> carrying(const OpeningCase& given, const Opening& opening);

/// Of each column, of any scale. Throws Error for an expression that is negative or not finite in one that carries water, or 0 in all.
std::vector<double> shape_of_profile(const OpeningCase& given, const Opening& opening);

/// Velocities of the columns that carry water over their mean; `wet`: of each column.
std::vector<double> profile_of(const Opening& opening, std::vector<double> shape, const std::vector<bool>& wet);

/// The greatest speed that a law, or the limit of a command, gives to any column from the start to `duration`, m/s.
double fastest_flow(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration);

/// The greatest discharge that a law, or the limit of a command, gives from the start to `duration`, m³/s (2-D: m²/s); 0 where it is free.
double greatest_discharge(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration);

/// The speed that a discharge gives to the fastest of the columns that carry water, m/s.
double fastest_of_discharge(const OpeningCase& given, const Opening& opening, double discharge);

/// With which a head drives water into air at the opening's lowest place, m/s.
double fastest_by_head(const OpeningCase& given, const Opening& opening, const FlowLaw& law, const Case& scene);

}  // namespace wavetank
