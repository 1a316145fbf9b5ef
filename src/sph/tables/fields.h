#pragma once

#include <string>
#include <vector>

namespace wavetank {

/// Arrays of values of the particles, which have their fields one after the other, so many values apart as there is room for particles.
enum class ParticleArray { state, rates, sums };

/// A field of one of them, and what is to be known of it.
struct FieldRow {
  ParticleArray array = ParticleArray::state;
  std::vector<std::string> components;  ///< their names: one, or those of a vector. Kernels have them as FIELD_, RATE_, SUM_ and the name.
  std::string unit;                     ///< "" of what has none
  std::string meaning;
  bool is_saved = false;  ///< in snapshots, because nothing else tells it at a step's end
};

/// Those of a case: of the particles' state, the rates of change and the integrators' sums of these.
class FieldTable {
 public:
  /// Throws Error if two components of an array have one name.
  explicit FieldTable(std::vector<FieldRow> rows);

  /// The place of a component in its array; throws Error for one that there is not.
  int at(ParticleArray array, const std::string& component) const;
  /// Components of an array.
  int count(ParticleArray array) const { return static_cast<int>(names(array).size()); }
  const std::vector<FieldRow>& rows() const { return rows_; }
  /// The device's names for the places.
  std::string header() const;

 private:
  const std::vector<std::string>& names(ParticleArray array) const { return names_[static_cast<int>(array)]; }

  std::vector<FieldRow> rows_;
  std::vector<std::string> names_[3];
};

/// Those that every case has.
const std::vector<FieldRow>& common_fields();

}  // namespace wavetank
