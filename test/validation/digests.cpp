// digests: what twelve small cases are after 200 steps, to the bit, one line each. Two versions of the solver that print the same compute
// the same (scripts/same_bits). 2-D and 3-D, three kinds of walls, two density diffusions; with a paddle that moves and a float that is
// moved by the water.
//   digests FILE: in double precision, and FILE gets each case's places, velocities and pressures at the end: what a change of rounding
//   alone leaves the same to the last digit of single precision, in which they are told.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <numeric>

#include "../common/box_case.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank {
namespace {

constexpr int steps = 200;

/// FNV-1a.
class Digest {
 public:
  void add(const void* from, std::size_t size) {
    const unsigned char* bytes = static_cast<const unsigned char*>(from);
    for (std::size_t k = 0; k < size; ++k) value_ = (value_ ^ bytes[k]) * 1099511628211ULL;
  }
  unsigned long long value() const { return value_; }

 private:
  unsigned long long value_ = 14695981039346656037ULL;
};

/// Of an array in the order of the particles' names.
template <class Value>
unsigned long long digest_of(const std::vector<Value>& values, const std::vector<std::size_t>& order) {
  Digest digest;
  for (const std::size_t i : order) digest.add(&values[i], sizeof(Value));
  return digest.value();
}

/// A column of water that breaks, 20 or 10 spacings high.
Case dam_break(int dimensions) {
  const double width = dimensions == 2 ? 0.0 : 0.24;
  Case scene = box_case(Vector3d(0.8, width, 0.6), 0.4, dimensions == 2 ? 0.02 : 0.04);
  scene.fluid.fill = {Box{Vector3d::Zero(), Vector3d(0.4, width, 0.4)}};
  scene.instruments.rate = 100;
  scene.numerics.packing.settling = 1;
  return scene;
}

void add_paddle(Case& scene) {
  BodyCase paddle{"paddle", Box{Vector3d(0.6, 0, 0.1), Vector3d(0.7, 0, 0.5)}, Motion::prescribed};
  paddle.rigid.prescribed.harmonics = {{Direction::surge, 0.03, 2, 0, 0}};
  scene.bodies.push_back(paddle);
}

void add_float(Case& scene, double width) {
  BodyCase body{"float", Box{Vector3d(0.1, width / 6, 0.3), Vector3d(0.26, 5 * width / 6, 0.46)}, Motion::free};
  body.rigid.density = 400;
  scene.bodies.push_back(body);
}

void write_fields(std::FILE* file, const std::string& name, const ParticleCloud& cloud, const std::vector<std::size_t>& order) {
  std::fprintf(file, "# %s\n", name.c_str());
  for (const std::size_t i : order)
    std::fprintf(file, "%.9g %.9g %.9g %.9g %.9g %.9g %.9g\n", cloud.position[i].x(), cloud.position[i].y(), cloud.position[i].z(),
                 cloud.velocity[i].x(), cloud.velocity[i].y(), cloud.velocity[i].z(), cloud.pressure[i]);
}

void print_digests(const std::string& name, const Case& scene, std::FILE* fields) {
  Simulation simulation(scene);
  Digest wrenches;
  for (int step = 0; step < steps; ++step) {
    simulation.advance();
    for (const WrenchSample& sample : simulation.take_samples().wrenches)
      for (const auto& wrench : sample.wrenches) {
        wrenches.add(wrench.pressure_force.data(), 3 * sizeof(double));
        wrenches.add(wrench.pressure_torque.data(), 3 * sizeof(double));
      }
  }
  const ParticleCloud cloud = simulation.particles();
  std::vector<std::size_t> order(cloud.id.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cloud.id[a] < cloud.id[b]; });
  if (fields != nullptr) write_fields(fields, name, cloud, order);
  const double time = simulation.state().time;
  Digest clock;
  clock.add(&time, sizeof time);
  std::printf(
      "%-46s %zu particles, t %.6f s: time %016llx position %016llx velocity %016llx pressure %016llx density %016llx γ %016llx surface "
      "%016llx wrenches %016llx\n",
      name.c_str(), order.size(), time, clock.value(), digest_of(cloud.position, order), digest_of(cloud.velocity, order),
      digest_of(cloud.pressure, order), digest_of(cloud.density, order), digest_of(cloud.shepard, order), digest_of(cloud.surface, order),
      wrenches.value());
  std::fflush(stdout);
}

void run(std::FILE* fields) {
  const struct {
    const char* name;
    WallElements elements;
  } walls[] = {{"numerical", WallElements::numerical}, {"semi-analytical", WallElements::semi_analytical}, {"facets", WallElements::facet}};
  for (const int dimensions : {2, 3})
    for (const auto& [wall, elements] : walls)
      for (const DensityDiffusion diffusion : {DensityDiffusion::fourtakas, DensityDiffusion::antuono}) {
        Case scene = dam_break(dimensions);
        scene.numerics.walls.elements = elements;
        scene.numerics.density_diffusion = diffusion;
        if (fields != nullptr) scene.numerics.precision = Precision::double_;
        std::string name =
            std::to_string(dimensions) + "-D, " + wall + (diffusion == DensityDiffusion::fourtakas ? ", fourtakas" : ", antuono");
        if (dimensions == 2 && elements == WallElements::facet && diffusion == DensityDiffusion::fourtakas) {
          add_paddle(scene);
          name += ", a paddle";
        }
        if (dimensions == 3 && elements == WallElements::facet && diffusion == DensityDiffusion::antuono) {
          add_float(scene, 0.24);
          name += ", a float";
        }
        print_digests(name, scene, fields);
      }
}

}  // namespace
}  // namespace wavetank

int main(int count, char** arguments) {
  std::FILE* const fields = count > 1 ? std::fopen(arguments[1], "w") : nullptr;
  if (count > 1 && fields == nullptr) {
    std::fprintf(stderr, "digests: '%s' cannot be written\n", arguments[1]);
    return 1;
  }
  try {
    wavetank::run(fields);
    if (fields != nullptr) std::fclose(fields);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "digests: %s\n", error.what());
    return 1;
  }
  return 0;
}
