#pragma once

#include <vector>

#include "core/scene/scene.h"

namespace vat::stability {

/// A stack of balls of 1 m that meet by projection, dropped by a centimetre each.
struct ProjectionPoint {
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real mass_ratio = 1;      ///< of every other ball to those between, which bear them
  Real step = 0;            ///< [s]
  bool is_guarded = false;  ///< a step was undone: a fault
  Real energy_gain = 0;     ///< greatest rise above the start, over the energy of the fall
  Real overlap = 0;         ///< greatest in the second half, in diameters
  Real kinetic_energy = 0;  ///< at the end, over the energy of the fall
};

/// Steps from 0.1 ms to 0.1 s, mass ratios from 1 to 1000.
std::vector<ProjectionPoint> projection_points(bool quick);

/// Fills in what a run of `point.step` shows.
ProjectionPoint measure_projection(ProjectionPoint point);

/// Whether it is stable: nothing guarded, no energy gained, and at rest at the end, without
/// overlaps that can be seen.
bool is_stable(const ProjectionPoint& point);

}  // namespace vat::stability
