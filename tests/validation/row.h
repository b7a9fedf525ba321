#pragma once

#include <cstdint>
#include <string>

#include "core/types.h"

namespace vat::validation {

/// How far a measured value may be from its reference.
struct Tolerance {
  enum class Kind {
    absolute,  ///< |measured - reference| <= value
    relative,  ///< |measured - reference| <= value |reference|
    at_most,   ///< measured <= reference
    at_least,  ///< measured >= reference
    reported,  ///< any number: where the method itself is the limit, it is shown, not judged
  };
  Kind kind = Kind::absolute;
  Real value = 0;      ///< unused by at_most, at_least and reported
  std::string source;  ///< the theory or publication that it comes from; of reported, the cause
};

Tolerance within(Real value, std::string source);
Tolerance within_relative(Real value, std::string source);
/// The reference is itself the bound.
Tolerance at_most(std::string source);
Tolerance at_least(std::string source);
/// `cause`: why the reference is not reached.
Tolerance reported(std::string cause);

/// One line of the validation table.
struct Row {
  std::string metric;  ///< what was measured, with its unit
  Real reference = 0;
  Real measured = 0;
  Tolerance tolerance;
  std::uint64_t state_hash = 0;  ///< at the end of the last run that `measured` came from
  double seconds = 0;            ///< wall time of those runs

  /// False for values that are not numbers.
  bool passed() const;
};

}  // namespace vat::validation
