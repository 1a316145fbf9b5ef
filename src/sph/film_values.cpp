#include "film_values.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace wavetank {
namespace {

// A particle goes through the lumps of each block that it is near.
constexpr std::size_t lumps_of_block = 32;

}  // namespace

template <class Real>
std::vector<Real> film_values(const std::vector<FilmLump>& lumps, const Discretisation& discretisation) {
  std::vector<Real> values{static_cast<Real>((lumps.size() + lumps_of_block - 1) / lumps_of_block)};
  for (std::size_t first = 0; first < lumps.size(); first += lumps_of_block) {
    const std::size_t end = std::min(first + lumps_of_block, lumps.size());
    Eigen::AlignedBox3d box;
    for (std::size_t k = first; k < end; ++k) box.extend(lumps[k].place - discretisation.origin);
    for (int axis = 0; axis < 3; ++axis) {
      values.push_back(static_cast<Real>(box.min()[axis] - discretisation.support));
      values.push_back(static_cast<Real>(box.max()[axis] + discretisation.support));
    }
    values.push_back(static_cast<Real>(first));
    values.push_back(static_cast<Real>(end));
  }
  for (const FilmLump& lump : lumps) {
    const Eigen::Vector3d place = lump.place - discretisation.origin;
    for (const double value : {place.x(), place.y(), place.z(), lump.volume, lump.pressure, lump.closed})
      values.push_back(static_cast<Real>(value));
  }
  return values;
}

template std::vector<float> film_values(const std::vector<FilmLump>&, const Discretisation&);
template std::vector<double> film_values(const std::vector<FilmLump>&, const Discretisation&);

}  // namespace wavetank
