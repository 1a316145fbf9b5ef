#include "crowding.h"

#include <cmath>

namespace wavetank {

double volume_quantum(const Discretisation& d) { return std::ldexp(std::pow(d.spacing, d.dimensions), -28); }

void Crowding::add(const Crowding& others) {
  lost += others.lost;
  whole += others.whole;
  if (others.greatest < greatest || (others.greatest == greatest && others.id > id)) return;
  greatest = others.greatest;
  id = others.id;
  place = others.place;
}

LostVolume Crowding::volume(const Discretisation& discretisation) const {
  const double quantum = volume_quantum(discretisation);
  return {quantum * static_cast<double>(lost), quantum * static_cast<double>(whole), place};
}

}  // namespace wavetank
