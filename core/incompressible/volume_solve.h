#pragma once

#include "core/incompressible/complementarity.h"
#include "core/incompressible/pressure_response.h"
#include "core/step/force_model.h"

namespace vat {

/// Kept between steps, so that a steady one allocates nothing.
struct VolumeScratch {
  PressurePairs pairs;
  ResponseScratch response;
  Complementarity problem;
  std::vector<Real> relative_density;  ///< by slot
  std::vector<Real> start;             ///< by slot: the pressure that the velocities have seen
};

/// The pressure that the last step ended with.
void recall_pressure(StepContext& context);

/// Makes the velocities at the end of a step of `dt` from `time`, with the places at its start,
/// those of an incompressible liquid, and moves particles that are too close apart: the
/// divergence-free and the constant-density solve of J. Bender and D. Koschier (IEEE Trans. Vis.
/// Comput. Graph. 23 (2017) 1193), both within the step and unilateral, for the liquid may come
/// apart.
///
/// With s = rho / rho_0 and the rate D of PressureResponse, impulses dt F(p), p >= 0, change the
/// velocities of liquid and solids until dt D_i(v) <= max(0, 1 - s_i) / 2: what is dense enough is
/// not compressed, what is not closes half of its gap. Those of the last step are part of the
/// forces already; only the difference is solved for. Then shifts of the liquid bring
/// s_i + dt D_i(v) + D_i(shift) <= 1. They leave velocities alone (as in X. Y. Hu, N. A. Adams, J.
/// Comput. Phys. 227 (2007) 264), so that places that are too dense give no energy: what overlaps
/// at a start makes room, and does not explode.
VolumeReport keep_volume(const ForceModel& force_model, Configuration& now, Real time, Real dt,
                         VolumeScratch& scratch);

}  // namespace vat
