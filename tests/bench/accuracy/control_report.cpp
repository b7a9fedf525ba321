#include "tests/bench/accuracy/control_report.h"

#include <cmath>
#include <limits>

namespace vat::bench {

namespace {

/// Solutions with an error above the size of the problem do not converge yet.
bool is_converging(const Solution& solution) {
  return solution.failure.empty() && solution.error <= 1;
}

/// Returns the cost at which the line between two solutions reaches `error`, which is between their
/// errors.
double cost_between(const Solution& coarse, const Solution& fine, Real error,
                    double (*cost)(const Solution&)) {
  const double share = std::log(error / coarse.error) / std::log(fine.error / coarse.error);
  return cost(coarse) * std::pow(cost(fine) / cost(coarse), share);
}

std::optional<Price> price_of(const std::vector<Solution>& solutions, const Method& method,
                              Real error, double (*cost)(const Solution&)) {
  const Solution* coarsest = nullptr;
  for (auto at = solutions.rbegin(); at != solutions.rend(); ++at) {
    const Solution& solution = *at;
    if (name_of(solution.method) != name_of(method)) continue;
    if (is_converging(solution) && solution.error <= error) {
      coarsest = &solution;
      continue;
    }
    if (coarsest == nullptr) return {};
    if (!is_converging(solution) || coarsest->error <= 0) break;
    return Price{method, cost_between(solution, *coarsest, error, cost)};
  }
  if (coarsest == nullptr) return {};
  return Price{method, cost(*coarsest)};
}

double ratio(const std::optional<Price>& price, const std::optional<Price>& fixed) {
  return price && fixed ? price->cost / fixed->cost : kAbsent;
}

std::string name_or_none(const std::optional<Price>& price) {
  return price ? to_string(price->method.integrator) : "none reaches it";
}

}  // namespace

std::optional<Price> least_price(const std::vector<Solution>& solutions, StepControl control,
                                 Real error, double (*cost)(const Solution&)) {
  std::optional<Price> least;
  for (const Method& method : all_methods()) {
    if (method.control != control) continue;
    const std::optional<Price> price = price_of(solutions, method, error, cost);
    if (price && (!least || price->cost < least->cost)) least = price;
  }
  return least;
}

Table control_table(const std::vector<ProblemResult>& results) {
  Table table{
      {"case", "error at most", "best fixed", "its evaluations per particle", "best adaptive",
       "evaluations / fixed", "time / fixed", "local: evaluations / fixed", "local: time / fixed"},
      {}};
  for (const ProblemResult& result : results) {
    for (const Real error : kTargetErrors) {
      const auto price = [&](StepControl control, double (*cost)(const Solution&)) {
        return least_price(result.solutions, control, error, cost);
      };
      const auto fixed = price(StepControl::fixed, evaluations_of);
      const auto fixed_time = price(StepControl::fixed, seconds_of);
      const auto adaptive = price(StepControl::adaptive, evaluations_of);
      table.rows.push_back({result.name, error, name_or_none(fixed), fixed ? fixed->cost : kAbsent,
                            name_or_none(adaptive), ratio(adaptive, fixed),
                            ratio(price(StepControl::adaptive, seconds_of), fixed_time),
                            ratio(price(StepControl::local, evaluations_of), fixed),
                            ratio(price(StepControl::local, seconds_of), fixed_time)});
    }
  }
  return table;
}

}  // namespace vat::bench
