#pragma once

#include <cstdint>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/support/names.h"
#include "core/types.h"

namespace vat {

/// The solver that conserves the volume of liquids.
enum class PressureSolver : std::uint8_t {
  /// Boldt eq. 14 with the kernels of [MCG03]; bodies and walls push liquids with springs.
  gas,
  /// Weakly compressible, see core/liquid/tait/weakly_compressible.h; bodies and walls take part in
  /// density and pressure.
  tait,
  /// See core/liquid/incompressible/volume_solve.h; bodies and walls take part as in tait.
  incompressible,
};
template <>
inline constexpr std::array kNamesOf<PressureSolver>{"gas", "tait", "incompressible"};

/// The model of surface tension.
enum class SurfaceModel : std::uint8_t {
  curvature,  ///< a force at the surface, see core/liquid/surface/surface_tension.h
  cohesion,   ///< attraction of all pairs, see core/liquid/surface/cohesion.h
};
template <>
inline constexpr std::array kNamesOf<SurfaceModel>{"curvature", "cohesion"};

template <>
inline constexpr std::array kNamesOf<KernelId>{"wendland_c2", "cubic_spline"};
template <>
inline constexpr std::array kNamesOf<PairPrecision>{"single", "double"};

/// Tolerances of the solves of an incompressible liquid: relative changes of density, as means over
/// its particles. For a single particle, the density error may be 36 × density_tolerance, and the
/// density change 200 × divergence_tolerance.
struct IncompressibleSolve {
  Real density_tolerance = 5e-4;     ///< density above that at rest, at the end of a step
  Real divergence_tolerance = 1e-5;  ///< change of density by the velocities within a step
  int most_iterations = 100;         ///< of each linear solve
};

}  // namespace vat
