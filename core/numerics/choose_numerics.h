#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// Returns the numerics of the scene, with a chosen integrator, step and step control. The relative
/// error of the fastest motion stays below the accuracy of the scene during kAccurateRadians.
/// Numerics of a scene without an accuracy are unchanged. `samples` are the bodies of the scene.
///
/// For an error e per radian, the step is `resolving_phase` / omega (core/numerics/error_model.h),
/// but at most 0.9 of the stable step. The bounds of omega include those of
/// find_oscillating_parts() and that of the central field:
///
/// - If liquids flow or bodies can touch: velocity Verlet with adaptive steps and the tolerance e.
///   Forces with kinks limit all methods to order 2. The step is the longest that springs, the
///   central field and the stability of sound allow.
/// - With an incompressible liquid: the same with symplectic Euler, which this solver requires.
/// - Otherwise: fixed steps of the method that needs fewer force evaluations per time. Velocity
///   Verlet needs 1 / step, and Runge-Kutta 4 needs 4 / step. Implicit springs or an elongation
///   limit require velocity Verlet.
///
/// The step is the tick divided by an integer. If the integer exceeds kMaxStepsPerTick, the scene
/// is invalid.
Numerics choose_numerics(const Scene& scene, std::span<const SampledBody* const> samples);
inline constexpr Real kAccurateRadians = 100;

/// Replaces the numerics of a valid scene by the result of choose_numerics().
void resolve_accuracy(Scene& scene);

}  // namespace vat
