#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/scene/scene.h"
#include "tests/validation/cases/liquid/liquid_dam_break.h"
#include "tests/validation/run.h"

/// Problems for the comparison of pressure solvers with their own wall treatment, tait and
/// incompressible.
namespace vat::validation {

/// Density excess of the particles during a run.
struct DensityError {
  Real mean = 0;  ///< mean over particles and times
  Real greatest = 0;
  int samples = 0;

  void add(const Diagnostics& now);
};

/// Starts a run of a scene.
using StartRun = std::function<Run(const Scene&)>;

/// A run with one solver, and its density errors.
struct SolverRun {
  Run run;
  DensityError density;
};

/// A dam break (LIQ-15). The column is `layers` particles wide.
struct DamBreakRun : SolverRun {
  DamBreak seen;
};
DamBreakRun run_dam_break(PressureSolver solver, int layers, const StartRun& start);

/// A column at rest (LIQ-3), `layers` particles high. Heights and pressures of its particles are
/// means over the last of three seconds.
struct ColumnRun : SolverRun {
  std::vector<Real> heights;    ///< [m]
  std::vector<Real> pressures;  ///< [Pa]

  /// Returns the relative L2 distance between the pressures and hydrostatic pressures.
  Real pressure_error() const;
  /// Returns the maximum speed at the end, divided by sqrt(g H).
  Real residual_speed() const;
};
ColumnRun run_column(PressureSolver solver, int layers, const StartRun& start);

}  // namespace vat::validation
