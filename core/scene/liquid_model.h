#pragma once

#include <cstdint>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/support/names.h"
#include "core/types.h"

namespace vat {

/// Solver that computes the pressure of liquids.
enum class PressureSolver : std::uint8_t {
  /// Boldt eq. 14 with the kernels of [MCG03]. Bodies and walls exert spring forces on liquids.
  gas,
  /// Weakly compressible; see core/liquid/tait/weakly_compressible.h. Bodies and walls contribute
  /// to density and pressure.
  tait,
  /// Incompressible; see core/liquid/incompressible/volume_solve.h. Bodies and walls contribute as
  /// in tait.
  incompressible,
};
template <>
inline constexpr std::array kNamesOf<PressureSolver>{"gas", "tait", "incompressible"};

/// Model of surface tension.
enum class SurfaceModel : std::uint8_t {
  curvature,  ///< force at the surface; see core/liquid/surface/surface_tension.h
  cohesion,   ///< attraction of all pairs; see core/liquid/surface/cohesion.h
};
template <>
inline constexpr std::array kNamesOf<SurfaceModel>{"curvature", "cohesion"};

template <>
inline constexpr std::array kNamesOf<KernelId>{"wendland_c2", "cubic_spline"};
template <>
inline constexpr std::array kNamesOf<PairPrecision>{"single", "double"};

/// Tolerances of the linear solves of an incompressible liquid. Each tolerance is a relative change
/// of density, averaged over the particles. The density error of a single particle may be 36 ×
/// density_tolerance. The density change of a single particle may be 200 × divergence_tolerance.
struct IncompressibleSolve {
  Real density_tolerance = 5e-4;     ///< excess over the rest density at the end of a step
  Real divergence_tolerance = 1e-5;  ///< density change in a step due to the velocities
  int most_iterations = 100;         ///< maximum number of iterations of each linear solve
};

}  // namespace vat
