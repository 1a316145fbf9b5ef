#include "contour.h"
#include "wavetank/common/error.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank {

bool can_contour() { return false; }

Contour contour(const std::vector<NodeValue>&, float, std::size_t) { throw Error(why_no_surface); }

}  // namespace wavetank
