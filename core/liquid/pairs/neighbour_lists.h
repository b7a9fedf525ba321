#pragma once

namespace vat {

struct Model;
struct StepContext;
class Scratch;
class TaskRunner;

/// Lists the liquid and solid neighbours of liquid particles, and the liquid neighbours of solid
/// particles. The lists are for stages and solves of coupled liquids that visit single pairs. Also
/// sets the positions and volumes of LiquidScratch::liquid_records. The cells must be those of the
/// present positions.
void list_neighbours(const Model& model, Scratch& work, TaskRunner* runner);

/// Stage that calls list_neighbours().
void list_neighbours(StepContext& context);

}  // namespace vat
