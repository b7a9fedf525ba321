#pragma once

#include "core/stepping/step_control.h"

namespace vat {

/// The levels that the steps of local control start with, in parts of `dt`: a particle of level l
/// takes steps of dt / 2^l. Those of a rigid body have one level, the finest that any asks for;
/// neighbours along springs differ by at most kMaxLevelDifference (after T. R. Saitoh, J. Makino,
/// Astrophys. J. Lett. 697 (2009) L99, who allow 2: where springs of different levels balance each
/// other, 1 has a quarter of the error for a third more work), and what does not move has level 0.
void choose_local_levels(const Model& model, const PresentSteps& steps, Real dt,
                         LocalLevels& levels);
inline constexpr int kMaxLevelDifference = 1;

}  // namespace vat
