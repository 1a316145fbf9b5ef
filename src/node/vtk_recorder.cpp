#include "wavetank/node/vtk_recorder.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "wavetank/common/log.h"
#include "wavetank/common/whole_file.h"
#include "wavetank/node/frames.h"
#include "wavetank/scene/upward.h"

namespace wavetank {

namespace fs = std::filesystem;

namespace {

constexpr double least_delay = 1e-9;  ///< s, below any step
constexpr int listing_period = 10;    ///< frames
const char* const data_folder = "data";

std::string without_last_slash(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  return path;
}

/// Leaves an empty folder that can be written to; files come into it once the run has started.
void make_folder(const std::string& folder) {
  const std::string what = "cannot write files for ParaView into '" + folder + "': ";
  std::error_code problem;
  if (fs::exists(folder, problem)) {
    if (!fs::is_directory(folder, problem)) throw Error(what + "it is no folder");
    if (access(folder.c_str(), W_OK) != 0) throw Error(what + std::strerror(errno));
    const bool is_empty = fs::is_empty(folder, problem);
    if (problem) throw Error(what + problem.message());
    if (!is_empty) throw Error(what + "it is not empty; give a new folder, or empty it");
  } else if (!fs::create_directory(folder, problem)) {
    const fs::path parent = fs::path(folder).parent_path();
    std::error_code unknown;
    const bool has_parent =
        parent.empty() || fs::is_directory(parent, unknown) || (unknown && unknown != std::errc::no_such_file_or_directory);
    throw Error(what + (has_parent ? problem.message() : "there is no folder '" + parent.string() + "'"));
  }
}

void append_point(std::vector<double>& points, const Vector3d& point) {
  for (int axis = 0; axis < 3; ++axis) points.push_back(point[axis]);
}

std::vector<Vector3d> corners_of(const TriangleMesh& mesh) {
  std::vector<Vector3d> corners;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner) corners.push_back(mesh.corner(i, corner));
  return corners;
}

/// By the particles' ids, so that a particle keeps its place from frame to frame as long as none comes or goes, and the ids pack well.
VtkPolygons water_of(const ParticleCloud& cloud) {
  std::vector<std::uint32_t> order(cloud.id.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return cloud.id[a] < cloud.id[b]; });
  const auto ordered = [&](const auto& values) {
    auto result = values;
    for (std::size_t i = 0; i < order.size(); ++i) result[i] = values[order[i]];
    return result;
  };
  const auto vectors = [&](const std::vector<Eigen::Vector3f>& values) {
    std::vector<float> result(3 * order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (int axis = 0; axis < 3; ++axis) result[3 * i + axis] = values[order[i]][axis];
    return result;
  };
  VtkPolygons water;
  water.points = vectors(cloud.position);
  water.fields.push_back({"velocity", 3, vectors(cloud.velocity), false});
  water.fields.push_back({"pressure", 1, ordered(cloud.pressure), false});
  water.fields.push_back({"density", 1, ordered(cloud.density), false});
  water.fields.push_back({"mass", 1, ordered(cloud.mass), true});
  water.fields.push_back({"id", 1, ordered(cloud.id), true});
  water.fields.push_back({"gamma", 1, ordered(cloud.shepard), true});
  water.fields.push_back({"lambda", 1, ordered(cloud.eigenvalue), false});
  water.fields.push_back({"surface", 1, ordered(cloud.surface), true});
  return water;
}

VtkPolygons surface_triangles(const WaterSurface& surface) {
  VtkPolygons polygons;
  polygons.cells = VtkPolygons::Cells::triangles;
  std::vector<float> points;
  points.reserve(9 * surface.triangles.size());
  for (const std::array<int, 3>& triangle : surface.triangles)
    for (const int corner : triangle)
      for (int axis = 0; axis < 3; ++axis) points.push_back(surface.vertices[corner][axis]);
  polygons.points = points;
  return polygons;
}

VtkPolygons spray_points(const WaterSurface& surface) {
  std::vector<float> points;
  for (const Eigen::Vector3f& drop : surface.spray)
    for (int axis = 0; axis < 3; ++axis) points.push_back(drop[axis]);
  VtkPolygons polygons;
  polygons.points = points;
  return polygons;
}

template <class Instruments>
std::vector<std::string> names_of(const Instruments& instruments) {
  std::vector<std::string> names;
  for (const auto& each : instruments) names.push_back(each.name);
  return names;
}

}  // namespace

VtkRecorder::VtkRecorder(const std::string& folder, double rate, const Case& scene, std::string view, bool with_surface)
    : folder_(without_last_slash(folder)), period_(1.0 / rate), scene_(scene), view_(std::move(view)), with_surface_(with_surface) {
  make_folder(folder_);
}

void VtkRecorder::start(const Simulation& simulation) {
  const RigidWorld& bodies = simulation.bodies();
  const std::vector<BodyFrame> frames = body_frames(scene_, reference_points(bodies));
  references_ = reference_points(bodies);
  for (std::size_t owner = 0; owner < bodies.count(); ++owner)
    shapes_.push_back({owner == 0 ? "tank" : "body_" + scene_.bodies[owner - 1].name, owner, corners_of(simulation.layout().meshes[owner]),
                       owner > 0 && frames[owner].moves});
  if (with_surface_) finder_ = std::make_unique<SurfaceFinder>(simulation);
  next_ = simulation.state().time;
  std::error_code problem;
  if (!fs::create_directory(folder_ + "/" + data_folder, problem))
    throw VtkError("cannot write files for ParaView into '" + folder_ + "': " + problem.message());
  write_file("view.py", view_, false);
  work_ = std::make_unique<BackgroundWork>();
}

void VtkRecorder::record(const Simulation& simulation, const Samples& samples) {
  work_->check();
  if (!samples.pressures.empty()) readings_.pressures = samples.pressures.back().pressures;
  if (!samples.levels.empty()) readings_.levels = samples.levels.back().levels;
  if (!samples.velocities.empty()) readings_.velocities = samples.velocities.back().velocities;
  const double time = simulation.state().time;
  if (time < next_ - least_delay) return;
  while (next_ <= time + least_delay) next_ += period_;
  add_frame(simulation);
}

void VtkRecorder::add_frame(const Simulation& simulation) {
  const auto frame = std::make_shared<Frame>();
  frame->water = simulation.particles();
  if (finder_) frame->field = finder_->look_at(simulation);
  for (std::size_t owner = 0; owner < simulation.bodies().count(); ++owner)
    frame->states.push_back(simulation.bodies().state_in_tank(owner));
  frame->readings = readings_;
  last_ = simulation.state().time;
  hand_over([this, frame] { write_frame(*frame); });
}

/// Whatever goes wrong with it is a matter of the files, for which nothing else may be lost.
void VtkRecorder::hand_over(std::function<void()> piece) {
  work_->hand_over([this, piece = std::move(piece)] {
    try {
      piece();
    } catch (const VtkError&) {
      throw;
    } catch (const std::exception& error) {
      throw VtkError("cannot write files for ParaView into '" + folder_ + "': " + error.what());
    }
  });
}

void VtkRecorder::finish(const Simulation& simulation) {
  if (!work_) return;
  if (simulation.state().time > last_ + least_delay) add_frame(simulation);
  hand_over([this] { write_collections(true); });
  work_->finish();
}

void VtkRecorder::write_frame(const Frame& frame) {
  if (finder_) write_surface(frame);
  write_part(frame, "water", water_of(frame.water));
  for (const Shape& shape : shapes_) {
    const std::string file = shape.name + ".vtp";
    if (shape.moves) {
      write_part(frame, shape.name, triangles_of(shape, frame));
    } else {
      if (frames_ == 0) write_file(std::string(data_folder) + "/" + file, vtp_content(triangles_of(shape, frame)), false);
      list_part(frame.water.time, shape.name, file);
    }
  }
  write_readings(frame);
  write_collections(false);
  has_frames_ = true;
  ++frames_;
}

/// Without it, where it cannot be found: the particles are there all the same.
void VtkRecorder::write_surface(const Frame& frame) {
  WaterSurface surface;
  try {
    surface = finder_->find(frame.field);
  } catch (const std::exception& error) {
    log(LogLevel::warning, std::string("a surface of the water could not be found: ") + error.what());
  }
  write_part(frame, "surface", surface_triangles(surface));
  write_part(frame, "spray", spray_points(surface));
}

/// case.pvd each time. Those of single things, which would be as long as all of the run each time, if they are new or it is their turn, or
/// if all are asked for.
void VtkRecorder::write_collections(bool all) const {
  const bool is_their_turn = all || frames_ % listing_period == 0;
  for (const auto& [name, collection] : parts_of_)
    if (is_their_turn || collection.count() == 1)
      write_file(std::string(data_folder) + "/" + name + ".pvd", collection.content(), is_their_turn);
  write_file("case.pvd", all_.content(), is_their_turn);
}

void VtkRecorder::write_readings(const Frame& frame) {
  const InstrumentsCase& instruments = scene_.instruments;
  if (!frame.readings.pressures.empty()) {
    std::vector<double> points;
    for (const PressureProbeCase& probe : instruments.pressure_probes) append_point(points, place_of(frame, probe.position, probe.body));
    VtkPolygons probes;
    probes.points = points;
    probes.fields = {{"pressure", 1, frame.readings.pressures, false}, {"name", 1, names_of(instruments.pressure_probes), false}};
    write_part(frame, "probes", probes);
  }
  if (!frame.readings.velocities.empty()) {
    std::vector<double> points, velocities;
    for (const VelocityProbeCase& probe : instruments.velocity_probes) append_point(points, place_of(frame, probe.position, probe.body));
    for (const Vector3d& velocity : frame.readings.velocities) append_point(velocities, velocity);
    VtkPolygons probes;
    probes.points = points;
    probes.fields = {{"velocity", 3, velocities, false}, {"name", 1, names_of(instruments.velocity_probes), false}};
    write_part(frame, "velocity_probes", probes);
  }
  if (!frame.readings.levels.empty()) {
    std::vector<double> points;
    for (std::size_t k = 0; k < instruments.wave_gauges.size(); ++k) {
      Vector3d surface = instruments.wave_gauges[k].position;
      surface[top_of(scene_).axis] = frame.readings.levels[k];
      append_point(points, surface);
    }
    VtkPolygons gauges;
    gauges.points = points;
    gauges.fields = {{"level", 1, frame.readings.levels, false}, {"name", 1, names_of(instruments.wave_gauges), false}};
    write_part(frame, "gauges", gauges);
  }
}

/// Of a probe: with its body.
Vector3d VtkRecorder::place_of(const Frame& frame, const Vector3d& given, const std::string& body) const {
  const std::size_t owner = owner_of(scene_, body);
  return owner == 0 ? given : frame.states[owner].moved(given, references_[owner]);
}

VtkPolygons VtkRecorder::triangles_of(const Shape& shape, const Frame& frame) const {
  std::vector<double> points;
  points.reserve(3 * shape.corners.size());
  for (const Vector3d& given : shape.corners)
    append_point(points, shape.moves ? frame.states[shape.owner].moved(given, references_[shape.owner]) : given);
  VtkPolygons polygons;
  polygons.cells = VtkPolygons::Cells::triangles;
  polygons.points = points;
  return polygons;
}

void VtkRecorder::write_part(const Frame& frame, const std::string& name, const VtkPolygons& polygons) {
  char number[16];
  std::snprintf(number, sizeof number, "_%05d", frames_);
  const std::string file = name + number + ".vtp";
  write_file(std::string(data_folder) + "/" + file, vtp_content(polygons), false);
  list_part(frame.water.time, name, file);
}

/// A name keeps its place in all frames, also behind instruments that have no reading at first.
void VtkRecorder::list_part(double time, const std::string& name, const std::string& file) {
  parts_of_[name].add(time, 0, name, file);
  const int place = places_.emplace(name, static_cast<int>(places_.size())).first->second;
  all_.add(time, place, name, std::string(data_folder) + "/" + file);
}

void VtkRecorder::write_file(const std::string& name, const std::string& content, bool until_on_disk) const {
  try {
    write_whole(folder_ + "/" + name, content, "the file for ParaView", until_on_disk);
  } catch (const Error& error) {
    throw VtkError(error.what());
  }
}

}  // namespace wavetank
