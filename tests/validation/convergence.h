#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/validation/case.h"

namespace vat::validation {

/// Error of a run at its end.
using ErrorOf = std::function<Real(const Run&)>;

/// Adds one row: the observed order over `steps` of the error at `time`, which must be within 0.2
/// of `order`.
void add_order_row(Sheet& sheet, const Scene& scene, IntegratorId integrator,
                   const std::vector<Real>& steps, Real time, Real order, const ErrorOf& error_of);

/// `longest` and the next `count` - 1 halves of it.
std::vector<Real> halved(Real longest, int count);

}  // namespace vat::validation
