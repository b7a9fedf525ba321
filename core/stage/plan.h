#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/names.h"

namespace vat {

struct StepContext;

/// The columns that stages exchange.
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

/// One pass over whole arrays.
using StageFunction = void (*)(StepContext&);

struct Stage {
  std::string_view name;
  std::vector<Column> reads;
  std::vector<Column> writes;
  StageFunction run;
};

/// The stages of one force evaluation, in order. It contains only stages that the scene needs.
struct StepPlan {
  std::vector<Stage> stages;
};

/// Collects stages. A stage must not read a column before another stage has written it.
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

/// The name of each stage, the columns that it reads, and the columns that it writes.
std::string to_text(const StepPlan& plan);

}  // namespace vat
