#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "../grid_shape.h"
#include "wavetank/scene/case.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank {

/// What the numbers that kernels read follow from.
struct ParameterSource {
  const Case& scene;  ///< settled
  const Layout& layout;
  const Discretisation& discretisation;
  const GridShape& grid;
  int images = 0;  ///< of the tank
};

/// A number that kernels read, as p->name. Lengths are relative to the grid's origin; 2-D quantities are per metre of width.
struct ParameterRow {
  enum class Kind { real, integer };

  std::string name;
  std::string unit;  ///< "" of what has none
  std::string meaning;
  std::function<double(const ParameterSource&)> value;
  Kind kind = Kind::real;
};

/// α of Wendland's W = α (1−q/2)⁴ (1+2q), q = r/h; per m^d.
double kernel_scale(const Discretisation& discretisation);

/// Those that every case has.
const std::vector<ParameterRow>& common_parameters();

/// The members of the parameter block, as the device code declares it: real ones first.
std::string parameters_header(const std::vector<ParameterRow>& rows);

/// The numbers of one case.
class ParameterBlock {
 public:
  /// Throws Error if two rows have one name.
  ParameterBlock(std::vector<ParameterRow> rows, const ParameterSource& source);

  /// Throw Error for a name that no row has.
  double at(const std::string& name) const;
  void set(const std::string& name, double value);
  /// As parameters_header lays them out.
  template <class Real>
  std::vector<char> bytes() const;

 private:
  std::vector<ParameterRow> rows_;
  std::map<std::string, double> values_;
};

}  // namespace wavetank
