#pragma once

#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/node/vtk_file.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {

/// Files for ParaView that cannot be written any more. what() says why.
class VtkError : public Error {
 public:
  using Error::Error;
};

/// Writes a run as files for ParaView while it goes on, in a thread of its own: case.pvd, which lists all of them, view.py, and in data/
/// the files of each frame (.vtp) with a collection (.pvd) for each thing that is drawn: water, tank, body_<name>, probes, velocity_probes,
/// gauges. All is in the tank's frame, m. A collection is replaced when a frame's files are whole, so that a run that is killed leaves all
/// frames until then.
class VtkRecorder {
 public:
  /// Makes the folder, if it is not there. `rate`: frames a second of simulated time, > 0. `view`: the script that becomes view.py. Throws
  /// Error for a folder that is not empty or cannot be written to.
  VtkRecorder(const std::string& folder, double rate, const Case& scene, std::string view);
  /// Leaves frames that wait to be written.
  ~VtkRecorder();
  VtkRecorder(const VtkRecorder&) = delete;
  VtkRecorder& operator=(const VtkRecorder&) = delete;

  /// The first frame is due at the simulation's present time. Throws VtkError.
  void start(const Simulation& simulation);
  /// A frame, if it is due; waits while two are still to be written. `samples`: since the last call. Throws VtkError for what went wrong
  /// with earlier ones.
  void record(const Simulation& simulation, const Samples& samples);
  /// Waits until all is written. Throws VtkError.
  void finish();
  /// Of case.pvd.
  std::string path() const { return folder_ + "/case.pvd"; }

 private:
  /// What instruments told last: nothing before the first sample.
  struct Readings {
    std::vector<double> pressures, levels;
    std::vector<Vector3d> velocities;
  };
  struct Frame {
    ParticleCloud water;
    std::vector<RigidState> states;  ///< in the tank, by owner
    Readings readings;
  };
  /// A mesh that follows an owner. It is a copy: the thread may outlive the simulation.
  struct Shape {
    std::string name;
    std::size_t owner = 0;
    std::vector<Vector3d> corners;  ///< m, as the case's geometry has them, three a triangle
    bool moves = false;
  };

  void write_frames();
  void write_frame(const Frame& frame);
  void write_part(const Frame& frame, const std::string& name, const VtkPolygons& polygons);
  void list_part(double time, const std::string& name, const std::string& file);
  void write_file(const std::string& name, const std::string& content) const;
  void write_readings(const Frame& frame);
  Vector3d place_of(const Frame& frame, const Vector3d& given, const std::string& body) const;
  VtkPolygons triangles_of(const Shape& shape, const Frame& frame) const;
  void hand_over(Frame frame);
  void throw_problem();

  const std::string folder_;
  const double period_;  ///< s
  const Case& scene_;
  std::string view_;
  std::vector<Shape> shapes_;
  std::vector<Vector3d> references_;  ///< by owner, m, as the case's geometry has them
  double next_ = 0;                   ///< s of simulated time
  Readings readings_;

  // of the thread that writes
  int frames_ = 0, parts_ = 0;
  VtkCollection all_;
  std::map<std::string, VtkCollection> parts_of_;

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Frame> waiting_;
  bool is_writing_ = false, is_over_ = false;
  std::exception_ptr problem_;
};

}  // namespace wavetank
