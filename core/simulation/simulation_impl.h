#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/guard/guard.h"
#include "core/simulation/simulation.h"
#include "core/sleep/sleepers.h"
#include "core/state/controls.h"
#include "core/stepping/stepper.h"
#include "core/stepping/workspace.h"
#include "core/validation/validate.h"

namespace vat {

class LoadingArchive;

/// The content of a snapshot: all data except buffers.
struct SimulationContent {
  std::shared_ptr<const Model> model;  ///< of the stepped bodies: all bodies except sleepers
  State state;
  Controls controls;
  std::shared_ptr<const Sleepers> sleepers;  ///< null if no body sleeps

  /// The model of all bodies, including sleepers.
  const Model& all() const { return sleepers ? *sleepers->model : *model; }
  /// The configuration of all bodies.
  Configuration gather() const;
  std::uint64_t hash() const;
};

/// The controls whose bodies are in `model`, with the indices of that model. Bodies that have
/// melted lose their grabs and forces.
Controls rebind(Controls controls, const Model& before, const Model& model);

/// A body that melts.
struct MeltedBody {
  std::size_t body = 0;  ///< index into Model::bodies
  std::string into;      ///< material
};

struct SimulationImpl : SimulationContent {
  using Samples = std::vector<std::shared_ptr<const SampledBody>>;

  /// The state before advance(), restored if advance() fails.
  struct CallStart {
    SimulationContent content;
    /// The bounds of the model, if the call has changed it.
    std::optional<std::pair<GuardBounds, StepBounds>> bounds;
  };

  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  BodyId next_id = 1;      ///< restore() does not reset it: ids are not reused
  GuardBounds bounds;      ///< of the model
  StepBounds step_bounds;  ///< of the model
  Workspace work;
  Stepper stepper;
  CallStart call_start;        ///< of the present advance()
  mutable Workspace measured;  ///< buffers of read-only queries
  Configuration shown;  ///< configuration of all bodies after a call, without contacts; valid only
                        ///< if a body sleeps
  std::shared_ptr<const Sleepers> shown_sleepers;  ///< the sleepers in `shown`
  // Buffers of wake_near().
  std::vector<Index> near;
  std::vector<Index> woken;

  Real step_size() const { return model->scene.numerics.step; }
  std::uint32_t steps_per_tick() const {
    const Numerics& numerics = model->scene.numerics;
    return static_cast<std::uint32_t>(std::llround(numerics.tick / numerics.step));
  }
  Real time() const { return static_cast<Real>(state.step_count) * step_size(); }
  /// The configuration of all bodies, valid between calls.
  const Configuration& all_now() const { return sleepers ? shown : state.now; }
  const ModelBody* find(BodyId id) const;
  const ModelBody* find(std::string_view name) const;
  BodyView view_of(const ModelBody& body) const;
  /// Runs the plan for all bodies, with the buffers `measured`, and returns the sums over all
  /// particles.
  Diagnostics measure_all() const;
  /// The present state of the scene, for the checks of commands.
  CurrentScene present() const;

  /// The bounds of the stepped bodies. The bound of a body's travel depends on all bodies that it
  /// can touch, including sleepers.
  static GuardBounds bounds_of(const SimulationContent& content);
  /// Adopts the state from the bytes of a snapshot. If it fails, it changes only next_id.
  Status load(LoadingArchive& archive);
  /// Adopts a content with its bounds. Does not fail.
  void adopt(SimulationContent content, GuardBounds content_bounds,
             StepBounds content_step_bounds) noexcept;
  /// Compiles `scene`, and carries over the state of the bodies whose ids remain, and their grabs.
  /// If it fails, it changes nothing. If a sample is null, the body's present sample is used. A
  /// body without a sample is sampled. `kept` lists the remaining particles of each body in
  /// ascending order. A body without a list keeps all particles. Bodies in `described_anew` are
  /// sampled again if their sample follows from their description.
  void recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples,
                 const std::vector<std::optional<std::vector<Index>>>& kept,
                 const std::vector<BodyId>& described_anew = {});
  void recompile(Scene scene, const std::vector<BodyId>& ids);
  /// A faster recompile() for a change of one body's initial position and motion. No body may
  /// sleep. Compiles this body only.
  void recompile_moved(std::size_t body, BodyDescription moved);
  /// The ids of all bodies, in order.
  std::vector<BodyId> ids() const;
  /// If it fails, it changes nothing.
  void melt(const std::vector<MeltedBody>& bodies);
  /// Sets the constants of the springs of grabs for the step of the scene.
  void tune_grabs();
  /// Moves rigid particles to their poses, for views.
  void pose_rigid_particles();

  /// Wakes all bodies. Every command that may move a sleeping body must first call wake_all().
  void wake_all();
  /// Puts bodies at rest to sleep, and wakes bodies that others may reach in the next nominal step.
  void sleep_and_wake();
  void look_for_rest();
  void wake_near();
  /// Updates `shown` if some bodies sleep.
  void show();
  /// Continues with the bodies that `islands` does not list, from a configuration of all bodies.
  void step_others_than(std::vector<Index> islands, std::shared_ptr<const Model> whole,
                        Configuration now);

  /// Tells the observer that `stage` begins.
  void enter(std::string_view stage) const {
    if (observer != nullptr) observer->stage_begins(stage);
  }
  void begin_call();
  void undo_call() noexcept;
  /// Applies the scheduled changes of bodies (melting and flow) that the scene prescribes for the
  /// next nominal step.
  void change_bodies_on_time(AdvanceReport& report);
  void melt_on_time(AdvanceReport& report);
  void flow();
  bool take_guarded_steps(std::uint32_t steps, AdvanceReport& report);
  bool take_nominal_step(AdvanceReport& report);
};

}  // namespace vat
