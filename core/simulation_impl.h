#pragma once

#include "core/integrators/integrator.h"
#include "core/simulation.h"
#include "core/step/controls.h"

namespace vat {

/// What a snapshot holds: everything but scratch.
struct Snapshot::Content {
  std::shared_ptr<const Model> model;
  State state;
  Controls controls;
  BodyId next_id = 1;
};

struct Simulation::Impl : Snapshot::Content {
  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  Workspace work;
  IntegratorScratch scratch;
  State backup;                ///< start of the advance() in progress
  mutable Workspace measured;  ///< scratch of read-only questions

  Real step_size() const { return model->scene.numerics.step; }
  Real time() const { return static_cast<Real>(state.step_count) * step_size(); }
  const ModelBody* find(BodyId id) const;

  /// Compiles `scene` and carries over the state of the bodies whose ids stay.
  void recompile(Scene scene, const std::vector<BodyId>& ids);
  /// Rigid particles to their poses, for views.
  void pose_rigid_particles();
};

}  // namespace vat
