#pragma once

#include <string>
#include <vector>

#include "core/numerics/stable_step.h"
#include "core/scene/scene.h"

namespace vat::stability {

/// A scene that is linear near its rest state, so its largest stable step is known.
struct LinearCase {
  int steps = 3000;        ///< number after which an unstable step is detected
  std::string body;        ///< the oscillating system
  Real stiffness = 0;      ///< springs or contacts [N/m]
  Real mass_ratio = 1;     ///< heaviest to lightest particle
  Real damping_ratio = 0;  ///< fastest mode
  Scene scene;             ///< slightly displaced from rest
  std::vector<Vec3> rest;  ///< rest positions of all particles [m]
  Real displacement = 0;   ///< initial displacement [m]
  std::vector<Oscillation> modes;
};

/// Returns the cases of springs only, with implicit springs. They have no step limit.
std::vector<LinearCase> implicit_cases(bool quick);
/// Returns the cases: oscillator, pair, chain, lattice, one and two balls on the floor, and
/// periodic liquid lattices with sound only or viscosity only.
std::vector<LinearCase> linear_cases(bool quick);
/// Returns the cases of liquids. They have the mode of find_step_limits(). Its limits of velocity
/// Verlet, c dt / h and nu dt / h^2, follow from the linear dispersion operator.
std::vector<LinearCase> liquid_cases(bool quick);

/// Returns the smallest limit of the modes [s].
Real theoretical_step(const LinearCase& linear, IntegratorId integrator);

/// Returns the largest fraction of `step`, up to 1.5, that is stable, to 1 / 128; 0 if a quarter is
/// unstable. A step is stable if no particle exceeds a thousand times the initial displacement
/// within `steps` steps. In the second half, no particle may exceed twice its maximum of the first
/// half. Without damping, explicit Euler and Heun grow with every step, slowly if the step is
/// short.
Real largest_stable_part(const LinearCase& linear, IntegratorId integrator, Real step, int steps);

struct StepMapPoint {
  std::string body;
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real stiffness = 0;
  Real mass_ratio = 1;
  Real damping_ratio = 0;
  Real frequency = 0;  ///< fastest mode [rad/s]
  Real theory = 0;     ///< [s]
  Real measured = 0;   ///< [s]
};

/// Computes a point of the map by bisection about the theoretical step. If that is 0, shows that
/// omega dt = 1.5 grows. The theoretical step must be finite.
StepMapPoint map_point(const LinearCase& linear, IntegratorId integrator);

/// Returns the longest tried step if theory has no limit: 10^5 over the frequency [rad/s], or
/// kMaxStep.
Real longest_tried_step(Real frequency);

/// Computes a point if theory has no limit. `measured` is the longest stable step of a series from
/// 1 over the frequency to longest_tried_step(), in factors of ten.
StepMapPoint map_point_without_limit(const LinearCase& linear, IntegratorId integrator);

}  // namespace vat::stability
