#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene.h"
#include "core/simulation/body_values.h"
#include "core/simulation/connection_values.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

struct SimulationImpl;

/// The part of Simulation for programs that let users inspect and change a running scene. Commands
/// take effect between steps. A command that fails changes nothing.
class HostInterface {
 public:
  /// Like Simulation::bodies(), into a list whose memory is reused.
  void list_bodies(std::vector<BodyView>& views) const;
  /// Like Simulation::liquid_fields(), into columns whose memory is reused.
  Status measure_liquid(BodyId id, LiquidFields& fields) const;
  /// Returns springs and contacts of the present state. Costs about one force evaluation if bodies
  /// can touch. Contacts by projection are those of the last step. Fails if the body does not
  /// exist.
  Result<Connections> connections(const ConnectionQuery& query) const;

  /// Adds a body at the present time. Fails like Simulation::create(), with paths under "/body", or
  /// if its name is in use.
  Result<BodyId> add_body(const BodyDescription& body);
  /// Adds a body with the positions and velocities of `motion` in place of those of its
  /// description. Fails also if `motion` does not have a value for each particle, is out of range,
  /// or is outside the vat; these paths are under "/state".
  Result<BodyId> add_body(const BodyDescription& body, const BodyMotion& motion);
  /// Removes a body with its grabs, applied forces and emitters. Fails if the body does not exist.
  Status remove_body(BodyId id);
  /// Moves a body, and rotates it if it is rigid. Its shape and its grabs stay. Its description
  /// moves with it. Fails if the body does not exist, is empty or has particles in a nozzle; if it
  /// leaves the vat, the plane of a two-dimensional scene or kMaxLength; if it is faster than
  /// kMaxSpeed; or if it would have more pairs than a scene may start with.
  Status move_body(BodyId id, const BodyPlacement& placement);
  /// Adds a material, or replaces the constants of the material with this name. A new density
  /// changes the masses of bodies that have no explicit mass. Velocities stay. Plastic flow and
  /// tears stay if the springs join the same particles. Numerics stay. Fails like
  /// Simulation::create(), with paths under "/material", and if the support radius of an emitted
  /// liquid would change.
  Status set_material(const Material& material);
  /// Moves the vat by `offset` [m], in addition to its own motion, with at most kMaxHandSpeed and
  /// kMaxHandAcceleration along each axis. Fails without a vat; for an offset along an axis that
  /// exceeds the longest side of the vat, is periodic or leaves the plane of a two-dimensional
  /// scene; and if an emitter would be outside.
  Status move_vat(const Vec3& offset);
  /// Opens or closes an emitter. Particles in the tube of a closed emitter continue to flow. Fails
  /// if there is no emitter with this name.
  Status set_emitter(std::string_view name, bool open);
  /// Turns a deformable body into a liquid body of this material. Particles keep their positions,
  /// velocities and masses, and lose their springs; fixed particles are released. Ends the body's
  /// grabs and applied forces. Fails if the body or the material does not exist, the body is not
  /// deformable, or the material does not suit liquids or these particles.
  Status melt_body(BodyId id, const std::string& material);
  /// Sets gravity [m/s^2]. Fails if a component exceeds kMaxGravity in magnitude.
  Status set_gravity(const Vec3& gravity);
  /// Changes the integrator and the nominal step [s]; the tick stays. Fails like
  /// Simulation::create(), with the paths /integrator and /step; within a tick; and if the step of
  /// a scene with emitters would change.
  Status set_numerics(IntegratorId integrator, Real step);
  /// Adds or replaces an interface. Fails like Simulation::create(), with paths under "/interface".
  Status set_interface(const InterfaceDescription& interface);
  /// Applies a force [N] to the whole body, as equal accelerations, for `duration` [s]. The
  /// duration is rounded up to whole steps, and the force reduced to keep the impulse. Fails if the
  /// body does not exist or is empty, a component exceeds kMaxForce, the duration is not above 0
  /// and at most kMaxForceTime, or kMaxAppliedForces act already.
  Status apply_force(BodyId id, const Vec3& force, Real duration);

  /// Ties a particle to a target by a critically damped spring. In deformable and liquid bodies the
  /// spring acts on the particles around it. The caller chooses the id `grab`; an existing grab
  /// moves to the new particle. Fails if the body or the particle does not exist, `target` [m] is
  /// not within kMaxLength, or there are kMaxGrabs other grabs.
  Status grab_start(std::uint64_t grab, BodyId id, Index particle, const Vec3& target);
  /// Moves the target [m]. Fails if the grab does not exist or the target is beyond kMaxLength.
  Status grab_move(std::uint64_t grab, const Vec3& target);
  /// Ends a grab. Fails if it does not exist, for example because its body was removed.
  Status grab_end(std::uint64_t grab);
  /// Returns the target of a grab [m]; empty if the grab does not exist.
  std::optional<Vec3> grab_target(std::uint64_t grab) const;

 protected:
  HostInterface();
  HostInterface(HostInterface&&) noexcept;
  HostInterface& operator=(HostInterface&&) noexcept;
  ~HostInterface();

  std::unique_ptr<SimulationImpl> impl_;
};

}  // namespace vat
