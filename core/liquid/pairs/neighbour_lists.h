#pragma once

namespace vat {

struct StepContext;

/// Stage that lists the liquid and solid neighbours of liquid particles, for stages of coupled
/// liquids that visit single pairs. Also sets the positions and volumes of
/// LiquidScratch::liquid_records.
void list_neighbours(StepContext& context);

}  // namespace vat
