#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/numerics_change.h"
#include "core/support/result.h"

/// Measured choice of the numerics of a scene; TUNE.md describes the rules.
namespace vat::tune {

/// One choice of the numerics of a scene. The solver and its tolerances matter for liquids only.
struct Candidate {
  PressureSolver pressure_solver = PressureSolver::tait;
  IncompressibleSolve incompressible;
  Numerics numerics;  ///< without accuracy
};

/// Returns the numerics of a valid scene. If the scene has an accuracy, they follow from it.
Candidate candidate_of(const Scene& scene);

/// Returns the scene with these numerics.
Scene with_candidate(Scene scene, const Candidate& candidate);

/// Returns whether a running session can change from the numerics `a` to `b`: they have the same
/// solver, and in scenes with emitters the same step.
bool can_change(const Candidate& a, const Candidate& b, const Scene& scene);
/// Returns the values of a candidate that matter for its runs, except for the solver.
NumericsChange change_to(const Candidate& candidate, bool has_liquid);

/// Returns a text such as "velocity_verlet, adaptive 0.01, 2.5 ms". `has_liquid` adds the solver.
std::string describe(const Candidate& candidate, bool has_liquid);

/// Returns the expected number of force evaluations per simulated second, with a factor for the
/// iterations of an incompressible liquid.
Real expected_work(const Candidate& candidate);

/// The candidates of a scene, and the numerics of its two reference runs.
struct CandidateSet {
  Candidate fine;    ///< most accurate reference
  Candidate coarse;  ///< reference with steps that are longer by a factor of 1.5
  /// By ascending expected_work(). Every candidate gives a valid scene.
  std::vector<Candidate> candidates;
  std::size_t own = 0;      ///< index of the numerics of the scene
  bool has_liquid = false;  ///< whether the scene has liquid at any time
};

/// Returns the candidates of a valid scene. They are the combinations of
///
/// - the solver of the scene; for liquids also the other one of tait and incompressible;
/// - symplectic Euler, velocity Verlet and Runge-Kutta 4;
/// - fixed steps: five from the longest one to a quarter of it. The longest step is the greater of
///   the scene's step and the least limit of find_step_limits(), but at most the tick;
/// - adaptive and local steps: two longest steps, and the tolerances 0.1, 0.03, 0.01 and 0.003;
/// - tolerances of incompressible liquids, from those of the scene to 1 %;
///
/// for which find_errors() finds no error, and the numerics of the scene. The tick is unchanged.
CandidateSet find_candidates(const Scene& scene);

}  // namespace vat::tune
