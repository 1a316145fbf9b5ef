#include "assemblies.h"

#include <algorithm>
#include <optional>

namespace wavetank {
namespace {

std::optional<int> owner_of(const std::string& name, const Case& checked) {
  if (name == "tank" || (name == "world" && checked.tank.motion == Motion::fixed)) return 0;
  for (std::size_t b = 0; b < checked.bodies.size(); ++b)
    if (checked.bodies[b].name == name) return static_cast<int>(b + 1);
  return std::nullopt;
}

}  // namespace

bool is_rigid(const JointCase& joint, int dimensions) {
  if (joint.type != JointType::six_dof) return joint.type == JointType::fixed;
  for (std::size_t k = 0; k < joint.six_limits.size(); ++k) {
    const bool counts = dimensions == 3 || k == 0 || k == 2 || k == 4;  // x, z and pitch
    const auto& limits = joint.six_limits[k];
    if (counts && !(limits && (*limits)[0] == (*limits)[1])) return false;
  }
  return true;
}

std::vector<int> rigid_assemblies(const Case& checked) {
  std::vector<int> assembly(checked.bodies.size() + 1);
  for (std::size_t o = 0; o < assembly.size(); ++o) {
    const bool part_of_tank = o > 0 && checked.bodies[o - 1].motion == Motion::fixed;
    assembly[o] = part_of_tank ? 0 : static_cast<int>(o);
  }
  for (const JointCase& joint : checked.joints) {
    const std::optional<int> child = owner_of(joint.child, checked), parent = owner_of(joint.parent, checked);
    if (!child || !parent || !is_rigid(joint, checked.dimensions)) continue;
    const int joined = std::min(assembly[*child], assembly[*parent]), other = std::max(assembly[*child], assembly[*parent]);
    std::replace(assembly.begin(), assembly.end(), other, joined);
  }
  return assembly;
}

}  // namespace wavetank
