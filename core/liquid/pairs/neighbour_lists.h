#pragma once

namespace vat {

struct Model;
struct StepContext;
class Scratch;
class TaskRunner;

/// Lists, particle by particle, of what clusters of pairs hold together, for stages and solves of
/// coupled liquids that visit single pairs: liquid near liquid, and solids near liquid, both ways;
/// with the records' places and volumes. The workspace has the cells of the present places.
void list_neighbours(const Model& model, Scratch& work, TaskRunner* runner);

/// The same as a stage.
void list_neighbours(StepContext& context);

}  // namespace vat
