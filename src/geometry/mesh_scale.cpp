#include "mesh_scale.h"

#include <algorithm>
#include <cstdio>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double too_large = 10;         // times the tank: no body that is meant
constexpr double doubtful_tank = 10;     // times the lengths that the case gives in metres, or that part of them
constexpr double doubtful_height = 100;  // of a tank, times its water's depth

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string size_text(const Vector3d& size) { return number(size.x()) + " × " + number(size.y()) + " × " + number(size.z()) + " m"; }

Vector3d size_of(const TriangleMesh& mesh) {
  const Box box = mesh.bounding_box();
  return box.max - box.min;
}

/// The longest of the lengths that the case itself gives, all in metres: its box tank and what its fill reaches over. 0 = none.
double given_length(const Case& checked) {
  double longest = 0;
  const auto add = [&](Vector3d size) {
    if (checked.dimensions == 2) size.y() = 0;
    longest = std::max(longest, size.cwiseAbs().maxCoeff());
  };
  if (const auto* tank = std::get_if<BoxTank>(&checked.tank.shape)) add(tank->size);
  for (const FillRegion& region : checked.fluid.fill) {
    if (const auto* box = std::get_if<Box>(&region)) {
      add(box->max - box->min);
    } else {
      const auto& flood = std::get<FloodFill>(region);
      add(flood.seed);
      add(Vector3d(0, 0, flood.level));
    }
  }
  return longest;
}

}  // namespace

MeshScale::MeshScale(const Case& checked, std::vector<const TriangleMesh*> meshes) : case_(checked), meshes_(std::move(meshes)) {}

/// Of a mesh that a file has; shapes are given in metres.
const MeshSource* MeshScale::source(std::size_t part) const {
  const MeshSource* mesh = part == 0 ? std::get_if<MeshSource>(&case_.tank.shape) : std::get_if<MeshSource>(&case_.bodies[part - 1].shape);
  return mesh != nullptr && mesh->uri.rfind("shape://", 0) != 0 ? mesh : nullptr;
}

double MeshScale::longest(std::size_t part) const {
  Vector3d size = size_of(*meshes_[part]);
  if (case_.dimensions == 2) size.y() = 0;
  return size.maxCoeff();
}

std::string MeshScale::sized(std::size_t part) const {
  const std::string owner = part == 0 ? "the tank's" : "body '" + case_.bodies[part - 1].name + "': its";
  return owner + " mesh " + source(part)->uri + " is " + size_text(size_of(*meshes_[part]));
}

/// Millimetres are what most drawings are in.
std::string MeshScale::advice(std::size_t part, double fitting) const {
  const Vector3d& scale = source(part)->scale;
  const auto text = [&](double factor) {
    if (scale.x() == scale.y() && scale.y() == scale.z()) return number(factor * scale.x());
    return "[" + number(factor * scale.x()) + ", " + number(factor * scale.y()) + ", " + number(factor * scale.z()) + "]";
  };
  const std::string now = "its scale (metres per unit of the mesh), which is " + text(1) + ", ";
  if (longest(part) < fitting) return "check " + now.substr(0, now.size() - 2);
  return "if it is drawn in millimetres, " + now + "must be " + text(0.001);
}

void MeshScale::check_bodies() const {
  const double tank = longest(0);
  for (std::size_t part = 1; part < meshes_.size(); ++part) {
    if (source(part) == nullptr || !(longest(part) >= too_large * tank)) continue;
    throw Error(sized(part) + ", " + number(longest(part) / tank) + " times as large as the tank (" + size_text(size_of(*meshes_[0])) +
                "): " + advice(part, tank));
  }
}

std::string MeshScale::doubts() const {
  std::string text;
  const auto add = [&](std::size_t part, double fitting) { text += "; " + sized(part) + ": " + advice(part, fitting); };
  const double given = given_length(case_);
  if (source(0) != nullptr && given > 0 && (longest(0) >= doubtful_tank * given || given >= doubtful_tank * longest(0))) add(0, given);
  const double fitting = text.empty() ? longest(0) : given;
  for (std::size_t part = 1; part < meshes_.size(); ++part)
    if (source(part) != nullptr && longest(part) > fitting) add(part, fitting);
  return text;
}

std::string MeshScale::doubts_of_a_sound_case(double depth) const {
  std::string text;
  const auto add = [&](std::size_t part, double fitting, const std::string& beside) {
    text += (text.empty() ? "" : "; ") + sized(part) + ", beside " + beside + ": " + advice(part, fitting);
  };
  if (source(0) != nullptr && size_of(*meshes_[0]).z() >= doubtful_height * depth) add(0, depth, "water " + number(depth) + " m deep");
  for (std::size_t part = 1; part < meshes_.size(); ++part)
    if (source(part) != nullptr && case_.bodies[part - 1].motion != Motion::fixed && longest(part) > 1.5 * longest(0))
      add(part, longest(0), "a tank of " + size_text(size_of(*meshes_[0])));
  return text;
}

}  // namespace wavetank
