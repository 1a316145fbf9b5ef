#pragma once

#include <gtest/gtest.h>

#include <string>

#include "wavetank/common/error.h"

namespace wavetank {

/// What the Error says that `call` throws; empty, and a failed test, if it throws none.
template <class Call>
std::string error_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

}  // namespace wavetank
