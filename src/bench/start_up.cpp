#include "start_up.h"

#include <chrono>
#include <cstdio>

#include "wavetank/common/error.h"

namespace wavetank::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point from, Clock::time_point to) { return std::chrono::duration<double>(to - from).count(); }

constexpr const char* line_format = "start-up %lf %lf %lf %lf";

}  // namespace

Started start(const Case& scene) {
  const Clock::time_point begin = Clock::now();
  Clock::time_point laid_out = begin, built = begin;
  SimulationOptions options;
  options.time_kernels = true;
  options.progress = [&](const std::string& what, double fraction) {
    if (fraction < 1.0) return;
    if (what == "laying out") laid_out = Clock::now();
    if (what == "compiling kernels") built = Clock::now();
  };
  Started result;
  result.simulation = std::make_unique<Simulation>(scene, options);
  const Clock::time_point ready = Clock::now();
  result.simulation->advance();
  result.time = {seconds_between(begin, laid_out), seconds_between(laid_out, built), seconds_between(built, ready),
                 seconds_between(ready, Clock::now())};
  return result;
}

std::string text_of(const StartUp& time) {
  char text[200];
  std::snprintf(text, sizeof text, line_format, time.layout, time.kernel_build, time.packing, time.first_step);
  return text;
}

StartUp start_up_of(const std::string& text) {
  StartUp time;
  if (std::sscanf(text.c_str(), line_format, &time.layout, &time.kernel_build, &time.packing, &time.first_step) != 4)
    throw Error("a start-up was not measured: '" + text + "' came instead");
  return time;
}

}  // namespace wavetank::bench
