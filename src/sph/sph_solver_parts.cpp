#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "sph_solver.h"
#include "wavetank/common/error.h"
#include "wavetank/parallel/packed.h"

namespace wavetank {
namespace {

// Of the report's least id: no particle is in violation.
constexpr std::int64_t nobody_offends = std::numeric_limits<std::int64_t>::max();

/// A number that one part has, as integers that are 0 of the others: their sum has its bits, whatever it is.
std::int64_t bits_of(double value) {
  std::int64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

double value_of(std::int64_t bits) {
  double value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// What `teller` knows of the particle that a report names, for all.
void tell_of_offender(parallel::Group& group, StepReport& report, bool teller) {
  std::vector<std::int64_t> told(8, 0);
  if (teller) {
    told[0] = report.offender;
    told[1] = report.offender_id;
    for (int k = 0; k < 3; ++k) {
      told[2 + k] = bits_of(report.offender_position[k]);
      told[5 + k] = bits_of(report.offender_velocity[k]);
    }
  }
  told = group.sums(told);
  report.offender = told[0];
  report.offender_id = static_cast<std::uint32_t>(told[1]);
  for (int k = 0; k < 3; ++k) {
    report.offender_position[k] = value_of(told[2 + k]);
    report.offender_velocity[k] = value_of(told[5 + k]);
  }
}

}  // namespace

template <class Real>
void SphSolver<Real>::bind_part() {
  compute::Arguments all = arguments();
  all.memory("state", state_).memory("half_state", half_).memory("rates", rates_).memory("guard_hits", guarded_.hits);
  drains_.add_to(all);
  part_->bind(*make_, all, surroundings_.grid.starts(), case_.numerics.integrator == Integrator::symplectic);
  const auto carry = [&](const char* name, const std::vector<int>& places, Buffer& array) {
    if (!places.empty()) part_->carry(name, places, std::as_const(array), array, *make_, all);
  };
  const auto first = [](int count) {
    std::vector<int> places(count);
    for (int k = 0; k < count; ++k) places[k] = k;
    return places;
  };
  const auto places = [&](ParticleArray array, const std::vector<std::string>& components) {
    std::vector<int> found;
    for (const std::string& name : components)
      if (fields_.has(array, name)) found.push_back(fields_.at(array, name));
    return found;
  };
  std::vector<std::string> evolving;
  for (const FieldRow& row : fields_.rows())
    if (row.array == ParticleArray::state && row.evolution != FieldRow::Evolution::none)
      evolving.insert(evolving.end(), row.components.begin(), row.components.end());
  carry("state", first(fields_.count(ParticleArray::state)), state_);
  carry("acceleration", places(ParticleArray::rates, {"u", "v", "w"}), rates_);
  carry("compression rate", places(ParticleArray::rates, evolving), rates_);
  carry("shift", places(ParticleArray::state, {"shift_x", "shift_y", "shift_z"}), state_);
  carry("gradients", first(gradient_count()), gradient_);
  if (shifts()) carry("surroundings", first(field::around_count), around_);
}

template <class Real>
void SphSolver<Real>::over_own(const BoundSweep& sweep) const {
  if (part_)
    sweep.kernel.launch(static_cast<std::size_t>(part_->tiles()));
  else
    sweep.launch(count_);
}

template <class Real>
void SphSolver<Real>::refresh(const char* name) {
  if (part_) part_->refresh(name);
}

template <class Real>
void SphSolver<Real>::spoil(const char* name) {
  if (part_ && part_->parting().spoils) part_->spoil(name);
}

template <class Real>
void SphSolver<Real>::run_with_exchanges() {
  for (std::size_t k = 0; k < schedule_.stages().size(); ++k) {
    const Stage& stage = schedule_.stages()[k];
    for (const Access& access : stage.writes)
      if (stage.sweeps && part_->carries(access.array)) spoil(access.array.c_str());
    stage.run();
    for (const Access& access : part_->exchanges[k]) {
      if (!part_->carries(access.array))
        throw Error("stage '" + stage.name + "' finds the " + access.array + " of a part's own particles, which the parts do not exchange");
      refresh(access.array.c_str());
    }
  }
}

template <class Real>
void SphSolver<Real>::sort_part() {
  add_waiting();
  const int before = count_;
  typename WaterPart<Real>::Arrived gone;
  const std::vector<typename WaterPart<Real>::Arrived> arrived = part_->exchange_particles(count_, gone);
  left_ = left_of(gone);
  int all = before;
  for (const auto& some : arrived) all += static_cast<int>(some.id.size());
  reserve(all);
  for (const auto& some : arrived) {
    const std::size_t count = some.id.size();
    for (int f = 0; count > 0 && f < fields_.count(ParticleArray::state); ++f)
      state_.memory().write(&some.values[f * count], count * sizeof(Real), (f * static_cast<std::size_t>(stride_) + count_) * sizeof(Real));
    if (count > 0) id_.memory().write(some.id.data(), count * sizeof(std::uint32_t), count_ * sizeof(std::uint32_t));
    set_count(count_ + static_cast<int>(count));
  }
  part_->still_others(before, all - before);
  sort_alone();
}

template <class Real>
std::vector<LeftParticle> SphSolver<Real>::left_of(const typename WaterPart<Real>::Arrived& gone) const {
  const std::size_t count = gone.id.size();
  const auto value = [&](const char* component, std::size_t k) {
    return static_cast<double>(gone.values[static_cast<std::size_t>(fields_.at(ParticleArray::state, component)) * count + k]);
  };
  std::vector<LeftParticle> left;
  for (std::size_t k = 0; k < count; ++k)
    left.push_back({gone.id[k], value("mass", k), discretisation_.origin + Eigen::Vector3d(value("x", k), value("y", k), value("z", k))});
  return left;
}

template <class Real>
std::vector<LeftParticle> SphSolver<Real>::gather_left() {
  parallel::Group& group = *part_->parting().group;
  std::vector<LeftParticle> all = std::exchange(left_, {});
  if (group.rank() != 0) {
    parallel::Packed message;
    message.value(all.size());
    for (const LeftParticle& left : all)
      message.value(left.id).value(left.mass).value(left.position.x()).value(left.position.y()).value(left.position.z());
    group.send(0, message.take());
    return {};
  }
  for (int rank = 1; rank < group.size(); ++rank) {
    const parallel::Bytes bytes = group.receive(rank);
    parallel::Unpacked from(bytes);
    for (auto count = from.value<std::size_t>(); count > 0; --count) {
      LeftParticle left;
      left.id = from.value<std::uint32_t>();
      left.mass = from.value<double>();
      for (int axis = 0; axis < 3; ++axis) left.position[axis] = from.value<double>();
      all.push_back(left);
    }
  }
  std::sort(all.begin(), all.end(), [](const LeftParticle& a, const LeftParticle& b) { return a.id < b.id; });
  return all;
}

template <class Real>
void SphSolver<Real>::sort_alone() {
  surroundings_.grid.sort(count_);
  forget_gradients();
  std::swap(state_, half_);
  std::swap(id_, spare_id_);
  surroundings_.reach = static_cast<Real>(discretisation_.support);
  set_count(part_->look_around(count_));
}

template <class Real>
StepReport SphSolver<Real>::watch_parts(const std::vector<Real>& values, const std::vector<int>& counted) {
  parallel::Group& group = *part_->parting().group;
  std::vector<double> greatest;
  std::vector<std::int64_t> counts;
  for (const ReportRow& row : reports_.rows()) {
    if (row.kind == ReportRow::Kind::greatest) greatest.push_back(values[reports_.greatest(row.name)]);
    if (row.kind == ReportRow::Kind::count) counts.push_back(counted[reports_.integer(row.name)]);
  }
  greatest.push_back(counted[reports_.integer("particles")]);
  greatest = group.greatest(greatest);
  const std::string mismatch = std::exchange(part_->mismatch, "");
  counts.push_back(mismatch.empty() ? 0 : 1);
  counts.push_back(static_cast<std::int64_t>(left_.size()));
  counts = group.sums(counts);
  const bool halos_differ = counts[counts.size() - 2] > 0;
  part_->most_own = static_cast<std::int64_t>(greatest.back());
  std::map<std::string, double> found;
  std::size_t next_greatest = 0, next_count = 0;
  for (const ReportRow& row : reports_.rows()) {
    if (row.kind == ReportRow::Kind::greatest) found[row.name] = greatest[next_greatest++];
    if (row.kind == ReportRow::Kind::count) found[row.name] = static_cast<double>(counts[next_count++]);
  }
  StepReport report;
  report.let_in = std::exchange(masses_let_in_, {});
  part_->all += static_cast<std::int64_t>(report.let_in.size()) - counts.back();
  const bool only_infected = found["not_finite"] == 0 && found["infected"] > 0;  // without another to blame
  if (only_infected) found["not_finite"] = found["infected"];
  if (found["particles"] != static_cast<double>(part_->all))
    throw Error("the parts of the water have " + std::to_string(static_cast<std::int64_t>(found["particles"])) +
                " particles together, not " + std::to_string(part_->all) + ": some were lost between them");
  if (counts.back() > 0) report.left = gather_left();
  report.greatest_speed = greatest_speed_ = found["speed"];
  report.greatest_acceleration = greatest_acceleration_ = found["acceleration"];
  // as reduce.cl has it
  const Real h = static_cast<Real>(values_->at("smoothing_length")), courant = static_cast<Real>(values_->at("courant"));
  Real step = courant * h / (static_cast<Real>(values_->at("sound_speed")) + static_cast<Real>(greatest_speed_));
  step = std::min(step, courant * std::sqrt(h / std::max(static_cast<Real>(greatest_acceleration_), Real(1e-20))));
  step = std::min({step, static_cast<Real>(values_->at("viscous_time")), longest_step_});
  report_.memory().write(&step, sizeof step);
  report.time_step = step_ = step;
  report.not_finite = static_cast<int>(found["not_finite"]);
  report.outside = static_cast<int>(found["outside"]);
  report.too_fast = static_cast<int>(found["fast"]);
  report.guard_hits = static_cast<int>(found["guarded"]);
  guarded_.read(report.guard_hits > 0);
  report.shepard_bounded = static_cast<int>(found["bounded"]);
  for (std::size_t k = common_reports().size(); k < reports_.rows().size(); ++k) {
    const std::string& name = reports_.rows()[k].name;
    report.more[name] = found[name];
  }
  const bool sound = report.not_finite + report.outside + report.too_fast == 0;
  if (sound && halos_differ)
    throw Error(mismatch.empty() ? "another part of the water has other particles in its halo than it was sent" : mismatch);
  if (sound) return report;
  // the one of the least id is told of, by the part that has it
  int first = counted[reports_.integer("offender")];
  if (only_infected) first = std::min(first, counted[reports_.integer("first_infected")]);
  const bool offends = first != ReportTable::nobody;
  if (offends) describe_offender(report, first);
  const std::int64_t least = group.least({offends ? static_cast<std::int64_t>(report.offender_id) : nobody_offends})[0];
  tell_of_offender(group, report, offends && report.offender_id == least);
  return report;
}

template <class Real>
std::vector<int> SphSolver<Real>::places_in_parts(const std::vector<Real>& coordinates) const {
  const Parting& parting = part_->parting();
  const Real inverse = static_cast<Real>(values_->at(parting.axis == 0 ? "inverse_slot" : "inverse_row"));
  std::vector<int> places;
  places.reserve(coordinates.size());
  for (const Real coordinate : coordinates) {
    const int place = static_cast<int>(std::min(std::max(coordinate * inverse, Real(0)), Real(1e6))) + 1;
    places.push_back(std::min(std::max(place, 1), parting.places));
  }
  return places;
}

template <class Real>
std::vector<int> SphSolver<Real>::in_part(const std::vector<Real>& coordinates) const {
  const std::vector<int> places = places_in_parts(coordinates);
  const std::vector<char> has = places_had(*values_, part_->parting());
  std::vector<int> found;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (has[places[k]] != 0) found.push_back(static_cast<int>(k));
  return found;
}

template <class Real>
std::vector<int> SphSolver<Real>::own_points(const std::vector<Eigen::Vector3d>& points) const {
  const int axis = part_->parting().axis;
  std::vector<Real> coordinates;
  for (const Eigen::Vector3d& point : points) coordinates.push_back(static_cast<Real>(point[axis] - discretisation_.origin[axis]));
  const std::vector<int> places = places_in_parts(coordinates);
  const double begin = values_->at("own_begin"), end = values_->at("own_end");
  std::vector<int> found;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (places[k] >= begin && places[k] < end) found.push_back(static_cast<int>(k));
  return found;
}

template <class Real>
void SphSolver<Real>::set_cuts(const std::vector<int>& cuts) {
  wavetank::set_cuts(*values_, part_->parting(), cuts);
  upload_parameters(*values_);
  const int slots = static_cast<int>(values_->at("window_slots"));
  energy_rows_ = slots / static_cast<int>(values_->at(part_->parting().axis == 0 ? "window_size" : "slots_x"));
  surroundings_.grid.resize(device_, slots, 1 + 2 * static_cast<int>(stride_));
  part_->set_window(energy_rows_, slots);
  const std::size_t sums = static_cast<std::size_t>(energy_rows_) * energy_pieces_ * exact_places(field::energy_count);
  if (energy_parts_.size() < sums) energy_parts_ = compute::Buffer<std::int64_t>(device_, sums);
  wrenches_.set_part(part_->parting(), static_cast<int>(values_->at("own_begin")), static_cast<int>(values_->at("own_end")));
}

/// In the order of their ranks: its last bits depend on where they are cut.
template <class Real>
double SphSolver<Real>::sum_of_parts(double own) const {
  parallel::Group& group = *part_->parting().group;
  std::vector<std::int64_t> all(group.size(), 0);
  all[group.rank()] = bits_of(own);
  double sum = 0;
  for (const std::int64_t bits : group.sums(all)) sum += value_of(bits);
  return sum;
}

/// With what steps make when they are first made; of others it hears nothing, so that the numbers are nobody's.
template <class Real>
std::size_t SphSolver<Real>::memory_for(const std::vector<int>& cuts, const std::vector<char>& state) {
  set_cuts(cuts);
  restore(state);
  if (shifts()) find_shifts();
  if (case_.numerics.integrator == Integrator::symplectic)
    find_compression_rates(Slot::now);
  else
    find_rates(Slot::now);
  sort_part();
  return device_memory();
}

template <class Real>
double SphSolver<Real>::imbalance() const {
  const Parting& parting = part_->parting();
  if (part_->all == 0) return 1;
  return static_cast<double>(part_->most_own) * parting.group->size() / static_cast<double>(part_->all);
}

template <class Real>
std::uint64_t SphSolver<Real>::digest() const {
  std::uint64_t digest = digest_of(text_of(options_));
  ParameterBlock values = *values_;
  for (const ParameterRow& row : part_parameters()) values.set(row.name, 0);
  const std::vector<char> numbers = values.template bytes<double>();
  digest = digest_of({numbers.data(), numbers.size()}, digest);
  for (const auto& [name, text] : sources_) digest = digest_of(name + text, digest);
  return digest;
}

#define WAVETANK_PARTS(Real)                                                                           \
  template void SphSolver<Real>::bind_part();                                                          \
  template void SphSolver<Real>::over_own(const BoundSweep&) const;                                    \
  template void SphSolver<Real>::refresh(const char*);                                                 \
  template void SphSolver<Real>::spoil(const char*);                                                   \
  template void SphSolver<Real>::run_with_exchanges();                                                 \
  template void SphSolver<Real>::sort_part();                                                          \
  template std::vector<LeftParticle> SphSolver<Real>::left_of(const WaterPart<Real>::Arrived&) const;  \
  template std::vector<LeftParticle> SphSolver<Real>::gather_left();                                   \
  template void SphSolver<Real>::sort_alone();                                                         \
  template StepReport SphSolver<Real>::watch_parts(const std::vector<Real>&, const std::vector<int>&); \
  template std::vector<int> SphSolver<Real>::in_part(const std::vector<Real>&) const;                  \
  template std::vector<int> SphSolver<Real>::own_points(const std::vector<Eigen::Vector3d>&) const;    \
  template std::vector<int> SphSolver<Real>::places_in_parts(const std::vector<Real>&) const;          \
  template void SphSolver<Real>::set_cuts(const std::vector<int>&);                                    \
  template double SphSolver<Real>::sum_of_parts(double) const;                                         \
  template std::size_t SphSolver<Real>::memory_for(const std::vector<int>&, const std::vector<char>&); \
  template double SphSolver<Real>::imbalance() const;                                                  \
  template std::uint64_t SphSolver<Real>::digest() const;
WAVETANK_PARTS(float)
WAVETANK_PARTS(double)

}  // namespace wavetank
