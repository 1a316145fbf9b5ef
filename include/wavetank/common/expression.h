#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

namespace wavetank {

/// A number as a function of a place or of time or of both, given as text: of x, y and z (on a plan x and y alone), of t, or of all four,
/// with + − * / ^, comparisons, `? :`, pi, and sin, cos, tan, exp, ln, log10, sqrt, abs, min, max and the like (muparser's). Not to be
/// shared between threads.
class Expression {
 public:
  enum class Of { place, plan, time, time_and_place };

  /// Throws Error, which says what is wrong and at which character, for text that is none.
  explicit Expression(const std::string& text, Of of = Of::place);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// At a place, m. Not finite where the expression is not.
  double at(const Eigen::Vector3d& place) const;
  /// At a time, s; likewise.
  double at(double time) const;
  double at(double time, const Eigen::Vector3d& place) const;
  /// Whether x, y or z is in it.
  bool depends_on_place() const;
  /// What it may be of, for messages.
  static const char* variables(Of of);

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace wavetank
