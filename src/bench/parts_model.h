#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench_case.h"
#include "wavetank/compute/device.h"
#include "wavetank/sph/parts_need.h"

namespace wavetank::bench {

/// What a step costs, from which the time of one in parts follows. s.
struct PartsCosts {
  double sweeps = 0;   ///< of a particle: of its own part alone
  double others = 0;   ///< of a particle: of copies of others' too
  double host = 0;     ///< of a part
  double message = 0;  ///< that has no bytes
  double byte = 0;     ///< of a message
};

/// What a step in parts does.
struct PartsLoad {
  double particles = 0;  ///< own, of all parts that run one after the other
  double copies = 0;     ///< of others' particles, likewise
  double parts = 1;      ///< likewise
  double messages = 0, bytes = 0;
};

/// Of parts, or of messages, that run one after the other; parts on devices of their own: of the largest.
double step_seconds(const PartsCosts& costs, const PartsLoad& load);

/// Particles and halos that go from one part to another and back by turns: of two parts on the device, each in a thread.
struct MessageCosts {
  double message = 0, byte = 0;  ///< s
};
MessageCosts measure_messages(const compute::DeviceInfo& device);

/// A step of a case in so many parts that take turns on one device.
struct PartsMeasurement {
  PartsNeed need;
  PartsLoad load;
  double seconds = 0;       ///< a step, measured
  double by_the_model = 0;  ///< s
};

struct PartsReport {
  std::string device;
  std::string name;  ///< of the case
  std::size_t particles = 0;
  double one_device = 0;  ///< s a step, without parts
  double one_part = 0;    ///< s a step
  PartsCosts costs;
  double halo = 0;        ///< spacings, on one side of a part
  double copy_bytes = 0;  ///< that a step sends for each copy of a particle
  double messages = 0;    ///< that a step sends from one part to another
  std::vector<PartsMeasurement> measured;
};

/// `stopped` as measure_blocks has it: what has been measured until then comes back. Throws Error for a case that cannot be cut so.
PartsReport measure_parts(const BenchCase& bench_case, const compute::DeviceInfo& device, const std::vector<int>& parts, int repeats,
                          const std::function<bool()>& stopped);

/// Many devices, each with a slab of a long block of water.
struct Fleet {
  std::string name;
  double length = 0, section = 0;  ///< spacings; spacings²
  int devices = 1;
};
/// The share of the time that a device spends on what one device would do as well.
double efficiency(const Fleet& fleet, const PartsReport& report, const PartsCosts& costs);

/// Tables: measured steps beside the model's, and what that says of 10⁹ particles on 64 devices.
std::string table_of(const PartsReport& report);

}  // namespace wavetank::bench
