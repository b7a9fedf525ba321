#include "tests/validation/convergence.h"

#include "tests/validation/order.h"

namespace vat::validation {

void add_order_row(Sheet& sheet, const Scene& scene, IntegratorId integrator,
                   const std::vector<Real>& steps, Real time, Real order, const ErrorOf& error_of) {
  Row row{.metric = std::string("order of convergence, ") + to_string(integrator),
          .reference = order,
          .tolerance = within(0.2, "order of the method")};
  std::vector<Real> errors;
  for (const Real step : steps) {
    Run run = sheet.start(with_method(scene, integrator, step));
    run.advance_to(time);
    errors.push_back(error_of(run));
    row.seconds += run.seconds();
    row.state_hash = run.state_hash();
  }
  row.measured = observed_order(steps, errors);
  sheet.add(std::move(row));
}

std::vector<Real> halved(Real longest, int count) {
  std::vector<Real> steps;
  for (int i = 0; i < count; ++i) steps.push_back(longest / static_cast<Real>(1 << i));
  return steps;
}

}  // namespace vat::validation
