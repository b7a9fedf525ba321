#pragma once

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "core/guard/guard.h"
#include "core/simulation/simulation.h"
#include "core/sleep/sleepers.h"
#include "core/state/controls.h"
#include "core/stepping/integrator.h"
#include "core/stepping/local_step.h"
#include "core/stepping/step_control.h"
#include "core/stepping/workspace.h"
#include "core/validation/validate.h"

namespace vat {

class LoadingArchive;

/// What a snapshot holds: everything but scratch.
struct Snapshot::Content {
  std::shared_ptr<const Model> model;  ///< of what is stepped: all bodies, but for sleepers
  State state;
  Controls controls;
  std::shared_ptr<const Sleepers> sleepers;  ///< null where no body sleeps

  /// Of all bodies, whether they sleep or not.
  const Model& all() const { return sleepers ? *sleepers->model : *model; }
  /// Configuration of all bodies at any time.
  Configuration gather() const;
  std::uint64_t hash() const;
};

/// Those of `controls` whose bodies are in `model`, bound to their places there. A body that has
/// melted is let go.
Controls rebind(Controls controls, const Model& before, const Model& model);

/// A body that is to melt.
struct MeltedBody {
  std::size_t body = 0;  ///< index into Model::bodies
  std::string into;      ///< material
};

struct Simulation::Impl : Snapshot::Content {
  using Samples = std::vector<std::shared_ptr<const SampledBody>>;

  /// What an advance() that fails goes back to.
  struct CallStart {
    Content content;
    /// Of the model, where the call has changed it.
    std::optional<std::pair<GuardBounds, StepBounds>> bounds;
  };

  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  BodyId next_id = 1;      ///< restore() leaves it: an id is never used again
  GuardBounds bounds;      ///< of the model
  StepBounds step_bounds;  ///< of the model
  Workspace work;
  IntegratorScratch scratch;
  CallStart call_start;      ///< of the advance() in progress
  Configuration step_start;  ///< of its present step, or part of one
  PresentSteps present_steps;
  MotionProbe probe;
  LocalStepper local;
  mutable Workspace measured;  ///< scratch of read-only questions
  Configuration shown;         ///< of all bodies after a call, but for contacts, where some sleep
  std::shared_ptr<const Sleepers> shown_sleepers;  ///< those that it has
  // Scratch of wake_near().
  std::vector<Index> near;
  std::vector<Index> woken;

  Real step_size() const { return model->scene.numerics.step; }
  std::uint32_t steps_per_tick() const {
    const Numerics& numerics = model->scene.numerics;
    return static_cast<std::uint32_t>(std::llround(numerics.tick / numerics.step));
  }
  Real time() const { return static_cast<Real>(state.step_count) * step_size(); }
  /// Of all bodies; between calls, as they are now.
  const Configuration& all_now() const { return sleepers ? shown : state.now; }
  const ModelBody* find(BodyId id) const;
  /// For the checks of what users add.
  CurrentScene present() const;

  /// How far bodies may move in a step depends on all that may notice them: sleepers too.
  static GuardBounds bounds_of(const Content& content);
  /// Takes over what the bytes of a snapshot tell; changes nothing but next_id where it fails.
  Status load(LoadingArchive& archive);
  /// Takes over what belongs together. Does not fail.
  void adopt(Content content, GuardBounds content_bounds, StepBounds content_step_bounds) noexcept;
  /// Compiles `scene` and carries over the state of the bodies whose ids stay, and what users hold
  /// of them. Changes nothing where it fails. A null sample is the body's own, or made. `kept`,
  /// where it is not empty, has which particles of a body stay, as the first of its sample, in
  /// rising order; all where there is nothing. Bodies that are as described and whose description
  /// has changed are sampled anew.
  void recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples,
                 const std::vector<std::optional<std::vector<Index>>>& kept,
                 const std::vector<BodyId>& described_anew = {});
  void recompile(Scene scene, const std::vector<BodyId>& ids);
  /// The same as recompile() where nothing but one body's place and motion in `moved` is new; all
  /// are stepped. It compiles that one alone.
  void recompile_moved(std::size_t body, BodyDescription moved);
  /// Of all bodies, in their order.
  std::vector<BodyId> ids() const;
  /// Changes nothing where it fails.
  void melt(const std::vector<MeltedBody>& bodies);
  /// The constants of springs that hold bodies, for the scene's step.
  void tune_grabs();
  /// Rigid particles to their poses, for views.
  void pose_rigid_particles();

  /// All bodies are stepped from now on. What may change what holds them at rest begins with it.
  void wake_all();
  /// Puts what has rested to sleep, and wakes what something may reach in the next nominal step.
  void sleep_and_wake();
  void look_for_rest();
  void wake_near();
  /// Brings `shown` up to date, where some sleep.
  void show();
  /// Goes on with the bodies that are in no island, from a configuration of all of them.
  void step_others_than(std::vector<Index> islands, std::shared_ptr<const Model> whole,
                        Configuration now);

  /// Tells the observer that `stage` begins.
  void enter(std::string_view stage) const {
    if (observer != nullptr) observer->stage_begins(stage);
  }
  void begin_call();
  void undo_call() noexcept;
  /// What the scene has to happen as the next nominal step begins.
  void change_bodies_on_time(AdvanceReport& report);
  void melt_on_time(AdvanceReport& report);
  void flow();
  bool take_guarded_steps(std::uint32_t steps, AdvanceReport& report);
  bool take_nominal_step(AdvanceReport& report);
  /// One nominal step, in the parts that adaptive or local control chooses.
  bool take_varied_step(ForceModel& force_model, AdvanceReport& report);
  Real wanted_step(const ForceModel& force_model, Real start);
  /// What a step just taken would have shown, before the first one: from forces here and `dt` on.
  Real probe_start(const ForceModel& force_model, Real start, Real dt);
  /// Undoes whatever was done since the step began.
  void undo_step();
  /// One step with the scene's integrator and control, unguarded.
  void take_unguarded_step(const ForceModel& force_model, Real start, Real dt,
                           AdvanceReport& report);
  /// Puts back what left the vat in a step, or part of one, that ends at `end`; true where anything
  /// did.
  bool hold_inside_vat(Real end, AdvanceReport& report);
  /// What the guard has against a step of `dt` that was taken.
  std::optional<Fault> find_step_fault(Real dt) const;
  /// `dt` seconds from `start`, in as many equal parts as it takes; false where none helped.
  bool take_guarded_step(const ForceModel& force_model, Real start, Real dt, AdvanceReport& report);
  /// The same in `pieces` parts, up to the first fault.
  std::optional<GuardEvent> take_step_in(std::uint32_t pieces, const ForceModel& force_model,
                                         Real start, Real dt, AdvanceReport& report);
};

}  // namespace vat
