#include "schedule.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "wavetank/common/error.h"

namespace wavetank {
namespace {

std::string text_of(const Access& access) { return access.array + " (" + access.instant + ")"; }

/// Arrays by instant: "position, velocity (middle)".
std::string text_of(const std::vector<Access>& accesses) {
  std::vector<std::pair<std::string, std::string>> by_instant;
  for (const Access& access : accesses) {
    const auto found = std::find_if(by_instant.begin(), by_instant.end(), [&](const auto& entry) { return entry.first == access.instant; });
    if (found == by_instant.end())
      by_instant.emplace_back(access.instant, access.array);
    else
      found->second += ", " + access.array;
  }
  std::string text;
  for (const auto& [instant, arrays] : by_instant) text += (text.empty() ? "" : "; ") + arrays + " (" + instant + ")";
  return text.empty() ? "–" : text;
}

}  // namespace

std::vector<Access> at(const std::string& instant, const std::vector<std::string>& arrays) {
  std::vector<Access> accesses;
  for (const std::string& array : arrays) accesses.push_back({array, instant});
  return accesses;
}

std::vector<Access> operator+(std::vector<Access> some, const std::vector<Access>& others) {
  some.insert(some.end(), others.begin(), others.end());
  return some;
}

Schedule::Schedule(std::string integrator, std::vector<Access> kept, std::vector<Stage> stages)
    : integrator_(std::move(integrator)), kept_(std::move(kept)), stages_(std::move(stages)) {}

void Schedule::begin_with(Stage stage) {
  for (const Access& access : stage.reads)
    if (std::find(kept_.begin(), kept_.end(), access) == kept_.end()) kept_.push_back(access);
  for (Stage& later : stages_)
    if (later.moves > 0) later.reads = later.reads + stage.writes;
  stages_.insert(stages_.begin(), std::move(stage));
}

void Schedule::check() const {
  std::set<Access> written(kept_.begin(), kept_.end());
  std::map<Access, std::string> left_behind;  // by which stage
  const auto require = [&](const Access& access, const std::string& who) {
    if (written.count(access) != 0) return;
    const auto sorted = left_behind.find(access);
    throw Error("integrator " + integrator_ + ": " + who + " reads " + text_of(access) + ", which " +
                (sorted != left_behind.end() ? "stage '" + sorted->second + "' has left in the order of before"
                                             : std::string("no stage before it has written")) +
                ".");
  };
  for (const Stage& stage : stages_) {
    for (const Access& access : stage.reads) require(access, "stage '" + stage.name + "'");
    if (stage.sorts) {
      for (const Access& access : written) left_behind[access] = stage.name;
      written.clear();
    }
    for (const Access& access : stage.writes) {
      written.insert(access);
      left_behind.erase(access);
    }
  }
  for (const Access& access : kept_) require(access, "the next step");
}

std::string Schedule::page() const {
  std::string text = "One time step of integrator " + integrator_ + ". It begins with " + text_of(kept_) + ".\n";
  int number = 0;
  for (const Stage& stage : stages_) {
    text += "\n" + std::to_string(++number) + ". " + stage.name + "\n";
    text += "   reads   " + text_of(stage.reads) + "\n";
    text += "   writes  " + text_of(stage.writes) + "\n";
  }
  return text;
}

double Schedule::drift() const {
  std::map<std::string, double> moved;  // by instant
  double most = 0;
  for (int step = 0; step < 2; ++step)  // the second begins with what the first has left
    for (const Stage& stage : stages_) {
      for (const Access& access : stage.reads)
        if (stage.sweeps && access.array == "position") most = std::max(most, moved[access.instant]);
      if (stage.sorts) moved.clear();
      for (const Access& access : stage.writes)
        if (!stage.sorts && access.array == "position") moved[access.instant] = stage.moves;
    }
  return most;
}

std::vector<std::vector<Access>> Schedule::exchanges() const {
  std::vector<std::vector<Access>> result(stages_.size());
  std::set<Access> wanted;              // of the halo, by what comes after
  for (int step = 0; step < 2; ++step)  // backwards; the first time round finds what the next step wants at the end of this one
    for (std::size_t k = stages_.size(); k-- > 0;) {
      const Stage& stage = stages_[k];
      if (stage.sorts) {
        wanted.clear();
        continue;
      }
      std::vector<Access> made;
      for (const Access& access : stage.writes)
        if (wanted.erase(access) > 0 && access.array != "walls" && access.array != "wrenches")  // which are not of particles
          made.push_back(access);
      if (stage.sweeps) result[k] = made;
      if (stage.sweeps || !made.empty()) wanted.insert(stage.reads.begin(), stage.reads.end());
    }
  return result;
}

bool Schedule::writes(const std::string& array) const {
  for (const Stage& stage : stages_)
    for (const Access& access : stage.writes)
      if (access.array == array) return true;
  return false;
}

void Schedule::run() const {
  for (const Stage& stage : stages_) stage.run();
}

}  // namespace wavetank
