#include "wavetank/node/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wavetank {

namespace {

constexpr int bar_width = 30;
constexpr auto redraw_period = std::chrono::milliseconds(200);
constexpr auto line_period = std::chrono::seconds(10);
constexpr auto rate_window = std::chrono::seconds(10);

std::string formatted(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

}  // namespace

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0) return "?";
  if (seconds < 1.0) return formatted("%.0f ms", 1000.0 * seconds);
  if (seconds < 100.0) return formatted("%.1f s", seconds);
  constexpr double year = 365.25 * 86400;
  if (seconds > year) return formatted("%.3g years", seconds / year);
  const long whole = std::lround(seconds);
  char text[64];
  if (whole < 3600)
    std::snprintf(text, sizeof text, "%ld min %02ld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %02ld min", whole / 3600, whole % 3600 / 60);
  return text;
}

Progress::Style Progress::fitting(bool quiet) {
  if (quiet) return Style::silent;
  return isatty(STDOUT_FILENO) == 1 ? Style::bar : Style::lines;
}

Progress::Progress(Style style, double begin, double end) : style_(style), begin_(begin), end_(end) {}

void Progress::starting(const std::string& what, double fraction) { show(what, fraction, ""); }

void Progress::running(double time, std::uint64_t step) {
  const Clock::time_point now = Clock::now();
  if (marks_.empty() || now - marks_.back().wall > redraw_period / 2) marks_.push_back({now, time, step});
  while (marks_.size() > 2 && now - marks_.front().wall > rate_window) marks_.pop_front();
  const Mark& first = marks_.front();
  const double elapsed = std::chrono::duration<double>(now - first.wall).count();
  const double fraction = end_ > begin_ ? std::min(1.0, (time - begin_) / (end_ - begin_)) : 1.0;
  std::string details = formatted("%.4g s", time) + formatted(" of %.4g s", end_);
  if (elapsed > 0 && step > first.step) {
    details += formatted(", %.3g steps/s", static_cast<double>(step - first.step) / elapsed);
    const double rate = (time - first.time) / elapsed;
    if (rate > 0 && fraction < 1.0) details += ", " + duration_text((end_ - time) / rate) + " left";
  }
  show("running", fraction, details);
}

void Progress::show(const std::string& label, double fraction, const std::string& details) {
  if (style_ == Style::silent) return;
  const Clock::time_point now = Clock::now();
  const bool is_new = label != label_;
  const bool is_end = fraction >= 1.0 && shown_fraction_ < 1.0;
  const bool is_due = style_ == Style::bar ? now - shown_at_ >= redraw_period
                                           : now - shown_at_ >= line_period || std::floor(10 * fraction) > std::floor(10 * shown_fraction_);
  if (!is_new && !is_end && !is_due) return;
  label_ = label;
  shown_at_ = now;
  shown_fraction_ = fraction;
  const int percent = static_cast<int>(100.0 * fraction);
  if (style_ == Style::lines) {
    std::printf("%s %3d %%%s%s\n", label.c_str(), percent, details.empty() ? "" : "  ", details.c_str());
  } else {
    const int filled = static_cast<int>(bar_width * fraction);
    std::printf("\r\033[K%s [%s%s] %3d %%  %s", label.c_str(), std::string(filled, '#').c_str(),
                std::string(bar_width - filled, '.').c_str(), percent, details.c_str());
    bar_is_drawn_ = true;
  }
  std::fflush(stdout);
}

void Progress::clear() {
  if (!bar_is_drawn_) return;
  std::fputs("\r\033[K", stdout);
  std::fflush(stdout);
  bar_is_drawn_ = false;
}

}  // namespace wavetank
