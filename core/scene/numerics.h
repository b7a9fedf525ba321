#pragma once

#include <cstdint>
#include <optional>

#include "core/support/names.h"
#include "core/types.h"

namespace vat {

enum class IntegratorId : std::uint8_t {
  explicit_euler,
  symplectic_euler,
  velocity_verlet,
  heun,
  runge_kutta_4,
};
template <>
inline constexpr std::array kNamesOf<IntegratorId>{"explicit_euler", "symplectic_euler",
                                                   "velocity_verlet", "heun", "runge_kutta_4"};

/// The choice of step lengths; see core/stepping/step_control.h.
enum class StepControl : std::uint8_t {
  fixed,     ///< every step has the length of the scene's step
  adaptive,  ///< the step of the whole scene is halved as often as the fastest process needs
  local,     ///< each particle has its own step, the scene's step over a power of two
};
template <>
inline constexpr std::array kNamesOf<StepControl>{"fixed", "adaptive", "local"};

/// Integrator and time steps. `tick` is the interval at which a server applies commands and
/// publishes frames. It is a whole number of steps.
struct Numerics {
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real step = 1e-3;  ///< dt [s]; the longest step with step control
  Real tick = 0.02;  ///< [s]
  StepControl control = StepControl::fixed;
  /// With step control: the relative phase error per radian of the motion that steps resolve.
  Real tolerance = 0.01;
  /// The relative error by which integrator, step, control and tolerance are chosen, in place of
  /// the values above; see core/numerics/choose_numerics.h.
  std::optional<Real> accuracy{};
};

}  // namespace vat
