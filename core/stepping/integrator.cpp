#include "core/stepping/integrator.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {
namespace {

constexpr Integrator kIntegrators[] = {
    {IntegratorId::explicit_euler, 0, 0, &take_explicit_euler_step},
    {IntegratorId::symplectic_euler, 1, 0},
    {IntegratorId::velocity_verlet, 0.5, 0.5},
    {IntegratorId::heun, 0, 0, &take_heun_step},
    {IntegratorId::runge_kutta_4, 0, 0, &take_runge_kutta_4_step},
};

}  // namespace

const Integrator& integrator_of(IntegratorId id) {
  const auto* found = std::ranges::find(kIntegrators, id, &Integrator::id);
  VAT_CHECK(found != std::end(kIntegrators));
  return *found;
}

}  // namespace vat
