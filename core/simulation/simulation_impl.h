#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "core/guard/guard.h"
#include "core/simulation/simulation.h"
#include "core/sleep/sleepers.h"
#include "core/state/controls.h"
#include "core/stepping/step_engine.h"
#include "core/stepping/stepper.h"
#include "core/stepping/workspace.h"
#include "core/validation/validate.h"

namespace vat {

class LoadingArchive;

/// Content of a snapshot: all data except buffers.
struct SimulationContent {
  std::shared_ptr<const Model> model;  ///< stepped bodies: all bodies except sleepers
  State state;
  Controls controls;
  std::shared_ptr<const Sleepers> sleepers;  ///< null if no body sleeps

  /// Returns the model of all bodies, including sleepers.
  const Model& all() const { return sleepers ? *sleepers->model : *model; }
  /// Returns the configuration of all bodies.
  Configuration gather() const;
  std::uint64_t hash() const;
};

/// Returns `controls` with body indices converted from the model `before` to `model`. Grabs and
/// applied forces are removed if their body is not in `model` or has melted.
Controls rebind(Controls controls, const Model& before, const Model& model);

/// Returns whether StepEngine::bind() has failed because the engine lacks features of the scene.
inline bool lacks_features(const Status& bound) {
  return !bound && bound.errors().front().code == "not_on_device";
}

/// Body that melts.
struct MeltedBody {
  std::size_t body = 0;  ///< index into Model::bodies
  std::string into;      ///< name of the material
};

struct SimulationImpl : SimulationContent {
  using Samples = std::vector<std::shared_ptr<const SampledBody>>;

  /// State before a call of advance(). If the call fails, this state is restored.
  struct CallStart {
    SimulationContent content;
    /// Bounds of the model, if the call has changed them.
    std::optional<std::pair<GuardBounds, StepBounds>> bounds;
  };

  TaskRunner* runner = nullptr;
  StageObserver* observer = nullptr;
  BodyId next_id = 1;      ///< restore() does not reset it: ids are never reused
  GuardBounds bounds;      ///< bounds of the model
  StepBounds step_bounds;  ///< bounds of the model
  Workspace work;
  Stepper stepper;
  std::unique_ptr<StepEngine> engine;         ///< null: all steps are taken by `stepper`
  std::shared_ptr<const Model> engine_model;  ///< model of the last StepEngine::bind()
  bool engine_fits = false;                   ///< the engine has the features of `engine_model`
  bool device_is_current = false;  ///< the engine has the state, which has not changed since
  /// Steps that the engine has taken since the other members of `state` were read from it.
  std::uint64_t unread_steps = 0;
  std::optional<Error> engine_error;  ///< of a reading; the next report contains it
  CallStart call_start;               ///< start of the current advance()
  mutable Workspace measured;         ///< buffers of read-only queries
  /// Configuration of all bodies after a call, without contacts. Valid only if a body sleeps.
  Configuration shown;
  std::shared_ptr<const Sleepers> shown_sleepers;  ///< sleepers in `shown`
  // Buffers of wake_near().
  std::vector<Index> near;
  std::vector<Index> woken;
  // Buffers of find_quiet_steps().
  BodyMotions motions;
  Configuration seen;  ///< rigid states of the device, and the particles of some bodies
  std::vector<std::uint32_t> next_looks;

  Real step_size() const { return model->scene.numerics.step; }
  std::uint32_t steps_per_tick() const {
    const Numerics& numerics = model->scene.numerics;
    return static_cast<std::uint32_t>(std::llround(numerics.tick / numerics.step));
  }
  Real time() const { return static_cast<Real>(state.step_count) * step_size(); }
  /// Returns the configuration of all bodies. It is valid between calls.
  const Configuration& all_now() const { return sleepers ? shown : state.now; }
  /// Returns the model of all bodies, including sleepers.
  const std::shared_ptr<const Model>& model_of_all() const;
  const ModelBody* find(BodyId id) const;
  const ModelBody* find(std::string_view name) const;
  BodyView view_of(const ModelBody& body) const;
  /// Runs the plan for all bodies, with the buffers `measured`. Returns the sums over all
  /// particles.
  Diagnostics measure_all() const;
  /// Copies density and pressure of a liquid body, which measure_all() has left in `measured`.
  void copy_fields(const ModelBody& body, LiquidFields& fields) const;
  /// Returns the current state of the scene, for the checks of commands.
  CurrentScene present() const;

  /// Returns the bounds of the stepped bodies. The travel bound of a body depends on all bodies
  /// that it can touch, including sleepers.
  static GuardBounds bounds_of(const SimulationContent& content);
  /// Replaces the content by the bytes of a snapshot in a version of the format. On failure, only
  /// next_id changes.
  Status load(LoadingArchive& archive, std::uint32_t version);
  /// Replaces the content and its bounds. Does not fail.
  void adopt(SimulationContent content, GuardBounds content_bounds,
             StepBounds content_step_bounds) noexcept;
  /// Compiles `scene`, and transfers the state and grabs of the bodies whose ids remain. On
  /// failure, nothing changes. If a sample is null, the current sample of the body is used. Bodies
  /// without a sample are sampled. `kept` lists the remaining particles of each body in ascending
  /// order; a body without a list retains all particles. Bodies in `described_anew` are sampled
  /// again if their sample follows from their description.
  void recompile(Scene scene, const std::vector<BodyId>& ids, Samples samples,
                 const std::vector<std::optional<std::vector<Index>>>& kept,
                 const std::vector<BodyId>& described_anew = {});
  void recompile(Scene scene, const std::vector<BodyId>& ids);
  /// Performs recompile() after a change of one body's initial position and motion. Only this body
  /// is compiled. No body may sleep.
  void recompile_moved(std::size_t body, BodyDescription moved);
  /// Sets the appearance of an existing material. Nothing else changes: no body wakes, and no force
  /// is computed again.
  void set_appearance(const std::string& material, const Appearance& appearance);
  /// Returns the ids of all bodies, in order.
  std::vector<BodyId> ids() const;
  /// Melts bodies. On failure, nothing changes.
  void melt(const std::vector<MeltedBody>& bodies);
  /// Sets the constants of the springs of grabs for the step length of the scene.
  void tune_grabs();
  /// Moves rigid particles to the poses of their bodies, for views.
  void pose_rigid_particles();

  /// Wakes all bodies. Every command that may move a sleeping body must first call wake_all().
  void wake_all();
  /// Puts resting bodies to sleep, and wakes bodies that awake bodies may reach in the next nominal
  /// step.
  void sleep_and_wake();
  void look_for_rest();
  void wake_near();
  /// Counts the slow checks of the stepped bodies in `counts`, by their motion: the rigid states of
  /// `at`, and `particles` or else the particles of `at`. Returns whether a search for islands is
  /// due.
  bool count_slow_looks(const Configuration& at, std::span<const ParticleMotion> particles,
                        std::vector<std::uint32_t>& counts) const;
  /// Returns whether all bodies sleep.
  bool all_sleep() const { return sleepers && model->bodies.empty(); }
  /// Returns the number of steps until the next tick, at most `most`.
  std::uint32_t steps_until_tick(std::uint32_t most) const;
  /// Performs sleep_and_wake() by the motion of bodies on the device, before steps of the engine.
  /// Returns the number of steps, at most `most`, until the next check that can change the sleeping
  /// bodies. The result is 0, and nothing changes, if the check needs the whole state.
  std::uint32_t find_quiet_steps(std::uint32_t most);
  /// Returns the number of steps, at most `most`, in which no stepped body wakes a sleeper, by the
  /// motion in `seen` and `motions`. The result is 0 if a body may wake one before the next step.
  std::uint32_t steps_without_wake(std::uint32_t most);
  /// Returns this number for one body.
  std::uint32_t steps_without_wake_by(Index body, Real reach, std::uint32_t most);
  /// Performs sleep_and_wake() before steps of the engine. Reads the state from the engine only if
  /// necessary. Returns the number of steps until the next check, at most `most`.
  std::uint32_t sleep_and_wake_before(std::uint32_t most);
  /// Takes the steps of a call by the engine, if they need one check for sleep, which changes no
  /// sleeping body. Otherwise returns false, with an unchanged content.
  bool advance_quietly_on_device(std::uint32_t steps, AdvanceReport& report);
  /// Updates `shown` if any body sleeps.
  void show();
  /// Continues with the bodies for which `islands` has the value kAwake. `now` is the configuration
  /// of all bodies.
  void step_others_than(std::vector<Index> islands, std::shared_ptr<const Model> whole,
                        Configuration now);

  /// Notifies the observer that `stage` begins.
  void enter(std::string_view stage) const {
    if (observer != nullptr) observer->stage_begins(stage);
  }
  /// Takes the steps of a call by the engine. Returns false, with an unchanged content, if it
  /// cannot take them.
  bool advance_on_device(std::uint32_t steps, AdvanceReport& report);
  /// Prepares the engine for a changed model. Returns false if the engine lacks a feature of it.
  Result<bool> fit_engine(AdvanceReport& report);
  /// Reads the state of the last steps of the engine, if any. If the device has failed, the CPU
  /// repeats these steps.
  void read_from_device();
  void begin_call();
  void undo_call() noexcept;
  /// Returns whether scheduled changes of bodies (melting and flow) can be due before a nominal
  /// step.
  bool bodies_change_at(std::uint64_t step) const;
  /// Returns the number of nominal steps before the next ones that are due after the present step,
  /// at most `most`.
  std::uint32_t steps_until_change(std::uint32_t most) const;
  /// Performs the scheduled changes of bodies of the next nominal step.
  void change_bodies_on_time(AdvanceReport& report);
  void melt_on_time(AdvanceReport& report);
  void flow();
  /// Takes nominal steps on the CPU. Returns whether no step has failed.
  bool take_guarded_steps(std::uint32_t steps, AdvanceReport& report);
  /// Takes steps in which no changes of bodies are due, or before which they have been performed.
  /// Checks for sleep precede all steps except the first `checked`.
  bool take_unchanged_steps(std::uint32_t steps, AdvanceReport& report, std::uint32_t checked = 0);
  /// Takes the steps between two changes of bodies by the engine if possible, and otherwise on the
  /// CPU. Returns whether no step has failed.
  bool take_parts(std::uint32_t steps, AdvanceReport& report);
  bool take_nominal_step(AdvanceReport& report);
};

}  // namespace vat
