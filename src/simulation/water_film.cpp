#include "water_film.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace wavetank {
namespace {

// Of the spacing. At the start a gap has particles from the second on (narrow_gaps.cpp); of one below the first it is all film, also where
// particles are on the way out. Between, what is at the mouth would count twice, as a film's and as particles' push.
constexpr double closed_gap = 0.5, open_gap = 0.9;

// Of what walls leave of the kernel, particles fill so much of it where they fill all; and up to the second at the mouth of a gap of a
// spacing that has none. In one of the third they may be as few as that, and are rows on their way out: it counts less from a spacing on.
constexpr double full = 0.85, mouth = 0.65, gap_of_rows = 1.5;

// Of the filling at a covered face, what takes the film's place: so much in a closed gap (2-D, 3-D), and less by the last in one of a
// spacing. Measured on boxes a tenth to 0.85 of a spacing over a floor, whose force is right then to 2 %.
constexpr double rim_pressing_2d = 1.35, rim_pressing_3d = 1.05, less_rim_pressing = 0.6;

// Wider gaps have a film as far as particles have not come into them, up to the first of these; at the second they are open water.
// facing_walls.cl and walls.cl have the same, and those above but for the rim's.
constexpr double narrow_gap = 2.0, wide_gap = 2.5;

// The pressure is read this far off the surface, in the gap's water if it has any: on the surface itself, where two walls touch, γ has no
// one value.
constexpr double reading_distance = 0.1;

// Thinner films are nothing to particles.
constexpr double thinnest_lump = 0.02;

// Of √(g Δx), but no less than this part of the speed of sound: a gap between walls that are held has no lumps once it opens so fast, for
// it fills with what comes in from its sides; one at a free body has all of them once it closes so fast, and none while it opens or stays.
constexpr double fast = 0.05, least_fast = 1e-3;

// Of a film's lumps: those of thicker ones lie upon each other, for one row in the middle would push particles to the walls.
constexpr double thickest_lump = 0.5;

// A film has the pressure of particles that share its gap: they hold it by so much more than the film beside it does.
constexpr double as_particles = 10.0;

// Elements are about a spacing wide; across an edge of the body, and diagonally, their centres are nearer than this.
constexpr double neighbour_distance = 1.6;

// Cosine of the normals of a thin part's two faces, at the most.
constexpr double opposite = -0.5;

// Walls face each other if they lean less than 45° from it.
constexpr double facing = -0.7;

/// How much of the kernel at a wall particles lack where walls leave room for them.
double emptiness(const PointValue& fluid, double gap) {
  const double at_mouth = mouth * std::clamp((gap_of_rows - gap) / (gap_of_rows - 1.0), 0.0, 1.0);
  return std::clamp((full - fluid.filling / std::max(fluid.shepard, 0.05)) / (full - at_mouth), 0.0, 1.0);
}

/// How far a gap is too narrow for particles.
double closedness(double gap) { return std::clamp((open_gap - gap) / (open_gap - closed_gap), 0.0, 1.0); }

/// How much of a gap is film, from how wide it is, how empty, and how full the kernel of particles at its wall.
WaterFilm::Share film_share(double gap, double empty, double filling, int dimensions) {
  const double closed = closedness(gap);
  const double narrow = std::clamp((wide_gap - gap) / (wide_gap - narrow_gap), 0.0, 1.0);
  const double film = std::max(closed, narrow * empty);
  // particles beside a covered face press on its rim by 2 p Σ W V; about half of that belongs to the side beside it
  const double pressing = ((dimensions == 2 ? rim_pressing_2d : rim_pressing_3d) - less_rim_pressing * std::min(gap, 1.0)) * filling;
  return {film, std::min(film, std::max(1.0 - pressing, 0.0))};
}

Vector3d nearest_on_segment(const Vector3d& point, const Vector3d& a, const Vector3d& b) {
  const Vector3d side = b - a;
  return a + std::clamp((point - a).dot(side) / side.squaredNorm(), 0.0, 1.0) * side;
}

/// Of each element, those whose centres are nearer than `reach`, but not through a thin part.
std::vector<std::vector<int>> neighbours(std::vector<WallElement>& elements, double reach) {
  std::sort(elements.begin(), elements.end(), [](const WallElement& a, const WallElement& b) { return a.centre.x() < b.centre.x(); });
  std::vector<std::vector<int>> beside(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i)
    for (std::size_t j = i + 1; j < elements.size() && elements[j].centre.x() - elements[i].centre.x() < reach; ++j) {
      const double distance = (elements[i].centre - elements[j].centre).norm();
      if (distance >= reach || distance == 0 || elements[i].normal.dot(elements[j].normal) < opposite) continue;
      beside[i].push_back(static_cast<int>(j));
      beside[j].push_back(static_cast<int>(i));
    }
  return beside;
}

bool has_film(const Case& scene, int owner) { return owner > 0 && scene.bodies[owner - 1].rigid.water_film; }

}  // namespace

WaterFilm::WaterFilm(const RigidWorld& world, const Case& scene, const Layout& layout, const Discretisation& discretisation)
    : world_(world),
      dimensions_(scene.dimensions),
      spacing_(discretisation.spacing),
      sound_speed_(discretisation.sound_speed),
      density_(scene.fluid.density),
      gravity_(scene.gravity),
      surfaces_(world.count()),
      standing_(world.count()) {
  for (const Facet& facet : layout.facets) {
    Surface& surface = surfaces_[facet.owner];
    Eigen::AlignedBox3d box(facet.corners[0]);
    for (int k = 1; k < dimensions_; ++k) box.extend(facet.corners[k]);
    surface.facets.push_back(facet);
    surface.boxes.push_back(box);
    surface.box.extend(box);
  }
  for (const WallElement& element : layout.walls)
    if (has_film(scene, element.owner)) surfaces_[element.owner].elements.push_back(element);
  for (Surface& surface : surfaces_) surface.beside = neighbours(surface.elements, neighbour_distance * spacing_);
}

/// Takes places of the case's geometry to where they are now, in the tank's axes.
Eigen::Isometry3d WaterFilm::pose(std::size_t owner) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (owner == 0 || !world_.moves(owner)) return pose;
  const RigidState state = world_.state_in_tank(owner);
  pose.linear() = state.orientation.toRotationMatrix();
  pose.translation() = state.position - pose.linear() * world_.reference(owner);
  return pose;
}

/// Of an owner's wall, in the tank; m/s.
Vector3d WaterFilm::velocity(std::size_t owner, const Vector3d& place) const {
  if (owner == 0 || !world_.moves(owner)) return Vector3d::Zero();
  return world_.state_in_tank(owner).velocity_at(place);
}

/// Where `other` is nearer to elements of `body` than any before.
void WaterFilm::cover(std::size_t body, std::size_t other, std::vector<Cover>& covers) const {
  const Surface& own = surfaces_[body];
  const Surface& across = surfaces_[other];
  const Eigen::Isometry3d seen = pose(other).inverse() * pose(body);
  Eigen::AlignedBox3d box = own.box.transformed(seen);
  const double reach = wide_gap * spacing_;
  box.min().array() -= reach;
  box.max().array() += reach;
  if (!box.intersects(across.box)) return;
  std::vector<std::pair<const Facet*, Eigen::AlignedBox3d>> near;
  for (std::size_t f = 0; f < across.facets.size(); ++f) {
    if (!box.intersects(across.boxes[f])) continue;
    near.emplace_back(&across.facets[f], across.boxes[f]);
    near.back().second.min().array() -= reach;
    near.back().second.max().array() += reach;
  }
  if (near.empty()) return;
  for (std::size_t e = 0; e < own.elements.size(); ++e) {
    const Vector3d place = seen * own.elements[e].centre, normal = seen.linear() * own.elements[e].normal;
    for (const auto& [candidate, about] : near) {
      const Facet& facet = *candidate;
      if (!about.contains(place) || facet.normal.dot(normal) > facing) continue;
      const Vector3d nearest = dimensions_ == 2 ? nearest_on_segment(place, facet.corners[0], facet.corners[1])
                                                : nearest_on_triangle(place, facet.corners[0], facet.corners[1], facet.corners[2]);
      const double gap = (nearest - place).norm() / spacing_;
      if (gap < wide_gap && (!covers[e].covered || gap < covers[e].gap)) covers[e] = {true, other, gap, {}};
    }
  }
}

std::vector<WaterFilm::Cover> WaterFilm::covers(std::size_t body) {
  const auto find = [&](std::vector<Cover> covers, bool of_moving) {
    for (std::size_t other = 0; other < surfaces_.size(); ++other)
      if (other != body && (world_.moves(body) || world_.moves(other)) == of_moving) cover(body, other, covers);
    return covers;
  };
  if (standing_[body].empty()) standing_[body] = find(std::vector<Cover>(surfaces_[body].elements.size()), false);
  return find(standing_[body], true);
}

/// Of each element: of the open ones the fluid's, of the covered ones harmonic between those but for the weight of the water; Pa.
std::vector<double> WaterFilm::film_pressures(const Film& film, const Vector3d& weight) const {
  const Surface& surface = surfaces_[film.body];
  const std::size_t count = surface.elements.size();
  std::vector<double> pressures(count, 0.0);
  std::vector<int> unknown(count, -1);
  std::vector<std::size_t> covered;
  for (std::size_t e = 0; e < count; ++e) {
    pressures[e] = std::max(film.fluid[e].pressure, 0.0);
    if (film.covers[e].share.film <= 0) continue;
    unknown[e] = static_cast<int>(covered.size());
    covered.push_back(e);
  }
  std::vector<Eigen::Triplet<double>> matrix;
  Eigen::VectorXd right = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(covered.size()));
  for (std::size_t k = 0; k < covered.size(); ++k) {
    const int row = static_cast<int>(k);
    double sum = 1e-9;  // a film without a rim is dry
    for (const int other : surface.beside[covered[k]]) {
      const Vector3d way = surface.elements[covered[k]].centre - surface.elements[other].centre;
      const double conductance = spacing_ / way.norm();
      const bool in_film = unknown[other] >= 0;
      sum += conductance;
      if (in_film)
        matrix.emplace_back(row, unknown[other], -conductance);
      else
        right[row] += conductance * pressures[other];
      if (in_film || pressures[other] > 0) right[row] += conductance * weight.dot(way);  // no water, no head
    }
    // as far as the reading is sound
    const PointValue& beside = film.fluid[covered[k]];
    // in a gap too narrow for particles they have the film's pressure, not it theirs
    const double holds_particles = std::clamp((film.covers[covered[k]].gap - open_gap) / (1.0 - open_gap), 0.0, 1.0);
    const double contact =
        holds_particles * as_particles * std::clamp(2.0 * beside.filling / std::max(beside.shepard, 0.05) - 1.0, 0.0, 1.0);
    sum += contact;
    right[row] += contact * pressures[covered[k]];
    matrix.emplace_back(row, row, sum);
  }
  Eigen::SparseMatrix<double> laplacian(right.size(), right.size());
  laplacian.setFromTriplets(matrix.begin(), matrix.end());
  const Eigen::VectorXd solution = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(laplacian).solve(right);
  for (std::size_t k = 0; k < covered.size(); ++k) pressures[covered[k]] = std::max(solution[static_cast<Eigen::Index>(k)], 0.0);
  return pressures;
}

/// Whether a free body or particles feel the film.
bool WaterFilm::is_felt(std::size_t body, const std::vector<Cover>& covers) const {
  if (world_.is_free(body)) return true;
  return std::any_of(covers.begin(), covers.end(),
                     [this](const Cover& cover) { return cover.covered && (cover.gap >= thinnest_lump || world_.is_free(cover.owner)); });
}

std::vector<WaterFilm::Film> WaterFilm::films(bool all) {
  std::vector<Film> films;
  for (std::size_t body = 1; body < surfaces_.size(); ++body) {
    const Surface& surface = surfaces_[body];
    if (surface.elements.empty()) continue;
    Film film{body, pose(body), covers(body), std::vector<char>(surface.elements.size(), 0), {}};
    if (!all && !is_felt(body, film.covers)) continue;
    for (std::size_t e = 0; e < film.covers.size(); ++e) {
      if (!film.covers[e].covered) continue;
      film.wanted[e] = 1;
      for (const int other : surface.beside[e]) film.wanted[other] = 1;
    }
    if (std::find(film.wanted.begin(), film.wanted.end(), 1) != film.wanted.end()) films.push_back(std::move(film));
  }
  return films;
}

void WaterFilm::read(Solver& fluid, std::vector<Film>& films) {
  std::vector<Vector3d> places;
  for (const Film& film : films) {
    const std::vector<WallElement>& elements = surfaces_[film.body].elements;
    for (std::size_t e = 0; e < elements.size(); ++e)
      if (film.wanted[e]) places.push_back(film.to_tank * (elements[e].centre - reading_distance * spacing_ * elements[e].normal));
  }
  if (points_)
    points_->set(places);
  else
    points_ = fluid.make_points(places);
  const std::vector<PointValue> found = fluid.evaluate(*points_);
  auto next = found.begin();
  for (Film& film : films) {
    film.fluid.resize(film.wanted.size());
    for (std::size_t e = 0; e < film.wanted.size(); ++e)
      if (film.wanted[e]) film.fluid[e] = *next++;
    share(film);
  }
}

void WaterFilm::share(Film& film) const {
  for (std::size_t e = 0; e < film.covers.size(); ++e) {
    Cover& cover = film.covers[e];
    if (!cover.covered) continue;
    // at the mouth the particles before it fill a part of the kernel: what is behind tells whether the gap is empty
    double empty = emptiness(film.fluid[e], cover.gap);
    for (const int other : surfaces_[film.body].beside[e])
      if (film.covers[other].covered) empty = std::max(empty, emptiness(film.fluid[other], film.covers[other].gap));
    cover.share = film_share(cover.gap, empty, film.fluid[e].filling, dimensions_);
  }
}

void WaterFilm::add(const Film& film, const std::optional<FrameMotion>& frame, State& state) const {
  const std::size_t body = film.body;
  const Surface& surface = surfaces_[body];
  const Vector3d gravity = frame ? frame->gravity_at(film.to_tank * world_.reference(body)) : gravity_;
  const std::vector<double> pressures = film_pressures(film, density_ * (film.to_tank.linear().transpose() * gravity));
  for (std::size_t e = 0; e < surface.elements.size(); ++e) {
    // of two bodies with films the first one's elements count for both
    const auto& [covered, other, gap, share] = film.covers[e];
    if (share.film <= 0 || (other < body && !surfaces_[other].elements.empty())) continue;
    const WallElement& element = surface.elements[e];
    const Vector3d normal = film.to_tank.linear() * element.normal;
    const Vector3d force = share.added * pressures[e] * element.area * normal;
    const Vector3d place = film.to_tank * element.centre;
    const auto add = [&](std::size_t owner, const Vector3d& part) {
      state.loads[owner].force += part;
      state.loads[owner].torque += (place - pose(owner) * world_.reference(owner)).cross(part);
    };
    add(body, force);
    add(other, -force);
    if (gap < thinnest_lump && film.fluid[e].filling <= 0) continue;                      // nothing to feel, and nobody caught
    const double opening = (velocity(body, place) - velocity(other, place)).dot(normal);  // m/s
    const bool held = !world_.is_free(body) && (other == 0 || !world_.is_free(other));    // in the tank, which its own axes go with
    const double scale = std::max(fast * std::sqrt(gravity.norm() * spacing_), least_fast * sound_speed_);
    const double felt = gap < thinnest_lump ? 0.0 : std::clamp((held ? 1.0 : 0.0) - opening / scale, 0.0, 1.0);
    const double width = std::max(gap, thinnest_lump);
    const int layers = static_cast<int>(std::ceil(width / thickest_lump));
    const double thickness = width * spacing_ / layers, volume = thickness * element.area;
    for (int k = 0; k < layers; ++k)
      state.lumps.push_back(
          {place - (k + 0.5) * thickness * normal, felt * share.film * volume, pressures[e], closedness(gap) * share.film * volume});
  }
}

WaterFilm::State WaterFilm::find(Solver& fluid, const std::optional<FrameMotion>& frame, bool all) {
  std::vector<Film> found;
  {
    const Stopwatch::Lap lap(time_);
    found = films(all);
  }
  State state;
  state.loads.resize(surfaces_.size());
  if (found.empty()) return state;
  time_.tick();
  read(fluid, found);
  const Stopwatch::Lap lap(time_);
  for (const Film& film : found) add(film, frame, state);
  return state;
}

}  // namespace wavetank
