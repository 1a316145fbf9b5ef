#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "wavetank/node/bag_writer.h"
#include "wavetank/node/messages.h"
#include "wavetank/node/surface_drawer.h"
#include "wavetank/node/surface_messages.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// What else than samples is recorded.
struct RecordedPictures {
  bool clouds = false;     ///< the free surface's particles
  bool particles = false;  ///< all particles
  bool surface = false;    ///< the water's surface as a mesh and a height map
};

/// Records a run into a bag, as wavetank_run and the node both do: what holds for all of it first, then samples, the status every 10 ms of
/// simulated time, clouds at publishing/cloud_bag_rate, the water's surface at publishing/surface_bag_rate, and its end.
class RunRecorder {
 public:
  /// `bag`: the file; `topic_prefix`: as BagWriter has it. Throws as BagWriter.
  RunRecorder(const std::string& bag, const std::string& topic_prefix, const Case& scene, const StampClock& clock,
              RecordedPictures pictures);

  /// The case, the markers, whose meshes are triangles so that the bag has them, and the transforms that stand still, at the simulation's
  /// present time.
  void start(const Simulation& simulation, const std::vector<BodyFrame>& frames);
  /// A message of a sample.
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message) {
    bag_.write(topic, stamp, message);
  }
  /// The status at those samples of the energies that it is due at, and the pictures that are due; a surface is
  /// written when it is found. `run`: of this moment. Throws BagError as BagWriter, and where a surface cannot be drawn: the bag is whole
  /// until then, and finish() still works.
  void record(const Simulation& simulation, const std::vector<EnergySample>& energies, const RunState& run);
  /// What was recorded until now stays readable, whatever becomes of this process. Throws BagError as BagWriter.
  void keep() { bag_.keep(); }
  /// No surface from now on: the water is no longer fit for one, after a Violation.
  void draw_no_more() { is_drawing_ = false; }
  /// The simulation is back at time 0.
  void restart() { next_status_ = next_cloud_ = next_surface_ = 0; }
  /// The last status, and the bag gets its name. Throws BagError as BagWriter, and for the last surface as record: the bag is whole then.
  void finish(const SolverState& solver, const EnergySample& energies, const RunState& run);

  bool is_open() const { return bag_.is_open(); }
  bool is_whole() const { return is_whole_; }  ///< and has its name
  const std::string& path() const { return bag_.path(); }

 private:
  const Case& case_;
  const StampClock& clock_;
  BagWriter bag_;
  void record_cloud(const Simulation& simulation);
  void record_surface(const Simulation& simulation);
  void write_surfaces();
  void check_drawing() const;
  std::string missing_surface();

  RecordedPictures pictures_;
  bool is_drawing_ = true;
  bool is_whole_ = false;
  double next_status_ = 0, next_cloud_ = 0, next_surface_ = 0;  ///< s of simulated time
  std::mutex mutex_;
  std::vector<SurfaceMessages> found_;     ///< surfaces that are not written yet
  std::unique_ptr<SurfaceDrawer> drawer_;  ///< last: its thread uses all of the above
};

}  // namespace wavetank
