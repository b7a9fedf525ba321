#pragma once

#include <string>

#include "core/stepping/control/step_control.h"

namespace vat {

/// Chooses the levels of local step control for a step of `dt` [s]. A particle of level l takes
/// steps of dt / 2^l; a finer level is a higher level. All particles of a rigid body have the
/// finest level that any particle of the body needs. The levels of particles joined by a spring
/// differ by at most kMaxLevelDifference (after T. R. Saitoh, J. Makino, Astrophys. J. Lett. 697
/// (2009) L99, with a difference of 2). For springs in equilibrium between particles of different
/// levels, a difference of 1 has a quarter of the error of 2 for a third more work. Particles that
/// do not move have level 0.
void choose_local_levels(const Model& model, const PresentSteps& steps, Real dt,
                         LocalLevels& levels);
inline constexpr int kMaxLevelDifference = 1;

/// Returns a line for each deformable and rigid body with the number of parts of a step that its
/// springs and its description require. Contacts and fast motion may require more. Returns an empty
/// text for other controls.
std::string describe_sub_steps(const Model& model);

}  // namespace vat
