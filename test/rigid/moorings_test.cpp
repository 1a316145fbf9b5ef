// Catenaries against their formulas, what moorings say of themselves, and the wind.
#include <random>

#include "../../src/rigid/catenary.h"
#include "../../src/rigid/wind.h"
#include "rigid_fixture.h"

namespace wavetank::moorings_test {
namespace {

// ---- catenary

TEST(Catenary, BetweenEndsOfOneHeightHasTheFormulasPull) {
  // Hung freely from two ends 2 a sinh⁻¹… apart: L = 2 a sinh(D/2a) with a = H/w, and half the weight at either end.
  const double a = 3, span = 8, weight = 20;
  Catenary line{2 * a * std::sinh(0.5 * span / a), weight, 0, false};
  const std::optional<CatenaryPull> pull = catenary_pull(line, span, 0);
  ASSERT_TRUE(pull);
  EXPECT_NEAR(pull->horizontal, a * weight, 1e-9 * a * weight);
  EXPECT_NEAR(pull->vertical, 0.5 * weight * line.length, 1e-9 * weight * line.length);
  EXPECT_NEAR(pull->anchor_vertical, -0.5 * weight * line.length, 1e-9 * weight * line.length);
  EXPECT_NEAR(pull->tension(), pull->anchor_tension(), 1e-9 * pull->tension());
  EXPECT_EQ(pull->lying, 0);
}

TEST(Catenary, ThatLiesOnItsBedHasTheFormulasPull) {
  // From where it leaves the bed it is z = a (cosh(x/a) − 1) of the length s = a sinh(x/a), with a = H/w.
  const double a = 2, hung = 3, weight = 50, lying = 7;
  Catenary line{lying + a * std::sinh(hung / a), weight, 0, true};
  const double rise = a * (std::cosh(hung / a) - 1);
  const std::optional<CatenaryPull> pull = catenary_pull(line, lying + hung, rise);
  ASSERT_TRUE(pull);
  EXPECT_NEAR(pull->horizontal, a * weight, 1e-9 * a * weight);
  EXPECT_NEAR(pull->lying, lying, 1e-9);
  EXPECT_EQ(pull->anchor_vertical, 0);
  EXPECT_NEAR(pull->tension() - pull->anchor_tension(), weight * rise, 1e-8 * weight * rise) << "the tension grows by w z";
  const std::vector<Eigen::Vector2d> shape = catenary_shape(line, lying + hung, rise, *pull, 401);
  double length = 0;
  for (std::size_t k = 1; k < shape.size(); ++k) length += (shape[k] - shape[k - 1]).norm();
  EXPECT_NEAR(length, line.length, 1e-4 * line.length);
  EXPECT_LT((shape.front() - Eigen::Vector2d(0, 0)).norm(), 1e-12);
  EXPECT_NEAR(shape[200].y(), 0, 1e-9) << "the middle of the line lies";
}

TEST(Catenary, ThatIsTautIsASpringOfItsStiffness) {
  const double length = 10, stiffness = 1e6, stretch = 1e-3;
  Catenary line{length, 1e-3, 1 / stiffness, false};
  const double distance = length * (1 + stretch);
  const std::optional<CatenaryPull> pull = catenary_pull(line, 0.6 * distance, 0.8 * distance);
  ASSERT_TRUE(pull);
  EXPECT_NEAR(pull->tension(), stiffness * stretch, 1e-2) << "of 1000 N, beside a weight of 0.01 N";
  EXPECT_NEAR(pull->horizontal / pull->vertical, 0.75, 1e-5);
}

TEST(Catenary, ThatHangsSlackPullsStraightDown) {
  Catenary line{10, 30, 0, true};
  const std::optional<CatenaryPull> pull = catenary_pull(line, 5, 4);  // 4 m hang, 6 m lie on 5 m
  ASSERT_TRUE(pull);
  EXPECT_EQ(pull->horizontal, 0);
  EXPECT_NEAR(pull->vertical, 120, 1e-6);
  EXPECT_NEAR(pull->lying, 6, 1e-6);
  for (const Eigen::Vector2d& place : catenary_shape(line, 5, 4, *pull, 25)) {
    EXPECT_GE(place.x(), 0);
    EXPECT_LE(place.x(), 5 + 1e-9);
    EXPECT_LE(place.y(), 4 + 1e-9);
  }
}

TEST(Catenary, ThatIsTooShortAndDoesNotStretchHasNoPull) {
  EXPECT_FALSE(catenary_pull({10, 30, 0, true}, 8, 6));
  EXPECT_TRUE(catenary_pull({10, 30, 1e-5, true}, 8, 6));
}

// From slack to taut, by whatever place: the pull solves both equations, and grows with the span.
TEST(Catenary, SolvesItsEquationsEverywhere) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> part(0, 1);
  for (int trial = 0; trial < 2000; ++trial) {
    Catenary line{1 + 20 * part(generator), 1 + 100 * part(generator), part(generator) < 0.5 ? 0 : 1e-3 * part(generator),
                  part(generator) < 0.5};
    const double rise = (line.bed ? 1 : 2 * part(generator) - 1) * part(generator) * 0.99 * line.length;
    double reach = std::sqrt(line.length * line.length - rise * rise);
    if (line.compliance > 0) reach *= 1.05;
    const double span = 0.999 * reach * part(generator);
    const std::optional<CatenaryPull> pull = catenary_pull(line, span, rise);
    ASSERT_TRUE(pull) << trial;
    EXPECT_NEAR(pull->vertical - pull->anchor_vertical, line.weight * (line.length - pull->lying), 1e-9 * line.weight * line.length);
    const auto farther = catenary_pull(line, span + 1e-3 * (reach - span), rise);
    ASSERT_TRUE(farther);
    EXPECT_GE(farther->horizontal, pull->horizontal * (1 - 1e-9)) << trial;
    if (pull->horizontal == 0) continue;
    const std::vector<Eigen::Vector2d> shape = catenary_shape(line, span, rise, *pull, 2001);
    // its last place is put at the top; what the equations have there is on the way on from the two before
    const Eigen::Vector2d end = 2 * shape[1999] - shape[1998];
    EXPECT_LT((end - Eigen::Vector2d(span, rise)).norm(), 2e-3 * line.length) << trial;
  }
}

/// Where a line ends that begins at its anchor with a pull, m: the balance of its elements, whose tension T turns by their weight and
/// stretches them, dT/ds = (0, w) and dx/ds = T/|T| (1 + c |T|), by Runge and Kutta's fourth order in `steps`. No formula of a catenary is
/// in it. `tension`: at its end, N.
Eigen::Vector2d end_of_line(const Catenary& line, const CatenaryPull& pull, int steps, Eigen::Vector2d& tension) {
  Eigen::Vector2d place(pull.lying * (1 + line.compliance * pull.horizontal), 0);  // what lies is as taut everywhere
  tension = Eigen::Vector2d(pull.horizontal, pull.anchor_vertical);
  const double step = (line.length - pull.lying) / steps;
  const auto direction = [&](double on) -> Eigen::Vector2d {
    const Eigen::Vector2d at = tension + Eigen::Vector2d(0, line.weight * on);
    return at / at.norm() * (1 + line.compliance * at.norm());
  };
  for (int k = 0; k < steps; ++k) {
    place += step / 6 * (direction(0) + 4 * direction(0.5 * step) + direction(step));
    tension.y() += line.weight * step;
  }
  return place;
}

TEST(Catenary, IsTheLineWhoseElementsAreInBalance) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> part(0, 1);
  double worst = 0;
  int hanging = 0, lying = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const bool bed = trial % 2 == 0;
    const Catenary line{1 + 20 * part(generator), 1 + 100 * part(generator), trial % 3 == 0 ? 0 : 1e-3 * part(generator), bed};
    const double rise = (bed ? 1 : 2 * part(generator) - 1) * 0.9 * part(generator) * line.length;
    const double reach = std::sqrt(line.length * line.length - rise * rise);
    const double span = (0.3 + 0.68 * part(generator)) * reach;
    const std::optional<CatenaryPull> pull = catenary_pull(line, span, rise);
    ASSERT_TRUE(pull) << trial;
    if (pull->horizontal < 1e-2 * line.weight * line.length) continue;  // straight down, where the direction jumps at the bottom
    Eigen::Vector2d tension;
    const Eigen::Vector2d end = end_of_line(line, *pull, 500, tension);
    worst = std::max(worst, (end - Eigen::Vector2d(span, rise)).norm() / line.length);
    EXPECT_NEAR(tension.norm(), pull->tension(), 1e-9 * pull->tension()) << trial;
    ++(pull->lying > 0 ? lying : hanging);
  }
  std::printf("lines integrated from their anchors end off their tops by at most %.1e of their length, %d that lie in part, %d that hang\n",
              worst, lying, hanging);
  EXPECT_LT(worst, 1e-7);
  EXPECT_GT(lying, 50);
  EXPECT_GT(hanging, 50);
}

TEST(Catenary, HasTheFiguresOfATextbook) {
  // R. C. Hibbeler, Engineering Mechanics: Statics, chapter 7, the uniform cable of 5 N/m over 20 m that sags by 6 m: it is 24.2 m long,
  // its horizontal pull is 45.9 N and its greatest tension 75.9 N, as printed
  const std::optional<CatenaryPull> pull = catenary_pull({24.2, 5, 0, false}, 20, 0);
  ASSERT_TRUE(pull);
  // a length of three digits is good to 0.05 m, by which the pull changes by 0.5 N
  EXPECT_NEAR(pull->horizontal, 45.9, 0.5);
  EXPECT_NEAR(pull->tension(), 75.9, 0.4);
}

// ---- moorings of a body

Case moored(const MooringCase& line) {
  Case scene = dry_case({12, 4, 8}, 0.5);
  scene.bodies = {free_box("buoy", {6, 2, 6}, {0.4, 0.4, 0.4})};
  scene.bodies[0].rigid.collision = CollisionShape::none;
  scene.bodies[0].rigid.moorings = {line};
  return scene;
}

TEST(Moorings, ASpringTellsItsTensionAndItsEnds) {
  MooringCase line;
  line.anchor = {6, 2, 2};
  line.attachment = {6, 2, 5.8};
  line.stiffness = 1000;
  line.length = 3.5;
  Trial run(moored(line), 1e-3);
  const std::vector<MooringState> moorings = run.world.moorings();
  ASSERT_EQ(moorings.size(), 1U);
  EXPECT_NEAR(moorings[0].tension, 300, 1e-9);
  EXPECT_NEAR(moorings[0].anchor_tension, 300, 1e-9);
  ASSERT_EQ(moorings[0].line.size(), 2U);
  EXPECT_LT((moorings[0].line[0] - line.anchor).norm(), 1e-12);
  EXPECT_LT((moorings[0].line[1] - line.attachment).norm(), 1e-12);
}

/// To the middle of the buoy.
MooringCase catenary_from(const Vector3d& anchor, double length, double weight) {
  MooringCase line;
  line.line = MooringLine::catenary;
  line.anchor = anchor;
  line.attachment = {6, 2, 6};
  line.length = length;
  line.weight = weight;
  return line;
}

// A buoy on a heavy line, lifted by more than its weight: where it comes to rest, lift, weight and line are in balance.
TEST(Moorings, ACatenaryHoldsABuoyWhereItsPullBalances) {
  MooringCase line = catenary_from(Vector3d(3, 2, 2), 5.2, 30);
  line.axial_stiffness = 1e5;
  Case scene = moored(line);
  scene.bodies[0].rigid.centre_of_mass = Vector3d(6, 2, 6);
  Trial run(scene, 1e-3);
  const double mass = run.world.properties(1).mass;
  const Vector3d lift(60, 0, mass * gravity + 150);
  run.load = [&] {
    std::vector<RigidLoad> loads(2);
    loads[1].force = lift - 60 * run.world.state(1).velocity;
    loads[1].torque = -20 * run.world.state(1).angular_velocity;
    return loads;
  };
  run.until(20);
  EXPECT_LT(run.world.state(1).velocity.norm(), 1e-4) << "not yet at rest";
  const MooringState mooring = run.world.moorings().at(0);
  EXPECT_NEAR(mooring.tension, std::hypot(60.0, 150.0), 0.01);
  EXPECT_NEAR(mooring.anchor_tension, std::hypot(60.0, 150 - 30 * (5.2 - mooring.lying)), 0.01);
  EXPECT_NEAR(mooring.lying, 5.2 - 150 / 30.0, 1e-3) << "so much hangs as it is lifted by";
  for (const Vector3d& place : mooring.line) EXPECT_NEAR(place.y(), 2, 1e-9);
  EXPECT_LT((mooring.line.front() - line.anchor).norm(), 1e-9);
  EXPECT_LT((mooring.line.back() - run.world.state(1).position).norm(), 1e-9);
}

// What the line takes from the body it gives to the tank: together they gain the weight of the line, about the line's middle, and nothing
// else but their own.
TEST(Moorings, ACatenaryOnAFreeTankLeavesBothTogetherItsWeightAlone) {
  for (const double length : {5.2, 4.4}) {  // lying in part, and hanging
    MooringCase line = catenary_from(Vector3d(3, 2, 2), length, 30);
    line.axial_stiffness = 1e5;
    line.bed = length > 5;
    if (!line.bed) line.anchor = {3, 2, 4};
    Case scene = moored(line);
    scene.tank.motion = Motion::free;
    scene.tank.rigid.mass = 300;
    scene.tank.rigid.centre_of_mass = Vector3d(6, 2, 3);
    scene.tank.rigid.inertia = {2000, 5000, 6000, 0, 0, 0};
    scene.bodies[0].rigid.velocity = {0.3, 0.2, 0.1};
    constexpr double step = 2e-4;
    Trial run(scene, step);
    const double mass = run.world.properties(1).mass;
    const auto momentum = [&] { return Vector3d(mass * run.world.state(1).velocity + 300 * run.world.state(0).velocity); };
    const auto spin = [&] {  // about the origin
      Vector3d sum = Vector3d::Zero();
      for (const std::size_t o : {0, 1}) {
        const RigidState state = run.world.state(o);
        const Eigen::Matrix3d turn = state.orientation.toRotationMatrix();
        sum += run.world.properties(o).mass * state.position.cross(state.velocity) +
               turn * run.world.properties(o).inertia * turn.transpose() * state.angular_velocity;
      }
      return sum;
    };
    const Vector3d before = momentum(), spin_before = spin();
    Vector3d turned = Vector3d::Zero(), by_line = Vector3d::Zero();
    double pulled = 0, lying = 0;
    run.until(0.4, [&] {
      const MooringState mooring = run.world.moorings().at(0);
      Vector3d middle = Vector3d::Zero();  // of the line's weight, by trapezia over places that are evenly spread along it
      for (std::size_t k = 0; k + 1 < mooring.line.size(); ++k)
        middle += 0.5 * (mooring.line[k] + mooring.line[k + 1]) / static_cast<double>(mooring.line.size() - 1);
      const RigidState tank = run.world.state(0);
      const Vector3d place = tank.moved(middle, run.world.reference(0));
      by_line += step * place.cross(Vector3d(0, 0, -30 * length));
      for (const std::size_t o : {0, 1})
        turned += step * run.world.state(o).position.cross(Vector3d(0, 0, -gravity * run.world.properties(o).mass));
      pulled = std::max(pulled, mooring.tension);
      lying = std::max(lying, mooring.lying);
    });
    EXPECT_GT(pulled, 30);
    EXPECT_EQ(lying > 0.5, line.bed);
    const Vector3d gained = momentum() - before, weight(0, 0, -0.4 * (gravity * (mass + 300) + 30 * length));
    EXPECT_LT((gained - weight).head<2>().norm(), 1e-9);
    EXPECT_NEAR(gained.z(), weight.z(), 1e-5 * 0.4 * 30 * length) << "a step's own implicit part, of order (step)²";
    const Vector3d change = spin() - spin_before - turned;
    std::printf("angular momentum by a line %s: off by %.2g of what its weight gives\n", line.bed ? "that lies in part" : "that hangs",
                (change - by_line).norm() / by_line.norm());
    EXPECT_LT((change - by_line).norm(), 2e-4 * by_line.norm()) << "sums at the ends of steps, and 24 chords in the place of the curve";
  }
}

TEST(Moorings, AStiffCatenaryIsStable) {
  MooringCase line = catenary_from(Vector3d(6, 2, 2), 4, 1);
  line.axial_stiffness = 1e9;
  Case scene = moored(line);
  scene.gravity = {0, 0, -gravity};
  Trial run(scene, 1e-3);
  const double mass = run.world.properties(1).mass;
  run.load = [&] {
    std::vector<RigidLoad> loads(2);
    loads[1].force = Vector3d(0, 0, 2 * mass * gravity) - 50 * run.world.state(1).velocity;
    return loads;
  };
  run.until(2);
  EXPECT_NEAR(run.world.state(1).position.z(), 6, 2e-3);
  EXPECT_TRUE(run.world.state(1).position.allFinite());
}

TEST(Moorings, ThatAreTautAndDoNotStretchAreRefused) {
  MooringCase line = catenary_from(Vector3d(6, 2, 2), 4, 1);
  EXPECT_EQ(error_of([&] { Trial run(moored(line), 1e-3); }),
            "body 'buoy': mooring 0 (counted from 0) is taut: its ends are 4 m apart, and its length of 4 m does not stretch; give its "
            "axial_stiffness, or make it longer");
}

// ---- wind

TEST(Wind, DragsABodyUpToItsSpeedAsTheFormulaSays) {
  Case scene = dry_case({40, 4, 4}, 0.5);
  scene.gravity = Vector3d::Zero();
  scene.bodies = {free_box("sail", {1, 2, 2}, {0.4, 0.4, 0.4})};
  scene.bodies[0].rigid.collision = CollisionShape::none;
  WindCase wind;
  wind.velocity = {10, 0, 0};
  wind.area = 0.5;
  wind.drag_coefficient = 1.2;
  wind.density = 1.2;
  scene.bodies[0].rigid.wind = wind;
  Trial run(scene, 1e-3);
  const double mass = run.world.properties(1).mass, rate = 0.5 * 1.2 * 1.2 * 0.5 / mass;
  run.until(2);
  // du/dt = r (U − u)², from rest: U − u = U/(1 + r U t); a step takes u from its beginning, which is late by half of it: r U Δt of u
  EXPECT_NEAR(run.world.state(1).velocity.x(), 10 - 10 / (1 + rate * 10 * 2), rate * 10 * 1e-3 * 1.84);
  EXPECT_NEAR(run.world.state(1).velocity.z(), 0, 1e-12);
}

TEST(Wind, GustsHaveTheirIntensityAndTimeScaleAndRepeatThemselves) {
  WindCase given;
  given.velocity = {3, 0, 4};
  given.gust_intensity = 0.2;
  given.gust_time = 4;
  const Wind wind(given), again(given);
  given.seed = 2;
  const Wind other(given);
  double sum = 0, squares = 0, lagged = 0;
  constexpr int count = 200000;
  for (int k = 0; k < count; ++k) {
    const double time = 0.1 * k, speed = wind.velocity(time).norm();
    EXPECT_EQ(wind.velocity(time), again.velocity(time));
    sum += speed;
    squares += speed * speed;
    lagged += (speed - 5) * (wind.velocity(time + 4).norm() - 5);
  }
  const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
  EXPECT_NEAR(mean, 5, 0.05);
  EXPECT_NEAR(deviation, 1, 0.05);
  EXPECT_NEAR(lagged / count, std::exp(-1.0), 0.1) << "a time scale later they are alike by 1/e";
  EXPECT_NE(wind.velocity(1), other.velocity(1));
  EXPECT_NEAR(wind.velocity(3).x() / wind.velocity(3).z(), 0.75, 1e-12) << "from one side";
}

}  // namespace
}  // namespace wavetank::moorings_test
