#pragma once

#include <string>
#include <vector>

#include "wavetank/geometry/mesh.h"

namespace wavetank {

/// Meshes beside the lengths that a case gives in metres: a forgotten `scale` makes a mesh drawn in millimetres a thousand times too large.
/// `meshes`: 0 the tank, 1 + i body i.
class MeshScale {
 public:
  MeshScale(const Case& checked, std::vector<const TriangleMesh*> meshes);

  /// Throws Error for a body of a mesh that is ten times as large as the tank.
  void check_bodies() const;
  /// Which meshes are of a doubtful size, how large they are, and which scale would fit; empty if none is. For the end of a message on
  /// what did not work out.
  std::string doubts() const;
  /// The same of a case that could be laid out: only what would be strange in spite of that. `depth`: of the water, m.
  std::string doubts_of_a_sound_case(double depth) const;

 private:
  const MeshSource* source(std::size_t part) const;
  double longest(std::size_t part) const;
  std::string sized(std::size_t part) const;
  std::string advice(std::size_t part, double fitting) const;

  const Case& case_;
  std::vector<const TriangleMesh*> meshes_;
};

}  // namespace wavetank
