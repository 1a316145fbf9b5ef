#include "wavetank/common/log.h"

#include <cstdio>
#include <mutex>
#include <utility>

#include "wavetank/common/visible_text.h"

namespace wavetank {
namespace {

std::mutex mutex;

LogSink& sink() {
  static LogSink current = [](LogLevel level, const std::string& line) {
    const char* prefix = level == LogLevel::info ? "" : level == LogLevel::warning ? "warning: " : "error: ";
    std::fprintf(stderr, "%s%s\n", prefix, line.c_str());
  };
  return current;
}

}  // namespace

void set_log_sink(LogSink replacement) {
  const std::lock_guard<std::mutex> lock(mutex);
  sink() = std::move(replacement);
}

void log(LogLevel level, const std::string& line) {
  LogSink current;  // called without the lock: it may log itself, or wait for somebody who does
  {
    const std::lock_guard<std::mutex> lock(mutex);
    current = sink();
  }
  if (current) current(level, visible_lines(line));
}

}  // namespace wavetank
