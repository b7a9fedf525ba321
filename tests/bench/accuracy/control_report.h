#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/bench/accuracy/accuracy_report.h"

namespace vat::bench {

/// The target errors of the tables.
inline constexpr std::array<Real, 5> kTargetErrors = {5e-2, 1e-2, 1e-3, 1e-4, 1e-6};

/// A method and its cost for an error.
struct Price {
  Method method{};
  double cost = 0;
};

/// Returns the least cost of a step control for `error`, with the cheapest integrator. The cost is
/// that of the coarsest solution that has this error with all finer ones. It may be interpolated
/// between this solution and the next coarser one, linearly in logarithms. Returns no value if no
/// solution has this error.
std::optional<Price> least_price(const std::vector<Solution>& solutions, StepControl control,
                                 Real error, double (*cost)(const Solution&));

/// Returns the cost of adaptive and local control relative to fixed steps, for each problem and
/// target error.
Table control_table(const std::vector<ProblemResult>& results);

}  // namespace vat::bench
