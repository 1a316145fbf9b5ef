#include "catenary.h"

#include <algorithm>
#include <cmath>

#include "roots.h"

namespace wavetank {
namespace {

constexpr double least_ratio = 1e-9;  // of the horizontal pull to the line's weight: below it the line hangs straight down
constexpr double taut_ratio = 1e-9;   // of a length that does not stretch, left over
constexpr int most_doublings = 1000;  // beyond doubles' range

/// The equations of the line for pulls H, horizontal, and V, vertical at its top.
class Equations {
 public:
  explicit Equations(const Catenary& line) : line_(line), whole_(line.weight * line.length) {}

  bool lies(double vertical) const { return line_.bed && vertical < whole_; }
  double anchor_vertical(double vertical) const { return lies(vertical) ? 0 : vertical - whole_; }
  double lying(double vertical) const { return lies(vertical) ? line_.length - vertical / line_.weight : 0; }

  double rise(double horizontal, double vertical) const {
    const double bottom = anchor_vertical(vertical), hanging = line_.length - lying(vertical);
    return (std::hypot(horizontal, vertical) - std::hypot(horizontal, bottom)) / line_.weight +
           line_.compliance * hanging * 0.5 * (vertical + bottom);
  }
  double span(double horizontal, double vertical) const {
    const double bottom = anchor_vertical(vertical);
    return lying(vertical) + horizontal / line_.weight * (std::asinh(vertical / horizontal) - std::asinh(bottom / horizontal)) +
           line_.compliance * horizontal * line_.length;
  }
  /// V, by which the line rises so far under H.
  double vertical(double horizontal, double wanted) const {
    const auto above = [&](double vertical) { return rise(horizontal, vertical) - wanted; };
    double low = line_.bed ? 0 : 0.5 * whole_, high = 0.5 * whole_, reach = whole_;
    for (int k = 0; k < most_doublings && above(high) < 0; ++k, reach *= 2) high += reach;
    reach = whole_;
    for (int k = 0; k < most_doublings && !line_.bed && above(low) > 0; ++k, reach *= 2) low -= reach;
    return zero_of(above, low, high);
  }
  CatenaryPull pull(double horizontal, double vertical) const { return {horizontal, vertical, anchor_vertical(vertical), lying(vertical)}; }

 private:
  Catenary line_;
  double whole_;  ///< N, its weight
};

}  // namespace

std::optional<CatenaryPull> catenary_pull(const Catenary& line, double span, double rise) {
  if (line.bed) rise = std::max(rise, 0.0);
  if (line.compliance == 0 && std::hypot(span, rise) >= (1 - taut_ratio) * line.length) return std::nullopt;
  const Equations equations(line);
  const double least = least_ratio * line.weight * line.length;
  const auto beyond = [&](double logarithm) {
    const double horizontal = std::exp(logarithm);
    return equations.span(horizontal, equations.vertical(horizontal, rise)) - span;
  };
  const double low = std::log(least);
  if (beyond(low) >= 0) {  // it hangs straight down, and what is left lies about
    CatenaryPull slack = equations.pull(least, equations.vertical(least, rise));
    slack.horizontal = 0;
    return slack;
  }
  double high = std::log(line.weight * line.length);
  for (int k = 0; k < most_doublings && beyond(high) < 0; ++k) high += 1;
  const double horizontal = std::exp(zero_of(beyond, low, high));
  return equations.pull(horizontal, equations.vertical(horizontal, rise));
}

std::vector<Eigen::Vector2d> catenary_shape(const Catenary& line, double span, double rise, const CatenaryPull& pull, int count) {
  const double w = line.weight, h = std::max(pull.horizontal, least_ratio * w * line.length), v = pull.anchor_vertical;
  std::vector<Eigen::Vector2d> places;
  for (int k = 0; k < count; ++k) {
    const double along = line.length * k / (count - 1), hung = std::max(along - pull.lying, 0.0), end = v + w * hung;
    const double beside = std::min(along, pull.lying) + h / w * (std::asinh(end / h) - std::asinh(v / h)) + line.compliance * h * along;
    const double above = (std::hypot(h, end) - std::hypot(h, v)) / w + line.compliance * hung * 0.5 * (v + end);
    places.emplace_back(beside, above);
  }
  // of a line that hangs straight down, what lies about is drawn from the anchor to under its top
  const double reached = places.back().x();
  if (pull.horizontal == 0 && reached > 0)
    for (Eigen::Vector2d& place : places) place.x() *= span / reached;
  places.back() = {span, line.bed ? std::max(rise, 0.0) : rise};
  return places;
}

}  // namespace wavetank
