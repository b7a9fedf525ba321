#pragma once

#include <memory>
#include <numeric>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/model/compile.h"
#include "core/state/controls.h"
#include "core/stepping/step_plan.h"
#include "core/stepping/workspace.h"

namespace vat::test {

/// Compiles a scene. The ids of its bodies are 1, 2, ...
inline std::shared_ptr<const Model> compile_scene(const Scene& scene) {
  std::vector<BodyId> ids(scene.bodies.size());
  std::iota(ids.begin(), ids.end(), BodyId{1});
  return compile(scene, ids, std::vector<std::shared_ptr<const SampledBody>>(ids.size()));
}

/// The forces of one configuration: compiles a scene and runs its plan without integration.
class ForceProbe {
 public:
  explicit ForceProbe(const Scene& scene, TaskRunner* runner = nullptr)
      : model_(compile_scene(scene)), state_(initial_state(*model_)), runner_(runner) {
    evaluate();
  }

  void evaluate(Real time = 0) {
    ForceModel{*model_, controls_, work_, runner_}.evaluate(state_.now, time, state_.forces);
  }
  const Model& model() const { return *model_; }
  State& state() { return state_; }
  const State& state() const { return state_; }
  const Workspace& work() const { return work_; }
  /// Returns the force [N] on particle `i` of the body with index `body` in the scene.
  const Vec3& force(std::size_t body, Index i = 0) const {
    return state_.forces.particle[model_->bodies[body].particles.begin + i];
  }

 private:
  std::shared_ptr<const Model> model_;
  State state_;
  Controls controls_;
  Workspace work_;
  TaskRunner* runner_;
};

}  // namespace vat::test
