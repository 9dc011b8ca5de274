// What a program says when something is wrong.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::testing {

/// The text of the Error that `action` throws, of whom `fault` says has to act.
inline std::string error_text(Fault fault, const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault);
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace stillpoint::testing
