#pragma once

#include <cstdint>
#include <string>

#include "core/types.h"

namespace vat::validation {

/// The permitted difference between a measured value and its reference.
struct Tolerance {
  enum class Kind {
    absolute,  ///< |measured - reference| <= value
    relative,  ///< |measured - reference| <= value |reference|
    at_most,   ///< measured <= reference
    at_least,  ///< measured >= reference
    reported,  ///< any number: the method itself is the limit, so the value is shown, not compared
  };
  Kind kind = Kind::absolute;
  Real value = 0;      ///< unused by at_most, at_least and reported
  std::string source;  ///< theory or publication; for `reported`, the cause
};

Tolerance within(Real value, std::string source);
Tolerance within_relative(Real value, std::string source);
/// Returns a tolerance in which the reference itself is the bound.
Tolerance at_most(std::string source);
Tolerance at_least(std::string source);
/// `cause` states why the reference is not reached.
Tolerance reported(std::string cause);

/// One line of the validation table.
struct Row {
  std::string metric;  ///< measured quantity with its unit
  Real reference = 0;
  Real measured = 0;
  Tolerance tolerance;
  std::uint64_t state_hash = 0;  ///< at the end of the last run of `measured`
  double seconds = 0;            ///< wall time of these runs
  std::string refusal{};         ///< DeviceUse::reason() of these runs; empty without a device

  /// Returns false for values that are not numbers.
  bool passed() const;
};

}  // namespace vat::validation
