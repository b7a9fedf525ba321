#pragma once

#include <string>
#include <vector>

#include "core/numerics/stable_step.h"
#include "core/scene/scene.h"

namespace vat::stability {

/// A scene that is linear near its rest, so that its largest stable step is known.
struct LinearCase {
  int steps = 3000;        ///< in which a step that is too long is seen
  std::string body;        ///< what oscillates
  Real stiffness = 0;      ///< of its springs or contacts [N/m]
  Real mass_ratio = 1;     ///< of its heaviest to its lightest particle
  Real damping_ratio = 0;  ///< of its fastest mode
  Scene scene;             ///< a little away from rest
  std::vector<Vec3> rest;  ///< of all its particles [m]
  Real displacement = 0;   ///< of the start from rest [m]
  std::vector<Oscillation> modes;
};

/// The bodies of springs alone, with implicit springs: no step is too long.
std::vector<LinearCase> implicit_cases(bool quick);
/// Oscillator, pair, chain, lattice, ball on the floor, pair of balls on the floor, and a liquid on
/// a lattice that repeats itself, with sound or viscosity alone.
std::vector<LinearCase> linear_cases(bool quick);
/// The liquids of those. Their one mode is that of find_step_limits(), for which the limits of
/// velocity Verlet, c dt / h and nu dt / h^2, were found with the linear dispersion operator.
std::vector<LinearCase> liquid_cases(bool quick);

/// The least of the modes' limits [s].
Real theoretical_step(const LinearCase& linear, IntegratorId integrator);

/// The greatest part of `step` up to 1.5 that a run does not let grow, to 1 / 128; 0 where not even
/// a quarter is stable. A part is stable where within `steps` steps no particle goes beyond a
/// thousand times the start's displacement, and none twice as far in the second half as in the
/// first. Undamped with explicit Euler or Heun every step grows, slowly where it is short.
Real largest_stable_part(const LinearCase& linear, IntegratorId integrator, Real step, int steps);

struct StepMapPoint {
  std::string body;
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real stiffness = 0;
  Real mass_ratio = 1;
  Real damping_ratio = 0;
  Real frequency = 0;  ///< of the fastest mode [rad/s]
  Real theory = 0;     ///< [s]
  Real measured = 0;   ///< [s]
};

/// One point of the map: bisects about theory, or where that is 0, shows that omega dt = 1.5 grows.
/// Theory must be finite.
StepMapPoint map_point(const LinearCase& linear, IntegratorId integrator);

/// The longest of the steps that are tried where theory is infinite: 10^5 over the frequency
/// [rad/s], or kMaxStep.
Real longest_tried_step(Real frequency);

/// The same where theory is infinite: measured is the longest of steps from 1 over the frequency to
/// longest_tried_step(), a decade apart, up to which all are stable.
StepMapPoint map_point_without_limit(const LinearCase& linear, IntegratorId integrator);

}  // namespace vat::stability
