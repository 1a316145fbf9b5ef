#include "case_keys.h"

#include "joint_keys.h"
#include "mesh_keys.h"
#include "motion_values.h"
#include "opening_keys.h"
#include "rigid_keys.h"
#include "robot_keys.h"
#include "wave_keys.h"

namespace wavetank::scene {
namespace {

Section<Box> box_section() {
  Section<Box> section;
  section.key("min", &Box::min, position(), "m", "Corner of least coordinates.").required = true;
  section.key("max", &Box::max, position(), "m", "Corner of greatest coordinates, each greater than that of `min`; y is ignored in 2-D.")
      .required = true;
  section.rule([](const Box& box, const Setting& map, const std::string& path, const Context& context) {
    for (const int axis : {0, 1, 2}) {
      if (axis == 1 && context.dimensions == 2) continue;
      if (box.min[axis] < box.max[axis]) continue;
      refuse(*map.find("max"), {join_path(path, "max"), "m"},
             "greater than " + join_path(path, "min") + ", " + map.find("min")->brief() + ", in " + "xyz"[axis]);
    }
  });
  return section;
}

// The keys of a box or a mesh that fills the variant `shape`.
template <class T, class Shape>
void add_mesh_keys(Section<T>& section, Shape shape) {
  declare_mesh_keys([&](auto... key) -> KeyDescription& { return section.template key_of<MeshSource>(shape, key...); });
  section.exactly_one_of({{"box"}, {"mesh", "scale", "translation", "rotation"}});
}

Section<FillRegion> fill_section() {
  Section<FillRegion> section;
  section.key_of<Box>(Whole{}, "box", Whole{}, section_of(box_section()), "", "Water in a box.").required = true;
  section
      .key_of<FloodFill>(Whole{}, "seed", &FloodFill::seed, position(), "m",
                         "A point inside a region bounded by walls: water fills the region from it ...")
      .required = true;
  section
      .key_of<FloodFill>(Whole{}, "level", &FloodFill::level, number({}), "m",
                         "... up to this z of the free surface; with gravity nearer to x or y, that coordinate of it, over the seed.")
      .required = true;
  section.exactly_one_of({{"box"}, {"seed", "level"}});
  return section;
}

Section<DampingCase> damping_section() {
  Section<DampingCase> section;
  section.key("box", &DampingCase::box, section_of(box_section()), "", "Where.").required = true;
  section
      .key("direction", &DampingCase::direction, vector(), "",
           "Along which the damping grows, from nothing at the box's near side, with the square of the way.")
      .required = true;
  section
      .key("strength", &DampingCase::strength, number(greater_than(0)), "1/s",
           "Rate at the box's far side, at which velocities go over to `velocity`. For waves of period T in a zone of a wavelength some "
           "10/T.")
      .required = true;
  section.key("velocity", &DampingCase::velocity, vector(), "m/s", "Towards which velocities go, such as that of a current.");
  section.rule([](const DampingCase& zone, const Setting& map, const std::string& path, const Context& context) {
    const Vector3d way = context.dimensions == 2 ? Vector3d(zone.direction.x(), 0, zone.direction.z()) : zone.direction;
    if (way.isZero(0.0)) refuse_vector(map, path, "direction", zone.direction, "a direction, not all 0");
  });
  return section;
}

// Sound is hardly ever faster than in water itself, 1480 m/s; beyond this a key is wrong.
constexpr double greatest_sound_speed = 1e6;  // m/s

Section<FluidCase> fluid_section() {
  Section<FluidCase> section;
  section.key("density", &FluidCase::density, number(greater_than(0)), "kg/m³", "Density ρ₀ at rest.");
  section.key("viscosity", &FluidCase::viscosity, number(at_least(0)), "Pa·s", "Dynamic viscosity μ.");
  section.key("sound_speed", &FluidCase::sound_speed, number_or_auto(above_up_to(0, greatest_sound_speed)), "m/s",
              "Speed of sound c₀ of the weakly compressible fluid; `auto` is 10 × the greatest expected speed.");
  section.key("spacing", &FluidCase::spacing, number_if_given(greater_than(0)), "m", "Initial distance Δx of the particles.").required =
      true;
  section
      .key("particles", &FluidCase::particles, count_if_given(between(1, 1e9)), "",
           "About so many fluid particles: the spacing follows from the fluid's volume.")
      .required = true;
  section
      .key("fill", &FluidCase::fill, list_of(fill_section()), "",
           "Where the water is at the start: one or more regions; [] where all of it comes in by openings.")
      .required = true;
  section.key("damping", &FluidCase::damping, list_of(damping_section()), "",
              "Boxes in which the water's velocity is damped, so that waves do not come back from behind them; not where bodies are.");
  Section<InitialCase> initial;
  initial.key("u", &InitialCase::u, expression(Expression::Of::place), "m/s", "Velocity along x, such as `sin(2*pi*x)*cos(2*pi*z)`.");
  initial.key("v", &InitialCase::v, expression(Expression::Of::place), "m/s", "Along y; not used in 2-D.");
  initial.key("w", &InitialCase::w, expression(Expression::Of::place), "m/s", "Along z.");
  initial.key("pressure", &InitialCase::pressure, expression(Expression::Of::place), "Pa",
              "Gauge pressure, instead of the hydrostatic one.");
  initial.key("elevation", &InitialCase::elevation, expression(Expression::Of::plan), "m",
              "Of the free surface over the level of each `fill`, such as `0.02*cos(2*pi*x)`: of x and y; with gravity along −z. What is "
              "hydrostatic is so below it.");
  initial.key("waves", &InitialCase::waves, section_if_given(initial_wave_section()), "",
              "Waves by theory that are there at the start: surface, velocity and pressure together, instead of the expressions.");
  section.key("initial", &FluidCase::initial, section_of(initial), "",
              "The water at the start, after packing and settling: expressions of x, y, z (m), with pi and the usual functions, or waves "
              "by theory. What is not given is level, at rest and hydrostatic.");
  section.key("current", &FluidCase::current, vector_in_plane(), "m/s",
              "Velocity of all water at the start, beside what `initial` gives: a flume begins with its current.");
  section.exactly_one_of({{"spacing"}, {"particles"}});
  return section;
}

Section<TankCase> tank_section() {
  Section<BoxTank> box;
  box.key("size", &BoxTank::size, size(), "m", "Inner length, width and height; the width is ignored in 2-D.").required = true;
  box.key("origin", &BoxTank::origin, position(), "m", "Corner of least coordinates.");
  box.key("closed", &BoxTank::closed, flag(), "", "Whether the tank has a lid; without one its side most nearly against gravity is open.");
  Section<TankCase> section;
  section.key_of<BoxTank>(&TankCase::shape, "box", Whole{}, section_of(box), "", "A rectangular tank.").required = true;
  add_mesh_keys(section, &TankCase::shape);
  section.key(
      "splash_guard", &TankCase::splash_guard, flag(), "",
      "Keeps spray above the tank's highest point over the tank, as if its walls went on upwards; without it, a particle that flies "
      "out stops the run.");
  section.key(
      "periodic", &TankCase::periodic, axes(), "",
      "Directions in which the tank repeats itself: it has no walls at these ends, and what leaves at one comes in at the other. For "
      "tanks that do not turn.");
  section.key("motion", &TankCase::motion, motion_word(), "",
              "How the tank moves; the fluid is solved in its frame, and the case's coordinates are those of the start.");
  add_rigid_keys(section);
  return section;
}

/// Of a body the law may be the case's.
template <class Friction>
Section<Friction> friction_section() {
  constexpr bool of_body = std::is_same_v<Friction, SkinFrictionCase>;
  std::vector<std::pair<std::string, FrictionLaw>> laws{{"none", FrictionLaw::none},
                                                        {"viscous", FrictionLaw::viscous},
                                                        {"law_of_the_wall", FrictionLaw::law_of_the_wall},
                                                        {"coefficient", FrictionLaw::coefficient}};
  if (of_body) laws.insert(laws.begin(), {"as_case", FrictionLaw::as_case});
  Section<Friction> section;
  section.key(
      "law", &FrictionCase::law, choice<FrictionLaw>(laws), "",
      std::string("What holds the water back along the wall: nothing; `viscous`, μ u/d at each particle's distance d, of a boundary "
                  "layer that the particles resolve; `law_of_the_wall`, the logarithmic law at that distance, of a turbulent one "
                  "that they do not; `coefficient`, ½ C_f ρ u²") +
          (of_body ? "; `as_case`, as `numerics/walls/friction` says." : "."));
  section.key_where([](const FrictionCase& friction) { return friction.law == FrictionLaw::coefficient; }, "coefficient",
                    &FrictionCase::coefficient, number(between(0, 1)), "", "C_f of `coefficient`.");
  section.key_where([](const FrictionCase& friction) { return friction.law == FrictionLaw::law_of_the_wall; }, "roughness",
                    &FrictionCase::roughness, number(at_least(0)), "m",
                    "Height k_s of Nikuradse's sand grains, of `law_of_the_wall`; 0: smooth.");
  section.rule([](const FrictionCase& friction, const Setting& map, const std::string& path, const Context&) {
    if (friction.law != FrictionLaw::coefficient && map.find("coefficient") != nullptr)
      refuse_key(map, path, "coefficient",
                 "is of the law coefficient only; leave it out, or set " + join_path(path, "law") + " to coefficient");
    if (friction.law != FrictionLaw::law_of_the_wall && map.find("roughness") != nullptr)
      refuse_key(map, path, "roughness", "is of the law law_of_the_wall only; leave it out, or set " + join_path(path, "law") + " to that");
  });
  return section;
}

/// true, or the place.
Codec<std::optional<ImuCase>> imu() {
  const std::string demand = "true, false, or its place, [x, y, z]";
  return {"true, false or [x, y, z]", "",
          [demand](const Setting& setting, const Item& item, Context& context) -> std::optional<ImuCase> {
            if (setting.kind == Setting::Kind::list) return ImuCase{position().read(setting, item, context)};
            if (setting.kind != Setting::Kind::scalar ||
                (setting.text != "true" && setting.text != "True" && setting.text != "false" && setting.text != "False"))
              refuse(setting, item, demand);
            return flag().read(setting, item, context) ? std::optional<ImuCase>(ImuCase{}) : std::nullopt;
          },
          [](const std::optional<ImuCase>& value, const Context& context) -> std::optional<Setting> {
            if (!value) return std::nullopt;
            return value->position ? position().write(*value->position, context) : flag().write(true, context);
          }};
}

Section<BodyCase> body_section() {
  Section<BodyCase> section;
  section
      .key("name", &BodyCase::name, name(), "",
           "Part of the names of the body's topics and frame; its own among bodies, probes and gauges.")
      .required = true;
  section.key("motion", &BodyCase::motion, motion_word(), "",
              "How the body moves: not at all, by its weight and all forces on it, as prescribed here, or at a velocity commanded while it "
              "runs.");
  section.key("surface_velocity", &BodyCase::surface_velocity, vector(), "m/s",
              "Of a belt: its surface runs at this velocity while the body stands; only the part along the surface acts.");
  section.key("skin_friction", &BodyCase::skin_friction, section_of(friction_section<SkinFrictionCase>()), "",
              "Of the water along the body.");
  section.key_of<Box>(&BodyCase::shape, "box", Whole{}, section_of(box_section()), "", "A box.").required = true;
  add_mesh_keys(section, &BodyCase::shape);
  add_rigid_keys(section);
  section.key("imu", &BodyCase::imu, imu(), "m",
              "An inertial measurement unit: true, at the body's centre of mass, or its place at the start; it moves with the body.");
  section.rule([](const BodyCase& body, const Setting& map, const std::string& path, const Context&) {
    if (body.motion == Motion::fixed || body.surface_velocity.isZero(0.0)) return;
    throw Error(map.find("surface_velocity")->place.describe() + ": " + join_path(path, "surface_velocity") +
                " is for bodies that stand only; leave it out, or set " + join_path(path, "motion") + " to fixed");
  });
  return section;
}

Section<WallCase> wall_section() {
  Section<WallCase> section;
  section.key(
      "method", &WallCase::method, choice<WallMethod>({{"boundary_integral", WallMethod::boundary_integral}, {"ghost", WallMethod::ghost}}),
      "", "How walls act on the fluid: by boundary integrals, or by mirror images of the particles, for tanks of planes at right angles.");
  section.key("shepard", &WallCase::shepard,
              choice<ShepardFactor>({{"none", ShepardFactor::none},
                                     {"volumetric", ShepardFactor::volumetric},
                                     {"monolithic", ShepardFactor::monolithic},
                                     {"geometric", ShepardFactor::geometric}}),
              "", "How the Shepard factor γ, the kernel's integral over the fluid's side of the walls, is found.");
  section.key(
      "elements", &WallCase::elements,
      choice<WallElements>(
          {{"numerical", WallElements::numerical}, {"semi_analytical", WallElements::semi_analytical}, {"facet", WallElements::facet}}),
      "",
      "What the boundary integrals sum over: rectangles of about Δx, triangles of about Δx, or the mesh's own triangles of any size, "
      "exactly.");
  section.key("slip", &WallCase::slip, choice<Slip>({{"no_slip", Slip::no_slip}, {"free_slip", Slip::free_slip}}), "",
              "The fluid's velocity along a wall.");
  section.key_where([](const WallCase& walls) { return walls.slip == Slip::no_slip; }, "friction", &WallCase::friction,
                    section_of(friction_section<FrictionCase>()), "",
                    "Of the water along walls with `no_slip`, where no body says otherwise; by boundary integrals.");
  section.key("renormalise_divergence", &WallCase::renormalise_divergence, flag(), "",
              "With fourtakas or no diffusion: whether the velocity's divergence is divided by the Shepard factor's root, and diffusion by "
              "the factor.");
  section.key("repulsion", &WallCase::repulsion, number(between(0, 1)), "(c₀/10)²",
              "Of ghosts, and of walls with moving least squares: strength of a short-range repulsion by the wall; 0 leaves it out.");
  section.key("guard_distance", &WallCase::guard_distance, number(between(0, 1)), "Δx",
              "Nearer to a wall than this, a particle loses its velocity towards it; 0 switches the guard off, but not the splash guard.");
  return section;
}

template <class Choice>
Codec<Choice> method() {
  std::vector<std::pair<std::string, Choice>> words;
  for (const MethodWord<Choice>& known : method_words<Choice>()) words.emplace_back(known.word, known.choice);
  return choice<Choice>(words);
}

template <class Choice>
std::string meanings(const std::string& subject) {
  std::string text = subject;
  for (const MethodWord<Choice>& known : method_words<Choice>())
    text += std::string(text == subject ? ": `" : "; `") + known.word + "`, " + known.meaning;
  return text + ".";
}

Section<LeastSquaresCase> least_squares_section() {
  Section<LeastSquaresCase> section;
  section.key("pressure", &LeastSquaresCase::pressure, method<MlsPressure>(), "", meanings<MlsPressure>("Form of the pressure's gradient"));
  section.key("pivot", &LeastSquaresCase::pivot, number(between(1e-6, 0.2)), "",
              "Where less than this part of a basis function is not explained by those before it, the fit is of first order.");
  section.key("support", &LeastSquaresCase::support, number_or_auto(between(2, 8)), "Δx",
              "Radius R_m within which neighbours count, no more than `numerics/support`; `auto` is 3.4 in 2-D and 2.6 in 3-D.");
  return section;
}

Section<NumericsCase> numerics_section() {
  Section<PackingCase> packing;
  packing.key("iterations", &PackingCase::iterations, whole_number(between(0, 100000)), "",
              "Steps of packing the particles before the start; 0 starts from the lattice.");
  packing.key(
      "settling", &PackingCase::settling, number(between(0, 100)), "4 H/c₀",
      "Damped time before the start, in which the water comes to rest with its free sides held; H is its greatest depth. 0 leaves it out.");
  Section<NumericsCase> section;
  section.key("scheme", &NumericsCase::scheme, method<Scheme>(), "", meanings<Scheme>("The SPH scheme"));
  section.key_where(
      [](const NumericsCase& numerics) { return numerics.scheme != Scheme::delta_sph; }, "limiter", &NumericsCase::limiter,
      number(between(1, 2)), "",
      "θ of the limiter of Riemann schemes, minmod of what the gradients say and θ times the difference: 1 diffuses most and "
      "keeps impacts calm; with 2, values between two particles go as far as those of the other, and smooth flows lose least.");
  section.key("gradients", &NumericsCase::gradients, method<Gradients>(), "", meanings<Gradients>("How derivatives are found"));
  section.key_where([](const NumericsCase& numerics) { return numerics.gradients != Gradients::sph; }, "mls", &NumericsCase::mls,
                    section_of(least_squares_section()), "", "Moving least squares, of `gradients` other than `sph`.");
  section.key("support", &NumericsCase::support, number_or_auto(between(2, 8)), "Δx",
              "Radius R of the kernel's support; `auto` is 4 in 2-D and 3 in 3-D.");
  section.key("walls", &NumericsCase::walls, section_of(wall_section()), "", "Walls of the tank and of the bodies.");
  section.key(
      "density_diffusion", &NumericsCase::density_diffusion, method<DensityDiffusion>(), "",
      meanings<DensityDiffusion>("Density diffusion; where it is not given, `none` with a Riemann scheme, which diffuses by itself"));
  section.key("density_diffusion_coefficient", &NumericsCase::density_diffusion_coefficient, number(between(0, 1)), "", "δ.");
  section.key("artificial_viscosity", &NumericsCase::artificial_viscosity, number(between(0, 1)), "",
              "Coefficient α of the artificial viscosity; where it is not given, 0 with a Riemann scheme and 0.1 with `gradients` other "
              "than `sph`.");
  section
      .key("acoustic_damping", &NumericsCase::acoustic_damping, number(between(0, 10)), "",
           "Coefficient α₂ of the acoustic damper, a bulk viscosity α₂ c₀ h on sound alone; with `symplectic`. 0: none. Where it is not "
           "given, 0 with a Riemann scheme, another integrator or `gradients` other than `sph`.")
      .default_text = number_text(usual_acoustic_damping);
  section.key("turbulence", &NumericsCase::turbulence, method<Turbulence>(), "", meanings<Turbulence>("Model of eddies below the spacing"));
  section.key_where([](const NumericsCase& numerics) { return numerics.turbulence == Turbulence::smagorinsky; }, "smagorinsky_coefficient",
                    &NumericsCase::smagorinsky_coefficient, number(between(0, 1)), "", "C_s.");
  section.key("equation_of_state", &NumericsCase::equation_of_state, method<EquationOfState>(), "",
              meanings<EquationOfState>("Pressure from density"));
  section.key_where([](const NumericsCase& numerics) { return numerics.gradients == Gradients::sph; }, "viscosity_model",
                    &NumericsCase::viscosity_model, method<ViscosityModel>(), "",
                    meanings<ViscosityModel>("Form of the physical viscosity's sum, of `gradients: sph`"));
  section.key("negative_pressure", &NumericsCase::negative_pressure,
              choice<NegativePressure>({{"allowed", NegativePressure::allowed}, {"clamped", NegativePressure::clamped}}), "",
              "What the fluid does where its pressure would fall below that of the air.");
  section.key("shifting", &NumericsCase::shifting, method<Shifting>(), "", meanings<Shifting>("Particle shifting law"));
  section.key("tensile", &NumericsCase::tensile, method<Tensile>(), "",
              meanings<Tensile>("Where the laws lind, sun and michel also hold particles apart that come close"));
  section.key("expected_speed", &NumericsCase::expected_speed, number_or_auto(greater_than(0)), "m/s",
              "Greatest speed of the water that is expected, for the laws oger and sun; `auto` is a tenth of the speed of sound.");
  section.key("integrator", &NumericsCase::integrator, method<Integrator>(), "", meanings<Integrator>("Time scheme"));
  section.key("courant", &NumericsCase::courant, number(above_up_to(0, 1.5)), "", "Time step as a fraction of h/(c₀ + |u|).");
  section.key("precision", &NumericsCase::precision, choice<Precision>({{"single", Precision::single}, {"double", Precision::double_}}), "",
              "Of the numbers on the device; not every device has double.");
  section.key("packing", &NumericsCase::packing, section_of(packing), "", "Before the start.");
  return section;
}

Section<InstrumentsCase> instruments_section() {
  Section<PressureProbeCase> probe;
  probe.key("name", &PressureProbeCase::name, name(), "", "Part of the names of the probe's topic and frame.").required = true;
  probe.key("position", &PressureProbeCase::position, position(), "m", "At the start, on a wall or in the fluid; in 2-D also [x, z].")
      .required = true;
  probe.key("body", &PressureProbeCase::body, text(), "", "The body that the probe is fixed to; empty: the tank.");
  probe.key("diameter", &PressureProbeCase::diameter, number(at_least(0)), "m",
            "Of the sensor's disc on the wall, over which it takes the mean; in 2-D the length of its strip. 0: a point.");
  Section<WaveGaugeCase> gauge;
  gauge.key("name", &WaveGaugeCase::name, name(), "", "The gauge's name.").required = true;
  gauge
      .key("position", &WaveGaugeCase::position, gauge_position(), "m",
           "Of the vertical line; a z may be given and is ignored; in 2-D also [x]. With gravity nearer to y or x the line is along that: "
           "[x, z] or [y, z].")
      .required = true;
  Section<VelocityProbeCase> velocity;
  velocity.key("name", &VelocityProbeCase::name, name(), "", "Part of the name of the probe's topic.").required = true;
  velocity.key("position", &VelocityProbeCase::position, position(), "m", "At the start, in the fluid; in 2-D also [x, z].").required =
      true;
  velocity.key("body", &VelocityProbeCase::body, text(), "", "The body that the probe is fixed to; empty: the tank.");
  Section<InstrumentsCase> section;
  section.key("pressure_probes", &InstrumentsCase::pressure_probes, list_of(probe), "", "Pressure probes.");
  section.key("wave_gauges", &InstrumentsCase::wave_gauges, list_of(gauge), "",
              "Wave gauges: the level of the free surface on lines along the axis nearest to gravity.");
  section.key("velocity_probes", &InstrumentsCase::velocity_probes, list_of(velocity), "",
              "Velocity probes: the water's velocity at points, relative to the tank.");
  section.key("sections", &InstrumentsCase::sections, list_of(flow_section()), "",
              "Plane sections through which the discharge is measured.");
  const Range rates = above_up_to(0, 1e6);
  section.key("rate", &InstrumentsCase::rate, number(rates), "Hz",
              "Samples a second of simulated time, of all instruments without a rate of their own.");
  section.key("gauge_rate", &InstrumentsCase::gauge_rate, number_or_auto(rates), "Hz", "Of the wave gauges; `auto` is `instruments/rate`.");
  section.key("wrench_rate", &InstrumentsCase::wrench_rate, number_or_auto(rates), "Hz",
              "Of the force and torque on tank and bodies; `auto` is `instruments/rate`.");
  section.key("energy_rate", &InstrumentsCase::energy_rate, number_or_auto(rates), "Hz",
              "Of energies and mass; `auto` is `instruments/rate`.");
  section.key("flow_rate", &InstrumentsCase::flow_rate, number_or_auto(rates), "Hz",
              "Of the discharges at openings and through sections; `auto` is `instruments/rate`.");
  section.key("pose_rate", &InstrumentsCase::pose_rate, number_or_auto(rates), "Hz",
              "Of moving bodies' poses, of joints and of moorings; `auto` is 100, or `instruments/rate` where that is less.");
  section.key("imu_rate", &InstrumentsCase::imu_rate, number_or_auto(rates), "Hz",
              "Of inertial measurement units; `auto` is that of the poses.");
  return section;
}

// The clouds' rates and the other keys of publishing lie at different places of the file, and in one struct.
Section<PublishingCase> rates_section() {
  Section<PublishingCase> section;
  section.key("cloud", &PublishingCase::cloud_rate, number(above_up_to(0, 1e6)), "Hz",
              "Particle clouds on topics, at most: of wall time, while someone listens. Fewer where more would take over 3 % of the time.");
  section.key("cloud_bag", &PublishingCase::cloud_bag_rate, number(above_up_to(0, 1e6)), "Hz",
              "Particle clouds in a bag of `wavetank_run --clouds`: of simulated time.");
  section.key(
      "surface", &PublishingCase::surface_rate, number(above_up_to(0, 1e6)), "Hz",
      "The water's surface on topics, at most: of wall time, while someone listens. Fewer where more would take over 3 % of the time.");
  section.key("surface_bag", &PublishingCase::surface_bag_rate, number(above_up_to(0, 1e6)), "Hz",
              "The water's surface in a bag of `wavetank_run --surface`: of simulated time.");
  return section;
}

template <class Member, class Value>
void add_publishing_key(Section<Case>& section, const std::string& name, Member member, Codec<Value> codec, const std::string& unit,
                        const std::string& description) {
  section.key(
      name, [member](auto& target) -> auto& { return target.publishing.*member; }, codec, unit, description);
}

Section<Case> declare_case() {
  Section<Case> section;
  section.key("title", &Case::title, text(), "", "One line that says what the case is.");
  section.key("dimensions", &Case::dimensions, dimension_count(), "",
              "A 2-D case lies in the x–z plane; its positions may be given as [x, z].");
  section.key("gravity", &Case::gravity, vector(), "m/s²", "Of any direction; in 2-D without a y component.");
  section.key("duration", &Case::duration, number(greater_than(0)), "s", "Of simulated time.").required = true;
  section.key(
      "device", &Case::device, nonempty_text(), "",
      "OpenCL device: `auto`, `cpu`, `gpu`, a part of the device's name, or \"PLATFORM:DEVICE\" by index, in quotes; several of them, "
      "or `all`, for [water in parts](distributed.md).");
  section.key("fluid", &Case::fluid, section_of(fluid_section()), "", "The water.").required = true;
  section.key("tank", &Case::tank, section_of(tank_section()), "", "The tank: a box or a mesh.").required = true;
  section.key("bodies", &Case::bodies, list_of(body_section()), "", "Bodies in the tank: boxes or closed meshes.");
  section.key("joints", &Case::joints, list_of(joint_section()), "", "Joints between bodies, or a body and the tank or the world.");
  section.key("robots", &Case::robots, robot_list(), "",
              "Robots described in URDF: their links become bodies and their joints joints, after those of the case.");
  section.key("openings", &Case::openings, list_of(opening_section()), "", "Holes in walls, through which water comes in and leaves.");
  section.key("numerics", &Case::numerics, section_of(numerics_section()), "", "The method.");
  section.key("instruments", &Case::instruments, section_of(instruments_section()), "", "What is measured.");
  section.key("rates", &Case::publishing, section_of(rates_section()), "", "How often clouds and the water's surface are published.");
  add_publishing_key(section, "max_points", &PublishingCase::max_points, whole_number(between(1, 1e9)), "",
                     "Of a published cloud; more are decimated.");
  add_publishing_key(section, "reference_pressure", &PublishingCase::reference_pressure, number({}), "Pa",
                     "Added to the gauge pressure in sensor_msgs/FluidPressure; 101325 gives absolute pressure.");
  add_publishing_key(section, "world_frame", &PublishingCase::world_frame, frame(), "", "tf frame of the case's coordinates.");
  add_publishing_key(section, "publish_clock", &PublishingCase::publish_clock, flag(), "",
                     "Whether the node publishes /clock from the simulated time.");
  add_publishing_key(section, "real_time_factor", &PublishingCase::real_time_factor, number(at_least(0)), "",
                     "Upper limit of simulated over wall time; 0 = as fast as it goes.");
  return section;
}

}  // namespace

const Section<Case>& case_section() {
  static const Section<Case> section = declare_case();
  return section;
}

const KeyDescription& case_keys() {
  static const KeyDescription root = [] {
    KeyDescription description;
    description.holds = Holds::section;
    description.children = case_section().descriptions();
    return description;
  }();
  return root;
}

}  // namespace wavetank::scene
