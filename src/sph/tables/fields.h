#pragma once

#include <string>
#include <vector>

namespace wavetank {

/// Arrays of values of the particles, which have their fields one after the other, so many values apart as there is room for particles.
enum class ParticleArray { state, rates, sums };

/// A field of one of them, and what is to be known of it.
struct FieldRow {
  /// How a field of the state changes in time. One that has a rate has it among the rates, and a sum of rates among the sums, under its
  /// name.
  enum class Evolution {
    none,       ///< it follows from others, or stays, or integrators know it by name
    conjugate,  ///< by its rate; the symplectic scheme has it at the middle of a step as it has positions
    follower    ///< by its rate, which no other rate needs to know to second order
  };

  ParticleArray array = ParticleArray::state;
  std::vector<std::string> components;  ///< their names: one, or those of a vector. Kernels have them as FIELD_, RATE_, SUM_ and the name.
  std::string unit;                     ///< "" of what has none
  std::string meaning;
  bool is_saved = false;  ///< in snapshots, because nothing else tells it at a step's end
  Evolution evolution = Evolution::none;
};

/// Those of a case: of the particles' state, the rates of change and the integrators' sums of these.
class FieldTable {
 public:
  /// Adds the rates and sums of what evolves. Throws Error if two components of an array have one name.
  explicit FieldTable(std::vector<FieldRow> rows);

  bool has(ParticleArray array, const std::string& component) const;
  /// The place of a component in its array; throws Error for one that there is not.
  int at(ParticleArray array, const std::string& component) const;
  /// Components of an array.
  int count(ParticleArray array) const { return static_cast<int>(names(array).size()); }
  const std::vector<FieldRow>& rows() const { return rows_; }
  /// The device's names for the places, and what does a thing for each field that evolves: EACH_CONJUGATE(DO), EACH_FOLLOWER(DO).
  std::string header() const;

 private:
  /// A macro that does a thing for each field that evolves so.
  std::string each_of(FieldRow::Evolution evolution, const std::string& macro) const;
  const std::vector<std::string>& names(ParticleArray array) const { return names_[static_cast<int>(array)]; }

  std::vector<FieldRow> rows_;
  std::vector<std::string> names_[3];
};

/// Those that every case has.
const std::vector<FieldRow>& common_fields();

}  // namespace wavetank
