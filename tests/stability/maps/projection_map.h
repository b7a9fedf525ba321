#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// A stack of balls of 1 m with projection contacts. Each ball falls by a centimetre.
struct ProjectionPoint {
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real mass_ratio = 1;      ///< mass ratio of alternate balls; the lower is the lighter
  Real step = 0;            ///< [s]
  bool is_guarded = false;  ///< the guard undid a step: a fault
  Real energy_gain = 0;  ///< maximum increase above the start, relative to the energy of the fall
  Real overlap = 0;      ///< maximum in the second half, in diameters
  Real kinetic_energy = 0;  ///< at the end, relative to the energy of the fall
};

/// Returns points with steps from 0.1 ms to 0.1 s and mass ratios from 1 to 1000.
std::vector<ProjectionPoint> projection_points(bool quick);

/// Runs with `point.step` and returns the point with its results.
ProjectionPoint measure_projection(ProjectionPoint point);

/// Returns whether the run is stable: no undone step, no energy gain, at rest at the end, and no
/// visible overlaps.
bool is_stable(const ProjectionPoint& point);

}  // namespace vat::stability
