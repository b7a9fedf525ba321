#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics.h"
#include "core/scene/scene.h"
#include "core/stage/advance_report.h"
#include "core/stage/observer.h"
#include "core/support/instruction_set.h"
#include "core/support/parallel.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

/// A rigid body's pose and motion.
struct RigidPose {
  Vec3 center_of_mass;    ///< [m]
  Quat orientation;       ///< body axes, those of the body's shape, to world axes
  Vec3 velocity;          ///< [m/s] of the centre of mass
  Vec3 angular_velocity;  ///< [rad/s] world axes
};

/// Read-only view of one body; valid until the simulation next changes. A particle's index is its
/// place here: emitted particles are added at the end, and where some are drained, those after them
/// move up in their order. Its number is its own from its coming to its going: the n particles that
/// a body starts with have 0 to n - 1, and each one emitted has the next.
struct BodyView {
  BodyId id;
  std::string_view name;
  BodyKind kind;
  std::string_view material;
  std::span<const Vec3> positions;        ///< [m] world axes, as are velocities
  std::span<const Vec3> velocities;       ///< [m/s]
  std::span<const Real> masses;           ///< [kg]
  std::span<const Real> radii;            ///< [m]
  std::optional<RigidPose> pose;          ///< rigid bodies
  std::span<const Vec3> local_positions;  ///< [m] rigid bodies: about the centre of mass, body axes
  bool is_asleep = false;                 ///< see Scene::sleeping
  std::span<const Index> numbers{};       ///< rising; empty: each particle's is its index
};

/// SPH fields of one liquid body at the present positions, one value a particle.
struct LiquidFields {
  std::vector<Real> density;   ///< [kg/m^3]
  std::vector<Real> pressure;  ///< [Pa]
};

/// A particle of a body, by its number.
struct ConnectedParticle {
  BodyId body = 0;
  Index particle = 0;
  bool operator==(const ConnectedParticle&) const = default;
};

/// Two particles and what there is between them: of a static spring its strain, length over length
/// at rest less 1; of a contact the force along the line between them [N], negative where it pulls.
struct ConnectedPair {
  ConnectedParticle a;
  ConnectedParticle b;
  Real value = 0;
};

/// Of all that there are every so many, beginning with the first.
struct ConnectionList {
  std::size_t total = 0;
  std::size_t every = 1;
  std::vector<ConnectedPair> sample;
};

/// What of the connections is asked for.
struct ConnectionQuery {
  std::optional<BodyId> body{};  ///< those of this one alone
  std::size_t max_count = 0;     ///< of each list
};

/// Static springs that are not torn, and contacts between bodies, or within one, that push or pull.
struct Connections {
  ConnectionList springs;
  ConnectionList contacts;
};

/// Where a body is put, and how it moves from then on.
struct BodyPlacement {
  Vec3 center_of_mass = Vec3::Zero();  ///< [m]
  std::optional<Quat> orientation{};   ///< rigid bodies, as in RigidPose; as it is without
  /// [m/s] of all of the body, which then does not turn; as it is without.
  std::optional<Vec3> velocity{};
};

/// Where the particles of a body are, and how they move, as BodyView tells it.
struct BodyMotion {
  std::vector<Vec3> positions;      ///< [m] world axes; of liquid and deformable bodies
  std::vector<Vec3> velocities;     ///< [m/s] the same
  std::optional<RigidPose> pose{};  ///< of rigid bodies, in their place
};

class Snapshot;

/// A particle simulation of one scene. Commands take effect between steps. Not thread-safe; one
/// simulation must not be used from two threads at once. Same scene, same commands, same
/// instruction set: same bits, for any TaskRunner.
class Simulation {
 public:
  /// Fails with every error of the scene, and where this machine lacks the instruction set (see
  /// check_available()). `runner` may be null (serial) and must outlive this. An accuracy chooses
  /// the numerics once: commands do not change them.
  static Result<Simulation> create(const Scene& scene, TaskRunner* runner = nullptr,
                                   InstructionSet instructions = best_instruction_set());

  /// Goes on from the bytes of a snapshot with the same bits, in any process of any machine that
  /// has the instruction set. Fails where the bytes are not all of those that a snapshot gave, are
  /// of another version of the format, or were saved with other instructions: those of the bytes
  /// are used where none are given. Codes: other_format, other_version, wrong_length, damaged,
  /// bad_value, other_instruction_set, not_available.
  static Result<Simulation> load(std::span<const std::uint8_t> bytes, TaskRunner* runner = nullptr,
                                 std::optional<InstructionSet> instructions = {});

  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Takes `steps` steps of step_size(), each in the parts that the scene's StepControl chooses,
  /// all of them guarded: see GuardEvent. All or none: after a failure, or an exception, the state
  /// is the one before the call.
  AdvanceReport advance(std::uint32_t steps);

  InstructionSet instruction_set() const;  ///< of the vectorised loops
  Real time() const;                       ///< [s]
  Real step_size() const;                  ///< [s]
  std::uint32_t steps_per_tick() const;
  std::size_t particle_count() const;
  /// With all that emitters may add.
  std::size_t greatest_particle_count() const;
  std::size_t spring_count() const;
  /// Those that are not stepped at present; see Scene::sleeping.
  std::size_t sleeping_body_count() const;
  const Scene& scene() const;  ///< as it is now: commands change it

  /// In the order of the scene; added bodies are last.
  std::vector<BodyView> bodies() const;
  /// The same in a list whose memory is used again.
  void list_bodies(std::vector<BodyView>& views) const;
  /// Nothing if no body has this id. Ids stay with their bodies, whatever is added or removed.
  std::optional<BodyView> find_body(BodyId id) const;
  /// Nothing if no body has this name.
  std::optional<BodyId> find_body(std::string_view name) const;
  /// The vat's present displacement [m]; zero without a vat or motion.
  Vec3 vat_offset() const;
  /// Fails for a body that is not liquid.
  Result<LiquidFields> liquid_fields(BodyId id) const;
  /// The same in columns whose memory is used again.
  Status measure_liquid(BodyId id, LiquidFields& fields) const;

  /// 64-bit hash of all that the next steps start from: the state, with the forces that are kept
  /// from the last step, gravity, open emitters, grabs and applied forces. Equal futures for one
  /// scene.
  std::uint64_t state_hash() const;
  /// A copy of the present state, with the bodies and the commands in force.
  Snapshot snapshot() const;
  /// Goes to a snapshot taken from this simulation, or from another with the same instruction set,
  /// bodies and commands in force included. Ids go on: none that this one gave is given again.
  void restore(const Snapshot& snapshot);

  /// Measures the present state, at the cost of about one force evaluation.
  Diagnostics diagnostics() const;
  /// Springs and contacts of the present state, at the cost of about one force evaluation where
  /// bodies may touch; by projection those of the last step. Fails if there is no such body.
  Result<Connections> connections(const ConnectionQuery& query) const;
  /// The stages of one force evaluation and the columns they read and write, as text.
  std::string plan_text() const;
  /// Told of the stages of every step from now on; null for nobody. It must outlive its use here.
  void set_observer(StageObserver* observer);

  /// Adds a body at the present time. Fails like create(), paths under "/body"; its name must be
  /// new.
  Result<BodyId> add_body(const BodyDescription& body);
  /// The same of one that has been there: it is as described, but where and as fast as `motion`
  /// tells. Fails too where that is not of all its particles, out of range or out of the vat; paths
  /// under "/state".
  Result<BodyId> add_body(const BodyDescription& body, const BodyMotion& motion);
  /// Ends the body's grabs and applied forces too, and its emitters. Fails if there is no such
  /// body.
  Status remove_body(BodyId id);
  /// Puts a body elsewhere, turned if it is rigid, and keeps its shape. What users hold of it stays
  /// held. Its description begins that much elsewhere, that of a rigid body where it is put. Fails
  /// if there is no such body, it has no particles or some in a nozzle, it leaves the vat, the
  /// plane of a scene in two dimensions or kMaxLength, is faster than kMaxSpeed, or would have more
  /// pairs than a scene may start with.
  Status move_body(BodyId id, const BodyPlacement& placement);
  /// Adds a material, or replaces the constants of the one of its name: those of springs too, and
  /// where the density changes the masses of all that is of it and was not given a mass; velocities
  /// stay, and so does what springs have flown or torn, as long as they join the same particles.
  /// Numerics stay as they are. Fails like create(), paths under "/material", and where a liquid
  /// that an emitter feeds would change its support radius.
  Status set_material(const Material& material);
  /// Moves the vat by hand, beside its own motion: from how far the hand has moved it by now to
  /// `offset` [m], with at most kMaxHandSpeed and kMaxHandAcceleration along each axis, and there
  /// it stays. Fails without a vat, for an offset longer along an axis than the vat's longest side,
  /// one along a periodic axis or out of the plane of a scene in two dimensions, and where an
  /// emitter would be outside.
  Status move_vat(const Vec3& offset);
  /// Opens or closes an emitter: of a closed one what is in its tube goes on, and nothing comes
  /// after it. Fails if there is no emitter of that name.
  Status set_emitter(std::string_view name, bool open);
  /// Makes a deformable body liquid, of a material with liquid constants: its particles keep their
  /// places, velocities and masses, so that momentum is kept, and lose their springs; none stays
  /// fixed. Ends the body's grabs and applied forces. Fails if there is no such body or material,
  /// the body is not deformable, or the material is not for liquids or for this body's particles.
  Status melt_body(BodyId id, const std::string& material);
  /// `gravity` in m/s^2, each component at most kMaxGravity in magnitude; fails beyond.
  Status set_gravity(const Vec3& gravity);
  /// Steps with another integrator, or in nominal steps of another length [s], from now on; the
  /// tick stays. Fails like create(), paths /integrator and /step, where the step of a scene with
  /// emitters would change, and within a tick.
  Status set_numerics(IntegratorId integrator, Real step);
  /// Adds or replaces one interface. Fails like create(), paths under "/interface".
  Status set_interface(const InterfaceDescription& interface);
  /// A force [N] on the whole body as it is now, in equal accelerations, for `duration` seconds
  /// rounded up to whole steps; weakened as much, so that the impulse is force times duration.
  /// Fails if there is no such body or it is empty, a component is beyond kMaxForce, the duration
  /// is not above 0 and at most kMaxForceTime, or kMaxAppliedForces act already.
  Status apply_force(BodyId id, const Vec3& force, Real duration);

  /// Ties a particle to a target by a critically damped spring. A deformable or liquid body is held
  /// by the particles around the grabbed one. `grab` is the caller's name for it; starting a grab
  /// that exists moves it to the new particle. Fails if there is no such body or particle, `target`
  /// [m] is not within kMaxLength, or there are kMaxGrabs others.
  Status grab_start(std::uint64_t grab, BodyId id, Index particle, const Vec3& target);
  /// Moves the target [m]. Fails if there is no such grab, or beyond kMaxLength.
  Status grab_move(std::uint64_t grab, const Vec3& target);
  /// Lets go. Fails if there is no such grab, as when its body was removed.
  Status grab_end(std::uint64_t grab);
  /// Where the grab pulls to [m]; nothing where there is no such grab.
  std::optional<Vec3> grab_target(std::uint64_t grab) const;

 private:
  Simulation();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Everything needed to go on with the same bits. Constant: copies share their content, and it may
/// be read by any thread.
class Snapshot {
 public:
  Snapshot(const Snapshot&);
  Snapshot(Snapshot&&) noexcept;
  Snapshot& operator=(const Snapshot&);
  Snapshot& operator=(Snapshot&&) noexcept;
  ~Snapshot();

  /// That of the simulation as it was.
  std::uint64_t state_hash() const;
  const Scene& scene() const;  ///< as it was then; see Simulation::scene()
  /// For Simulation::load(): the scene as it was, the state and the commands in force. Per particle
  /// 48 bytes, of liquids by incompressible solves 8 more, with velocity Verlet 24 more, where
  /// liquid flows in or out or has melted 64 more; a body that sleeps counts once, others beside it
  /// twice.
  std::vector<std::uint8_t> to_bytes() const;

 private:
  friend class Simulation;
  struct Content;
  Snapshot(std::shared_ptr<const Content> content, BodyId next_id, InstructionSet instructions);
  std::shared_ptr<const Content> content_;
  BodyId next_id_;
  InstructionSet instructions_;
};

}  // namespace vat
