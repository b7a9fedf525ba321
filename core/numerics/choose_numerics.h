#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// The scene's numerics, with the integrator, step and control for which the relative error of its
/// fastest motion stays below its accuracy during kAccurateRadians. Unchanged if the scene has no
/// accuracy. `samples` are the scene's bodies.
///
/// For an error e per radian, a step is `resolving_phase` / omega (core/numerics/error_model.h), at
/// most 0.9 of the stable step, for the bounds of omega from find_oscillating_parts() and for the
/// central field:
///
/// - If liquids flow or bodies can touch: velocity Verlet, because forces with kinks limit all
///   methods to order 2, in adaptive steps with the tolerance e. The step is the longest that
///   springs and the central field allow, and that is stable for sound.
/// - With an incompressible liquid: the same with symplectic Euler, which this solver requires.
/// - Otherwise fixed steps of velocity Verlet or Runge-Kutta 4, whichever evaluates forces less
///   often: 1 / step or 4 / step. If a material has implicit springs or an elongation limit,
///   velocity Verlet.
///
/// The step is the tick divided by a whole number, which may exceed kMaxStepsPerTick; a scene with
/// such an accuracy is invalid.
Numerics choose_numerics(const Scene& scene, std::span<const SampledBody* const> samples);
inline constexpr Real kAccurateRadians = 100;

/// Replaces the numerics of a valid scene by the chosen ones.
void resolve_accuracy(Scene& scene);

}  // namespace vat
