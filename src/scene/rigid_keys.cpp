#include "rigid_keys.h"

#include "mesh_keys.h"
#include "motion_keys.h"
#include "motion_values.h"

namespace wavetank::scene {
namespace {

Section<ForceCase> force_section() {
  Section<ForceCase> section;
  section.key("force", &ForceCase::force, vector_in_plane(), "N", "In 2-D a metre of width (N/m), without a y component.");
  section.key("torque", &ForceCase::torque, vector_about(), "N·m", "In 2-D a metre of width (N), a number about y or [0, y, 0].");
  section.key("point", &ForceCase::point, if_given(position()), "m",
              "Of the body at the start, where the force acts; if it is left out, the centre of mass.");
  section.key("turns_with_body", &ForceCase::turns_with_body, flag(), "",
              "Whether force and torque keep their direction in the body, as a thruster's, not in the world.");
  section.key("from", &ForceCase::from, number(at_least(0)), "s", "When it begins.");
  section.key("to", &ForceCase::to, number_if_given(greater_than(0)), "s",
              "When it ends, later than `from`; if it is left out, with the simulation.");
  section.key("frequency", &ForceCase::frequency, number(at_least(0)), "Hz",
              "Of a harmonic force: times sin(2π f (t − from) + φ); 0 = constant.");
  section.key("phase", &ForceCase::phase, angle(), "°", "φ of a harmonic force.");
  section.rule([](const ForceCase& force, const Setting& map, const std::string& path, const Context&) {
    if (force.force.isZero(0.0) && force.torque.isZero(0.0))
      throw Error(map.place.describe() + ": " + path + " has neither a force nor a torque; give at least one that is not 0");
    if (force.to && *force.to <= force.from) refuse(*map.find("to"), {join_path(path, "to"), "s"}, "later than " + join_path(path, "from"));
    if (force.phase != 0 && force.frequency == 0)
      refuse_key(map, path, "phase", "is for harmonic forces only; leave it out, or give " + join_path(path, "frequency"));
  });
  return section;
}

// Keys that not every kind of line has: written, and allowed, with that kind only.
struct LineKey {
  const char* name;
  MooringLine line;
  bool required;
};
const LineKey line_keys[] = {{"stiffness", MooringLine::spring, true}, {"damping", MooringLine::spring, false},
                             {"slack", MooringLine::spring, false},    {"weight", MooringLine::catenary, true},
                             {"bed", MooringLine::catenary, false},    {"axial_stiffness", MooringLine::catenary, false}};

Codec<std::string> name_if_given() {
  Codec<std::string> codec = name();
  codec.write = [write = codec.write](const std::string& value, const Context& context) -> std::optional<Setting> {
    if (value.empty()) return std::nullopt;
    return write(value, context);
  };
  return codec;
}

Codec<MooringLine> line_word() { return choice<MooringLine>({{"spring", MooringLine::spring}, {"catenary", MooringLine::catenary}}); }

void check_mooring(const MooringCase& mooring, const Setting& map, const std::string& path, const Context& context) {
  const auto word = [&](MooringLine line) { return line_word().write(line, context)->text; };
  for (const LineKey& key : line_keys) {
    const bool given = map.find(key.name) != nullptr;
    if (key.line != mooring.line && given)
      refuse_key(map, path, key.name,
                 "is of the line " + word(key.line) + " only; leave it out, or set " + join_path(path, "line") + " to that");
    if (key.line == mooring.line && key.required && !given)
      refuse_key(map, path, key.name, "is missing; a mooring of the line " + word(key.line) + " needs it (number, N/m)");
  }
  if (mooring.line != MooringLine::catenary) return;
  if (!mooring.length) refuse_key(map, path, "length", "is missing; a mooring of the line catenary needs it (number, m)");
  const double distance = (mooring.attachment - mooring.anchor).norm();
  if (!mooring.axial_stiffness && *mooring.length <= distance)
    refuse(*map.find("length"), {join_path(path, "length"), "m"},
           "greater than the distance of its ends at the start, " + number_text(distance) + ", where no axial_stiffness is given");
}

Section<MooringCase> mooring_section() {
  Section<MooringCase> section;
  const auto add = [&](const std::string& name, auto member, const auto& codec, const std::string& unit,
                       const std::string& description) -> KeyDescription& {
    MooringLine line{};
    for (const LineKey& key : line_keys)
      if (name == key.name) line = key.line;
    return section.key_where([line](const MooringCase& mooring) { return mooring.line == line; }, name, member, codec, unit, description);
  };
  section.key("name", &MooringCase::name, name_if_given(), "",
              "Part of the name of its topic, its own among the moorings of its body; if it is left out, its place in the list, from 0.");
  section.key(
      "line", &MooringCase::line, line_word(), "",
      "What the line is: a linear `spring` with a damper, or a `catenary`, which hangs by its weight and is at rest at every instant.");
  section
      .key("anchor", &MooringCase::anchor, position(), "m",
           "The fixed end: of a body's mooring it moves with the tank, of the tank's own it stands in the world.")
      .required = true;
  section.key("attachment", &MooringCase::attachment, position(), "m", "The other end, where it is at the start; moves with the body.")
      .required = true;
  add("stiffness", &MooringCase::stiffness, number(at_least(0)), "N/m", "Of a spring, required for it; in 2-D a metre of width (N/m²).");
  add("damping", &MooringCase::damping, number(at_least(0)), "N·s/m", "Of a spring, along the line; in 2-D a metre of width (N·s/m²).");
  section.key("length", &MooringCase::length, number_if_given(at_least(0)), "m",
              "Unstretched, required for a catenary; if it is left out of a spring, the distance of the ends at the start.");
  add("slack", &MooringCase::slack, flag(), "", "Of a spring: whether it pulls only, as a rope; else it pushes too.");
  add("weight", &MooringCase::weight, number(greater_than(0)), "N/m",
      "Of a catenary, required for it: of a metre of the line, less its buoyancy; in 2-D a metre of width (N/m²).");
  add("axial_stiffness", &MooringCase::axial_stiffness, number_if_given(greater_than(0)), "N",
      "Of a catenary, EA; if it is left out, the line does not stretch, and the run stops where it is taut. In 2-D a metre of width "
      "(N/m).");
  add("bed", &MooringCase::bed, flag(), "",
      "Of a catenary: whether it lies, without friction, on a level bed at its anchor's height; else it may hang below that.");
  section.rule(check_mooring);
  return section;
}

Section<WindCase> wind_section() {
  Section<WindCase> section;
  section.key("velocity", &WindCase::velocity, vector_in_plane(), "m/s", "The mean.").required = true;
  section.key("area", &WindCase::area, number(greater_than(0)), "m²", "Of the body over the water, across the wind; in 2-D its height (m).")
      .required = true;
  section.key("centre", &WindCase::centre, if_given(position()), "m",
              "Of that area, where it is at the start; moves with the body; if it is left out, the centre of mass.");
  section.key("drag_coefficient", &WindCase::drag_coefficient, number(at_least(0)), "", "C of the force ½ ρ C A |U − u| (U − u).");
  section.key("density", &WindCase::density, number(greater_than(0)), "kg/m³", "ρ of the air.");
  section.key("gust_intensity", &WindCase::gust_intensity, number(between(0, 1)), "",
              "Standard deviation of the wind's speed over its mean; 0: it is constant.");
  section.key("gust_time", &WindCase::gust_time, number(greater_than(0)), "s",
              "Integral time scale of the gusts, whose autocorrelation decays exponentially.");
  section.key("seed", &WindCase::seed, whole_number(between(0, 1e9)), "", "Of the gusts: the same gusts for the same seed.");
  return section;
}

Section<MeshSource> collision_part_section() {
  Section<MeshSource> section;
  declare_mesh_keys([&](auto... key) -> KeyDescription& { return section.key(key...); });
  return section;
}

template <class T>
constexpr bool is_tank = std::is_same_v<T, TankCase>;

// As a member of the whole tank or body.
template <class Member>
auto of_rigid(Member member) {
  return [member](auto& target) -> auto& { return target.rigid.*member; };
}

template <class T>
void add_mass_keys(Section<T>& section) {
  const std::string whose = is_tank<T> ? "Of the tank without the water, required if it is free" : "Of a free body, or else its density";
  section.key("mass", of_rigid(&RigidCase::mass), number_if_given(greater_than(0)), "kg", whose + "; in 2-D a metre of width (kg/m).");
  if constexpr (!is_tank<T>) {  // walls have no volume
    section.key("density", of_rigid(&RigidCase::density), number_if_given(greater_than(0)), "kg/m³",
                "Of a free body, of the volume that it encloses, or else its mass.");
  }
  section.key(
      "centre_of_mass", of_rigid(&RigidCase::centre_of_mass), if_given(position()), "m",
      is_tank<T> ? "Likewise, at the start; required if the tank is free." : "At the start; if it is left out, the centre of volume.");
  const std::string otherwise = is_tank<T> ? "required if the tank is free" : "if it is left out, that of uniform density";
  section.key("inertia", of_rigid(&RigidCase::inertia), if_given(inertia()), "kg·m²",
              "About the centre of mass; " + otherwise + ". In 2-D only yy counts (kg·m), and may be given alone.");
}

template <class T>
void add_collision_keys(Section<T>& section) {
  section.key("friction", of_rigid(&RigidCase::friction), number(at_least(0)), "",
              "Coulomb's coefficient; of two in contact, the root of the product.");
  section.key("restitution", of_rigid(&RigidCase::restitution), number(between(0, 1)), "",
              "Speed after over before an impact; of two in contact, the greater.");
  if constexpr (is_tank<T>) {
    section.key("collision", of_rigid(&RigidCase::collision),
                choice<CollisionShape>(
                    {{"automatic", CollisionShape::automatic}, {"parts", CollisionShape::parts}, {"none", CollisionShape::none}}),
                "", "What stands for the tank in contacts: its walls, the convex hulls of `collision_parts`, or nothing.");
  } else {
    section.key(
        "collision", of_rigid(&RigidCase::collision),
        choice<CollisionShape>({{"automatic", CollisionShape::automatic},
                                {"convex_hull", CollisionShape::convex_hull},
                                {"decomposition", CollisionShape::decomposition},
                                {"parts", CollisionShape::parts},
                                {"none", CollisionShape::none}}),
        "",
        "What stands for the body in contacts: `automatic` is a box's box and a mesh's convex hull or, where that fills too much, a "
        "decomposition into convex parts; `parts` are the convex hulls of `collision_parts`; `none` passes through everything but "
        "the fluid.");
  }
  section.key_where([](const T& whole) { return whole.rigid.collision == CollisionShape::parts; }, "collision_parts",
                    of_rigid(&RigidCase::collision_parts), list_of(collision_part_section()), "",
                    "Meshes for `collision: parts`, each placed by its own keys in the case's coordinates.");
}

// What else there is to say of a motion: written, and allowed, with that motion only.
struct MotionKey {
  const char* name;
  Motion motion;
};
const MotionKey motion_keys[] = {
    {"velocity", Motion::free}, {"angular_velocity", Motion::free}, {"prescribed", Motion::prescribed}, {"command", Motion::commanded},
    {"forces", Motion::free},   {"moorings", Motion::free},         {"water_film", Motion::free},       {"wind", Motion::free}};

template <class T>
void add_motion_keys(Section<T>& section) {
  const auto add = [&](const std::string& name, auto member, const auto& codec, const std::string& unit, const std::string& description) {
    Motion motion{};
    for (const MotionKey& key : motion_keys) {
      if (name == key.name) motion = key.motion;
    }
    section.key_where([motion](const T& whole) { return whole.motion == motion; }, name, of_rigid(member), codec, unit, description);
  };
  add("velocity", &RigidCase::velocity, vector_in_plane(), "m/s", "Of the centre of mass at the start, if free.");
  add("angular_velocity", &RigidCase::angular_velocity, vector_about(), "rad/s",
      "At the start, if free; in 2-D also a number about y, or else [0, y, 0].");
  add("prescribed", &RigidCase::prescribed, section_of(prescribed_section()), "", "The motion, if prescribed.");
  add("command", &RigidCase::command, section_of(command_section()), "", "Limits on the motion, if commanded.");
  add("forces", &RigidCase::forces, list_of(force_section()), "", "From outside, on what is free.");
  add("moorings", &RigidCase::moorings, list_of(mooring_section()), "",
      "Lines that hold what is free: springs with dampers, or catenaries.");
  if constexpr (!is_tank<T>) {
    add("wind", &RigidCase::wind, section_if_given(wind_section()), "", "On what of a free body is over the water.");
    add("water_film", &RigidCase::water_film, flag(), "",
        "Whether a film of water presses on what of a free body lies on a wall, or nearer to it than a spacing; if not, it is sealed "
        "there.");
  }
}

void check_collision(const RigidCase& rigid, const Setting& map, const std::string& path) {
  const bool by_parts = rigid.collision == CollisionShape::parts;
  if (by_parts && rigid.collision_parts.empty())
    refuse_key(map, path, "collision_parts", "is missing or empty; collision: parts needs a list of at least one mesh");
  if (!by_parts && map.find("collision_parts") != nullptr)
    refuse_key(map, path, "collision_parts",
               "is for collision: parts only; leave it out, or set " + join_path(path, "collision") + " to parts");
}

// Its walls have no volume to find these from.
void check_free_tank(const RigidCase& rigid, const Setting& map, const std::string& path) {
  const auto demand = [&](bool given, const std::string& key, const std::string& what) {
    if (!given) refuse_key(map, path, key, "is missing; a free tank needs its " + what);
  };
  demand(rigid.mass.has_value(), "mass", "mass (kg)");
  demand(rigid.centre_of_mass.has_value(), "centre_of_mass", "centre of mass ([x, y, z], m)");
  demand(rigid.inertia.has_value(), "inertia", "inertia ([xx, yy, zz, xy, xz, yz], kg·m²)");
}

template <class T>
void check_rigid(const T& whole, const Setting& map, const std::string& path, const Context& context) {
  const RigidCase& rigid = whole.rigid;
  for (const MotionKey& key : motion_keys) {
    if (whole.motion == key.motion || map.find(key.name) == nullptr) continue;
    const std::string word = motion_word().write(key.motion, context)->text;
    refuse_key(map, path, key.name, "is for motion: " + word + " only; leave it out, or set " + join_path(path, "motion") + " to " + word);
  }
  if (rigid.mass && rigid.density)
    throw Error(map.find("density")->place.describe() + ": " + path + " has both mass and density; give exactly one of them");
  if (whole.motion == Motion::free) {
    if constexpr (is_tank<T>) {
      check_free_tank(rigid, map, path);
    } else if (!rigid.mass && !rigid.density) {
      refuse_key(map, path, "mass", "is missing; a free body needs exactly one of mass (kg) and density (kg/m³)");
    }
  }
  const PrescribedCase& prescribed = rigid.prescribed;
  if (whole.motion == Motion::prescribed && prescribed.harmonics.empty() && prescribed.ramps.empty() && prescribed.records.empty() &&
      !prescribed.waves)
    refuse_key(map, path, "motion",
               "is prescribed, but nothing prescribes it; give " + join_path(path, "prescribed") +
                   " at least one of harmonics, ramps, records and waves");
  check_collision(rigid, map, path);
}

template <class T>
void add_keys_and_rules(Section<T>& section) {
  add_mass_keys(section);
  add_motion_keys(section);
  add_collision_keys(section);
  section.rule(check_rigid<T>);
}

}  // namespace

void add_rigid_keys(Section<TankCase>& section) { add_keys_and_rules(section); }
void add_rigid_keys(Section<BodyCase>& section) { add_keys_and_rules(section); }

}  // namespace wavetank::scene
