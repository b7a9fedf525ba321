#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/validation/run.h"

namespace vat::bench {

/// A scene with a known error at one time, solved by every method.
struct Problem {
  std::string title;
  std::string error_name;  ///< compared quantity and reference; the error is relative to its size
  Scene scene;
  Real end = 0;                            ///< [s]
  std::vector<std::uint32_t> step_counts;  ///< of fixed steps from start to end, increasing
  /// Number of the longest steps of variable control; 0: as with fixed steps.
  std::uint32_t longest_step_count = 0;
  /// Factor of that number with each smaller tolerance.
  std::uint32_t longest_step_growth = 1;
  std::function<Real(const validation::Run&)> error;
};

/// A problem with its name. Creating the problem may run a reference solution.
struct ProblemEntry {
  std::string name;  ///< name of the validation case, if there is one, and its variation
  std::function<Problem(TaskRunner*)> make;
  bool is_long = false;  ///< quick runs include it only by name
};

/// Returns all problems: deformable, rigid, liquid, interaction, and catalogue scenes.
const std::vector<ProblemEntry>& all_problems();

std::vector<ProblemEntry> deformable_problems();
std::vector<ProblemEntry> rigid_problems();
std::vector<ProblemEntry> liquid_problems();
std::vector<ProblemEntry> interaction_problems();
std::vector<ProblemEntry> catalogue_problems();

/// Reads a scene of the catalogue. Throws std::runtime_error if there is none with this name.
Scene load_catalogue(const std::string& name);

/// Returns the centres of mass of all bodies.
std::vector<Vec3> centers_of(const validation::Run& run);

/// Returns the root of the sum of squared distances. Both lists must have the same length.
Real distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b);

/// Returns `count` numbers, starting with `first`, each twice the previous one.
std::vector<std::uint32_t> doubled(std::uint32_t first, int count);

/// Returns the error of all particles' positions relative to a fine solution of the same equations.
/// It uses Runge-Kutta with `factor` times as many steps as the problem's finest. The error is
/// relative to the displacements from the start, as a ratio of root mean squares.
std::function<Real(const validation::Run&)> error_against_fine_run(const Problem& problem,
                                                                   int factor, TaskRunner* runner);

}  // namespace vat::bench
