#pragma once

#include <string>
#include <vector>

#include "wavetank/node/bag_writer.h"
#include "wavetank/node/messages.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Records a run into a bag, as wavetank_run and the node both do: what holds for all of it first, then samples, the status every 10 ms of
/// simulated time and clouds at publishing/cloud_bag_rate, and its end.
class RunRecorder {
 public:
  /// `bag`: the file; `topic_prefix`: as BagWriter has it; `clouds`: the free surface is wanted; `particles`: all particles
  /// are. Throws as BagWriter.
  RunRecorder(const std::string& bag, const std::string& topic_prefix, const Case& scene, const StampClock& clock, bool clouds,
              bool particles = false);

  /// The case, the markers, whose meshes are triangles so that the bag has them, and the transforms that stand still, at the simulation's
  /// present time.
  void start(const Simulation& simulation, const std::vector<BodyFrame>& frames);
  /// A message of a sample.
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_.write(topic, stamp, message);
  }
  /// The status at those samples of the energies that it is due at, and the clouds if they are due. `run`: of this moment.
  void record(const Simulation& simulation, const std::vector<EnergySample>& energies, const RunState& run);
  /// The simulation is back at time 0.
  void restart() { next_status_ = next_cloud_ = 0; }
  /// The last status, and the bag gets its name.
  void finish(const SolverState& solver, const EnergySample& energies, const RunState& run);

  bool is_open() const { return bag_.is_open(); }
  const std::string& path() const { return bag_.path(); }

 private:
  const Case& case_;
  const StampClock& clock_;
  BagWriter bag_;
  bool clouds_, particles_;
  double next_status_ = 0, next_cloud_ = 0;  ///< s of simulated time
};

}  // namespace wavetank
