#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

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
  /// Of a record all of it, of an expression that at a thousand times from the start to `duration`, s.
  double greatest(double duration) const;
  /// The same whatever it is; only where there is a quantity.
  double unchecked_at(double time) const { return value_(time); }

 private:
  std::string name_;
  std::optional<FlowQuantity> quantity_;
  std::function<double(double)> value_;
  std::optional<double> greatest_recorded_;
};

/// Velocities of the columns that carry water over their mean; `wet`: of each column.
std::vector<double> profile_of(const Opening& opening, FlowProfile profile, const std::vector<bool>& wet);

/// The greatest speed that a law, or the limit of a command, gives to any column from the start to `duration`, m/s.
double fastest_flow(const OpeningCase& given, const Opening& opening, const FlowLaw& law, double duration);

/// With which a head drives water into air at the opening's lowest place, m/s.
double fastest_by_head(const OpeningCase& given, const Opening& opening, const FlowLaw& law, const Case& scene);

}  // namespace wavetank
