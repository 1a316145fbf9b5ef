#pragma once

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "wavetank/common/error.h"
#include "wavetank/scene/case_reader.h"

/// For tests of what is refused: a sound case with one place changed.
namespace wavetank {

struct Fault {
  const char* name;
  const char* from;
  const char* to;
  std::vector<std::string> phrases;  ///< that the message must have
};

inline void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("the sound case has no " + from);
  return text.replace(at, from.size(), to);
}

/// What reading the text as case.yaml is refused with.
inline std::string error_of(const std::string& yaml, const std::vector<Override>& overrides = {}) {
  try {
    read_case_text(yaml, "case.yaml", overrides);
  } catch (const Error& error) {
    return error.what();
  }
  return "(no error)";
}

inline bool contains(const std::string& text, const std::string& phrase) { return text.find(phrase) != std::string::npos; }

inline void expect_refused(const std::string& sound, const Fault& fault) {
  const std::string message = error_of(replaced(sound, fault.from, fault.to));
  for (const std::string& phrase : fault.phrases) EXPECT_TRUE(contains(message, phrase)) << "\"" << phrase << "\" is not in: " << message;
  EXPECT_FALSE(contains(message, "\n")) << message;
}

}  // namespace wavetank
