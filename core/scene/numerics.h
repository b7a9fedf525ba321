#pragma once

#include <cstdint>
#include <optional>

#include "core/scene/device_choice.h"
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

/// Method that chooses step lengths; see core/stepping/control/step_control.h.
enum class StepControl : std::uint8_t {
  fixed,  ///< every step has the nominal length
  /// The step of the whole scene is halved as often as its fastest process requires.
  adaptive,
  local,  ///< each particle has a separate step: nominal step / power of two
};
template <>
inline constexpr std::array kNamesOf<StepControl>{"fixed", "adaptive", "local"};

/// Integrator and time steps. `tick` is the interval at which a server executes commands and
/// publishes frames. A tick is an integer number of steps.
struct Numerics {
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real step = 1e-3;  ///< nominal step dt [s]; the longest step if steps vary
  Real tick = 0.02;  ///< [s]
  StepControl control = StepControl::fixed;
  /// Relative phase error per radian of the motion that steps resolve. Used for adaptive and local
  /// steps.
  Real tolerance = 0.01;
  /// Relative error for which integrator, step, control and tolerance are chosen, in place of the
  /// values above; see core/numerics/choose_numerics.h.
  std::optional<Real> accuracy{};
  /// Device of the steps, which Simulation::set_engine() sets; absent: the CPU.
  std::optional<DeviceChoice> device{};
};

}  // namespace vat
