#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/node/background_work.h"
#include "wavetank/node/vtk_file.h"
#include "wavetank/simulation/simulation.h"
#include "wavetank/surface/surface_finder.h"

namespace wavetank {

/// Files for ParaView that cannot be written any more. what() says why.
class VtkError : public Error {
 public:
  using Error::Error;
};

/// Writes a run as files for ParaView while it goes on, in a thread of its own: case.pvd, which lists all of them, view.py, and in data/
/// the files of each frame (.vtp) with a collection (.pvd) for each thing that is drawn: surface, spray, water, tank, body_<name>, probes,
/// velocity_probes, gauges. All is in the tank's frame, m. case.pvd is replaced when a frame's files are whole, so that a run that is
/// killed leaves all frames until then; the collections of single things every ten frames and at the end.
class VtkRecorder {
 public:
  /// Makes the folder, if it is not there. `rate`: frames a second of simulated time, > 0. `view`: the script that becomes view.py.
  /// `with_surface`: the water's surface too, which needs can_find_surface(). Throws Error for a folder that is not empty or cannot be
  /// written to.
  VtkRecorder(const std::string& folder, double rate, const Case& scene, std::string view, bool with_surface);
  VtkRecorder(const VtkRecorder&) = delete;
  VtkRecorder& operator=(const VtkRecorder&) = delete;

  /// The first frame is due at the simulation's present time. Throws VtkError.
  void start(const Simulation& simulation);
  /// A frame, if it is due; waits while two are still to be written. `samples`: since the last call. Throws VtkError for what went wrong
  /// with earlier ones, whether one is due or not.
  void record(const Simulation& simulation, const Samples& samples);
  /// A frame of the last state, unless it has one, and waits until all is written. Throws VtkError.
  void finish(const Simulation& simulation);
  /// Of case.pvd.
  std::string path() const { return folder_ + "/case.pvd"; }
  /// Whether that lists anything yet.
  bool has_frames() const { return has_frames_; }

 private:
  /// What instruments told last: nothing before the first sample.
  struct Readings {
    std::vector<double> pressures, levels;
    std::vector<Vector3d> velocities;
  };
  struct Frame {
    ParticleCloud water;
    WaterField field;                ///< that its surface is found from, if that is wanted
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

  void add_frame(const Simulation& simulation);
  void hand_over(std::function<void()> piece);
  void write_frame(const Frame& frame);
  void write_surface(const Frame& frame);
  void write_part(const Frame& frame, const std::string& name, const VtkPolygons& polygons);
  void list_part(double time, const std::string& name, const std::string& file);
  void write_collections(bool all) const;
  void write_file(const std::string& name, const std::string& content, bool until_on_disk) const;
  void write_readings(const Frame& frame);
  Vector3d place_of(const Frame& frame, const Vector3d& given, const std::string& body) const;
  VtkPolygons triangles_of(const Shape& shape, const Frame& frame) const;

  const std::string folder_;
  const double period_;  ///< s
  const Case& scene_;
  const std::string view_;
  const bool with_surface_;
  std::vector<Shape> shapes_;
  std::vector<Vector3d> references_;  ///< by owner, m, as the case's geometry has them
  std::unique_ptr<SurfaceFinder> finder_;
  double next_ = 0;   ///< s of simulated time
  double last_ = -1;  ///< s of simulated time, of the last frame
  Readings readings_;

  // of the thread that writes
  int frames_ = 0;
  VtkCollection all_;
  std::map<std::string, VtkCollection> parts_of_;
  std::map<std::string, int> places_;  ///< of what is drawn, in a frame of case.pvd
  std::atomic<bool> has_frames_{false};

  std::unique_ptr<BackgroundWork> work_;  ///< last: its thread uses all of the above
};

}  // namespace wavetank
