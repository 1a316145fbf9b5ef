#pragma once

#include <functional>
#include <string>

namespace wavetank {

enum class LogLevel { info, warning, error };

/// Receives one line of text, without a newline. May be called from any thread, and from several at
/// once.
using LogSink = std::function<void(LogLevel level, const std::string& line)>;

/// Replaces the sink of the whole process; the default writes to standard error. Programs set it once, before anything else runs.
void set_log_sink(LogSink sink);

/// The line goes to the sink as visible_lines has it: a name in it may hold what a terminal obeys.
void log(LogLevel level, const std::string& line);

}  // namespace wavetank
