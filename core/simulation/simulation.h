#pragma once

#include <cstddef>
#include <cstdint>
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

/// A particle simulation of one scene. It is not thread-safe: two threads must not use it at the
/// same time. For the same scene, commands and instruction set it computes the same bits with every
/// TaskRunner. HostInterface has the commands that change a running scene.
///
///     Result<Simulation> created = Simulation::create(scene);
///     if (!created) return created.errors();
///     Simulation& simulation = created.value();
///     while (simulation.time() < 1) simulation.advance(simulation.steps_per_tick());
class Simulation : public HostInterface {
 public:
  /// Creates the simulation of a scene at time 0. Fails with all errors of the scene, and if this
  /// machine does not have the instruction set (see check_available()). `runner` may be null
  /// (serial) and must outlive the simulation. If the scene has an accuracy, it chooses the
  /// numerics once; commands do not change them.
  static Result<Simulation> create(const Scene& scene, TaskRunner* runner = nullptr,
                                   InstructionSet instructions = best_instruction_set());

  /// Continues from the bytes of a snapshot with the same bits, in any process on any machine that
  /// has the instruction set. Without `instructions` it uses the instruction set of the bytes.
  /// Fails if the bytes are incomplete, damaged, of another version of the format, or were saved
  /// with another instruction set. Codes: other_format, other_version, wrong_length, damaged,
  /// bad_value, other_instruction_set, not_available.
  static Result<Simulation> load(std::span<const std::uint8_t> bytes, TaskRunner* runner = nullptr,
                                 std::optional<InstructionSet> instructions = {});

  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Takes `steps` steps of step_size(), in the parts that the scene's StepControl chooses. Each
  /// part is checked; see GuardEvent. After a failure or an exception the state is that before the
  /// call.
  AdvanceReport advance(std::uint32_t steps);

  Real time() const;       ///< [s]
  Real step_size() const;  ///< nominal step [s]
  std::uint32_t steps_per_tick() const;
  InstructionSet instruction_set() const;  ///< of the vectorised loops
  const Scene& scene() const;              ///< the present scene; commands change it

  std::size_t particle_count() const;
  /// The number of particles if all emitters add as many as they may.
  std::size_t greatest_particle_count() const;
  std::size_t spring_count() const;
  /// The number of bodies that sleep; see Scene::sleeping.
  std::size_t sleeping_body_count() const;

  /// All bodies in the order of the scene, and then added ones in the order of their addition.
  std::vector<BodyView> bodies() const;
  /// The body with this id; empty if there is none. The id of a body never changes.
  std::optional<BodyView> find_body(BodyId id) const;
  /// The id of the body with this name; empty if there is none.
  std::optional<BodyId> find_body(std::string_view name) const;
  /// The present displacement of the vat [m]; zero without a vat or motion.
  Vec3 vat_offset() const;
  /// The SPH fields of a liquid body. Costs about one force evaluation. Fails if the body does not
  /// exist or is not liquid.
  Result<LiquidFields> liquid_fields(BodyId id) const;
  /// Measures the present state. Costs about one force evaluation.
  Diagnostics diagnostics() const;

  /// 64-bit hash of the data from which the next steps start: state, kept forces, gravity, open
  /// emitters, grabs and applied forces. Within one scene, equal hashes mean an equal future.
  std::uint64_t state_hash() const;
  /// A copy of the present state, with the bodies and the commands in force.
  Snapshot snapshot() const;
  /// Restores a snapshot of this simulation, or of another one with the same instruction set, with
  /// its bodies and commands. Ids of bodies are not reused.
  void restore(const Snapshot& snapshot);

  /// The stages of one force evaluation with the columns that they read and write, as text.
  std::string plan_text() const;
  /// Sets the observer of the stages of all following steps, which must outlive its use; null:
  /// no observer.
  void set_observer(StageObserver* observer);

 private:
  Simulation();
};

}  // namespace vat
