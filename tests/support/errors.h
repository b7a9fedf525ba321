#pragma once

#include <gtest/gtest.h>

#include <string>

#include "core/support/result.h"

namespace vat::test {

/// Returns "code path" of every error, one per line. Expects a message in each.
inline std::string errors_of(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    EXPECT_FALSE(error.message.empty());
    text += (text.empty() ? "" : "\n") + error.code + ' ' + error.path;
  }
  return text;
}
/// Returns the same for a result or status; empty if it has no error.
template <class Outcome>
std::string errors_of(const Outcome& outcome) {
  return outcome.ok() ? "" : errors_of(outcome.errors());
}

}  // namespace vat::test
