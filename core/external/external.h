#pragma once

namespace vat {

struct StepContext;

/// Stage: starts every particle's force with gravity (Boldt eq. 4) and the central field, and adds
/// what users apply.
void set_external_forces(StepContext& context);

}  // namespace vat
