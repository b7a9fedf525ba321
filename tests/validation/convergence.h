#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/validation/case.h"

namespace vat::validation {

/// Error of a run at its end.
using ErrorOf = std::function<Real(const Run&)>;

/// Adds a row with the observed order of the error at `time` over `steps`. It must be within 0.2 of
/// `order`.
void add_order_row(Sheet& sheet, const Scene& scene, IntegratorId integrator,
                   const std::vector<Real>& steps, Real time, Real order, const ErrorOf& error_of);

/// Returns `longest` and its next `count` - 1 halves.
std::vector<Real> halved(Real longest, int count);

}  // namespace vat::validation
