// free_flows: flows without walls of the particle shifting paper, by any scheme and shifting law; prints a table of what happens in time.
//   free_flows FLOW WORD=VALUE...
// FLOW is taylor_green (a periodic square of side L = 1 m with speeds up to U = 1 m/s) or square (a square patch that turns with ω = 1/s).
// Words: n (particles along the side, 50), reynolds (0: inviscid), drift (of the whole flow along x, U, 0), end (t U/L or t ω, 0.4), rows
// (10), alpha (artificial viscosity of delta_sph, 0.01), limiter (of Riemann schemes, 1), sound (c₀ over the greatest speed, 10),
// precision, fields (a name: x, z and pressure of every particle are written to NAME_T.csv at every `field_rows`th row), keep (a file: a
// run that was ended goes on from the last row, whose state is in it, and prints the rows before again); and any of the case's method words
// as KEY=WORD: scheme, gradients, pressure (of numerics/mls), viscosity_model, shifting, tensile, integrator, equation_of_state (cole),
// density_diffusion. c₀ and lengths make the rest: Δt = 0.75 h/c₀, times `step`.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "../common/box_case.h"
#include "../sph/state_bytes.h"
#include "wavetank/common/error.h"
#include "wavetank/compute/device.h"
#include "wavetank/scene/case_reader.h"
#include "wavetank/sph/solver.h"
#include "word_arguments.h"

namespace wavetank {
namespace {

constexpr double pi = 3.14159265358979323846;

using namespace validation;

class Flow {
 public:
  explicit Flow(const Words& words) : n(static_cast<int>(number(words, "n", 50))), drift(number(words, "drift", 0)) {
    spacing = 1.0 / n;
    reynolds = number(words, "reynolds", 0);
  }
  virtual ~Flow() = default;
  virtual Vector3d velocity(const Vector3d& place) const = 0;
  virtual double pressure(const Vector3d& place) const = 0;  ///< Pa, at the start
  virtual double greatest_speed() const = 0;
  virtual bool is_periodic() const = 0;
  virtual double domain() const { return 1; }  ///< m: its side, whose least corner is at 0
  virtual double origin() const { return 0; }  ///< m: of x and z in what is written

  int n;
  double drift, spacing, reynolds;
};

class TaylorGreen final : public Flow {
 public:
  using Flow::Flow;
  Vector3d velocity(const Vector3d& x) const override {
    return {std::sin(2 * pi * x.x()) * std::cos(2 * pi * x.z()) + drift, 0, -std::cos(2 * pi * x.x()) * std::sin(2 * pi * x.z())};
  }
  double pressure(const Vector3d& x) const override { return 250 * (std::cos(4 * pi * x.x()) + std::cos(4 * pi * x.z())); }
  double greatest_speed() const override { return 1; }
  bool is_periodic() const override { return true; }
};

class TurningSquare final : public Flow {
 public:
  /// In a domain that its corners, which fly on as they were, do not leave.
  explicit TurningSquare(const Words& words)
      : Flow(words), domain_(std::max(4.0, std::ceil(2 * (std::sqrt(0.5) * std::hypot(1, number(words, "end", 0.4)) + 0.05)))) {}
  Vector3d velocity(const Vector3d& x) const override { return {x.z() - origin(), 0, -(x.x() - origin())}; }
  double pressure(const Vector3d& x) const override {
    double sum = 0;
    for (int m = 1; m < 60; m += 2)
      for (int k = 1; k < 60; k += 2)
        sum -= 32 / (m * k * pi * pi) / ((m * pi) * (m * pi) + (k * pi) * (k * pi)) * std::sin(m * pi * (x.x() - origin() + 0.5)) *
               std::sin(k * pi * (x.z() - origin() + 0.5));
    return 1000 * sum;
  }
  double greatest_speed() const override { return std::sqrt(0.5); }
  bool is_periodic() const override { return false; }
  double domain() const override { return domain_; }
  double origin() const override { return 0.5 * domain_; }

 private:
  double domain_;
};

/// Pairs of particles closer than half a spacing, in a periodic square of side 1 or without ends.
int close_pairs(const FluidState& fluid, double spacing, bool periodic) {
  std::map<std::pair<int, int>, std::vector<Vector3d>> cells;
  const int n = static_cast<int>(std::floor(1 / spacing));
  const auto wrapped = [&](int k) { return periodic ? (k % n + n) % n : k; };
  const auto cell = [&](double x) { return static_cast<int>(std::floor(periodic ? (x - std::floor(x)) * n : x * n)); };
  int pairs = 0;
  for (const Vector3d& place : fluid.position) {
    const int i = cell(place.x()), k = cell(place.z());
    for (int a = -1; a <= 1; ++a)
      for (int b = -1; b <= 1; ++b) {
        const auto found = cells.find({wrapped(i + a), wrapped(k + b)});
        if (found == cells.end()) continue;
        for (const Vector3d& other : found->second) {
          Vector3d way = place - other;
          if (periodic) way -= Vector3d(std::round(way.x()), 0, std::round(way.z()));
          if (way.norm() < 0.5 * spacing) ++pairs;
        }
      }
    cells[{wrapped(i), wrapped(k)}].push_back(place);
  }
  return pairs;
}

/// A table of places, m, and pressures over ρU² (or ρω²L²), a particle a line.
void write_field(const std::string& name, double time, double origin, const FluidState& fluid) {
  char path[512];
  std::snprintf(path, sizeof path, "%s_%.2f.csv", name.c_str(), time);
  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) throw Error("cannot write " + std::string(path));
  std::fprintf(file, "x,z,pressure\n");
  for (std::size_t i = 0; i < fluid.id.size(); ++i)
    std::fprintf(file, "%.5f,%.5f,%.5f\n", fluid.position[i].x() - origin, fluid.position[i].z() - origin, fluid.pressure[i] / 1000);
  if (std::fclose(file) != 0) throw Error("cannot write " + std::string(path));
}

/// What a run has come to at a row of its table.
struct Kept {
  int step = 0, rows = 0;
  double energy = 0, volume = 0, mass = 0;  // at the start
  std::string table;                        // as it was printed
  std::vector<char> state;
};

void write_kept(const std::string& path, const Kept& kept) {
  {
    std::ofstream out(path + ".part", std::ios::binary);
    out << kept.step << ' ' << kept.rows << ' ' << std::hexfloat << kept.energy << ' ' << kept.volume << ' ' << kept.mass << ' ' << std::dec
        << kept.table.size() << ' ' << kept.state.size() << '\n';
    out << kept.table;
    out.write(kept.state.data(), static_cast<std::streamsize>(kept.state.size()));
    if (!out.flush()) throw Error("cannot write " + path + ".part");
  }
  std::filesystem::rename(path + ".part", path);
}

Kept read_kept(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string line, energy, volume, mass;
  std::getline(in, line);
  std::istringstream words(line);
  Kept kept;
  std::size_t table = 0, state = 0;
  words >> kept.step >> kept.rows >> energy >> volume >> mass >> table >> state;
  if (!words) throw Error(path + " is no kept run");
  kept.energy = std::stod(energy);
  kept.volume = std::stod(volume);
  kept.mass = std::stod(mass);
  kept.table.resize(table);
  kept.state.resize(state);
  in.read(kept.table.data(), static_cast<std::streamsize>(table));
  in.read(kept.state.data(), static_cast<std::streamsize>(state));
  if (!in) throw Error(path + " ends before its state does");
  return kept;
}

template <class Real>
void run(const Flow& flow, const Words& words, Precision precision) {
  const double side = flow.domain(), sound_speed = number(words, "sound", 10) * flow.greatest_speed();
  Case scene = box_case(Vector3d(side, 0, side), side, flow.spacing);
  scene.gravity = Vector3d::Zero();
  scene.tank.periodic = {flow.is_periodic(), false, flow.is_periodic()};
  scene.tank.splash_guard = false;
  scene.fluid.sound_speed = sound_speed;
  scene.fluid.viscosity = flow.reynolds > 0 ? 1000 / flow.reynolds : 0;
  NumericsCase& numerics = scene.numerics;
  numerics.precision = precision;
  numerics.negative_pressure = NegativePressure::allowed;
  numerics.equation_of_state = EquationOfState::cole;
  numerics.integrator = Integrator::runge_kutta_4;
  numerics.courant = 1.5;
  choose(words, "scheme", numerics.scheme);
  const bool riemann = numerics.scheme != Scheme::delta_sph;
  numerics.limiter = number(words, "limiter", 1);
  choose(words, "gradients", numerics.gradients);
  choose(words, "pressure", numerics.mls.pressure);
  choose(words, "viscosity_model", numerics.viscosity_model);
  numerics.density_diffusion = riemann                                ? DensityDiffusion::none
                               : numerics.gradients == Gradients::sph ? DensityDiffusion::antuono
                                                                      : DensityDiffusion::fourtakas;
  numerics.artificial_viscosity = riemann || flow.reynolds > 0 ? 0 : number(words, "alpha", 0.01);
  choose(words, "integrator", numerics.integrator);
  choose(words, "equation_of_state", numerics.equation_of_state);
  choose(words, "density_diffusion", numerics.density_diffusion);
  choose(words, "shifting", numerics.shifting);
  choose(words, "tensile", numerics.tensile);
  numerics.expected_speed = flow.greatest_speed();

  Layout layout;
  layout.spacing = flow.spacing;
  layout.domain = {Vector3d::Zero(), Vector3d(side, 0, side)};
  layout.open_top = false;
  const double corner = 0.5 * (side - 1);
  for (int i = 0; i < flow.n; ++i)
    for (int k = 0; k < flow.n; ++k) layout.particles.emplace_back(corner + (i + 0.5) * flow.spacing, 0, corner + (k + 0.5) * flow.spacing);
  layout.volumes.assign(layout.particles.size(), flow.spacing * flow.spacing);
  layout.levels.assign(layout.particles.size(), side);
  scene = settled(scene, layout);
  const Discretisation d = discretise(scene, layout);
  const compute::Device device(compute::choose_device("auto"));
  const auto solver = make_solver(device, scene, layout, d, {Vector3d::Zero()});
  solver->start();
  StateBytes<Real> state(*solver);
  const bool linear = numerics.equation_of_state == EquationOfState::linear;
  for (std::size_t i = 0; i < state.count; ++i) {
    const Vector3d place = layout.particles[i], velocity = flow.velocity(place);
    const double head = flow.pressure(place) / (1000 * sound_speed * sound_speed);
    const double compression = linear ? head : std::pow(1 + 7 * head, 1 / 7.0) - 1, volume = flow.spacing * flow.spacing;
    state.set("u", i, velocity.x());
    state.set("w", i, velocity.z());
    state.set("compression", i, compression);
    state.set("pressure", i, flow.pressure(place));
    state.set("volume", i, volume);
    state.set("mass", i, 1000 * (1 + compression) * volume);
  }
  solver->restore(state.bytes());
  double step = 0.75 * d.smoothing_length / (sound_speed);
  if (flow.reynolds > 0) step = std::min(step, 0.025 * d.support * d.support * flow.reynolds);
  step = std::min(step * number(words, "step", 1), 0.999 * d.viscous_time);
  solver->limit_time_step(step);
  solver->shorten_step(step);

  const double end = number(words, "end", 0.4);
  const int steps = static_cast<int>(std::round(end / step)), rows = static_cast<int>(number(words, "rows", 10));
  const auto kinetic = [&](const FluidState& fluid) {
    double sum = 0;
    for (std::size_t i = 0; i < fluid.id.size(); ++i)
      sum += 0.5 * fluid.mass[i] * (fluid.velocity[i] - Vector3d(flow.drift, 0, 0)).squaredNorm();
    return sum;
  };
  double shift = 0, shift_sum = 0;
  int shift_count = 0;
  const std::string fields = words.count("fields") != 0 ? words.at("fields") : "";
  const int field_rows = static_cast<int>(number(words, "field_rows", 1));
  const std::string keep = words.count("keep") != 0 ? words.at("keep") : "";
  Kept kept;
  const auto print = [&](const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof line, format, values...);
    std::fputs(line, stdout);
    std::fflush(stdout);
    kept.table += line;
  };
  const bool goes_on = !keep.empty() && std::filesystem::exists(keep);
  if (goes_on) {
    kept = read_kept(keep);
    solver->restore(kept.state);
    solver->limit_time_step(step);
    solver->shorten_step(step);
    std::fputs(kept.table.c_str(), stdout);
    std::fflush(stdout);
  } else {
    print("%8s %8s %9s %9s %9s %9s %9s %10s %10s %9s %9s %6s %9s %9s\n", "t", "E/E0", "max|u|", "du now", "du mean", "p rms", "p error",
          "dV/V", "dm/m", "V least", "V most", "close", "p centre", "p worst");
  }
  const auto centre = solver->make_points({Vector3d(0.5 * side, 0, 0.5 * side)});
  for (int k = kept.step; k <= steps; ++k) {
    const bool is_printed = goes_on && k == kept.step;
    if (!is_printed && (k % std::max(1, steps / rows) == 0 || k == steps)) {
      const FluidState fluid = solver->download();
      const double energy = kinetic(fluid);
      double volume = 0, mass = 0, least = 1e9, most = 0, square = 0, error = 0, worst = 0, speed = 0;
      for (std::size_t i = 0; i < fluid.id.size(); ++i) {
        const double own = fluid.mass[i] / (1000 * (1 + fluid.compression[i])), relative = own / (flow.spacing * flow.spacing);
        volume += own;
        mass += fluid.mass[i];
        least = std::min(least, relative);
        most = std::max(most, relative);
        square += std::pow(fluid.pressure[i] / 1000, 2);
        Vector3d at = fluid.position[i];
        at.x() -= flow.drift * k * step;
        const double wrong = (fluid.pressure[i] - flow.pressure(at)) / 1000;
        error += wrong * wrong;
        worst = std::max(worst, std::abs(wrong));
        speed = std::max(speed, (fluid.velocity[i] - Vector3d(flow.drift, 0, 0)).norm());
      }
      if (k == 0) {
        kept.energy = energy;
        kept.volume = volume;
        kept.mass = mass;
      }
      const double count = static_cast<double>(fluid.id.size());
      print("%8.4f %8.5f %9.4f %9.4f %9.4f %9.4f %9.4f %10.2e %10.2e %9.3f %9.3f %6d %9.5f %9.4f\n", k * step, energy / kept.energy, speed,
            shift, shift_count > 0 ? shift_sum / shift_count : 0.0, std::sqrt(square / count), std::sqrt(error / count),
            volume / kept.volume - 1, mass / kept.mass - 1, least, most, close_pairs(fluid, flow.spacing, flow.is_periodic()),
            solver->evaluate(*centre)[0].pressure / 1000, worst);
      if (!fields.empty() && kept.rows % field_rows == 0) write_field(fields, k * step, flow.origin(), fluid);
      ++kept.rows;
      if (!keep.empty()) {
        kept.step = k;
        kept.state = solver->save();
        write_kept(keep, kept);
      }
      shift_sum = 0;
      shift_count = 0;
    }
    if (k == steps) break;
    const StepReport report = solver->advance();
    if (!report.valid()) throw Error("the run is lost at t = " + std::to_string(k * step));
    if (k + 1 < steps && std::abs(report.time_step - step) > 1e-5 * step)
      throw Error("steps of " + std::to_string(step) + " s were wanted, but the next one is of " + std::to_string(report.time_step) + " s");
    const auto found = report.more.find("shift");
    shift = found == report.more.end() ? 0 : found->second;
    shift_sum += shift;
    ++shift_count;
  }
}

}  // namespace
}  // namespace wavetank

int main(int count, char** arguments) {
  using namespace wavetank;
  try {
    const std::string name = count > 1 ? arguments[1] : "";
    const Words words = words_of(std::max(count - 2, 0), arguments + 2);
    std::unique_ptr<Flow> flow;
    if (name == "taylor_green") flow = std::make_unique<TaylorGreen>(words);
    if (name == "square") flow = std::make_unique<TurningSquare>(words);
    if (flow == nullptr) throw Error("the flow is '" + name + "'; it must be taylor_green or square");
    if (words.count("precision") != 0 && words.at("precision") == "double")
      run<double>(*flow, words, Precision::double_);
    else
      run<float>(*flow, words, Precision::single);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "free_flows: %s\n", failure.what());
    return 1;
  }
  return 0;
}
