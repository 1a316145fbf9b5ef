#include <algorithm>
#include <cmath>
#include <map>

#include "case_keys.h"
#include "joint_keys.h"
#include "motion_keys.h"
#include "motion_values.h"
#include "opening_keys.h"
#include "wavetank/common/error.h"
#include "wavetank/common/water_waves.h"
#include "wavetank/scene/initial_state.h"
#include "wavetank/scene/upward.h"

namespace wavetank::scene {
namespace {

// Probes and bodies have tf frames and all of them have topics: a name stands for one thing in the whole case.
class NameCheck {
 public:
  NameCheck(const Case& read, const Setting& root) : root_(root), world_frame_(read.publishing.world_frame) {}

  template <class Named>
  void check(const std::vector<Named>& list, const std::string& path) {
    for (std::size_t i = 0; i < list.size(); ++i) check_name(list[i].name, join_path(join_path(path, i), "name"));
  }

 private:
  void check_name(const std::string& name, const std::string& path) {
    const std::string start = nearest_setting(root_, path).place.describe() + ": " + path + " is " + name + ", ";
    if (name == "tank") throw Error(start + "which is reserved for the tank itself; give another name");
    if (name == world_frame_) throw Error(start + "which is the world_frame too; give another name");
    const auto [earlier, is_new] = paths_.emplace(name, path);
    if (!is_new)
      throw Error(start + "as is " + earlier->second + "; every body, probe, gauge, section and opening must have a name of its own");
  }

  const Setting& root_;
  std::string world_frame_;
  std::map<std::string, std::string> paths_;  ///< by name
};

// Joints take the world for one of their ends.
void check_body_name(const std::string& name, const std::string& path, const Setting& root) {
  if (name != "world") return;
  throw Error(nearest_setting(root, path).place.describe() + ": " + path + " is world, which is reserved for the world; give another name");
}

[[noreturn]] void clash(const Setting& root, const std::string& path, const std::string& text) {
  throw Error(nearest_setting(root, path).place.describe() + ": " + path + " is " + text);
}

void check_walls(const Case& read, const Setting& root) {
  const WallCase& walls = read.numerics.walls;
  if (walls.shepard == ShepardFactor::monolithic && walls.elements == WallElements::facet)
    clash(root, "numerics/walls/shepard",
          "monolithic, a midpoint rule, which facets of any size do not have; choose geometric, or other elements");
  if (walls.method == WallMethod::ghost && !read.bodies.empty())
    clash(root, "numerics/walls/method",
          "ghost, which mirrors the particles at the tank's planes only; leave out the bodies, or choose boundary_integral");
  if (walls.method != WallMethod::ghost && walls.repulsion > 0.0 && read.numerics.gradients == Gradients::sph)
    clash(root, "numerics/walls/repulsion", "for ghosts only; leave it out, or set numerics/walls/method to ghost");
  if (walls.method == WallMethod::ghost && read.tank.motion != Motion::fixed)
    clash(root, "numerics/walls/method", "ghost, whose images stand still; set tank/motion to fixed, or choose boundary_integral");
}

const char* word_of(FrictionLaw law) {
  switch (law) {
    case FrictionLaw::none:
      return "none";
    case FrictionLaw::law_of_the_wall:
      return "law_of_the_wall";
    case FrictionLaw::coefficient:
      return "coefficient";
    default:
      return "viscous";
  }
}

/// Of walls whose friction is said at `path`.
void check_friction(const Case& read, const Setting& root, const FrictionCase& friction, const std::string& path) {
  const WallCase& walls = read.numerics.walls;
  const std::string law = join_path(path, "law");
  const Setting& nearest = nearest_setting(root, law);
  const bool given = &nearest != &nearest_setting(root, path);  // not the default
  if (friction.law == FrictionLaw::as_case || !given) return;
  if (walls.method == WallMethod::ghost && friction.law == FrictionLaw::none)
    clash(root, law, "none, which is said of ghosts by numerics/walls/slip: free_slip; leave it out, and set that");
  if (friction.law == FrictionLaw::viscous && walls.slip == Slip::no_slip) return;
  if (walls.method == WallMethod::ghost)
    clash(root, law,
          std::string(word_of(friction.law)) +
              ", which boundary integrals have and ghosts have not; leave it out, or set "
              "numerics/walls/method to boundary_integral");
  if (walls.slip == Slip::free_slip && friction.law != FrictionLaw::none)
    clash(root, law,
          std::string(word_of(friction.law)) + ", of walls without slip, and numerics/walls/slip is free_slip; leave out one of them");
  if (friction.law == FrictionLaw::law_of_the_wall && friction.roughness == 0.0 && read.fluid.viscosity == 0.0)
    clash(root, law, "law_of_the_wall of a smooth wall, which goes by the viscosity, and fluid/viscosity is 0; give that, or a roughness");
}

/// Along an axis that does not repeat itself: the water then has a depth, and may have a free surface.
bool has_weight(const Case& read) {
  for (int axis = 0; axis < 3; ++axis)
    if (read.gravity[axis] != 0.0 && !read.tank.periodic[axis]) return true;
  return false;
}

// What least squares are not built for, and where water does not rest with them.
void check_least_squares(const Case& read, const Setting& root) {
  const NumericsCase& numerics = read.numerics;
  const std::string chosen = "numerics/gradients is " + word_of(numerics.gradients);
  const Setting* given = root.find("numerics");
  if (numerics.gradients == Gradients::sph) {
    if (given != nullptr && given->find("mls") != nullptr)
      clash(root, "numerics/mls", "of moving least squares, and " + chosen + "; leave it out, or set that to mls_corrected or mls");
    return;
  }
  if (numerics.scheme != Scheme::delta_sph)
    clash(root, "numerics/scheme",
          word_of(numerics.scheme) + ", which has gradients of its own, and " + chosen + "; set the one to delta_sph or the other to sph");
  if (numerics.density_diffusion == DensityDiffusion::antuono)
    clash(root, "numerics/density_diffusion", "antuono, which has gradients of its own, and " + chosen + "; choose fourtakas or none");
  if (numerics.shifting != Shifting::none)
    clash(root, "numerics/shifting", word_of(numerics.shifting) + ", by sums of SPH, and " + chosen + "; leave out one of them");
  if (numerics.turbulence != Turbulence::none)
    clash(root, "numerics/turbulence",
          word_of(numerics.turbulence) + ", whose viscosity varies, and " + chosen +
              ", whose Laplacian is of one viscosity; leave out one of them");
  if (given != nullptr && given->find("viscosity_model") != nullptr)
    clash(root, "numerics/viscosity_model",
          word_of(numerics.viscosity_model) + ", a sum of SPH, and " + chosen +
              ", whose viscosity is the Laplacian of the fit; leave it out");
  const double support = numerics.support.value_or(read.dimensions == 2 ? 4.0 : 3.0);
  if (numerics.mls.support && *numerics.mls.support > support)
    clash(
        root, "numerics/mls/support",
        "greater than numerics/support, " + number_text(support) + " spacings, within which neighbours are looked for; make it no greater");
  if (numerics.acoustic_damping > 0)
    clash(root, "numerics/acoustic_damping", "above 0, with which water does not rest where " + chosen + "; set it to 0, or leave it out");
  if (!read.bodies.empty())
    clash(root, "bodies", "given, and " + chosen + ", with which water does not rest at their edges; leave them out, or set that to sph");
  if (read.tank.motion != Motion::fixed)
    clash(root, "tank/motion", "other than fixed, and " + chosen + ", which is not built for it; set the one to fixed or the other to sph");
  if (!read.openings.empty())
    clash(root, "openings", "given, and " + chosen + ", which is not built for the water behind them; set that to sph");
  const bool whole = std::all_of(read.tank.periodic.begin(), read.tank.periodic.end(), [](bool along) { return along; });
  const bool closed = whole || (read.dimensions == 2 && read.tank.periodic[0] && read.tank.periodic[2]);
  if (numerics.mls.pressure == MlsPressure::difference && !closed)
    clash(root, "numerics/mls/pressure",
          "difference, to which a free surface is nothing: water would never leave its place but by noise; choose sum or adjoint, or make "
          "the tank periodic along every axis");
  if (numerics.negative_pressure == NegativePressure::allowed && has_weight(read))
    clash(root, "numerics/negative_pressure", "allowed, with which water that has weight flies apart where " + chosen + "; choose clamped");
  const WallCase& walls = numerics.walls;
  if (numerics.mls.pressure == MlsPressure::adjoint && !closed &&
      (walls.method != WallMethod::ghost || numerics.gradients != Gradients::mls))
    clash(root, "numerics/mls/pressure",
          "adjoint, with which water rests only where numerics/gradients is mls and numerics/walls/method is ghost; choose sum");
  if (walls.method == WallMethod::ghost) return;
  if (walls.elements != WallElements::facet)
    clash(root, "numerics/walls/elements",
          "not facet, and " + chosen + ", whose images of the water go by facets; leave it out, or choose facet");
  const FrictionLaw friction = walls.friction.law;
  if (friction != FrictionLaw::viscous && friction != FrictionLaw::none && walls.slip == Slip::no_slip)
    clash(root, "numerics/walls/friction/law",
          std::string(word_of(friction)) + ", and " + chosen + ", whose walls have viscous friction or none; choose one of these");
}

// What a tank cannot do with its waves.
void check_waves(const Case& read, const Setting& root) {
  if (read.tank.rigid.prescribed.waves)
    clash(root, "tank/prescribed/waves", "given, but waves are made by a body, not by the tank; give them to a body");
  if (!read.fluid.damping.empty() && read.tank.motion == Motion::free)
    clash(root, "fluid/damping", "given, and tank/motion is free; a free tank does not feel what the zones take: leave one of them out");
  const bool any =
      std::any_of(read.bodies.begin(), read.bodies.end(), [](const BodyCase& body) { return body.rigid.prescribed.waves.has_value(); });
  if (any && read.gravity.isZero(0.0)) clash(root, "gravity", "zero, without which there are no waves; give some");
}

// The gauge that a paddle absorbs waves by.
void check_absorption(const Case& read, const Setting& root) {
  for (std::size_t b = 0; b < read.bodies.size(); ++b) {
    const PrescribedCase& prescribed = read.bodies[b].rigid.prescribed;
    if (!prescribed.waves || !prescribed.waves->absorption) continue;
    const std::string path = join_path(join_path("bodies", b), "prescribed/waves/absorption/gauge"),
                      name = prescribed.waves->absorption->gauge;
    if (read.tank.motion != Motion::fixed)
      clash(root, join_path(join_path("bodies", b), "prescribed/waves/absorption"),
            "given, and tank/motion is not fixed; gauges that move with a tank do not tell what comes back: leave one of them out");
    const auto& gauges = read.instruments.wave_gauges;
    const auto gauge = std::find_if(gauges.begin(), gauges.end(), [&](const WaveGaugeCase& known) { return known.name == name; });
    if (gauge == gauges.end()) {
      std::string known;
      for (const WaveGaugeCase& other : gauges) known += (known.empty() ? "" : ", ") + other.name;
      clash(root, path,
            name + ", which is no wave gauge of the case; " +
                (known.empty() ? std::string("it has none: give one before the paddle, in instruments/wave_gauges")
                               : "name one of " + known));
    }
    const auto* box = std::get_if<Box>(&read.bodies[b].shape);  // of meshes it is seen when they have been read
    if (box == nullptr) continue;
    const Vector3d way = piston_way(*prescribed.waves, prescribed);
    const double front = way.cwiseMax(0.0).dot(box->max) + way.cwiseMin(0.0).dot(box->min), before = way.dot(gauge->position) - front;
    if (!(before > 0))
      clash(root, path,
            name + ", which stands " + number_text(std::round(-1e6 * before) / 1e6) +
                " m behind the paddle's front; it must stand before it, where the waves go");
  }
}

// Waves at the start go on over the ends of a periodic tank. Of the ends of a mesh, the surface itself is looked at when it is filled.
void check_periodic_start(const Case& read, const InitialWaveCase& waves, const Setting& root) {
  const auto* tank = std::get_if<BoxTank>(&read.tank.shape);
  if (tank == nullptr) return;
  constexpr double tolerance = 1e-3;
  const double k = wave_number_of(waves, read.gravity.norm());
  const Vector3d way = waves.direction.normalized();
  for (int axis = 0; axis < 2; ++axis) {
    if (!read.tank.periodic[axis] || std::abs(way[axis]) < 1e-9) continue;
    const std::string along(1, "xy"[axis]);
    const double length = tank->size[axis], from = tank->origin[axis];
    if (waves.kind == InitialWaveKind::solitary) {
      if (std::abs(way[axis]) < 1 - 1e-9)
        clash(root, "fluid/initial/waves/direction",
              "askew to " + along + ", along which the tank is periodic, so that the solitary wave passes its end; send it along " + along +
                  ", or leave " + along + " out of tank/periodic");
      const double outskirts = solitary_profile(waves.height, waves.depth, read.gravity.norm()).outskirts;
      for (const double end : {from, from + length}) {
        const double left = 1.0 / std::pow(std::cosh(outskirts * (way[axis] * end - waves.crest)), 2);  // of the height
        if (left < tolerance) continue;
        clash(root, "fluid/initial/waves/crest",
              number_text(waves.crest) + " m, with which the solitary wave is " + number_text(left * waves.height) + " m high at " + along +
                  " = " + number_text(end) + " m, an end of the periodic tank, where it must be flat; make the tank longer, or put the " +
                  "crest in its middle");
      }
      continue;
    }
    const double held = length * k * std::abs(way[axis]) / (2 * M_PI), whole = std::round(held);
    if (std::abs(held - whole) > tolerance * std::max(1.0, held))
      clash(root, std::string("fluid/initial/waves/") + (waves.wavelength ? "wavelength" : "period"),
            "of waves " + number_text(waves.wavelength.value_or(2 * M_PI / k)) + " m long, of which the tank, periodic along " + along +
                ", holds " + number_text(held) + " in its " + number_text(length) + " m; it must hold a whole number of them");
  }
}

// What water can be at the start.
void check_initial(const Case& read, const Setting& root) {
  const InitialCase& initial = read.fluid.initial;
  if (initial.elevation.empty() && !initial.waves) return;
  const std::string path = std::string("fluid/initial/") + (initial.waves ? "waves" : "elevation");
  if (!(read.gravity.z() < 0) || read.gravity.x() != 0 || read.gravity.y() != 0)
    clash(root, path, "given, which is for gravity along −z; leave it out, or set gravity so");
  if (read.fluid.fill.empty()) clash(root, path, "given, and there is no water at the start; leave it out, or give fluid/fill a region");
  if (read.numerics.packing.settling > 0)
    clash(root, "numerics/packing/settling",
          "above 0, with which the water comes to rest, and " + path + " is given; leave one of them out");
  if (!initial.waves) return;
  const InitialWaveCase& waves = *initial.waves;
  for (const auto& [key, text] : {std::pair<const char*, const std::string&>{"elevation", initial.elevation},
                                  {"u", initial.u},
                                  {"v", initial.v},
                                  {"w", initial.w},
                                  {"pressure", initial.pressure}})
    if (!text.empty())
      clash(root, join_path("fluid/initial", key), "given beside fluid/initial/waves, which give it; leave one of them out");
  for (std::size_t f = 1; f < read.fluid.fill.size(); ++f)
    if (filled_to(read.fluid.fill[f], read) != filled_to(read.fluid.fill[0], read))
      clash(root, join_path("fluid/fill", f),
            "filled to another level than fluid/fill/0, and fluid/initial/waves are over one; fill to the same, or leave them out");
  check_periodic_start(read, waves, root);
  const std::string breaking = why_it_breaks(waves.height, waves.depth, wave_number_of(waves, read.gravity.norm()));
  if (!breaking.empty())
    clash(root, "fluid/initial/waves/height",
          number_text(waves.height) + " m, with which they would break: " + breaking + "; make it less");
}

// What moves at the start, relative to the tank, must be slow beside the water's sound: the watchdog's bound of half of it would stop the
// run before its first step. Where the tank turns or its motion is prescribed, that is left to the watchdog.
void check_speeds(const Case& read, const Setting& root) {
  if (!read.fluid.sound_speed) return;
  const double most = 0.5 * *read.fluid.sound_speed;
  const auto check = [&](Vector3d velocity, const std::string& path) {
    if (read.dimensions == 2) velocity.y() = 0;
    const double speed = velocity.norm();
    if (speed < most) return;
    clash(root, path,
          number_text(speed) + " m/s fast, and must be below half of fluid/sound_speed, " + number_text(most) +
              " m/s; make it slower, or choose a fluid/sound_speed of " + number_text(10 * speed) + " m/s, ten times as fast");
  };
  check(read.fluid.current, "fluid/current");
  const TankCase& tank = read.tank;
  const bool tank_is_free = tank.motion == Motion::free;
  const bool tank_is_known = tank.motion != Motion::prescribed && !(tank_is_free && !tank.rigid.angular_velocity.isZero());
  const Vector3d tank_velocity = tank_is_free ? tank.rigid.velocity : Vector3d::Zero();
  for (std::size_t b = 0; b < read.bodies.size(); ++b) {
    const std::string path = join_path("bodies", b);
    if (read.bodies[b].motion == Motion::free && tank_is_known)
      check(read.bodies[b].rigid.velocity - tank_velocity, join_path(path, "velocity"));
    if (read.bodies[b].motion == Motion::fixed) check(read.bodies[b].surface_velocity, join_path(path, "surface_velocity"));
  }
}

// What repeats itself from end to end does not in a frame that turns, whose forces grow with the distance from its axis.
void check_periodic(const Case& read, const Setting& root) {
  const TankCase& tank = read.tank;
  const auto& periodic = tank.periodic;
  if (std::none_of(periodic.begin(), periodic.end(), [](bool along) { return along; })) return;
  // along x and y gravity may drive a channel; along z there is a free surface
  if (periodic[2] && read.gravity.z() != 0.0)
    clash(root, "tank/periodic", "periodic along z, along which gravity acts; set gravity to zero along z, or leave z out");
  if (tank.motion == Motion::free || tank.motion == Motion::commanded) {
    const std::string word = motion_word().write(tank.motion, {read.dimensions})->text;
    clash(root, "tank/periodic",
          "for tanks that do not turn, and tank/motion is " + word + "; leave it out, or set tank/motion to fixed or prescribed");
  }
  const PrescribedCase& prescribed = tank.rigid.prescribed;
  const std::set<Direction> directions = directions_of(prescribed);
  if (std::any_of(directions.begin(), directions.end(), is_rotation))
    clash(root, "tank/periodic",
          "for tanks that do not turn, and tank/prescribed has a roll, pitch, yaw or angle; leave it out, or prescribe other directions "
          "only");
  for (std::size_t i = 0; i < prescribed.records.size(); ++i) {
    if (prescribed.records[i].column.empty())
      clash(root, join_path(join_path("tank/prescribed/records", i), "column"),
            "missing; a periodic tank must not turn, so that the column that it follows must be named");
  }
}

void check_levels(const Case& read, const Setting& root) {
  const Top top = top_of(read);
  for (std::size_t f = 0; f < read.fluid.fill.size(); ++f) {
    const auto* flood = std::get_if<FloodFill>(&read.fluid.fill[f]);
    if (flood == nullptr || top.way * flood->seed[top.axis] < top.way * flood->level) continue;
    const std::string path = join_path("fluid/fill", f);
    refuse(nearest_setting(root, join_path(path, "level")), {join_path(path, "level"), "m"},
           (top.way > 0 ? std::string("above the seed, ") : std::string("less than the seed's ") + "xyz"[top.axis] + ", ") +
               nearest_setting(root, join_path(path, "seed")).brief());
  }
}

template <class Probe>
void check_probes(const Case& read, const std::vector<Probe>& probes, const std::string& list, const Setting& root) {
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const std::string& name = probes[i].body;
    const auto is_it = [&](const BodyCase& body) { return body.name == name; };
    if (name.empty() || std::any_of(read.bodies.begin(), read.bodies.end(), is_it)) continue;
    std::string known;
    for (const BodyCase& body : read.bodies) known += (known.empty() ? "" : ", ") + body.name;
    clash(root, join_path(join_path(list, i), "body"),
          name + ", which is no body of the case; " + (known.empty() ? "it has none" : "name one of " + known) +
              ", or leave it out for the tank");
  }
}

void check_moorings(const std::vector<MooringCase>& moorings, const std::string& list, const Setting& root) {
  std::map<std::string, std::string> paths;  // by name
  for (std::size_t i = 0; i < moorings.size(); ++i) {
    if (moorings[i].name.empty()) continue;
    const std::string path = join_path(join_path(list, i), "name");
    const auto [earlier, is_new] = paths.emplace(moorings[i].name, path);
    if (!is_new)
      clash(root, path, moorings[i].name + ", as is " + earlier->second + "; every mooring of a body must have a name of its own");
  }
}

}  // namespace

void place_gauges(Case& read, const Setting& root) {
  const int axis = top_of(read).axis;
  if (axis == 2) return;
  std::vector<WaveGaugeCase>& gauges = read.instruments.wave_gauges;
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const Setting& given = nearest_setting(root, join_path(join_path("instruments/wave_gauges", i), "position"));
    Context context{read.dimensions};
    Vector3d& place = gauges[i].position;
    std::vector<double> numbers;
    for (std::size_t k = 0; k < given.items.size(); ++k) numbers.push_back(number({}).read(given.items[k], {}, context));
    const bool whole = numbers.size() == 3 || (read.dimensions == 2 && numbers.size() == 2);
    if (whole)
      place = Vector3d(numbers.front(), numbers.size() == 3 ? numbers[1] : 0.0, numbers.back());
    else
      place =
          axis == 0 ? Vector3d(0, numbers.size() == 2 ? numbers[0] : 0.0, numbers.back()) : Vector3d(numbers.front(), 0, numbers.back());
    place[axis] = 0;
    if (read.dimensions == 2) place.y() = 0;
  }
}

void choose_dissipation(Case& read, const Setting& root) {
  const Setting* numerics = root.find("numerics");
  const auto given = [&](const char* key) { return numerics != nullptr && numerics->find(key) != nullptr; };
  const bool delta_sph = read.numerics.scheme == Scheme::delta_sph, sums = read.numerics.gradients == Gradients::sph;
  if (!given("acoustic_damping"))
    read.numerics.acoustic_damping = delta_sph && sums && read.numerics.integrator == Integrator::symplectic ? usual_acoustic_damping : 0;
  if (!given("artificial_viscosity") && !sums) read.numerics.artificial_viscosity = usual_least_squares_viscosity;
  if (delta_sph) return;
  if (!given("density_diffusion")) read.numerics.density_diffusion = DensityDiffusion::none;
  if (!given("artificial_viscosity")) read.numerics.artificial_viscosity = 0;
}

void check_case(const Case& read, const Setting& root) {
  if (read.dimensions == 2 && read.gravity.y() != 0.0) {
    refuse(nearest_setting(root, "gravity"), {"gravity", "m/s²"}, "within the x–z plane of a 2-D case, [x, 0, z] or [x, z]");
  }
  if (read.gravity.isZero(0.0) && !read.fluid.sound_speed) {
    throw Error(nearest_setting(root, "gravity").place.describe() +
                ": fluid/sound_speed is auto, which needs a gravity to expect a speed from; give fluid/sound_speed as a number (m/s)");
  }
  if (read.numerics.turbulence == Turbulence::none) {
    const Setting* numerics = root.find("numerics");
    if (numerics != nullptr && numerics->find("smagorinsky_coefficient") != nullptr)
      clash(root, "numerics/smagorinsky_coefficient", "of numerics/turbulence: smagorinsky only; leave it out, or set that");
  }
  if (read.numerics.scheme == Scheme::delta_sph) {
    const Setting* numerics = root.find("numerics");
    if (numerics != nullptr && numerics->find("limiter") != nullptr)
      clash(root, "numerics/limiter", "of the schemes riemann_parshikov and riemann_ale only; leave it out, or choose one of them");
  }
  if (read.fluid.fill.empty() && read.openings.empty())
    refuse(nearest_setting(root, "fluid/fill"), {"fluid/fill", ""}, "a list of at least one region, where there are no openings");
  check_walls(read, root);
  check_speeds(read, root);
  check_least_squares(read, root);
  check_friction(read, root, read.numerics.walls.friction, "numerics/walls/friction");
  for (std::size_t b = 0; b < read.bodies.size(); ++b)
    check_friction(read, root, read.bodies[b].skin_friction, join_path(join_path("bodies", b), "skin_friction"));
  check_periodic(read, root);
  check_waves(read, root);
  check_absorption(read, root);
  check_initial(read, root);
  check_levels(read, root);
  check_joints(read, root);
  if (read.numerics.acoustic_damping > 0 && read.numerics.integrator != Integrator::symplectic)
    throw Error(nearest_setting(root, "numerics/acoustic_damping").place.describe() +
                ": numerics/acoustic_damping is above 0 and numerics/integrator is " + word_of(read.numerics.integrator) +
                ": the damper needs symplectic, which has the rates of the step before");
  NameCheck names(read, root);
  names.check(read.bodies, "bodies");
  for (std::size_t i = 0; i < read.bodies.size(); ++i)
    check_body_name(read.bodies[i].name, join_path(join_path("bodies", i), "name"), root);
  names.check(read.instruments.pressure_probes, "instruments/pressure_probes");
  names.check(read.instruments.wave_gauges, "instruments/wave_gauges");
  names.check(read.instruments.velocity_probes, "instruments/velocity_probes");
  names.check(read.instruments.sections, "instruments/sections");
  names.check(read.openings, "openings");
  check_probes(read, read.instruments.pressure_probes, "instruments/pressure_probes", root);
  check_probes(read, read.instruments.velocity_probes, "instruments/velocity_probes", root);
  check_moorings(read.tank.rigid.moorings, "tank/moorings", root);
  for (std::size_t b = 0; b < read.bodies.size(); ++b)
    check_moorings(read.bodies[b].rigid.moorings, join_path(join_path("bodies", b), "moorings"), root);
  check_openings(read, root);
}

}  // namespace wavetank::scene

namespace wavetank {

FrictionCase friction_of(const Case& scene, std::size_t owner) {
  FrictionCase friction = scene.numerics.walls.friction;
  if (owner > 0 && scene.bodies[owner - 1].skin_friction.law != FrictionLaw::as_case) friction = scene.bodies[owner - 1].skin_friction;
  if (scene.numerics.walls.slip == Slip::free_slip) friction.law = FrictionLaw::none;
  return friction;
}

}  // namespace wavetank
