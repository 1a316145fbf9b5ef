// Damaged inputs of every kind, each read in a process of its own: none may crash it, take more than 20 s or 4 GiB, leave a file behind, or
// be refused by anything but one sentence that names the file or the key. What fails is printed with its seed, which makes it again:
//   fuzz [--count N] [--seed FIRST] [--keep FOLDER] [--say] [KIND]...
// --say: what became of each, too.
#include <dirent.h>
#include <zlib.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "../../src/simulation/snapshot.h"
#include "../common/scratch_directory.h"
#include "mutation.h"
#include "wavetank/common/child_process.h"
#include "wavetank/common/expression.h"
#include "wavetank/common/log.h"
#include "wavetank/common/visible_text.h"
#include "wavetank/geometry/layout.h"
#include "wavetank/geometry/mesh.h"
#include "wavetank/rigid/rigid_world.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/simulation/simulation.h"
#include "wavetank/sph/discretisation.h"

namespace wavetank::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double longest = 20;                                 // s, for one input
constexpr std::uint64_t most_memory = std::uint64_t(4) << 30;  // bytes

const fs::path package = WAVETANK_SOURCE_DIRECTORY;

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string resolve(const std::string& uri) {
  const std::string own = "package://wavetank/";
  if (uri.rfind(own, 0) != 0) throw Error("'" + uri + "' is of another package");
  return (package / uri.substr(own.size())).string();
}

/// Sound files of the package by their endings.
std::vector<fs::path> own_files(const std::vector<std::string>& folders, const std::string& ending) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders)
    for (const fs::directory_entry& entry : fs::directory_iterator(package / folder))
      if (entry.path().extension() == ending) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// An input that was made, what reads it, and words of which a refusal must have one.
struct Input {
  std::string file;  ///< its name in the scratch folder; empty: it is no file
  std::string content;
  std::function<void()> read;  ///< throws Error where it is refused, and std::logic_error where it was accepted wrongly
  std::vector<std::string> words;
};

/// Of what was accepted: whatever it says, it must be this.
void demand(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("it was accepted, but ") + what);
}

/// As `wavetank_run --check` does, but for the device.
void lay_out_and_look(const Case& read) {
  const Layout layout = lay_out(read, resolve);
  const Case scene = settled(read, layout);
  discretise(scene, layout);
  const RigidWorld world(scene, layout, resolve);
  if (world.anything_moves()) world.at_end(0, 1e-3);
}

class Kinds {
 public:
  explicit Kinds(const ScratchDirectory& scratch) : scratch_(scratch) {
    for (const fs::path& file : own_files({"config", "test/node"}, ".yaml")) cases_.push_back(content_of(file));
    for (const char* small : {"still_tank.yaml", "floating_box.yaml", "moving_tank.yaml", "robot_tank.yaml"})
      small_cases_.push_back(content_of(package / "test/node" / small));
    for (const fs::path& file : own_files({"config", "test/node"}, ".urdf")) {
      robots_.push_back(content_of(file));
      fs::copy_file(file, scratch.path() / file.filename());  // that cases name
    }
    for (const fs::path& file : own_files({"meshes"}, ".stl"))
      if (fs::file_size(file) < 100000) solids_.push_back(content_of(file));
    std::istringstream page(content_of(package / "docs/case.md"));
    for (std::string line; std::getline(page, line);)
      if (line.rfind("| `", 0) == 0) keys_.push_back(line.substr(3, line.find('`', 3) - 3));
    for (std::string& key : keys_)
      for (std::size_t at = key.find("/N"); at != std::string::npos; at = key.find("/N", at + 1))
        if (at + 2 == key.size() || key[at + 2] == '/') key[at + 1] = '0';
  }

  std::vector<std::string> names() const {
    return {"cases", "numbers", "overrides", "stl", "obj", "dae", "ply", "motions", "urdf", "snapshots", "restored", "expressions"};
  }

  Input make(const std::string& kind, Mutation& mutation) {
    if (kind == "cases") return of_case(mutation.text(mutation.one_of(cases_)));
    if (kind == "numbers") return numbers(mutation);
    if (kind == "overrides") return overrides(mutation);
    if (kind == "stl") return mesh("m.stl", mutation.chance(30) ? mutation.text(stl_text()) : mutation.bytes(mutation.one_of(solids_)));
    if (kind == "obj") return mesh("m.obj", mutation.text(obj_text()));
    if (kind == "dae") return mesh("m.dae", mutation.text(dae_text()));
    if (kind == "ply") return mesh("m.ply", mutation.chance(50) ? mutation.text(ply_text()) : mutation.bytes(ply_bytes()));
    if (kind == "motions") return motion(mutation);
    if (kind == "urdf") return robot(mutation);
    if (kind == "snapshots") return snapshot(mutation);
    if (kind == "restored") return restored(mutation);
    return expression(mutation);
  }

 private:
  Input of_case(const std::string& text) const {
    const std::string path = scratch_.file("case.yaml");
    return {"case.yaml",
            text,
            [path] {
              const std::string written = write_case(read_case_file(path, {}, {resolve, {}}));
              demand(write_case(read_case_text(written, "the case that was written", {}, {resolve, {}})) == written,
                     "what is written of it reads otherwise");
            },
            {"case.yaml"}};
  }

  /// Every key of a small case, with numbers that are replaced: most can be laid out.
  Input numbers(Mutation& mutation) {
    if (whole_cases_.empty())
      for (const std::string& text : small_cases_) {
        const std::string path = scratch_.write("case.yaml", text);
        whole_cases_.push_back(write_case(read_case_file(path, {}, {resolve, [this](const std::string&) { return robots_[0]; }})));
      }
    const std::string path = scratch_.file("case.yaml");
    return {"case.yaml", mutation.numbers(mutation.one_of(whole_cases_)),
            [path] {
              lay_out_and_look(read_case_file(path, {}, {resolve, {}}));
            },
            places_};
  }

  Input overrides(Mutation& mutation) const {
    const std::string path = scratch_.file("case.yaml");
    std::vector<Override> given;
    for (std::size_t k = mutation.damages() ? 1 + mutation.below(mutation.chance(60) ? 1 : 3) : 0; k > 0; --k) {
      std::string key = mutation.one_of(keys_);
      if (mutation.chance(10)) key = mutation.text(key);
      std::string value = mutation.chance(50) ? mutation.one_of(awkward_numbers()) : mutation.plausible_number();
      if (mutation.chance(30))
        value = "[" + value + ", " + mutation.one_of(awkward_numbers()) + ", " + mutation.one_of(awkward_numbers()) + "]";
      given.push_back({key, value});
    }
    std::vector<std::string> places = places_;
    for (const Override& each : given) places.push_back(visible_text(each.key.substr(0, 60)));  // as it is printed, cut where it is long
    return {"case.yaml", mutation.one_of(small_cases_),
            [path, given] {
              lay_out_and_look(read_case_file(path, given, {resolve, {}}));
            },
            places};
  }

  Input mesh(const std::string& name, const std::string& content) const {
    const std::string path = scratch_.file(name);
    return {name,
            content,
            [path] {
              MeshSource source;
              source.uri = path;
              TriangleMesh mesh = read_mesh(source, "", {}, {"left"});
              for (const Vector3d& vertex : mesh.vertices) demand(vertex.allFinite(), "a vertex is not finite");
              for (const Vector3i& triangle : mesh.triangles)
                demand(triangle.minCoeff() >= 0 && triangle.maxCoeff() < static_cast<int>(mesh.vertices.size()),
                       "a triangle names a vertex that does not exist");
              check_closed(mesh);
            },
            {name}};
  }

  Input motion(Mutation& mutation) const {
    std::string text = "# a surge and a pitch\ntime,surge,pitch\n";
    for (int k = 0; k < 20; ++k)
      text += std::to_string(0.05 * k) + "," + std::to_string(0.01 * std::sin(k)) + "," + std::to_string(0.5 * k) + "\n";
    const std::string path = scratch_.file("motion.csv");
    return {"motion.csv",
            mutation.text(text),
            [path] {
              Case scene;
              scene.dimensions = 2;
              scene.duration = 1;
              scene.fluid.spacing = 0.05;
              scene.fluid.sound_speed = 20;
              scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(1, 0, 0.3)}};
              scene.tank.shape = BoxTank{Vector3d(1, 0, 0.6), Vector3d::Zero(), false};
              BodyCase body;
              body.name = "paddle";
              body.shape = Box{Vector3d(0.4, 0, 0.35), Vector3d(0.6, 0, 0.5)};
              body.motion = Motion::prescribed;
              RecordCase record;
              record.file = path;
              body.rigid.prescribed.records = {record};
              scene.bodies = {body};
              lay_out_and_look(scene);
            },
            {"motion.csv"}};
  }

  Input robot(Mutation& mutation) const {
    const std::string path = scratch_.write(
        "robot.yaml",
        "dimensions: 3\nduration: 1\nfluid: {sound_speed: 20, spacing: 0.1, fill: [{box: {min: [0, 0, 0], max: [1, 1, 0.3]}}]}\n"
        "tank: {box: {size: [1, 1, 1]}}\nrobots: [{urdf: m.urdf, position: [0.5, 0.5, 0.5]}]\n");
    return {"m.urdf", mutation.text(mutation.one_of(robots_)), [path] { read_case_file(path, {}, {resolve, {}}); }, {"m.urdf"}};
  }

  Input snapshot(Mutation& mutation) {
    if (snapshot_.empty()) {
      Snapshot sound;
      sound.version = "0.1.0";
      sound.device = "a device";
      sound.scene = small_cases_[0];
      sound.instruments = {1, 2, 3};
      sound.bodies = std::vector<char>(200, 'b');
      sound.fluid = std::vector<char>(5000, 'f');
      write_snapshot(scratch_.file("m.snapshot"), sound);
      snapshot_ = content_of(scratch_.file("m.snapshot"));
    }
    std::string bytes = mutation.bytes(snapshot_);
    if (mutation.chance(70)) bytes = with_checksum(bytes);
    const std::string path = scratch_.file("m.snapshot");
    return {"m.snapshot", bytes, [path] { read_snapshot(path); }, {"m.snapshot"}};
  }

  /// So that what lies behind the checksum is reached.
  static std::string with_checksum(std::string bytes) {
    if (bytes.size() < 8) return bytes;
    std::uint64_t hash = 14695981039346656037ULL;
    for (std::size_t k = 0; k + 8 < bytes.size(); ++k) hash = (hash ^ static_cast<unsigned char>(bytes[k])) * 1099511628211ULL;
    for (int k = 0; k < 8; ++k) bytes[bytes.size() - 8 + k] = static_cast<char>(hash >> (8 * k));
    return bytes;
  }

  /// Snapshots whose checksums are right, but not what they hold: restored into a simulation, which then goes on.
  Input restored(Mutation& mutation) {
    const std::string path = scratch_.file("m.snapshot");
    if (going_.empty()) going_ = state_of_a_run();
    std::string bytes = going_;
    if (mutation.chance(20)) {
      bytes = with_checksum(mutation.bytes(bytes));
    } else if (mutation.damages()) {
      scratch_.write("m.snapshot", going_);
      Snapshot snapshot = read_snapshot(path);
      for (std::size_t k = 1 + mutation.below(2); k > 0; --k) damage(snapshot, mutation);
      write_snapshot(path, snapshot);
      bytes = content_of(path);
    }
    return {"m.snapshot", bytes, [this, path] { restore_and_go_on(path); }, {"m.snapshot"}};
  }

  std::unique_ptr<Simulation> new_run() const {
    const std::string text = content_of(package / "test/fuzz/restored.yaml");
    return std::make_unique<Simulation>(read_case_text(text, "restored.yaml", {}, {resolve, {}}));
  }

  std::string bytes_of(const Simulation& simulation) const {
    const std::string path = scratch_.file("now.snapshot");
    simulation.save(path);
    const std::string bytes = content_of(path);
    fs::remove(path);
    return bytes;
  }

  /// In a process of its own: one that has begun a device's threads cannot make others that use it.
  std::string state_of_a_run() const {
    const ChildResult result = run_in_child(
        [this] {
          const std::unique_ptr<Simulation> simulation = new_run();
          for (int k = 0; k < 40; ++k) simulation->advance();
          return bytes_of(*simulation);
        },
        {most_memory, longest, 4 * longest});
    if (result.end != ChildResult::End::done) throw Error("the case of the fuzz does not run: " + result.bytes);
    return result.bytes;
  }

  /// A refusal changes nothing; what is accepted goes on, or the watchdog stops it.
  void restore_and_go_on(const std::string& path) {
    if (!run_) run_ = new_run();
    run_->take_samples();
    const std::string before = bytes_of(*run_);
    try {
      run_->restore(path);
    } catch (const Error&) {
      if (bytes_of(*run_) != before) throw std::logic_error("it was refused, but the simulation is not what it was");
      throw;
    }
    try {
      for (int k = 0; k < 3; ++k) run_->advance();
    } catch (const Violation&) {
    }
    constexpr std::size_t most = 1000;  // samples of three steps
    demand(run_->take_samples().pressures.size() < most, "its samples have no end");
    run_->restore(scratch_.write("m.snapshot", going_));
    demand(bytes_of(*run_) == going_, "then a sound one is not restored to what it was");
  }

  static double awkward_value(Mutation& mutation) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    static const std::vector<double> values{0,     -0.0, 1,      -1,           0.5,      1e-3,         -1e-3, 10,
                                            -10,   1e6,  1e9,    1e15,         1e39,     4294967296.0, 1e300, 1e-300,
                                            1e-39, -1e9, -1e300, std::nan(""), infinity, -infinity};
    return mutation.one_of(values);
  }

  template <class Value>
  static void damage_a_value(std::vector<char>& bytes, std::size_t begin, std::size_t size, Mutation& mutation) {
    if (size < sizeof(Value)) return;
    const auto value = static_cast<Value>(awkward_value(mutation));
    std::memcpy(bytes.data() + begin + sizeof value * mutation.below(size / sizeof value), &value, sizeof value);
  }

  static void damage(Snapshot& snapshot, Mutation& mutation) {
    const auto numbers = [&](std::vector<char>& bytes) {
      if (mutation.chance(90)) return damage_a_value<double>(bytes, 0, bytes.size(), mutation);
      const std::string damaged = mutation.bytes({bytes.begin(), bytes.end()});
      bytes.assign(damaged.begin(), damaged.end());
    };
    switch (mutation.below(9)) {
      case 0:
        snapshot.time = awkward_value(mutation);
        break;
      case 1:
        snapshot.time_step = awkward_value(mutation);
        break;
      case 2:
        snapshot.clocks[mutation.below(snapshot.clocks.size())] ^= std::uint64_t(1) << mutation.below(64);
        break;
      case 3:
        if (mutation.chance(50) || snapshot.instruments.empty())
          snapshot.instruments.push_back(1);
        else
          mutation.one_of(snapshot.instruments) = awkward_value(mutation);
        break;
      case 4:
        numbers(snapshot.bodies);
        break;
      case 5:
        numbers(snapshot.openings);
        break;
      default:
        damage_fluid(snapshot.fluid, mutation);
    }
  }

  /// A value of a block of the solver's state; the block's checksum is made anew. See SnapshotBlocks for what lies where.
  static void damage_fluid(std::vector<char>& bytes, Mutation& mutation) {
    struct Block {
      std::size_t begin, size;
      std::uint32_t value_size;
    };
    std::vector<Block> blocks;
    const auto value_at = [&](std::size_t at, auto value) {
      std::memcpy(&value, bytes.data() + at, sizeof value);
      return value;
    };
    for (std::size_t at = 0; at < bytes.size();) {
      at += sizeof(std::uint32_t) + value_at(at, std::uint32_t());
      const auto value_size = value_at(at, std::uint32_t());
      const auto size = static_cast<std::size_t>(value_at(at + sizeof(std::uint32_t), std::uint64_t()));
      at += 2 * sizeof(std::uint32_t) + sizeof(std::uint64_t);
      if (size > 0) blocks.push_back({at, size, value_size});
      at += size;
    }
    const Block& block = mutation.one_of(blocks);
    if (block.value_size == sizeof(double))
      damage_a_value<double>(bytes, block.begin, block.size, mutation);
    else
      damage_a_value<float>(bytes, block.begin, block.size, mutation);
    const auto sum = static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const unsigned char*>(bytes.data() + block.begin), block.size));
    std::memcpy(bytes.data() + block.begin - sizeof sum, &sum, sizeof sum);
  }

  Input expression(Mutation& mutation) const {
    static const std::vector<std::string> sound{"0.02*cos(2*pi*x)",       "sin(2*pi*x)*cos(2*pi*z)", "t < 1 ? t : 2",
                                                "exp(-x^2)+max(x, y, z)", "(1+(2+(3+x)))",           "if(x>0, 1, 0)"};
    const std::string text = mutation.text(mutation.one_of(sound));
    return {"",
            text,
            [text] {
              for (const Expression::Of of : {Expression::Of::time, Expression::Of::place, Expression::Of::time_and_place}) {
                try {
                  const Expression made(text, of);
                  of == Expression::Of::time    ? made.at(0.5)
                  : of == Expression::Of::place ? made.at(Vector3d(1, 2, 3))
                                                : made.at(0.5, Vector3d(1, 2, 3));
                } catch (const Error&) {
                  if (of == Expression::Of::time_and_place) throw;
                }
              }
            },
            {"no expression"}};
  }

  // ---- a box in every format

  static const TriangleMesh& box() {
    static const TriangleMesh mesh = box_mesh({Vector3d::Zero(), Vector3d(0.2, 0.3, 0.4)}, false, "box");
    return mesh;
  }

  static std::string stl_text() {
    std::ostringstream text;
    text << "solid box\n";
    for (std::size_t t = 0; t < box().triangles.size(); ++t) {
      text << "facet normal 0 0 0\nouter loop\n";
      for (int k = 0; k < 3; ++k) text << "vertex " << box().corner(t, k).transpose() << "\n";
      text << "endloop\nendfacet\n";
    }
    text << "endsolid\n";
    return text.str();
  }

  static std::string obj_text() {
    std::ostringstream text;
    text << "# a box\nmtllib none.mtl\no left\n";
    for (const Vector3d& v : box().vertices) text << "v " << v.transpose() << "\n";
    text << "vn 0 0 1\nvt 0 0\nusemtl red\ng left\n";
    for (const Vector3i& t : box().triangles) text << "f " << t[0] + 1 << "/1/1 " << t[1] + 1 << "//1 " << t[2] - 8 << "\n";
    return text.str();
  }

  static std::string dae_text() {
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit "
            "name=\"meter\" meter=\"1\"/>"
            "<up_axis>Z_UP</up_axis></asset>\n<library_geometries><geometry id=\"g\" name=\"left\"><mesh><source id=\"p\">\n<float_array "
            "id=\"pa\" count=\"24\">";
    for (const Vector3d& v : box().vertices) text << v.transpose() << " ";
    text << "</float_array>\n<technique_common><accessor source=\"#pa\" count=\"8\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
            "name=\"Y\" type=\"float\"/>"
            "<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>\n<vertices id=\"v\"><input semantic=\"POSITION\" "
            "source=\"#p\"/></vertices>\n"
            "<triangles count=\"12\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>";
    for (const Vector3i& t : box().triangles) text << t.transpose() << " ";
    text << "</p></triangles>\n</mesh></geometry></library_geometries>\n<library_visual_scenes><visual_scene id=\"s\"><node "
            "id=\"n\"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
            "</matrix>\n<node id=\"m\"><rotate>0 0 1 90</rotate><instance_geometry "
            "url=\"#g\"/></node></node></visual_scene></library_visual_scenes>\n"
            "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
    return text.str();
  }

  static std::string ply_head(const char* form) {
    return std::string("ply\nformat ") + form +
           " 1.0\ncomment a box\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 12\nproperty list "
           "uchar int vertex_indices\nend_header\n";
  }

  static std::string ply_text() {
    std::ostringstream text;
    text << ply_head("ascii");
    for (const Vector3d& v : box().vertices) text << v.transpose() << "\n";
    for (const Vector3i& t : box().triangles) text << "3 " << t.transpose() << "\n";
    return text.str();
  }

  static std::string ply_bytes() {
    std::string bytes = ply_head("binary_little_endian");
    const auto add = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
    for (const Vector3d& v : box().vertices)
      for (int axis = 0; axis < 3; ++axis) add(static_cast<float>(v[axis]));
    for (const Vector3i& t : box().triangles) {
      bytes += '\3';
      for (int k = 0; k < 3; ++k) add(t[k]);
    }
    return bytes;
  }

  const ScratchDirectory& scratch_;
  /// Where a case is wrong: its file, a key, or a thing by its name.
  const std::vector<std::string> places_{"case.yaml", "/", "body '", "joint '", "mesh '", "the tank", "gauge", "probe", "section '"};
  std::vector<std::string> cases_, small_cases_, whole_cases_, robots_, solids_, keys_;
  std::string snapshot_;
  std::string going_;                ///< bytes of a snapshot that a run goes on from
  std::unique_ptr<Simulation> run_;  ///< of this process
};

constexpr char accepted[] = "accepted";
const std::string crashed = "it crashed: ";

/// What becomes of an input, in the process that calls it.
std::string outcome_of(const Input& input) {
  try {
    input.read();
    return accepted;
  } catch (const Error& error) {
    return error.what();
  }
}

/// What is wrong with what a refused input was refused with; empty = nothing.
std::string fault_of_sentence(const std::string& said, const std::vector<std::string>& words) {
  if (said == accepted) return "";
  if (said.find('\n') != std::string::npos) return "what it was refused with is no single sentence: " + said;
  if (said.size() > 1500) return "what it was refused with is " + std::to_string(said.size()) + " long: " + said;
  if (std::none_of(words.begin(), words.end(), [&](const std::string& word) { return said.find(word) != std::string::npos; }))
    return "what it was refused with does not say where: " + said;
  return "";
}

std::string fault_of_end(const ChildResult& result) {
  switch (result.end) {
    case ChildResult::End::crashed:
      return crashed + result.bytes;
    case ChildResult::End::out_of_memory:
      return "it took more than 4 GiB";
    case ChildResult::End::out_of_time:
      return "it took longer than 20 s";
    case ChildResult::End::refused:
      return "it was refused by no Error, or accepted wrongly: " + result.bytes;
    case ChildResult::End::interrupted:
      return "it was interrupted";
    case ChildResult::End::done:
      break;
  }
  return "";
}

std::size_t count_of_files(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

struct Options {
  std::size_t count = 200;
  std::uint64_t first = 1;
  std::string keep;
  bool says = false;
  std::vector<std::string> kinds;
};

/// What became of one input.
struct Outcome {
  std::uint64_t seed = 0;
  bool was_refused = false;
  std::string fault;   ///< empty = none
  double seconds = 0;  ///< of wall time
  std::string said;    ///< what it was refused with
};

class Run {
 public:
  Run(Kinds& kinds, const std::string& kind, const Options& options, const ScratchDirectory& scratch)
      : kinds_(kinds), kind_(kind), options_(options), scratch_(scratch) {}

  /// How many inputs were taken wrongly.
  int faults() {
    const Clock::time_point begin = Clock::now();
    // what is not damaged has to be accepted, or the rest says nothing
    const Input sound = made(1, false);
    if (const std::string said = said_of(sound); said != accepted) report({0, true, "the sound one is refused: " + said, 0, said});
    constexpr std::uint64_t batch = 50;  // inputs a process: a process costs more than most of them
    const std::uint64_t end = options_.first + options_.count;
    for (std::uint64_t first = options_.first; first < end; first += batch) take(first, std::min(first + batch, end));
    constexpr std::uint64_t enough = 20;  // damaged inputs, of which some have to be refused
    if (options_.count >= enough && refused_ == 0) report({0, false, "not one of the damaged ones is refused", 0, ""});
    std::printf("%-12s seeds %llu to %llu: %zu refused, %zu accepted, %d faults, %d of them crashes; %.1f s, the slowest %.2f s\n",
                kind_.c_str(), static_cast<unsigned long long>(options_.first), static_cast<unsigned long long>(end - 1), refused_,
                accepted_, faults_, crashes_, std::chrono::duration<double>(Clock::now() - begin).count(), slowest_);
    std::fflush(stdout);
    return faults_;
  }

 private:
  Input made(std::uint64_t seed, bool damages = true) {
    Mutation mutation(seed * 1000003 + kind_.size() * 7919 + static_cast<unsigned char>(kind_[0]), damages);
    Input input = kinds_.make(kind_, mutation);
    if (!input.file.empty()) scratch_.write(input.file, input.content);
    return input;
  }

  std::string said_of(const Input& input) {
    const ChildResult result = run_in_child([&] { return outcome_of(input); }, {most_memory, longest, 2 * longest});
    return result.end == ChildResult::End::done ? result.bytes : fault_of_end(result);
  }

  /// All in one process; where that does not come back, each in one of its own, which tells whose fault it is.
  void take(std::uint64_t first, std::uint64_t end) {
    std::vector<Outcome> outcomes;
    const ChildResult result = run_in_child(
        [&] {
          std::string lines;
          for (std::uint64_t seed = first; seed < end; ++seed)
            lines += line_of(outcome(seed, [&](const Input& input) { return outcome_of(input); }));
          return lines;
        },
        {most_memory, longest, 2 * longest});
    std::istringstream lines(result.end == ChildResult::End::done ? result.bytes : "");
    for (std::string line; std::getline(lines, line);) outcomes.push_back(outcome_of_line(line));
    if (outcomes.size() != end - first) {
      outcomes.clear();
      for (std::uint64_t seed = first; seed < end; ++seed) outcomes.push_back(outcome_alone(seed));
    }
    for (const Outcome& each : outcomes) report(each);
  }

  template <class Take>
  Outcome outcome(std::uint64_t seed, const Take& take) {
    const Input input = made(seed);
    const std::size_t files = count_of_files(scratch_.path());
    const Clock::time_point start = Clock::now();
    const std::string said = take(input);
    Outcome result{seed, said != accepted, fault_of_sentence(said, input.words),
                   std::chrono::duration<double>(Clock::now() - start).count(), said};
    if (result.fault.empty() && count_of_files(scratch_.path()) != files) result.fault = "it left a file behind";
    return result;
  }

  Outcome outcome_alone(std::uint64_t seed) {
    std::string fault;
    Outcome result = outcome(seed, [&](const Input& input) {
      const ChildResult child = run_in_child([&] { return outcome_of(input); }, {most_memory, longest, 2 * longest});
      fault = fault_of_end(child);
      return fault.empty() ? child.bytes : std::string(accepted);
    });
    if (!fault.empty()) result.fault = fault;
    return result;
  }

  static std::string line_of(const Outcome& outcome) {
    return std::to_string(outcome.seed) + " " + std::to_string(outcome.was_refused) + " " + std::to_string(outcome.seconds) + " " +
           visible_text(outcome.fault, 1000) + "\t" + visible_text(outcome.said, 1000) + "\n";
  }

  static Outcome outcome_of_line(const std::string& line) {
    Outcome outcome;
    std::istringstream words(line);
    words >> outcome.seed >> outcome.was_refused >> outcome.seconds;
    words.ignore();
    std::getline(words, outcome.fault, '\t');
    std::getline(words, outcome.said);
    return outcome;
  }

  void report(const Outcome& outcome) {
    slowest_ = std::max(slowest_, outcome.seconds);
    if (options_.says)
      std::printf("%s, seed %llu: %s\n", kind_.c_str(), static_cast<unsigned long long>(outcome.seed),
                  visible_text(outcome.said, 1000).c_str());
    if (outcome.fault.empty()) ++(outcome.was_refused ? refused_ : accepted_);
    if (outcome.fault.empty()) return;
    ++faults_;
    if (outcome.fault.rfind(crashed, 0) == 0) ++crashes_;
    std::printf("%s, seed %llu: %s\n", kind_.c_str(), static_cast<unsigned long long>(outcome.seed),
                visible_text(outcome.fault, 1000).c_str());
    if (options_.keep.empty() || outcome.seed == 0) return;
    const Input input = made(outcome.seed);
    fs::create_directories(options_.keep);
    std::ofstream(fs::path(options_.keep) / (kind_ + "_" + std::to_string(outcome.seed) + "_" + input.file), std::ios::binary)
        << input.content;
  }

  Kinds& kinds_;
  std::string kind_;
  const Options& options_;
  const ScratchDirectory& scratch_;
  std::size_t refused_ = 0, accepted_ = 0;
  int faults_ = 0, crashes_ = 0;
  double slowest_ = 0;
};

/// Throws Error for what is no whole number from 1 on.
std::uint64_t number_of(const std::string& option, const std::string& word) {
  const bool digits = !word.empty() && word.size() < 16 && word.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || std::stoull(word) == 0) throw Error(option + " is '" + word + "'; it must be a whole number from 1 on");
  return std::stoull(word);
}

Options options_of(int argc, char** argv) {
  Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k];
    const bool has_value = k + 1 < argc;
    if (word == "--count" && has_value)
      options.count = number_of(word, argv[++k]);
    else if (word == "--seed" && has_value)
      options.first = number_of(word, argv[++k]);
    else if (word == "--say")
      options.says = true;
    else if (word == "--keep" && has_value)
      options.keep = argv[++k];
    else
      options.kinds.push_back(word);
  }
  return options;
}

}  // namespace
}  // namespace wavetank::fuzz

int main(int argc, char** argv) {
  using namespace wavetank;
  set_log_sink([](LogLevel, const std::string&) {});
  fuzz::Options options;
  try {
    options = fuzz::options_of(argc, argv);
  } catch (const Error& error) {
    std::fprintf(stderr, "fuzz: %s\n", error.what());
    return 2;
  }
  const ScratchDirectory scratch;
  fuzz::Kinds kinds(scratch);
  if (options.kinds.empty()) options.kinds = kinds.names();
  int faults = 0;
  for (const std::string& kind : options.kinds) {
    const std::vector<std::string> known = kinds.names();
    if (std::find(known.begin(), known.end(), kind) == known.end()) {
      std::fprintf(stderr, "fuzz: '%s' is no kind of input; give [--count N] [--seed FIRST] [--keep FOLDER] and kinds\n", kind.c_str());
      return 2;
    }
    faults += fuzz::Run(kinds, kind, options, scratch).faults();
  }
  return faults == 0 ? 0 : 1;
}
