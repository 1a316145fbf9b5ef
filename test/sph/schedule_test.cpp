// Schedules are checked before they run, and every integrator's passes.
#include "../../src/sph/schedule/schedule.h"

#include <gtest/gtest.h>

#include "../../src/sph/integrators/integrator.h"
#include "../common/error_of.h"
#include "wavetank/common/error.h"
#include "wavetank/sph/schedule_page.h"

namespace wavetank::schedule_test {
namespace {

/// Two stages about a sort, which takes the position along and nothing else.
Schedule dummy(const std::vector<Access>& kept, const std::vector<Access>& first_writes, const std::vector<Access>& last_reads) {
  return {"dummy",
          kept,
          {{"first", at("now", {"position"}), first_writes, [] {}},
           {"sort", {}, at("now", {"position"}), [] {}, 0, false, true},
           {"last", last_reads, {}, [] {}}}};
}

std::string refusal(const Schedule& schedule) {
  return error_of([&] { schedule.check(); });
}

TEST(Schedule, RefusesWhatNothingHasWritten) {
  EXPECT_EQ(refusal(dummy({}, {}, {})), "integrator dummy: stage 'first' reads position (now), which no stage before it has written.");
  EXPECT_EQ(refusal(dummy(at("now", {"position"}), {}, at("middle", {"pressure"}))),
            "integrator dummy: stage 'last' reads pressure (middle), which no stage before it has written.");
}

TEST(Schedule, RefusesWhatASortHasLeftBehind) {
  EXPECT_EQ(refusal(dummy(at("now", {"position"}), at("now", {"rate"}), at("now", {"rate"}))),
            "integrator dummy: stage 'last' reads rate (now), which stage 'sort' has left in the order of before.");
  EXPECT_EQ(refusal(dummy(at("now", {"position", "rate"}), {}, {})),
            "integrator dummy: the next step reads rate (now), which stage 'sort' has left in the order of before.");
}

TEST(Schedule, TakesWhatIsSound) { EXPECT_NO_THROW(dummy(at("now", {"position"}), at("now", {"rate"}), at("now", {"position"})).check()); }

TEST(Schedule, RunsItsStagesInTheirOrder) {
  std::string order;
  const Schedule schedule("dummy", {}, {{"a", {}, {}, [&] { order += "a"; }}, {"b", {}, {}, [&] { order += "b"; }}});
  schedule.run();
  schedule.run();
  EXPECT_EQ(order, "abab");
}

/// "stage: arrays; …" of what a part is sent after its own particles' are found.
std::string exchanges_of(const Case& scene) {
  const Schedule schedule = schedule_of(scene, nullptr);
  const std::vector<std::vector<Access>> exchanges = schedule.exchanges();
  std::string text;
  for (std::size_t k = 0; k < exchanges.size(); ++k) {
    if (exchanges[k].empty()) continue;
    text += (text.empty() ? "" : "; ") + schedule.stages()[k].name + ":";
    for (const Access& access : exchanges[k]) text += " " + access.array;
  }
  return text;
}

TEST(Schedule, SaysWhatPartsExchange) {
  Case scene;
  scene.numerics.integrator = Integrator::symplectic;
  EXPECT_EQ(exchanges_of(scene), "compression rates: compression rate");
  scene.numerics.shifting = Shifting::sun;
  EXPECT_EQ(exchanges_of(scene), "shifts by sun: shift; compression rates: compression rate");
  scene.numerics.shifting = Shifting::none;
  scene.numerics.integrator = Integrator::predictor_corrector;
  EXPECT_EQ(exchanges_of(scene), "rates of the start: acceleration compression rate");
  scene.numerics.integrator = Integrator::runge_kutta_4;
  EXPECT_EQ(exchanges_of(scene),
            "rates of the start: acceleration compression rate; rates of the middle, k2: acceleration compression rate; rates of the "
            "middle, k3: acceleration compression rate");
}

TEST(Schedule, OfEveryIntegratorIsSoundAndKnowsItsDrift) {
  const std::pair<Integrator, double> drifts[] = {
      {Integrator::symplectic, 0.5}, {Integrator::predictor_corrector, 1.0}, {Integrator::runge_kutta_4, 1.0}};
  for (const auto& [integrator, drift] : drifts) {
    Case scene;
    scene.numerics.integrator = integrator;
    for (const MethodWord<Shifting>& law : method_words<Shifting>()) {
      scene.numerics.shifting = law.choice;
      const Schedule schedule = schedule_of(scene, nullptr);
      EXPECT_NO_THROW(schedule.check());
      EXPECT_EQ(schedule.drift(), drift) << schedule.page();
    }
  }
}

TEST(Schedule, WhatComesFirstIsReadByWhatMoves) {
  Schedule schedule("shifted", at("now", {"position"}),
                    {{"sort", at("now", {"position"}), at("now", {"position"}), [] {}, 0, false, true},
                     {"drift", at("now", {"position"}), at("now", {"position"}), [] {}, 1}});
  schedule.begin_with({"shifts", at("now", {"position"}), at("now", {"shift"}), [] {}});
  EXPECT_EQ(error_of([&] { schedule.check(); }),
            "integrator shifted: stage 'drift' reads shift (now), which stage 'sort' has left in the order of before.");
}

TEST(Schedule, IsAPage) {
  const std::string page = schedule_page(Case());
  EXPECT_NE(page.find("One time step of integrator symplectic."), std::string::npos) << page;
  EXPECT_NE(page.find("3. accelerations\n   reads   position, velocity, compression, followers, pressure, volume, walls (middle)\n"
                      "   writes  acceleration, clearance (middle)\n"),
            std::string::npos)
      << page;
}

}  // namespace
}  // namespace wavetank::schedule_test
