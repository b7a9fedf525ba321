#include "core/stage/plan.h"

#include "core/support/check.h"

namespace vat {
namespace {

std::string join(const std::vector<Column>& columns) {
  std::string text;
  for (const Column column : columns) {
    if (!text.empty()) text += ' ';
    text += to_string(column);
  }
  return text;
}

}  // namespace

PlanBuilder::PlanBuilder(std::initializer_list<Column> given) {
  for (const Column column : given) written_[static_cast<std::size_t>(column)] = true;
}

void PlanBuilder::add(std::string_view name, std::initializer_list<Column> reads,
                      std::initializer_list<Column> writes, StageFunction run) {
  for (const Column column : reads) VAT_CHECK(written_[static_cast<std::size_t>(column)]);
  for (const Column column : writes) written_[static_cast<std::size_t>(column)] = true;
  plan_.stages.push_back({name, reads, writes, run});
}

std::string to_text(const StepPlan& plan) {
  std::string text;
  for (const Stage& stage : plan.stages) {
    text += stage.name;
    text += "\n  reads  " + join(stage.reads) + "\n  writes " + join(stage.writes) + "\n";
  }
  return text;
}

}  // namespace vat
