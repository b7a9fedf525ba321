#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// The scene's numerics with integrator, step and control that keep the relative error of its
/// fastest motion below its accuracy for kAccurateRadians; as they are where it asks for none.
/// `samples` are the scene's bodies.
///
/// With an error e per radian a step is `resolving_phase` / omega (core/numerics/error_model.h), at
/// most 0.9 of the stable one, for the bounds of omega of find_oscillating_parts() and for the
/// central field:
///
/// - Where liquids flow or bodies may touch: velocity Verlet, since forces with kinks are of order
///   2 with any method, in adaptive steps with the tolerance e; the step is the longest that
///   springs and the central field allow, and that is stable for sound.
/// - With an incompressible liquid: symplectic Euler, the only one to drive it, in the same way.
/// - Elsewhere fixed steps, of velocity Verlet or of Runge-Kutta 4, whichever evaluates forces less
///   often: 1 / step against 4 / step. Where a material has implicit springs or an
///   elongation limit, always the former.
///
/// The step is the tick over a whole number, which may be above kMaxStepsPerTick; a scene with such
/// an accuracy is not valid.
Numerics choose_numerics(const Scene& scene, std::span<const SampledBody* const> samples);
inline constexpr Real kAccurateRadians = 100;

/// Replaces the numerics of a valid scene by those chosen.
void resolve_accuracy(Scene& scene);

}  // namespace vat
