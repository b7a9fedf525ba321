#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "tests/validation/run.h"

namespace vat::bench {

/// A scene whose error at one time can be told, to be solved by every method.
struct Problem {
  std::string title;
  std::string error_name;  ///< what is compared, and with what; the error is relative to its size
  Scene scene;
  Real end = 0;                            ///< [s]
  std::vector<std::uint32_t> step_counts;  ///< of fixed steps from start to end, rising
  /// Number of the longest steps of varied control; 0: as with fixed steps.
  std::uint32_t longest_step_count = 0;
  /// How many times as many there are with each finer tolerance.
  std::uint32_t longest_step_growth = 1;
  std::function<Real(const validation::Run&)> error;
};

/// A problem by its name. Making one may run a reference solution.
struct ProblemEntry {
  std::string name;  ///< of the validation case where there is one, and how it is varied
  std::function<Problem(TaskRunner*)> make;
  bool is_long = false;  ///< left out of quick runs that do not name it
};

/// All problems: deformable, rigid, liquid, interaction, and scenes of the catalogue.
const std::vector<ProblemEntry>& all_problems();

std::vector<ProblemEntry> deformable_problems();
std::vector<ProblemEntry> rigid_problems();
std::vector<ProblemEntry> liquid_problems();
std::vector<ProblemEntry> interaction_problems();
std::vector<ProblemEntry> catalogue_problems();

/// `count` numbers from `first` on, each twice the one before.
std::vector<std::uint32_t> doubled(std::uint32_t first, int count);

/// The error of all particles' positions against a fine solution of the same equations, by
/// Runge-Kutta with `factor` times as many steps as the problem's finest, relative to the ways from
/// the start; roots of mean squares.
std::function<Real(const validation::Run&)> error_against_fine_run(const Problem& problem,
                                                                   int factor, TaskRunner* runner);

}  // namespace vat::bench
