#include "device_limits.h"

#include <algorithm>
#include <functional>
#include <string>

#include "wavetank/compute/buffer.h"
#include "wavetank/compute/program.h"

namespace wavetank::bench {
namespace {

constexpr int tries = 5;
constexpr int accumulators = 12;  // more than a processor's units times their latency, and few enough for 16 registers
constexpr int widths[] = {1, 4, 8, 16};

// Every work-item writes its sum, so that nothing of it can be left out.
const char* const source = R"(
#define ALL(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(10) DO(11)
#define START(k) vector x##k = (vector)(1.0f + 0.001f * k) + 1.0e-6f * (float)get_global_id(0);
#define SUM(k) + x##k
#define MULTIPLY_ADD(k) x##k = x##k * a + b;
#define INVERSE_ROOT(k) x##k = 1.0f / sqrt(x##k);

__kernel void multiply_add(int rounds, float factor, float term, __global vector* sums) {
  const vector a = factor, b = term;
  ALL(START)
  for (int round = 0; round < rounds; ++round) { ALL(MULTIPLY_ADD) }
  sums[get_global_id(0)] = (vector)(0.0f) ALL(SUM);
}

__kernel void inverse_root(int rounds, __global vector* sums) {
  ALL(START)
  for (int round = 0; round < rounds; ++round) { ALL(INVERSE_ROOT) }
  sums[get_global_id(0)] = (vector)(0.0f) ALL(SUM);
}

__kernel void triad(int count, float factor, __global const vector* b, __global const vector* c, __global vector* a) {
  const int i = get_global_id(0);
  if (i < count) a[i] = b[i] + factor * c[i];
}
)";

/// Of a kernel's launch, s: the least of `tries`.
double least_time(compute::Device& device, int tries, const std::function<void()>& launch) {
  double least = 0;
  for (int k = 0; k < tries; ++k) {
    device.reset_timings();
    launch();
    double seconds = 0;
    for (const compute::KernelTiming& timing : device.timings()) seconds += timing.seconds;
    if (seconds > 0 && (least == 0 || seconds < least)) least = seconds;
  }
  return least;
}

double most_a_second(double amount, double seconds) { return seconds > 0 ? amount / seconds : 0; }

/// The greatest rate of a kernel that does `each` operations a number and round, over rounds enough to be timed well.
double arithmetic_rate(compute::Device& device, int width, std::size_t items, double each, const std::function<void(int rounds)>& launch) {
  constexpr double least_seconds = 0.02;
  int rounds = 64;
  while (rounds < (1 << 24) && least_time(device, 1, [&] { launch(rounds); }) < least_seconds) rounds *= 2;
  return most_a_second(each * accumulators * width * static_cast<double>(items) * rounds,
                       least_time(device, tries, [&] { launch(rounds); }));
}

void measure_arithmetic(compute::Device& device, const compute::Program& program, int width, DeviceLimits& limits) {
  const std::size_t items = 2048 * std::size_t{std::max(device.info().compute_units, 1U)};
  compute::Buffer<float> sums(device, 2 * items * width);  // launches are rounded up to whole work-groups
  const compute::Kernel multiply_add = program.kernel("multiply_add"), inverse_root = program.kernel("inverse_root");
  limits.flops = std::max(limits.flops, arithmetic_rate(device, width, items, 2,
                                                        [&](int rounds) { multiply_add.launch(items, rounds, 0.999f, 0.001f, sums); }));
  limits.inverse_roots = std::max(limits.inverse_roots,
                                  arithmetic_rate(device, width, items, 1, [&](int rounds) { inverse_root.launch(items, rounds, sums); }));
}

void measure_memory(compute::Device& device, const compute::Program& program, int width, DeviceLimits& limits) {
  const compute::DeviceInfo& info = device.info();
  const std::size_t bytes = std::min({std::size_t{256} << 20, info.max_allocation / 2, info.global_memory / 8});
  const std::size_t vectors = bytes / (sizeof(float) * width);
  compute::Buffer<float> a(device, vectors * width), b(device, vectors * width), c(device, vectors * width);
  const compute::Kernel triad = program.kernel("triad");
  const double seconds = least_time(device, tries, [&] { triad.launch(vectors, static_cast<int>(vectors), 0.5f, b, c, a); });
  limits.bytes = std::max(limits.bytes, most_a_second(3.0 * sizeof(float) * static_cast<double>(vectors) * width, seconds));
}

}  // namespace

DeviceLimits measure_limits(const compute::DeviceInfo& info) {
  compute::Device device(info, true);
  DeviceLimits limits;
  for (const int width : widths) {
    const std::string vector = width == 1 ? "float" : "float" + std::to_string(width);
    const compute::Program program(device, {{"limits.cl", source}}, "limits.cl", "-cl-fast-relaxed-math -Dvector=" + vector);
    measure_arithmetic(device, program, width, limits);
    if (width == 4) measure_memory(device, program, width, limits);
  }
  return limits;
}

}  // namespace wavetank::bench
