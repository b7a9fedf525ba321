#include "core/numerics/error_model.h"

#include <cmath>

#include "core/support/check.h"

namespace vat {

Real resolving_phase(IntegratorId integrator, Real error) {
  switch (integrator) {
    case IntegratorId::explicit_euler:
    case IntegratorId::symplectic_euler:
      return 2 * error;
    case IntegratorId::velocity_verlet:
      return std::sqrt(24 * error);
    case IntegratorId::heun:
      return std::sqrt(6 * error);
    case IntegratorId::runge_kutta_4:
      return std::sqrt(std::sqrt(120 * error));
  }
  VAT_CHECK(false && "not an integrator");
  return 0;
}

Real resolving_phase_of_places(const Numerics& numerics) {
  const bool is_euler = numerics.integrator == IntegratorId::symplectic_euler;
  return resolving_phase(is_euler ? IntegratorId::velocity_verlet : numerics.integrator,
                         numerics.tolerance);
}

bool estimates_errors(const Numerics& numerics) {
  return numerics.control == StepControl::adaptive &&
         numerics.integrator != IntegratorId::explicit_euler &&
         numerics.integrator != IntegratorId::symplectic_euler;
}

}  // namespace vat
