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
/// alike. For the particles beside the gap it is water: lumps of it stand in for the particles that are missing there, or they would shoot
/// into an empty gap.
class WaterFilm {
 public:
  /// `world` is looked at throughout.
  WaterFilm(const RigidWorld& world, const Case& settled_case, const Layout& layout, const Discretisation& discretisation);

  struct State {
    std::vector<RigidLoad> loads;  ///< one an owner about its reference point, in the tank's axes
    std::vector<FilmLump> lumps;   ///< in the tank's axes, body by body
  };
  /// The films in the present state; `frame`: of a tank that moves. Nothing is asked of the fluid where no body is near a wall. `all`: also
  /// those that neither a free body nor particles feel.
  State find(Solver& fluid, const std::optional<FrameMotion>& frame, bool all);

  /// Looking for films and solving them so far, without the fluid's part.
  const Stopwatch& time() const { return time_; }

  struct Share {
    double film = 0;   ///< of the gap: 0 where it is open water, 1 where there are no particles
    double added = 0;  ///< of the film's pressure, to what particles press with
  };

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
    Share share;
  };

  struct Film {
    std::size_t body = 0;
    Eigen::Isometry3d to_tank;  ///< where the body is
    std::vector<Cover> covers;  ///< of each element
    std::vector<char> wanted;   ///< of each element: the fluid there is read
    std::vector<PointValue> fluid;
  };

  std::vector<Film> films(bool all);
  bool is_felt(std::size_t body, const std::vector<Cover>& covers) const;
  std::vector<Cover> covers(std::size_t body);
  void cover(std::size_t body, std::size_t other, std::vector<Cover>& covers) const;
  /// The fluid at the covered elements and those beside them; zero at the others.
  void read(Solver& fluid, std::vector<Film>& films);
  /// Between film and particles, once these are read.
  void share(Film& film) const;
  std::vector<double> film_pressures(const Film& film, const Vector3d& weight) const;
  void add(const Film& film, const std::optional<FrameMotion>& frame, State& state) const;
  Eigen::Isometry3d pose(std::size_t owner) const;
  Vector3d velocity(std::size_t owner, const Vector3d& place) const;

  const RigidWorld& world_;
  int dimensions_;
  double spacing_;
  double sound_speed_;
  double density_;
  Vector3d gravity_;
  std::vector<Surface> surfaces_;
  std::vector<std::vector<Cover>> standing_;  ///< of each owner that stands in the tank: by others that do; empty = not found yet
  std::unique_ptr<PointSet> points_;          ///< where the fluid was read last
  Stopwatch time_;
};

}  // namespace wavetank
