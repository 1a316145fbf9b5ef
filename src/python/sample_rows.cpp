#include "sample_rows.h"

#include <utility>

namespace wavetank {
namespace {

/// Puts numbers into a row.
class RowWriter {
 public:
  explicit RowWriter(std::vector<double>& row) : row_(row) {}
  void put(double value) { row_.push_back(value); }
  void put(const Vector3d& vector) { row_.insert(row_.end(), vector.data(), vector.data() + 3); }
  void put(const Quaterniond& turn) { row_.insert(row_.end(), turn.coeffs().data(), turn.coeffs().data() + 4); }

 private:
  std::vector<double>& row_;
};

/// m, of an owner's frame, as the case's geometry has it: a body's reference point, for the tank the case's origin.
Vector3d origin_of(const RigidWorld& world, std::size_t owner) { return owner == 0 ? Vector3d(Vector3d::Zero()) : world.reference(owner); }

/// `to_reference`: from the frame's origin to the point that the wrench is about, m.
void put_wrench(const Wrench& wrench, const Vector3d& to_reference, RowWriter& row) {
  const auto put_part = [&](bool pressure, bool viscous) {
    Vector3d force = Vector3d::Zero();
    Vector3d torque = Vector3d::Zero();
    if (pressure) {
      force += wrench.pressure_force;
      torque += wrench.pressure_torque;
    }
    if (viscous) {
      force += wrench.viscous_force;
      torque += wrench.viscous_torque;
    }
    torque += to_reference.cross(force);
    row.put(force);
    row.put(torque);
  };
  put_part(true, true);
  put_part(true, false);
  put_part(false, true);
}

void put_pose(const RigidState& state, const Vector3d& origin, const Vector3d& reference, RowWriter& row) {
  const Vector3d position = state.moved(origin, reference);
  const Quaterniond into_body = state.orientation.conjugate();
  row.put(position);
  row.put(state.orientation);
  row.put(Vector3d(into_body * state.velocity_at(position)));
  row.put(Vector3d(into_body * state.angular_velocity));
}

}  // namespace

template <class Sample, class Fill>
void SampleRows::add_kind(const std::string& kind, const std::vector<Sample>& samples, Fill fill) {
  if (samples.empty()) return;
  Rows& rows = rows_[kind];
  for (const Sample& sample : samples) {
    const std::size_t before = rows.values.size();
    RowWriter row(rows.values);
    fill(sample, row);
    rows.times.push_back(sample.time);
    rows.width = rows.values.size() - before;
  }
  Rows& newest = newest_[kind];
  newest.width = rows.width;
  newest.times.assign(1, rows.times.back());
  newest.values.assign(rows.values.end() - static_cast<std::ptrdiff_t>(rows.width), rows.values.end());
}

void SampleRows::add(const Samples& samples) {
  const auto put_all = [](const auto& values, RowWriter& row) {
    for (const auto& value : values) row.put(value);
  };
  add_kind("pressures", samples.pressures, [&](const PressureSample& sample, RowWriter& row) { put_all(sample.pressures, row); });
  add_kind("levels", samples.levels, [&](const LevelSample& sample, RowWriter& row) { put_all(sample.levels, row); });
  add_kind("wrenches", samples.wrenches, [&](const WrenchSample& sample, RowWriter& row) {
    for (std::size_t owner = 0; owner < sample.wrenches.size(); ++owner)
      put_wrench(sample.wrenches[owner], world_.reference(owner) - origin_of(world_, owner), row);
  });
  add_kind("poses", samples.poses, [&](const PoseSample& sample, RowWriter& row) {
    for (std::size_t owner = 0; owner < sample.states.size(); ++owner)
      put_pose(sample.states[owner], origin_of(world_, owner), world_.reference(owner), row);
  });
  add_kind("joints", samples.poses, [](const PoseSample& sample, RowWriter& row) {
    for (const JointState& joint : sample.joints) {
      row.put(joint.position);
      row.put(joint.velocity);
      row.put(joint.effort);
    }
  });
  add_kind("flows", samples.flows, [](const FlowSample& sample, RowWriter& row) {
    for (const FlowAtOpening& flow : sample.flows) {
      row.put(flow.discharge);
      row.put(flow.volume);
    }
  });
  add_kind("velocities", samples.velocities, [&](const VelocitySample& sample, RowWriter& row) { put_all(sample.velocities, row); });
  add_kind("sections", samples.sections, [](const SectionSample& sample, RowWriter& row) {
    for (const FlowThroughSection& flow : sample.flows) {
      row.put(flow.discharge);
      row.put(flow.area);
    }
  });
  add_kind("imus", samples.imus, [](const ImuSample& sample, RowWriter& row) {
    for (const ImuReading& reading : sample.readings) {
      row.put(reading.orientation);
      row.put(reading.angular_velocity);
      row.put(reading.specific_force);
    }
  });
  add_kind("moorings", samples.moorings, [](const MooringSample& sample, RowWriter& row) {
    for (const MooringState& mooring : sample.moorings) {
      row.put(mooring.tension);
      row.put(mooring.anchor_tension);
      row.put(mooring.lying);
    }
  });
  add_kind("energies", samples.energies, [](const EnergySample& sample, RowWriter& row) {
    row.put(sample.kinetic);
    row.put(sample.potential);
    row.put(sample.compression);
    row.put(sample.mass);
    row.put(sample.damper_power);
  });
}

std::map<std::string, Rows> SampleRows::take() { return std::exchange(rows_, {}); }

void SampleRows::clear() {
  rows_.clear();
  newest_.clear();
}

}  // namespace wavetank
