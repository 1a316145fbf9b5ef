// wavetank._simulation, what wavetank.Tank (src/python/wavetank/tank.py) is made of: numbers and arrays, without names or units of its own.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "held_signals.h"
#include "steered_simulation.h"
#include "wavetank/common/error.h"
#include "wavetank/common/log.h"
#include "wavetank/common/version.h"
#include "wavetank/scene/case_reader.h"

namespace py = pybind11;

namespace wavetank {
namespace {

/// Thrown through the library when a signal's handler has raised an exception, which then waits in the interpreter.
struct Interrupted : std::exception {
  const char* what() const noexcept override { return "interrupted"; }
};

/// What a signal's handler has raised where the library could not be left, until it can; null = nothing. To be touched with the interpreter
/// held; never deleted at the end of the process, when there is no interpreter any more.
py::error_already_set* interruption = nullptr;

/// Whether an exception is one, as Ctrl-C's and that of sys.exit(), and no failure of the code that it came through; it is kept then.
bool keep_interruption(py::error_already_set& error) {
  if (error.matches(PyExc_Exception)) return false;
  delete interruption;
  interruption = new py::error_already_set(std::move(error));
  return true;
}

/// Raises what was kept, in the interpreter; false if nothing was.
bool raise_interruption() {
  if (!interruption) return false;
  interruption->restore();
  delete interruption;
  interruption = nullptr;
  return true;
}

/// Looks for signals on behalf of the interpreter, which cannot while the library works: often enough that nobody notices, seldom enough
/// that it costs nothing.
class SignalWatch {
 public:
  void look() {
    const auto now = std::chrono::steady_clock::now();
    if (now < due_) return;
    due_ = now + std::chrono::milliseconds(10);
    held_.let_through();
    const py::gil_scoped_acquire interpreter;
    if (interruption || PyErr_CheckSignals() != 0) throw Interrupted();
  }

 private:
  HeldSignals held_;
  std::chrono::steady_clock::time_point due_{};
};

ResourceResolver resolver_of(const py::object& resolve) {
  // The library copies and drops the resolver while it works, when the interpreter's counts of references are not to be touched.
  const std::shared_ptr<py::object> kept(new py::object(resolve), [](py::object* object) {
    const py::gil_scoped_acquire interpreter;
    delete object;
  });
  return [kept](const std::string& address) {
    const py::gil_scoped_acquire interpreter;
    try {
      return (*kept)(address).cast<std::string>();
    } catch (py::error_already_set& error) {
      if (keep_interruption(error)) throw Interrupted();
      throw Error(py::str(error.value()).cast<std::string>());
    }
  };
}

py::array_t<double> array_of(const std::vector<double>& values, std::size_t width) {
  const std::size_t rows = width == 0 ? 0 : values.size() / width;
  py::array_t<double> result({rows, width});
  std::copy(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows * width), result.mutable_data());
  return result;
}

template <class Value>
py::array_t<Value> array_of(const std::vector<Value>& values) {
  return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<float> array_of(const std::vector<Eigen::Vector3f>& vectors) {
  py::array_t<float> result({vectors.size(), std::size_t{3}});
  for (std::size_t i = 0; i < vectors.size(); ++i) std::copy(vectors[i].data(), vectors[i].data() + 3, result.mutable_data(i, 0));
  return result;
}

using Numbers = std::array<double, 3>;

Vector3d vector_of(const Numbers& numbers) { return {numbers[0], numbers[1], numbers[2]}; }
Numbers numbers_of(const Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

py::dict dictionary_of(const std::map<std::string, Rows>& kinds) {
  py::dict result;
  for (const auto& [kind, rows] : kinds) result[kind.c_str()] = py::make_tuple(array_of(rows.times), array_of(rows.values, rows.width));
  return result;
}

/// The simulation for the interpreter: one thread at a time, the others refused; the interpreter free for other threads meanwhile.
class PythonSimulation {
 private:
  /// The simulation is one thread's for as long as this lives.
  class Turn {
   public:
    Turn(std::atomic_flag& taken, pid_t process) : taken_(taken) {
      if (getpid() != process)
        throw Error(
            "the tank belongs to the process that made it, and this one was forked from it: make the tank here, in a process that is "
            "started anew (multiprocessing: the start method 'spawn')");
      if (taken.test_and_set()) throw Error("the tank is at work in another thread: wait until that is done");
    }
    ~Turn() { taken_.clear(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    std::atomic_flag& taken_;
  };

  SteeredSimulation& steered() {
    if (!steered_) throw Error("the tank is closed");
    return *steered_;
  }
  Simulation& simulation() { return steered().simulation(); }

  /// What takes its time: without the interpreter, which looks for signals now and then.
  template <class What>
  void work(What what) {
    const Turn turn(taken_, process_);
    try {
      const py::gil_scoped_release others_may_run;
      SignalWatch watch;
      watch_ = &watch;
      what();
    } catch (const Interrupted&) {
      raise_interruption();
      throw py::error_already_set();
    } catch (const Error&) {
      // Another thread of the program can take Ctrl-C while a kernel is compiled: then that is why the compiler failed (HeldSignals).
      if (raise_interruption() || PyErr_CheckSignals() != 0) throw py::error_already_set();
      throw;
    }
    if (raise_interruption()) throw py::error_already_set();
  }

  /// What takes none.
  template <class What>
  auto look(What what) {
    const Turn turn(taken_, process_);
    return what(steered());
  }

 public:
  using Settings = std::vector<std::pair<std::string, std::string>>;

  /// `file`: the case's; empty = `text` is the case.
  PythonSimulation(const std::string& file, const std::string& text, const Settings& settings, const py::object& resolve,
                   const std::string& restore) {
    std::vector<Override> overrides;
    for (const auto& [key, value] : settings) overrides.push_back({key, value, "setting "});
    const ResourceResolver resolver = resolver_of(resolve);
    work([&] {
      const Surroundings surroundings{resolver, {}};
      const Case checked =
          file.empty() ? read_case_text(text, "the case", overrides, surroundings) : read_case_file(file, overrides, surroundings);
      steered_ = std::make_unique<SteeredSimulation>(checked, resolver, restore, [this] { watch_->look(); });
    });
  }

  ~PythonSimulation() {
    try {
      close();
    } catch (py::error_already_set& error) {  // nothing can be raised from here
      keep_interruption(error);
    }
  }

  void advance(double seconds) {
    work([&] { steered().advance(seconds); });
  }
  void advance_to(double time) {
    work([&] { steered().advance_to(time); });
  }
  void reset() {
    work([&] { steered().reset(); });
  }
  void save(const std::string& path) {
    work([&] { simulation().save(path); });
  }
  void close() {
    if (!steered_) return;
    if (getpid() != process_) {
      (void)steered_.release();  // nothing of a device works after a fork, and what would be waited for is not there
      return;
    }
    work([&] { steered_.reset(); });
  }

  py::dict particles(bool surface_only) {
    ParticleCloud cloud;
    work([&] { cloud = surface_only ? simulation().free_surface() : simulation().particles(); });
    py::dict result;
    result["id"] = array_of(cloud.id);
    result["position"] = array_of(cloud.position);
    result["velocity"] = array_of(cloud.velocity);
    result["pressure"] = array_of(cloud.pressure);
    result["density"] = array_of(cloud.density);
    result["shepard"] = array_of(cloud.shepard);
    result["surface"] = array_of(cloud.surface);
    result["eigenvalue"] = array_of(cloud.eigenvalue);
    return result;
  }

  py::dict take_samples() {
    return look([](SteeredSimulation& steered) { return dictionary_of(steered.samples().take()); });
  }
  py::dict newest_samples() {
    return look([](SteeredSimulation& steered) { return dictionary_of(steered.samples().newest()); });
  }

  py::tuple state() {
    return look([](SteeredSimulation& steered) {
      const SolverState state = steered.simulation().state();
      return py::make_tuple(state.time, state.step, state.time_step, state.particles, state.greatest_speed);
    });
  }
  std::string scene() {
    return look([](SteeredSimulation& steered) { return write_case(steered.simulation().scene()); });
  }
  std::string summary() {
    return look([](SteeredSimulation& steered) { return steered.simulation().summary(); });
  }

  /// Of the owner's reference point: position, orientation, velocity, angular velocity; of the tank in the world, of a body in the tank.
  py::tuple body_state(std::size_t owner) {
    return look([&](SteeredSimulation& steered) {
      const RigidWorld& world = steered.simulation().bodies();
      const RigidState state = owner == 0 ? world.state(0) : world.state_in_tank(owner);
      const Quaterniond& turn = state.orientation;
      return py::make_tuple(numbers_of(state.position), std::array<double, 4>{turn.x(), turn.y(), turn.z(), turn.w()},
                            numbers_of(state.velocity), numbers_of(state.angular_velocity));
    });
  }
  py::tuple mass_of(std::size_t owner) {
    return look([&](SteeredSimulation& steered) {
      const MassProperties& properties = steered.simulation().bodies().properties(owner);
      std::array<Numbers, 3> inertia{};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column) inertia[row][column] = properties.inertia(row, column);
      return py::make_tuple(properties.mass, inertia);
    });
  }
  py::tuple joint_state(std::size_t joint) {
    return look([&](SteeredSimulation& steered) {
      const JointState state = steered.simulation().bodies().joint_state(joint);
      return py::make_tuple(state.position, state.velocity, state.effort);
    });
  }
  py::tuple opening_state(std::size_t opening) {
    return look([&](SteeredSimulation& steered) {
      const OpeningState& state = steered.simulation().openings().at(opening);
      return py::make_tuple(state.discharge, state.volume);
    });
  }

  /// Force and torque about the centre of mass, in the body's axes if it turns with it, else in the tank's as they stand now; for
  /// `duration`, s of simulated time, and one step at least: it acts in the steps whose middle lies in it.
  void push(std::size_t owner, const Numbers& force, const Numbers& torque, bool turns_with_body, double duration) {
    look([&](SteeredSimulation& steered) {
      const Quaterniond tank = steered.simulation().bodies().state(0).orientation;
      OutsideWrench wrench;
      wrench.turns_with_body = turns_with_body;
      wrench.force = turns_with_body ? vector_of(force) : Vector3d(tank * vector_of(force));
      wrench.torque = turns_with_body ? vector_of(torque) : Vector3d(tank * vector_of(torque));
      const SolverState state = steered.simulation().state();
      wrench.until = state.time + std::max(duration, state.time_step);
      steered.simulation().set_outside_wrench(owner, wrench);
    });
  }
  void command_body(std::size_t owner, const Numbers& velocity, const Numbers& angular_velocity) {
    look([&](SteeredSimulation& steered) { steered.simulation().command(owner, vector_of(velocity), vector_of(angular_velocity)); });
  }
  void command_joint(std::size_t joint, double value) {
    look([&](SteeredSimulation& steered) { steered.simulation().command_joint(joint, value); });
  }
  void command_discharge(std::size_t opening, double discharge) {
    look([&](SteeredSimulation& steered) { steered.simulation().command_discharge(opening, discharge); });
  }

 private:
  const pid_t process_ = getpid();  ///< that made it; a fork has none of the threads behind the device
  std::atomic_flag taken_ = ATOMIC_FLAG_INIT;
  SignalWatch* watch_ = nullptr;
  std::unique_ptr<SteeredSimulation> steered_;
};

/// To Python's logging, under the name "wavetank".
void log_to_python(LogLevel level, const std::string& line) {
  const py::gil_scoped_acquire interpreter;
  const py::error_scope raised_before;  // on its way out while something is logged
  try {
    const char* const method = level == LogLevel::info ? "info" : level == LogLevel::warning ? "warning" : "error";
    py::module::import("logging").attr("getLogger")("wavetank").attr(method)("%s", line);
  } catch (py::error_already_set& error) {
    keep_interruption(error);  // anything else is an interpreter on its way out
  }
}

void raise(const char* kind, const std::exception& error) {
  PyErr_SetString(py::module::import("wavetank").attr(kind).ptr(), error.what());
}

}  // namespace
}  // namespace wavetank

PYBIND11_MODULE(_simulation, module) {
  using wavetank::PythonSimulation;
  wavetank::set_log_sink(wavetank::log_to_python);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const wavetank::Violation& violation) {
      wavetank::raise("Stopped", violation);
    } catch (const wavetank::Error& error) {
      wavetank::raise("Error", error);
    }
  });
  module.attr("version") = wavetank::version();
  py::class_<PythonSimulation>(module, "Simulation")
      .def(py::init<const std::string&, const std::string&, const PythonSimulation::Settings&, const py::object&, const std::string&>(),
           py::arg("file"), py::arg("text"), py::arg("settings"), py::arg("resolve"), py::arg("restore"))
      .def("advance", &PythonSimulation::advance)
      .def("advance_to", &PythonSimulation::advance_to)
      .def("reset", &PythonSimulation::reset)
      .def("save", &PythonSimulation::save)
      .def("close", &PythonSimulation::close)
      .def("particles", &PythonSimulation::particles)
      .def("take_samples", &PythonSimulation::take_samples)
      .def("newest_samples", &PythonSimulation::newest_samples)
      .def("state", &PythonSimulation::state)
      .def("scene", &PythonSimulation::scene)
      .def("summary", &PythonSimulation::summary)
      .def("body_state", &PythonSimulation::body_state)
      .def("mass_of", &PythonSimulation::mass_of)
      .def("joint_state", &PythonSimulation::joint_state)
      .def("opening_state", &PythonSimulation::opening_state)
      .def("push", &PythonSimulation::push)
      .def("command_body", &PythonSimulation::command_body)
      .def("command_joint", &PythonSimulation::command_joint)
      .def("command_discharge", &PythonSimulation::command_discharge);
}
