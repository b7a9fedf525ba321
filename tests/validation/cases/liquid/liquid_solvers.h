#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"
#include "tests/validation/cases/liquid/liquid_dam_break.h"
#include "tests/validation/run.h"

/// Problems that pressure solvers with walls of their own, tait and incompressible, are compared
/// on.
namespace vat::validation {

/// Particles that are too dense, over a run.
struct DensityError {
  Real mean = 0;  ///< over particles and times
  Real greatest = 0;
  int samples = 0;

  void add(const Diagnostics& now);
};

/// A run of one of the solvers, and how dense its liquid became.
struct SolverRun {
  Run run;
  DensityError density;
};

/// A dam break (LIQ-15) of columns `layers` particles wide.
struct DamBreakRun : SolverRun {
  DamBreak seen;
};
DamBreakRun run_dam_break(PressureSolver solver, int layers, TaskRunner* runner);

/// A column at rest (LIQ-3), `layers` high: its particles' heights and pressures, means over the
/// last of three seconds.
struct ColumnRun : SolverRun {
  std::vector<Real> heights;    ///< [m]
  std::vector<Real> pressures;  ///< [Pa]

  /// Relative L2 distance of the pressures from those of water.
  Real pressure_error() const;
  /// The greatest speed at the end, over sqrt(g H).
  Real residual_speed() const;
};
ColumnRun run_column(PressureSolver solver, int layers, TaskRunner* runner);

}  // namespace vat::validation
