#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/names.h"

namespace vat {

struct StepContext;

/// The columns that stages exchange. A column is an array of one quantity of all particles or
/// bodies, or a data structure derived from such arrays.
enum class Column : std::uint8_t {
  position,
  velocity,
  rigid_state,
  force,
  liquid_cells,
  solid_cells,
  pair_clusters,
  pair_motion,
  liquid_pairs,
  density,
  filled_density,
  pressure,
  liquid_solids,
  solid_pressure,
  transport,
  surface,
  surface_normals,
  contact_list,
  mobility,
  cell_pressure,
  rigid_force,
  kept_pressure,
};
template <>
inline constexpr std::array kNamesOf<Column>{
    "position",       "velocity",        "rigid_state",   "force",          "liquid_cells",
    "solid_cells",    "pair_clusters",   "pair_motion",   "liquid_pairs",   "density",
    "filled_density", "pressure",        "liquid_solids", "solid_pressure", "transport",
    "surface",        "surface_normals", "contact_list",  "mobility",       "cell_pressure",
    "rigid_force",    "kept_pressure"};
inline constexpr std::size_t kColumnCount = kNamesOf<Column>.size();

/// A function that reads and writes columns for all particles or bodies.
using StageFunction = void (*)(StepContext&);

struct Stage {
  std::string_view name;
  std::vector<Column> reads;
  std::vector<Column> writes;
  StageFunction run;
};

/// The stages of one force evaluation, in order. A plan contains only the stages that the scene
/// needs.
struct StepPlan {
  std::vector<Stage> stages;
};

/// Collects the stages of a plan. A stage may read only columns that are arguments of the
/// constructor or that an earlier stage writes.
class PlanBuilder {
 public:
  explicit PlanBuilder(std::initializer_list<Column> given);
  void add(std::string_view name, std::initializer_list<Column> reads,
           std::initializer_list<Column> writes, StageFunction run);
  StepPlan finish() && { return std::move(plan_); }

 private:
  StepPlan plan_;
  bool written_[kColumnCount] = {};
};

/// Returns a text with each stage's name, the columns that the stage reads, and the columns that
/// the stage writes.
std::string to_text(const StepPlan& plan);

}  // namespace vat
