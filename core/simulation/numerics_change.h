#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace vat {

/// Change of the numerics of a running simulation. Absent values are unchanged.
struct NumericsChange {
  std::optional<IntegratorId> integrator{};
  std::optional<Real> step{};  ///< nominal step [s]
  std::optional<StepControl> control{};
  std::optional<Real> tolerance{};             ///< see Numerics
  std::optional<Real> density_tolerance{};     ///< see IncompressibleSolve
  std::optional<Real> divergence_tolerance{};  ///< see IncompressibleSolve

  bool operator==(const NumericsChange&) const = default;
};

/// Returns the scene after the change. The scene has no accuracy.
Scene with_change(Scene scene, const NumericsChange& change);

/// Returns whether the scene has the values that are present. Steps are equal if they are the same
/// part of the tick.
bool has_numerics(const Scene& scene, const NumericsChange& numerics);

}  // namespace vat
