#pragma once

#include <functional>
#include <string>
#include <vector>

namespace wavetank {

/// An array of the particles, and the instant that its values are of: where an integrator keeps several.
struct Access {
  std::string array;
  std::string instant;

  bool operator<(const Access& other) const { return array != other.array ? array < other.array : instant < other.instant; }
  bool operator==(const Access& other) const { return array == other.array && instant == other.instant; }
};

/// All of some arrays at one instant.
std::vector<Access> at(const std::string& instant, const std::vector<std::string>& arrays);

std::vector<Access> operator+(std::vector<Access> some, const std::vector<Access>& others);

/// One stage of a time step.
struct Stage {
  std::string name;
  std::vector<Access> reads, writes;
  std::function<void()> run;
  double moves = 0;     ///< how far the positions that it writes are from where they were sorted, in steps
  bool sweeps = false;  ///< it goes over the neighbours of what it reads
  bool sorts = false;   ///< it gives particles other places in memory: what it does not write is left behind
};

/// A time step as data: its stages in their order, which can be checked and printed before one is run.
class Schedule {
 public:
  Schedule() = default;
  /// `kept`: what a step begins with and leaves to the next one.
  Schedule(std::string integrator, std::vector<Access> kept, std::vector<Stage> stages);

  /// Puts a stage before all others, whose results every stage reads that moves particles. A step begins with what it reads.
  void begin_with(Stage stage);
  /// Throws Error, in one sentence, if a stage reads what nothing has written, or what a sort has left behind, or if a step does not leave
  /// what the next one begins with.
  void check() const;
  /// The stages and what they read and write, as a table of text.
  std::string page() const;
  /// How far particles may be from where they were sorted when their neighbours are gone over, in steps.
  double drift() const;
  /// Whether a stage writes this array at any instant.
  bool writes(const std::string& array) const;
  /// Of each stage, what it writes of a part's own particles that the part must then be sent of its halo: what later stages go over the
  /// neighbours of, or make that of. What others write, a part finds for its halo as for itself; a sort brings a new halo, with its state.
  std::vector<std::vector<Access>> exchanges() const;
  const std::vector<Stage>& stages() const { return stages_; }
  void run() const;

 private:
  std::string integrator_;
  std::vector<Access> kept_;
  std::vector<Stage> stages_;
};

}  // namespace wavetank
