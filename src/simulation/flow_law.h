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
  /// Of a record all of it, of an expression that at a thousand times from the start to `duration`, s, at the columns' places.
  double greatest(double duration, const Opening& opening) const;
  /// The same whatever it is; only where there is a quantity.
  double unchecked_at(double time) const { return value_(time); }

 private:
  double checked(double value, double time) const;

  std::string name_;
  std::optional<FlowQuantity> quantity_;
  std::function<double(double)> value_;
  std::optional<double> greatest_recorded_;
  std::shared_ptr<Expression> by_place_;  ///< of a velocity
};

/// Of each column, of any scale. Throws Error for an expression that is negative or not finite in one of them, or 0 in all.
std::vector<double> shape_of_profile(const OpeningCase& given, const Opening& opening);

/// Velocities of the columns that carry water over their mean; `wet`: of each column.
std::vector<double> profile_of(const Opening& opening, std::vector<double> shape, const std::vector<bool>& wet);

/// The greatest speed that a law, or the limit of a command, gives to any column from the start to `duration`, m/s.
double fastest_flow(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration);

/// With which a head drives water into air at the opening's lowest place, m/s.
double fastest_by_head(const OpeningCase& given, const Opening& opening, const FlowLaw& law, const Case& scene);

}  // namespace wavetank
