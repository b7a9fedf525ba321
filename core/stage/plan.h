#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace vat {

struct StepContext;

/// The columns that stages hand to one another.
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
inline constexpr std::size_t kColumnCount = 22;

/// One pass over whole arrays: never one particle.
using StageFunction = void (*)(StepContext&);

struct Stage {
  std::string_view name;
  std::vector<Column> reads;
  std::vector<Column> writes;
  StageFunction run;
};

/// The stages of one force evaluation, in order: only those that some body of the scene needs.
struct StepPlan {
  std::vector<Stage> stages;
};

/// Collects stages; a stage that reads a column nobody has written yet is a programming error.
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

/// One line a stage: name, columns read, columns written.
std::string to_text(const StepPlan& plan);

}  // namespace vat
