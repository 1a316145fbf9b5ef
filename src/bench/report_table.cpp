#include "report.h"
#include "text_table.h"

namespace wavetank::bench {
namespace {

std::string with_spread(const Series& series, double unit = 1) {
  return figure(series.median() / unit) + " ±" + figure(series.spread_percent()) + " %";
}

std::string cases_text(const Report& report) {
  TextTable table({"case", "particles", "particle-steps, M/s", "force evaluations, M/s", "pairs, M/s", "pairs", "candidates", "step, ms",
                   "host, ms", "host, %", "B/particle"});
  for (const Measurement& m : report.cases)
    table.add({m.bench_case.name, std::to_string(m.particles), with_spread(m.particle_steps, 1e6), with_spread(m.evaluations, 1e6),
               with_spread(m.pairs, 1e6), figure(m.pairs_per_particle.median()), figure(m.candidates_per_particle.median()),
               with_spread(m.step_milliseconds), with_spread(m.host_milliseconds), figure(m.host_percent.median()),
               figure(m.bytes_per_particle)});
  return table.text();
}

std::string starts_text(const Report& report) {
  TextTable table({"case", "start-up, s", "layout", "kernel build", "packing", "first step", "cold build, s"});
  for (const Measurement& m : report.cases)
    table.add({m.bench_case.name, figure(m.start_up.total()), figure(m.start_up.layout), figure(m.start_up.kernel_build),
               figure(m.start_up.packing), figure(m.start_up.first_step), figure(m.cold_build)});
  return table.text();
}

std::string kernels_text(const Report& report) {
  TextTable table({"case", "kernel", "ms a step", "of the step, %"});
  for (const Measurement& m : report.cases)
    for (const KernelSeries& kernel : m.kernels)
      table.add({m.bench_case.name, kernel.kernel, with_spread(kernel.milliseconds),
                 figure(100 * kernel.milliseconds.median() / m.step_milliseconds.median())});
  return table.text();
}

std::string limits_text(const Report& report) {
  TextTable limits({"limit of the device", "measured"});
  limits.add({"fused multiply-adds, Gflop/s", figure(report.limits.flops / 1e9)});
  limits.add({"memory bandwidth, GB/s", figure(report.limits.bytes / 1e9)});
  limits.add({"1/√x, G/s", figure(report.limits.inverse_roots / 1e9)});
  TextTable sweeps({"case", "sweep", "flop a candidate", "Gflop/s", "of the limit, %", "B a candidate", "loads, GB/s", "of the limit, %"});
  for (const Measurement& m : report.cases)
    for (const SweepRate& sweep : m.sweeps)
      sweeps.add({m.bench_case.name, sweep.kernel, figure(sweep.flops_per_candidate), figure(sweep.flops.median() / 1e9),
                  figure(100 * sweep.flops.median() / report.limits.flops), figure(sweep.bytes_per_candidate),
                  figure(sweep.bytes.median() / 1e9), figure(100 * sweep.bytes.median() / report.limits.bytes)});
  return limits.text() + "\n" + sweeps.text();
}

}  // namespace

std::string table_of(const Report& report) {
  std::string text = report.device + "\n" + std::to_string(report.repeats) + " repeats, medians and their spread (docs/performance.md)\n";
  if (report.interrupted) text += "interrupted: not all was measured\n";
  for (const Skipped& skipped : report.skipped) text += "skipped " + skipped.name + ": " + skipped.why + "\n";
  for (const std::string& part : {cases_text(report), starts_text(report), kernels_text(report), limits_text(report)}) text += "\n" + part;
  return text;
}

}  // namespace wavetank::bench
