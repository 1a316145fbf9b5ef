#include "json.h"
#include "report.h"
#include "wavetank/common/version.h"

namespace wavetank::bench {
namespace {

Json json_of(const Series& series) {
  return Json::object({{"median", series.median()},
                       {"spread_percent", series.spread_percent()},
                       {"values", Json::list({series.values.begin(), series.values.end()})}});
}

Json json_of(const StartUp& time) {
  return Json::object({{"total", time.total()},
                       {"layout", time.layout},
                       {"kernel_build", time.kernel_build},
                       {"packing", time.packing},
                       {"first_step", time.first_step}});
}

Json kernels_of(const Measurement& m) {
  std::vector<Json::Member> members;
  for (const KernelSeries& kernel : m.kernels) members.push_back({kernel.kernel, json_of(kernel.milliseconds)});
  return Json::object(members);
}

Json sweeps_of(const Measurement& m, const DeviceLimits& limits) {
  std::vector<Json::Member> members;
  for (const SweepRate& sweep : m.sweeps)
    members.push_back({sweep.kernel, Json::object({{"flops_per_candidate", sweep.flops_per_candidate},
                                                   {"flops_per_second", json_of(sweep.flops)},
                                                   {"flops_percent_of_limit", 100 * sweep.flops.median() / limits.flops},
                                                   {"bytes_per_candidate", sweep.bytes_per_candidate},
                                                   {"bytes_per_second", json_of(sweep.bytes)},
                                                   {"bytes_percent_of_limit", 100 * sweep.bytes.median() / limits.bytes}})});
  return Json::object(members);
}

Json json_of(const Measurement& m, const DeviceLimits& limits) {
  return Json::object({{"name", m.bench_case.name},
                       {"dimensions", static_cast<double>(m.bench_case.dimensions)},
                       {"particles", static_cast<double>(m.particles)},
                       {"spacing_m", m.bench_case.spacing},
                       {"smoothing_over_spacing", m.bench_case.smoothing},
                       {"steps_per_repeat", static_cast<double>(m.steps)},
                       {"particle_steps_per_second", json_of(m.particle_steps)},
                       {"evaluated_particles_per_second", json_of(m.evaluations)},
                       {"pairs_per_second", json_of(m.pairs)},
                       {"pairs_per_particle", json_of(m.pairs_per_particle)},
                       {"candidates_per_particle", json_of(m.candidates_per_particle)},
                       {"step_ms", json_of(m.step_milliseconds)},
                       {"host_ms", json_of(m.host_milliseconds)},
                       {"host_percent", json_of(m.host_percent)},
                       {"kernels_ms", kernels_of(m)},
                       {"device_bytes_per_particle", m.bytes_per_particle},
                       {"start_up_s", json_of(m.start_up)},
                       {"cold_build_s", m.cold_build},
                       {"sweeps", sweeps_of(m, limits)}});
}

}  // namespace

std::string json_of(const Report& report) {
  std::vector<Json> cases, skipped;
  for (const Measurement& measurement : report.cases) cases.push_back(json_of(measurement, report.limits));
  for (const Skipped& one : report.skipped) skipped.push_back(Json::object({{"name", one.name}, {"why", one.why}}));
  return Json::object({{"wavetank", version()},
                       {"device", report.device},
                       {"repeats", static_cast<double>(report.repeats)},
                       {"interrupted", report.interrupted},
                       {"limits", Json::object({{"flops_per_second", report.limits.flops},
                                                {"bytes_per_second", report.limits.bytes},
                                                {"inverse_roots_per_second", report.limits.inverse_roots}})},
                       {"cases", Json::list(cases)},
                       {"skipped", Json::list(skipped)}})
             .text() +
         "\n";
}

}  // namespace wavetank::bench
