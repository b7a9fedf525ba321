#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene/scene.h"
#include "core/simulation/body_values.h"
#include "core/simulation/host_interface.h"
#include "core/simulation/snapshot.h"
#include "core/stage/advance_report.h"
#include "core/stage/observer.h"
#include "core/support/instruction_set.h"
#include "core/support/parallel.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

class StepEngine;

/// Particle simulation of one scene. It is not thread-safe: two threads must not use it at the same
/// time. With the same scene, commands and instruction set, results are bitwise equal with every
/// TaskRunner. HostInterface provides the commands that change a running scene.
///
///     Result<Simulation> created = Simulation::create(scene);
///     if (!created) return created.errors();
///     Simulation& simulation = created.value();
///     while (simulation.time() < 1) simulation.advance(simulation.steps_per_tick());
class Simulation : public HostInterface {
 public:
  /// Returns the simulation of a scene at time 0. Fails with all errors of the scene, and if the
  /// machine does not support the instruction set (see check_available()). `runner` may be null for
  /// serial execution; otherwise, it must outlive the simulation. If the scene has an accuracy,
  /// create() chooses the numerics once. Commands do not change this choice.
  static Result<Simulation> create(const Scene& scene, TaskRunner* runner = nullptr,
                                   InstructionSet instructions = best_instruction_set());

  /// Returns the simulation of a snapshot's bytes, which continues bitwise equal. The bytes can be
  /// loaded by any process, on any machine that supports the instruction set. Without
  /// `instructions`, the simulation uses the instruction set of the bytes. Fails if the bytes are
  /// incomplete, damaged, in another version of the format, or saved with another instruction set.
  /// Codes: other_format, other_version, wrong_length, damaged, bad_value, other_instruction_set,
  /// not_available.
  static Result<Simulation> load(std::span<const std::uint8_t> bytes, TaskRunner* runner = nullptr,
                                 std::optional<InstructionSet> instructions = {});

  /// Returns an independent simulation in the state of the snapshot, which continues bitwise equal.
  /// Another thread can use it at the same time as the simulation of the snapshot. `runner` as in
  /// create().
  static Simulation from(const Snapshot& snapshot, TaskRunner* runner = nullptr);

  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Takes the following steps by `engine`, if it has the features of the scene; see
  /// StepEngine::bind(). Otherwise fails, and changes nothing. If an engine fails later, the
  /// simulation continues without it; see AdvanceReport::device_error. After a command, the CPU
  /// takes the steps while the engine lacks a feature of the scene. Copies of the simulation have
  /// no engine.
  Status set_engine(std::unique_ptr<StepEngine> engine);
  /// Sets the engine as set_engine(), even if the engine lacks a feature of the present scene. A
  /// loaded simulation then continues as the saved one. Fails with the code "device_failed".
  Status resume_engine(std::unique_ptr<StepEngine> engine);
  bool has_engine() const;
  /// Returns a name of the arithmetic of the steps: that of the engine, or the instruction set.
  std::string_view arithmetic() const;

  /// Advances the simulation by `steps` steps of step_size(). The StepControl of the scene may
  /// divide each step. After each part, the state is checked; see GuardEvent. After a failure or an
  /// exception, the state is that before the call.
  AdvanceReport advance(std::uint32_t steps);

  Real time() const;       ///< [s]
  Real step_size() const;  ///< nominal step [s]
  std::uint32_t steps_per_tick() const;
  InstructionSet instruction_set() const;  ///< set of the vectorised loops
  const Scene& scene() const;              ///< current scene, including changes by commands

  std::size_t particle_count() const;
  /// Returns the number of particles if all emitters add as many as permitted.
  std::size_t greatest_particle_count() const;
  std::size_t spring_count() const;
  /// Returns the number of sleeping bodies; see Scene::sleeping.
  std::size_t sleeping_body_count() const;

  /// Returns all bodies: the bodies of the scene in order, then added bodies in the order of their
  /// addition.
  std::vector<BodyView> bodies() const;
  /// Returns the body with this id, or an empty optional if no body has this id. The id of a body
  /// never changes.
  std::optional<BodyView> find_body(BodyId id) const;
  /// Returns the id of the body with this name, or an empty optional if no body has this name.
  std::optional<BodyId> find_body(std::string_view name) const;
  /// Returns an owner of the memory of all present views. While the owner exists, the views remain
  /// valid and keep their values. The simulation continues with a copy of positions and velocities.
  std::shared_ptr<const void> keep_views();
  /// Returns the current displacement of the vat [m]. The result is zero without a vat or motion.
  Vec3 vat_offset() const;
  /// Returns the SPH fields of a liquid body. The cost is about one force evaluation. Fails if the
  /// body does not exist or is not liquid.
  Result<LiquidFields> liquid_fields(BodyId id) const;
  /// Returns the fields of all bodies, in the order of bodies(), for the cost of one body. The
  /// fields of bodies that are not liquid are empty.
  std::vector<LiquidFields> liquid_fields() const;
  /// Measures the current state. The cost is about one force evaluation.
  Diagnostics diagnostics() const;

  /// Returns a 64-bit hash of all data that determine the next steps: state, stored forces,
  /// gravity, open emitters, grabs and applied forces. Within one scene, equal hashes mean equal
  /// future states.
  std::uint64_t state_hash() const;
  /// Returns a copy of the current state, with the bodies and the active commands.
  Snapshot snapshot() const;
  /// Restores a snapshot of this simulation, or of another simulation with the same instruction
  /// set, including bodies and commands. Ids of bodies are not reused.
  void restore(const Snapshot& snapshot);

  /// Returns a text that lists the stages of one force evaluation, with the columns (particle
  /// arrays) that each stage reads and writes.
  std::string plan_text() const;
  /// Sets the observer of the stages of all following steps. The observer must outlive its use;
  /// null removes the observer.
  void set_observer(StageObserver* observer);

 private:
  Simulation();
};

}  // namespace vat
