#include "shape_mesh.h"

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <sstream>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

const std::string scheme = "shape://";
constexpr int usual_facets = 24, least_facets = 8, greatest_facets = 512;

/// A shape's kind and numbers as its URI gives them.
class ShapeText {
 public:
  explicit ShapeText(const std::string& uri) : uri_(uri) {
    const std::size_t question = std::min(uri.find('?'), uri.size());
    kind_ = uri.substr(scheme.size(), question - scheme.size());
    std::istringstream fields(uri.substr(std::min(question + 1, uri.size())));
    for (std::string field; std::getline(fields, field, '&');) {
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) refuse("'" + field + "' is not of the form NAME=VALUE");
      if (!values_.emplace(field.substr(0, equals), field.substr(equals + 1)).second)
        refuse(field.substr(0, equals) + " is given twice; give it once");
    }
  }

  const std::string& kind() const { return kind_; }

  /// Refuses every field but these.
  void allow(const std::vector<std::string>& names) const {
    std::string known;
    for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
    for (const auto& [name, text] : values_) {
      if (std::find(names.begin(), names.end(), name) == names.end()) refuse("'" + name + "' is no property of it; it has " + known);
    }
  }

  double length(const std::string& name) const {
    const std::string& text = required(name);
    const double value = number(text);
    if (!(value > 0)) refuse(name + " is '" + text + "'; it must be a number greater than 0 (m)");
    return value;
  }

  Vector3d lengths(const std::string& name) const {
    const std::string& text = required(name);
    std::vector<double> values;
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) values.push_back(number(part));
    const bool positive = std::all_of(values.begin(), values.end(), [](double value) { return value > 0; });
    if (values.size() != 3 || !positive || text.back() == ',')
      refuse(name + " is '" + text + "'; it must be X,Y,Z, three numbers greater than 0 (m)");
    return {values[0], values[1], values[2]};
  }

  int facets() const {
    const auto given = values_.find("facets");
    if (given == values_.end()) return usual_facets;
    const double count = number(given->second);
    if (!(count >= least_facets && count <= greatest_facets && std::fmod(count, 4) == 0)) {
      refuse("facets is '" + given->second + "'; it must be a multiple of 4 from " + std::to_string(least_facets) + " to " +
             std::to_string(greatest_facets));
    }
    return static_cast<int>(count);
  }

  [[noreturn]] void refuse(const std::string& why) const { throw Error("mesh '" + uri_ + "': " + why); }

 private:
  const std::string& required(const std::string& name) const {
    const auto given = values_.find(name);
    if (given == values_.end() || given->second.empty()) refuse(name + " is missing; it must be given (m)");
    return given->second;
  }

  /// NaN for what is no finite number.
  static double number(const std::string& text) {
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0;
    const bool whole = (in >> std::noskipws >> value) && in.peek() == std::istringstream::traits_type::eof();
    return whole && std::isfinite(value) ? value : std::nan("");
  }

  const std::string& uri_;
  std::string kind_;
  std::map<std::string, std::string> values_;
};

/// A unit circle's points as an equilateral polygon, from x towards y.
Vector3d on_circle(int k, int count) { return {std::cos(2 * M_PI * k / count), std::sin(2 * M_PI * k / count), 0}; }

/// Rings of points at equal distances from pole to pole, each with four more points than its neighbour nearer to a pole: triangles of
/// nearly one size all over the sphere.
TriangleMesh unit_sphere(int facets) {
  const int rings = facets / 2, equator = rings / 2;  // ring 0 is the upper pole
  const auto quarter = [&](int ring) { return std::min(ring, rings - ring); };
  TriangleMesh mesh;
  std::vector<int> first;  // vertex of each ring
  for (int ring = 0; ring <= rings; ++ring) {
    first.push_back(static_cast<int>(mesh.vertices.size()));
    const double polar = M_PI * ring / rings;
    const int count = std::max(4 * quarter(ring), 1);
    for (int k = 0; k < count; ++k) mesh.vertices.push_back(std::sin(polar) * on_circle(k, count) + std::cos(polar) * Vector3d::UnitZ());
  }
  const auto vertex = [&](int ring, int k) { return first[ring] + k % std::max(4 * quarter(ring), 1); };
  for (int ring = 0; ring < rings; ++ring) {
    const bool upper = ring < equator;
    const int small = upper ? ring : ring + 1, large = upper ? ring + 1 : ring;  // the one nearer to a pole, and the other
    const auto add = [&](int a, int b, int c) { mesh.triangles.push_back(upper ? Vector3i(a, b, c) : Vector3i(a, c, b)); };
    for (int side = 0; side < 4; ++side) {
      const int on_small = side * quarter(small), on_large = side * quarter(large);
      for (int k = 0; k < quarter(large); ++k) {
        add(vertex(small, on_small + k), vertex(large, on_large + k), vertex(large, on_large + k + 1));
        if (k < quarter(small)) add(vertex(small, on_small + k), vertex(large, on_large + k + 1), vertex(small, on_small + k + 1));
      }
    }
  }
  return mesh;
}

/// Of radius 1 and length 1 along z.
TriangleMesh unit_cylinder(int facets) {
  TriangleMesh mesh;
  for (const double z : {-0.5, 0.5}) {
    for (int k = 0; k < facets; ++k) mesh.vertices.push_back(on_circle(k, facets) + z * Vector3d::UnitZ());
  }
  const int bottom = 2 * facets, top = bottom + 1;  // the ends' centres
  mesh.vertices.emplace_back(0, 0, -0.5);
  mesh.vertices.emplace_back(0, 0, 0.5);
  for (int k = 0; k < facets; ++k) {
    const int next = (k + 1) % facets;
    mesh.triangles.emplace_back(k, next, facets + next);
    mesh.triangles.emplace_back(k, facets + next, facets + k);
    mesh.triangles.emplace_back(bottom, next, k);
    mesh.triangles.emplace_back(top, facets + k, facets + next);
  }
  return mesh;
}

/// What floats draws as much water as the true shape: the inscribed mesh is enlarged to its volume.
void stretch(TriangleMesh& mesh, const Vector3d& factors) {
  for (Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(factors);
}

TriangleMesh box(const ShapeText& text) {
  text.allow({"size"});
  const Vector3d half = text.lengths("size") / 2;
  return box_mesh({-half, half}, false, "");
}

TriangleMesh sphere(const ShapeText& text) {
  text.allow({"radius", "facets"});
  const double radius = text.length("radius");
  TriangleMesh mesh = unit_sphere(text.facets());
  stretch(mesh, Vector3d::Constant(radius * std::cbrt(4 * M_PI / 3 / mesh.signed_volume())));
  return mesh;
}

TriangleMesh cylinder(const ShapeText& text) {
  text.allow({"radius", "length", "facets"});
  const double radius = text.length("radius"), length = text.length("length");
  TriangleMesh mesh = unit_cylinder(text.facets());
  const double across = radius * std::sqrt(M_PI / mesh.signed_volume());
  stretch(mesh, {across, across, length});
  return mesh;
}

}  // namespace

bool is_shape(const std::string& uri) { return uri.compare(0, scheme.size(), scheme) == 0; }

TriangleMesh shape_mesh(const std::string& uri) {
  const ShapeText text(uri);
  const auto make = [&] {
    if (text.kind() == "box") return box(text);
    if (text.kind() == "sphere") return sphere(text);
    if (text.kind() == "cylinder") return cylinder(text);
    text.refuse("there is no such shape; write shape://box?size=X,Y,Z, shape://sphere?radius=R or shape://cylinder?radius=R&length=L");
  };
  TriangleMesh mesh = make();
  mesh.name = uri;
  return mesh;
}

}  // namespace wavetank
