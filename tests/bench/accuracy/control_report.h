#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/bench/accuracy/accuracy_report.h"

namespace vat::bench {

/// The errors that the tables ask for.
inline constexpr std::array<Real, 5> kTargetErrors = {5e-2, 1e-2, 1e-3, 1e-4, 1e-6};

/// A method and what it needs for an error.
struct Price {
  Method method{};
  double cost = 0;
};

/// The least cost at which a step control keeps `error`, by whichever integrator needs least: at
/// the coarsest solution that keeps it with all finer ones, or between that one and the next
/// coarser, where a straight line in logarithms reaches `error`. Nothing where none keeps it.
std::optional<Price> least_price(const std::vector<Solution>& solutions, StepControl control,
                                 Real error, double (*cost)(const Solution&));

/// For each problem and target error what adaptive and local control need against fixed steps.
Table control_table(const std::vector<ProblemResult>& results);

}  // namespace vat::bench
