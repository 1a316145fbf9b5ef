#include "parts_model.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include "measurement.h"
#include "text_table.h"
#include "wavetank/compute/buffer.h"
#include "wavetank/compute/program.h"
#include "wavetank/parallel/group.h"
#include "wavetank/simulation/simulation.h"

namespace wavetank::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

const char* const copying = R"(
__kernel void copy(int count, __global const float* from, __global float* to) {
  const int i = get_global_id(0);
  if (i < count) to[i] = from[i];
}
)";

/// One of two parts that send each other what lies on their device.
struct Correspondent {
  Correspondent(const compute::DeviceInfo& info, int values)
      : device(info),
        program(device, {{"copy.cl", copying}}, "copy.cl", ""),
        copy(program.kernel("copy")),
        count(values),
        array(device, values),
        message(device, values) {}

  void exchange(parallel::Group& group) {
    device.finish();
    copy.launch(count, count, array, message);
    const std::vector<float> values = message.download(count);
    const char* const begin = reinterpret_cast<const char*>(values.data());
    group.send(1 - group.rank(), parallel::Bytes(begin, begin + values.size() * sizeof(float)));
    const parallel::Bytes bytes = group.receive(1 - group.rank());
    message.memory().write(bytes.data(), bytes.size());
    copy.launch(count, count, message, array);
  }

  compute::Device device;
  compute::Program program;
  compute::Kernel copy;
  int count;
  compute::Buffer<float> array, message;
};

/// Of a message of so many values, s: the least of some tries.
double message_seconds(const compute::DeviceInfo& info, int values) {
  Correspondent first(info, values), second(info, values);
  parallel::ThreadGroup both(2, true);
  for (const int rank : {0, 1}) both.at_end_of_turn(rank, [device = (rank == 0 ? first : second).device] { device.finish(); });
  constexpr int tries = 5, rounds = 20;
  double least = 0;
  for (int k = 0; k < tries; ++k) {
    const Clock::time_point begin = Clock::now();
    both.run([&](int rank) {
      for (int round = 0; round < rounds; ++round) (rank == 0 ? first : second).exchange(both.member(rank));
    });
    const double seconds = seconds_since(begin) / (2 * rounds);
    least = k == 0 ? seconds : std::min(least, seconds);
  }
  return least;
}

/// Of each part: `device`, as often as there are parts.
std::string repeated(const std::string& device, int parts) {
  std::string text = device;
  for (int k = 1; k < parts; ++k) text += "," + device;
  return text;
}

/// What a part does whatever particles it has: the host's work, and all walls.
bool is_of_part(const std::string& kernel) { return kernel.rfind("(host)", 0) == 0 || kernel == "wall_loads"; }

/// Kernels that go over tiles of a part's own particles.
bool is_of_own(const std::string& kernel) {
  return is_evaluation(kernel) || kernel == "surface_normals" || kernel == "surface_cone" || kernel == "shifts";
}

struct TimedSteps {
  double seconds = 0, in_kernels = 0, in_sweeps = 0;  ///< a step
  SolverState state;
};

TimedSteps timed(Simulation& simulation, int repeats, const std::function<bool()>& stopped) {
  const std::vector<Block> blocks = measure_blocks(simulation, repeats, stopped);
  TimedSteps found;
  Series seconds, kernels, sweeps;
  for (const Block& block : blocks) {
    double all = 0, of_sweeps = 0;
    for (const KernelTime& time : block.kernels) {
      if (is_of_part(time.kernel)) continue;
      all += time.seconds;
      if (is_of_own(time.kernel)) of_sweeps += time.seconds;
    }
    seconds.values.push_back(block.seconds / block.steps);
    kernels.values.push_back(all / block.steps);
    sweeps.values.push_back(of_sweeps / block.steps);
  }
  found.seconds = seconds.median();
  found.in_kernels = kernels.median();
  found.in_sweeps = sweeps.median();
  found.state = simulation.state();
  return found;
}

PartsCosts assumed_costs(const PartsReport& report) {
  const double own_share = report.costs.sweeps / (report.costs.sweeps + report.costs.others);
  constexpr double particle_step = 6e-9;           // s: a graphics card
  constexpr double link = 20e9, network = 6.25e9;  // bytes/s: to the host, and between machines for each card
  constexpr double latency = 65e-6;                // s
  PartsCosts costs;
  costs.sweeps = own_share * particle_step;
  costs.others = (1 - own_share) * particle_step;
  costs.host = 150e-6;  // five reductions
  costs.message = latency;
  costs.byte = 2 / link + 1 / network;
  return costs;
}

std::string milliseconds(double seconds) { return figure(1e3 * seconds); }

}  // namespace

double step_seconds(const PartsCosts& costs, const PartsLoad& load) {
  return costs.sweeps * load.particles + costs.others * (load.particles + load.copies) + costs.host * load.parts +
         costs.message * load.messages + costs.byte * load.bytes;
}

MessageCosts measure_messages(const compute::DeviceInfo& device) {
  constexpr int few = 64, many = 1 << 20;
  const double small = message_seconds(device, few), large = message_seconds(device, many);
  MessageCosts costs;
  costs.byte = std::max(large - small, 0.0) / (sizeof(float) * static_cast<double>(many - few));
  costs.message = small;
  return costs;
}

PartsReport measure_parts(const BenchCase& bench_case, const compute::DeviceInfo& device, const std::vector<int>& parts, int repeats,
                          const std::function<bool()>& stopped) {
  PartsReport report;
  report.device = device.describe();
  report.name = bench_case.name;
  const Case scene = make_case(bench_case, device.indices());
  std::vector<PartsNeed> needs;  // before anything is measured that would be lost by one that cannot be
  for (const int count : parts) needs.push_back(estimate_parts(scene, count).need);
  SimulationOptions options;
  options.time_kernels = true;
  options.parts_take_turns = true;
  const auto steps_of = [&](const char* what, const Case& of) {
    std::fprintf(stderr, "%s\n", what);
    return timed(*std::make_unique<Simulation>(of, options), repeats, stopped);
  };
  report.one_device = steps_of("one device", scene).seconds;
  if (stopped()) return report;
  options.in_parts = true;
  const TimedSteps one = steps_of("one part", scene);
  if (stopped()) return report;
  report.one_part = one.seconds;
  report.particles = one.state.particles;
  const auto particles = static_cast<double>(report.particles);
  const MessageCosts messages = measure_messages(device);
  report.costs.sweeps = one.in_sweeps / particles;
  report.costs.others = (one.in_kernels - one.in_sweeps) / particles;
  report.costs.host = std::max(one.seconds - one.in_kernels, 0.0);
  report.costs.message = messages.message;
  report.costs.byte = messages.byte;
  for (const PartsNeed& need : needs) {
    const int count = need.parts;
    const TimedSteps steps = steps_of((std::to_string(count) + " parts").c_str(), make_case(bench_case, repeated(device.indices(), count)));
    if (stopped()) break;
    PartsMeasurement measured;
    measured.need = need;
    measured.seconds = steps.seconds;
    const double ways = 2.0 * (count - 1);  // across each cut there and back
    measured.load = {particles, static_cast<double>(measured.need.all_others), static_cast<double>(count), ways * steps.state.messages,
                     ways * steps.state.message_bytes};
    measured.by_the_model = step_seconds(report.costs, measured.load);
    report.messages = steps.state.messages;
    report.copy_bytes = measured.load.bytes / measured.load.copies;
    report.halo = measured.load.copies / ways / (particles / water_length_in_spacings(bench_case));
    report.measured.push_back(measured);
  }
  return report;
}

double efficiency(const Fleet& fleet, const PartsReport& report, const PartsCosts& costs) {
  const double own = fleet.length * fleet.section / fleet.devices, copies = 2 * report.halo * fleet.section;
  const PartsLoad load{own, copies, 1, 2 * report.messages, copies * report.copy_bytes};
  return (costs.sweeps + costs.others) * own / step_seconds(costs, load);
}

std::string table_of(const PartsReport& report) {
  std::string text = report.device + "\n" + report.name + ", " + std::to_string(report.particles) +
                     " particles; parts take turns on one device (docs/distributed.md)\n\n";
  TextTable steps({"", "step, ms", "by the model, ms", "measured over the model", "copies of others, %", "messages a step", "MiB a step"});
  steps.add({"one device", milliseconds(report.one_device), "", "", "", "", ""});
  steps.add({"one part", milliseconds(report.one_part), "", "", "", "", ""});
  for (const PartsMeasurement& m : report.measured)
    steps.add({std::to_string(m.need.parts) + " parts", milliseconds(m.seconds), milliseconds(m.by_the_model),
               figure(m.seconds / m.by_the_model), figure(100 * m.load.copies / m.load.particles), figure(m.load.messages),
               figure(m.load.bytes / (1024.0 * 1024.0))});
  text += steps.text();
  TextTable costs({"what the model goes by", ""});
  const double particle = report.costs.sweeps + report.costs.others;
  costs.add({"a particle's step, µs", figure(1e6 * particle)});
  costs.add({"of that with copies of others too, %", figure(100 * report.costs.others / particle)});
  costs.add({"a part's step besides, ms", milliseconds(report.costs.host)});
  costs.add({"a message, µs", figure(1e6 * report.costs.message)});
  costs.add({"its bytes, GB/s", figure(1e-9 / report.costs.byte)});
  costs.add({"a halo, spacings", figure(report.halo)});
  text += "\n" + costs.text();
  if (!(report.halo > 0)) return text;
  const Fleet fleets[] = {{"basin, 2000 × 1000 × 500 spacings", 2000, 500000, 64},
                          {"flume, 40 000 × 250 × 100 spacings", 40000, 25000, 64}};
  TextTable forecast(
      {"10⁹ particles on 64 devices: efficiency", "devices and links as measured", "6 ns a particle's step, 20 and 6.25 GB/s"});
  for (const Fleet& fleet : fleets)
    forecast.add({fleet.name, figure(efficiency(fleet, report, report.costs)), figure(efficiency(fleet, report, assumed_costs(report)))});
  return text + "\n" + forecast.text();
}

}  // namespace wavetank::bench
