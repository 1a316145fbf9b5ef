#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <string>

namespace wavetank {

/// Shows on standard output how far a run is: a bar that is redrawn on a terminal, elsewhere a plain line every tenth of the way and at
/// least every ten seconds.
class Progress {
 public:
  enum class Style { silent, lines, bar };
  /// The style that fits standard output.
  static Style fitting(bool quiet);

  /// begin, end: s of simulated time.
  Progress(Style style, double begin, double end);
  ~Progress() { clear(); }

  void starting(const std::string& what, double fraction);  ///< of the start: 0…1
  void running(double time, std::uint64_t step);
  /// Takes the bar off the screen, so that other lines can be printed.
  void clear();
  void set_begin(double begin) { begin_ = begin; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Mark {
    Clock::time_point wall;
    double time;
    std::uint64_t step;
  };
  void show(const std::string& label, double fraction, const std::string& details);

  Style style_;
  double begin_, end_;
  std::deque<Mark> marks_;  ///< of the last seconds, for the rates
  std::string label_;       ///< of what was shown last
  Clock::time_point shown_at_;
  double shown_fraction_ = -1;
  bool bar_is_drawn_ = false;
};

/// "850 ms", "12.3 s", "4 min 10 s", "2 h 05 min", "3.17 years".
std::string duration_text(double seconds);

}  // namespace wavetank
