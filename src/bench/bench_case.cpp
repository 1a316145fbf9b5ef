#include "bench_case.h"

#include <algorithm>
#include <cmath>

#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

// SPHERIC benchmark 2, m: the experiment at MARIN; Kleefsman et al., J. Comput. Phys. 206 (2005).
constexpr double tank_length = 3.22, tank_width = 1.0, tank_height = 1.0;
constexpr double water_begin = 1.992, water_depth = 0.55;
constexpr double box_begin = 0.6635, box_length = 0.161, box_width = 0.403, box_height = 0.161;

struct Size {
  const char* name;
  double particles;
};
struct Smoothing {
  const char* name;
  double ratio;  ///< h/Δx
};
struct Diffusion {
  const char* name;
  DensityDiffusion value;
};

constexpr Size sizes[] = {{"10k", 1e4}, {"30k", 3e4}, {"100k", 1e5}, {"300k", 3e5}, {"1M", 1e6}};
constexpr const char* twin_size = "30k";
constexpr double twin_particles = 3e4;
constexpr Smoothing smoothings[] = {{"h1.5", 1.5}, {"h1.73", 1.73}, {"h2", 2.0}};
constexpr Diffusion diffusions[] = {
    {"fourtakas", DensityDiffusion::fourtakas}, {"antuono", DensityDiffusion::antuono}, {"none", DensityDiffusion::none}};

const std::vector<WallTreatment>& wall_treatments() {
  static const std::vector<WallTreatment> treatments = {
      {"facet", WallMethod::boundary_integral, WallElements::facet, ShepardFactor::geometric},
      {"numerical", WallMethod::boundary_integral, WallElements::numerical, ShepardFactor::geometric},
      {"semi_analytical", WallMethod::boundary_integral, WallElements::semi_analytical, ShepardFactor::geometric},
      {"volumetric", WallMethod::boundary_integral, WallElements::facet, ShepardFactor::volumetric},
      {"no_shepard", WallMethod::boundary_integral, WallElements::facet, ShepardFactor::none},
      {"monolithic", WallMethod::boundary_integral, WallElements::numerical, ShepardFactor::monolithic},
      {"ghost", WallMethod::ghost, WallElements::facet, ShepardFactor::geometric}};
  return treatments;
}

/// The spacing within 5 % of the water's size over the number of particles at which whole rows come nearest to that number.
double spacing_for(int dimensions, double particles) {
  const double area = (tank_length - water_begin) * water_depth;
  const double middle = std::pow((dimensions == 3 ? area * tank_width : area) / particles, 1.0 / dimensions);
  double best = middle, least = particles;
  for (int k = 0; k <= 200; ++k) {
    const double spacing = middle * (1.0 + 0.0005 * (k % 2 == 0 ? k / 2 : -(k + 1) / 2));  // the nearest ones first
    const double error = std::abs(static_cast<double>(particles_at(dimensions, spacing)) - particles);
    if (error >= least) continue;
    least = error;
    best = spacing;
  }
  return best;
}

std::string name_of(int dimensions, const char* size, const Smoothing& smoothing, const Diffusion& diffusion, const WallTreatment& walls) {
  return "dam_break_" + std::to_string(dimensions) + "d/" + size + "/" + smoothing.name + "/" + diffusion.name + "/" + walls.name;
}

std::string name_of(int dimensions, const char* size, Scheme scheme, Shifting shifting, Integrator integrator) {
  return "methods_" + std::to_string(dimensions) + "d/" + size + "/" + word_of(scheme) + "/" + word_of(shifting) + "/" +
         word_of(integrator);
}

/// Each scheme with each shifting law and integrator; the density diffusion is the scheme's own choice.
void add_methods(std::vector<BenchCase>& cases, int dimensions, const Size& size) {
  const double spacing = spacing_for(dimensions, size.particles);
  for (const auto& scheme : method_words<Scheme>())
    for (const auto& law : method_words<Shifting>())
      for (const auto& integrator : method_words<Integrator>()) {
        BenchCase result;
        result.dimensions = dimensions;
        result.spacing = spacing;
        result.smoothing = smoothings[0].ratio;
        result.scheme = scheme.choice;
        result.shifting = law.choice;
        result.integrator = integrator.choice;
        if (scheme.choice != Scheme::delta_sph) result.diffusion = DensityDiffusion::none;
        result.walls = wall_treatments()[0];
        result.name = name_of(dimensions, size.name, scheme.choice, law.choice, integrator.choice);
        result.small_twin = name_of(dimensions, twin_size, scheme.choice, law.choice, integrator.choice);
        cases.push_back(result);
      }
}

BenchCase spheric2_45() {
  BenchCase result;
  result.name = "spheric2_45";
  result.spacing = water_depth / 45;
  result.smoothing = smoothings[2].ratio;
  result.diffusion = DensityDiffusion::antuono;
  result.walls = wall_treatments()[0];
  result.small_twin = name_of(3, twin_size, smoothings[2], diffusions[1], wall_treatments()[0]);
  return result;
}

std::vector<BenchCase> make_all_cases() {
  std::vector<BenchCase> cases;
  for (const int dimensions : {2, 3})
    for (const Size& size : sizes) {
      const double spacing = spacing_for(dimensions, size.particles);
      for (const Smoothing& smoothing : smoothings)
        for (const Diffusion& diffusion : diffusions)
          for (const WallTreatment& walls : wall_treatments()) {
            const char* twin = size.particles > twin_particles ? twin_size : size.name;
            BenchCase result;
            result.name = name_of(dimensions, size.name, smoothing, diffusion, walls);
            result.dimensions = dimensions;
            result.spacing = spacing;
            result.smoothing = smoothing.ratio;
            result.diffusion = diffusion.value;
            result.walls = walls;
            result.small_twin = name_of(dimensions, twin, smoothing, diffusion, walls);
            cases.push_back(result);
          }
    }
  cases.push_back(spheric2_45());
  for (const int dimensions : {2, 3})
    for (const Size& size : {sizes[1], sizes[2]}) add_methods(cases, dimensions, size);
  return cases;
}

}  // namespace

const std::vector<BenchCase>& all_cases() {
  static const std::vector<BenchCase> cases = make_all_cases();
  return cases;
}

std::vector<BenchCase> default_cases() {
  std::vector<std::string> names;
  const std::vector<WallTreatment>& walls = wall_treatments();
  for (const int dimensions : {2, 3})
    for (const Size& size : sizes) names.push_back(name_of(dimensions, size.name, smoothings[0], diffusions[0], walls[0]));
  for (std::size_t k = 1; k < std::size(smoothings); ++k) names.push_back(name_of(3, "100k", smoothings[k], diffusions[0], walls[0]));
  for (std::size_t k = 1; k < std::size(diffusions); ++k) names.push_back(name_of(3, "100k", smoothings[0], diffusions[k], walls[0]));
  for (std::size_t k = 1; k < walls.size(); ++k) names.push_back(name_of(3, "100k", smoothings[0], diffusions[0], walls[k]));
  names.push_back("spheric2_45");
  std::vector<BenchCase> cases;
  for (const std::string& name : names) cases.push_back(case_named(name));
  return cases;
}

std::vector<BenchCase> short_cases() {
  std::vector<BenchCase> cases;
  for (const char* size : {"100k", "1M"}) cases.push_back(case_named(name_of(3, size, smoothings[0], diffusions[0], wall_treatments()[0])));
  return cases;
}

std::vector<BenchCase> chosen_cases(const std::vector<std::string>& filters) {
  if (filters.empty()) return default_cases();
  std::vector<BenchCase> cases;
  std::copy_if(all_cases().begin(), all_cases().end(), std::back_inserter(cases), [&](const BenchCase& bench_case) {
    return std::all_of(filters.begin(), filters.end(),
                       [&](const std::string& filter) { return bench_case.name.find(filter) != std::string::npos; });
  });
  if (!cases.empty()) return cases;
  std::string given;
  for (const std::string& filter : filters) given += (given.empty() ? "'" : " and '") + filter + "'";
  throw Error("no case's name contains " + given + " (wavetank_bench --list lists the names)");
}

const BenchCase& case_named(const std::string& name) {
  for (const BenchCase& bench_case : all_cases())
    if (bench_case.name == name) return bench_case;
  throw Error("there is no case '" + name + "' (wavetank_bench --list lists the names)");
}

Case make_case(const BenchCase& bench_case, const std::string& device) {
  const bool flat = bench_case.dimensions == 2;
  Case result;
  result.title = bench_case.name;
  result.dimensions = bench_case.dimensions;
  result.duration = 1;  // never reached
  result.device = device;
  result.fluid.density = 998;
  result.fluid.viscosity = 8.94e-4;
  result.fluid.sound_speed = 40;
  result.fluid.spacing = bench_case.spacing;
  result.fluid.fill = {Box{Vector3d(water_begin, 0, 0), Vector3d(tank_length, flat ? 0 : tank_width, water_depth)}};
  result.tank.shape = BoxTank{Vector3d(tank_length, flat ? 0 : tank_width, tank_height), Vector3d::Zero(), false};
  const double beside = flat ? 0 : 0.5 * (tank_width - box_width);
  const Box box{Vector3d(box_begin, beside, 0), Vector3d(box_begin + box_length, flat ? 0 : beside + box_width, box_height)};
  if (bench_case.walls.method != WallMethod::ghost) {  // ghosts mirror the tank's planes only
    BodyCase body;
    body.name = "box";
    body.shape = box;
    result.bodies.push_back(body);
  }
  result.numerics.support = 2 * bench_case.smoothing;
  result.numerics.scheme = bench_case.scheme;
  result.numerics.shifting = bench_case.shifting;
  result.numerics.integrator = bench_case.integrator;
  if (bench_case.scheme != Scheme::delta_sph) result.numerics.artificial_viscosity = 0;  // Riemann problems have their own
  result.numerics.density_diffusion = bench_case.diffusion;
  result.numerics.walls.method = bench_case.walls.method;
  result.numerics.walls.elements = bench_case.walls.elements;
  result.numerics.walls.shepard = bench_case.walls.shepard;
  result.numerics.walls.slip = Slip::no_slip;
  result.numerics.packing.iterations = 0;
  result.instruments.rate = 1e-3;  // Hz: not again after the start
  result.instruments.pose_rate = 1e-3;
  return result;
}

double water_length_in_spacings(const BenchCase& bench_case) { return (tank_length - water_begin) / bench_case.spacing; }

std::size_t particles_at(int dimensions, double spacing) {
  const auto rows = [spacing](double length) { return static_cast<std::size_t>(std::floor(length / spacing + 0.5 + 1e-6)); };
  return rows(tank_length - water_begin) * rows(water_depth) * (dimensions == 3 ? rows(tank_width) : 1);
}

}  // namespace wavetank::bench
