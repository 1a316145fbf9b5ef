#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "wavetank/common/stopwatch.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/sph/solver.h"

namespace wavetank {

/// The water between a body and a wall that it lies on or nearly touches, where the gap is too narrow for particles or they have not come
/// into it.
///
/// A slow film in a gap of even width obeys Reynolds' equation, ∇²(p − ρ g·x) = 0 along the gap, with the fluid's pressure around its rim.
/// So here: the elements of a body's surface that a wall covers have the pressure that is harmonic, but for the water's weight, between
/// those of the open elements about them, as far as particles nearby do not press on them already. Without it a light body that stands
/// flush on the floor would never be lifted. The film fills at once and thins without resistance; it presses on both sides of the gap
/// alike.
class WaterFilm {
 public:
  /// `world` is looked at throughout.
  WaterFilm(const RigidWorld& world, const Case& settled_case, const Layout& layout, const Discretisation& discretisation);

  /// The films' loads in the present state, one an owner about its reference point, in the tank's axes; `frame`: of a tank that moves. All
  /// zero, and nothing asked of the fluid, where no body is near a wall. `of_all`: not of free bodies alone.
  std::vector<RigidLoad> loads(Solver& fluid, const std::optional<FrameMotion>& frame, bool of_all);

  /// Looking for films and solving them so far, without the fluid's part.
  const Stopwatch& time() const { return time_; }

 private:
  struct Surface {  ///< an owner's walls, in the case's coordinates at its start
    std::vector<Facet> facets;
    std::vector<Eigen::AlignedBox3d> boxes;  ///< of each facet
    Eigen::AlignedBox3d box;
    std::vector<WallElement> elements;  ///< of a body that has films; so are the neighbours of each
    std::vector<std::vector<int>> beside;
  };
  struct Cover {
    bool covered = false;   ///< a wall is across
    std::size_t owner = 0;  ///< of that wall
    double gap = 0;         ///< to it, in spacings
    double share = 0;       ///< of the film: 0 where the gap is open water, 1 where there are no particles
  };

  struct Film {
    std::size_t body = 0;
    Eigen::Isometry3d to_tank;  ///< where the body is
    std::vector<Cover> covers;  ///< of each element
    std::vector<char> wanted;   ///< of each element: the fluid there is read
    std::vector<PointValue> fluid;
  };

  std::vector<Film> find(bool of_all) const;
  std::vector<Cover> covers(std::size_t body) const;
  void cover(std::size_t body, std::size_t other, std::vector<Cover>& covers) const;
  /// The fluid at the covered elements and those beside them; zero at the others.
  void read(Solver& fluid, std::vector<Film>& films);
  std::vector<double> film_pressures(const Film& film, const Vector3d& weight) const;
  void add_loads(const Film& film, const std::optional<FrameMotion>& frame, std::vector<RigidLoad>& loads) const;
  Eigen::Isometry3d pose(std::size_t owner) const;

  const RigidWorld& world_;
  int dimensions_;
  double spacing_;
  double density_;
  Vector3d gravity_;
  std::vector<Surface> surfaces_;
  std::unique_ptr<PointSet> points_;  ///< where the fluid was read last
  Stopwatch time_;
};

}  // namespace wavetank
