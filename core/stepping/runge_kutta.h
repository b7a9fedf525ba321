#pragma once

#include <span>

#include "core/scene/numerics.h"
#include "core/types.h"

namespace vat {

/// Stage s of an explicit Runge-Kutta method is evaluated at y_0 + dt * reach * k_{s-1}, and has
/// the weight `weight` in the step.
struct RungeKuttaStage {
  Real reach;
  Real weight;
};

/// Returns the stages of an integrator; empty for those that consist of kicks and a drift.
std::span<const RungeKuttaStage> runge_kutta_stages(IntegratorId id);

}  // namespace vat
