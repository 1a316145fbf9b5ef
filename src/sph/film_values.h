#pragma once

#include <vector>

#include "wavetank/sph/discretisation.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// The lumps as film.cl reads them.
template <class Real>
std::vector<Real> film_values(const std::vector<FilmLump>& lumps, const Discretisation& discretisation);

}  // namespace wavetank
