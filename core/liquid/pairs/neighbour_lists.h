#pragma once

namespace vat {

struct Model;
struct StepContext;
class Scratch;
class TaskRunner;

/// Lists the neighbours of each particle, for stages and solves of coupled liquids that visit
/// single pairs: liquid near liquid, and solids near liquid, in both directions. Also sets
/// positions and volumes of the records. The cells must be those of the present positions.
void list_neighbours(const Model& model, Scratch& work, TaskRunner* runner);

/// list_neighbours() as a stage.
void list_neighbours(StepContext& context);

}  // namespace vat
