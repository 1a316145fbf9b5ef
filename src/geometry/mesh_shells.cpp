#include "mesh_shells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh_topology.h"
#include "polygon.h"
#include "wavetank/common/error.h"

namespace wavetank {
namespace {

constexpr double same_angle = 1e-5;  // rad: float32 coordinates place triangles no better

/// Sets that are joined two by two.
class Joining {
 public:
  explicit Joining(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }
  void join(int a, int b) { parent_[root(a)] = root(b); }

  /// Numbers the sets from 0 on in the order of their first members.
  std::vector<int> numbers(int& count) {
    std::vector<int> number(parent_.size(), -1), result(parent_.size());
    count = 0;
    for (std::size_t m = 0; m < parent_.size(); ++m) {
      int& of_root = number[root(static_cast<int>(m))];
      if (of_root < 0) of_root = count++;
      result[m] = of_root;
    }
    return result;
  }

 private:
  std::vector<int> parent_;
};

struct Leaf {  ///< a triangle at an edge
  int triangle = 0;
  bool along = false;  ///< it runs along the edge from the lower vertex to the higher one; its normal then points to greater angles
  double angle = 0;    ///< about that direction

  int side_after() const { return 2 * triangle + (along ? 0 : 1); }
  int side_before() const { return 2 * triangle + (along ? 1 : 0); }
};

class ShellFinder {
 public:
  explicit ShellFinder(const TriangleMesh& mesh) : mesh_(mesh), sides_(2 * mesh.triangles.size()) {}

  Shells find() {
    const std::vector<HalfEdge> edges = sorted_edges(mesh_);
    for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
      while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
      join_about(edges, first, end);
    }
    return measured();
  }

 private:
  std::string named(const HalfEdge& edge) const {
    return "the edge from " + describe(mesh_.vertices[edge.low]) + " to " + describe(mesh_.vertices[edge.high]);
  }

  void join_about(const std::vector<HalfEdge>& edges, std::size_t first, std::size_t end) {
    if (end - first == 1) {
      throw Error("mesh '" + mesh_.name + "' is not closed: only one triangle has " + named(edges[first]) +
                  "; a body must enclose its volume");
    }
    std::vector<Leaf> leaves;
    for (std::size_t e = first; e < end; ++e)
      leaves.push_back({edges[e].triangle, mesh_.triangles[edges[e].triangle][edges[e].side] == edges[e].low, 0});
    if (leaves.size() > 2) put_in_order(edges, first, leaves);
    for (std::size_t k = 0; k < leaves.size(); ++k) sides_.join(leaves[k].side_after(), leaves[(k + 1) % leaves.size()].side_before());
  }

  void put_in_order(const std::vector<HalfEdge>& edges, std::size_t first, std::vector<Leaf>& leaves) const {
    const Vector3d& origin = mesh_.vertices[edges[first].low];
    const Vector3d axis = (mesh_.vertices[edges[first].high] - origin).normalized();
    const auto way = [&](std::size_t k) {  // across the edge, onto the triangle
      const HalfEdge& edge = edges[first + k];
      return Vector3d(mesh_.corner(edge.triangle, (edge.side + 2) % 3) - origin);
    };
    const Vector3d start = (way(0) - axis.dot(way(0)) * axis).normalized(), across = axis.cross(start);
    for (std::size_t k = 0; k < leaves.size(); ++k) {
      const double angle = std::atan2(across.dot(way(k)), start.dot(way(k)));
      leaves[k].angle = angle < -same_angle ? angle + 2 * M_PI : angle;
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.angle < b.angle; });
    for (std::size_t k = 0; k + 1 < leaves.size(); ++k) {
      if (leaves[k + 1].angle - leaves[k].angle > same_angle) continue;
      const bool third = k + 2 < leaves.size() && leaves[k + 2].angle - leaves[k + 1].angle <= same_angle;
      if (third || leaves[k].along == leaves[k + 1].along) {
        throw Error("mesh '" + mesh_.name + "' has no clear inside: triangles lie upon each other at " + named(edges[first]) +
                    "; unite its solids, or leave a gap between them");
      }
      if (!leaves[k].along) std::swap(leaves[k], leaves[k + 1]);  // front side to front side
      ++k;
    }
  }

  Shells measured() {
    Shells shells;
    int count = 0;
    shells.of_side = sides_.numbers(count);
    Joining touching(count);
    shells.volume.assign(count, 0);
    shells.forward = shells.backward = shells.volume;
    const Vector3d reference = mesh_.corner(0, 0);
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Vector3d a = mesh_.corner(t, 0) - reference, b = mesh_.corner(t, 1) - reference, c = mesh_.corner(t, 2) - reference;
      const double volume = a.dot(b.cross(c)) / 6, area = 0.5 * (b - a).cross(c - a).norm();
      const int front = shells.of_side[2 * t], back = shells.of_side[2 * t + 1];
      shells.volume[front] += volume;
      shells.volume[back] -= volume;
      shells.forward[front] += area;
      shells.backward[back] += area;
      touching.join(front, back);
    }
    shells.component = touching.numbers(shells.components);
    return shells;
  }

  const TriangleMesh& mesh_;
  Joining sides_;
};

}  // namespace

Shells find_shells(const TriangleMesh& mesh) { return ShellFinder(mesh).find(); }

}  // namespace wavetank
