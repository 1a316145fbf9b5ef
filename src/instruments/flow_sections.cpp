#include "wavetank/instruments/flow_sections.h"

#include "wavetank/instruments/filled.h"

namespace wavetank {

FlowSections::FlowSections(const Case& scene, const Layout& layout, const Solver& solver, const RigidWorld& world)
    : world_(world), sections_(layout.sections) {
  if (sections_.empty()) return;
  for (const FlowSection& section : sections_) places_.insert(places_.end(), section.places.begin(), section.places.end());
  for (SolidBody& body : solid_bodies(scene, layout))
    if (world.moves(body.owner)) moving_.push_back(std::move(body));
  points_ = solver.make_points(places_, PointValues::velocity);
}

std::vector<FlowThroughSection> FlowSections::read(Solver& solver) const {
  std::vector<FlowThroughSection> flows;
  if (sections_.empty()) return flows;
  const std::vector<PointValue> values = solver.evaluate(*points_);
  const std::vector<char> open = without_bodies(std::vector<char>(places_.size(), 1), places_, moving_, world_);
  std::size_t k = 0;
  for (const FlowSection& section : sections_) {
    FlowThroughSection flow;
    for (const double area : section.areas) {
      const double wet = open[k] ? area * filled(values[k]) : 0.0;
      flow.area += wet;
      flow.discharge += wet * section.normal.dot(values[k].velocity);
      ++k;
    }
    flows.push_back(flow);
  }
  return flows;
}

}  // namespace wavetank
