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
#include "core/simulation/numerics_change.h"
#include "core/support/result.h"
#include "core/types.h"

namespace vat {

struct SimulationImpl;

/// Part of Simulation for programs that let users inspect and change a running scene. Commands take
/// effect between steps. A command that fails changes nothing.
class HostInterface {
 public:
  /// Fills `views` as Simulation::bodies() does, and reuses its memory.
  void list_bodies(std::vector<BodyView>& views) const;
  /// Writes the result of Simulation::liquid_fields() to `fields`, and reuses its memory.
  Status measure_liquid(BodyId id, LiquidFields& fields) const;
  /// Returns springs and contacts of the current state. The cost is about one force evaluation if
  /// bodies can touch. Contacts by projection are those of the last step. Fails if the body of the
  /// query does not exist.
  Result<Connections> connections(const ConnectionQuery& query) const;

  /// Returns the momenta of a rigid body, or an empty optional for other bodies and unknown ids.
  std::optional<RigidMomentum> rigid_momentum(BodyId id) const;

  /// Adds a body at the current time. Fails like Simulation::create(), with paths under "/body",
  /// and if the name is in use.
  Result<BodyId> add_body(const BodyDescription& body);
  /// Adds a body with the positions and velocities of `motion` instead of those of its description.
  /// Also fails if `motion` does not have a value for each particle, is out of range, or is outside
  /// the vat. These errors have paths under "/state".
  Result<BodyId> add_body(const BodyDescription& body, const BodyMotion& motion);
  /// Removes a body with its grabs, applied forces and emitters. Fails if the body does not exist.
  Status remove_body(BodyId id);
  /// Moves a body, and rotates it if it is rigid. The description of the body moves with it; its
  /// shape and its grabs are unchanged. Fails if
  ///
  /// - the body does not exist, is empty, or has particles in a nozzle;
  /// - the body would leave the vat, the plane of a two-dimensional scene or kMaxLength;
  /// - the body would be faster than kMaxSpeed;
  /// - the body would have more pairs than permitted at the start of a scene.
  Status move_body(BodyId id, const BodyPlacement& placement);
  /// Replaces the positions and velocities of a body. Unlike move_body(), the description of the
  /// body is unchanged, and the cost is that of a copy and of one force evaluation. Fails if
  ///
  /// - the body does not exist, or is rigid and held, driven or has an axle;
  /// - `motion` does not have a value for each particle, or is out of range.
  ///
  /// The latter errors have paths under "/state".
  Status set_body_motion(BodyId id, const BodyMotion& motion);
  /// Adds a material, or replaces the constants of the material with the same name. A new density
  /// changes the masses of bodies without an explicit mass. Velocities and numerics are unchanged.
  /// Plastic flow and tears persist if the springs join the same particles. A change of the
  /// appearance alone does not change the state. Fails like
  /// Simulation::create(), with paths under "/material". Also fails if the support radius of an
  /// emitted liquid would change.
  Status set_material(const Material& material);
  /// Moves the vat to the displacement `offset` [m], which is added to its SlideMotion. The motion
  /// is limited to kMaxHandSpeed and kMaxHandAcceleration along each axis. Fails if
  ///
  /// - the scene has no vat;
  /// - a component of `offset` exceeds the longest side of the vat, is along a periodic axis, or
  ///   leaves the plane of a two-dimensional scene;
  /// - an emitter would be outside the vat.
  Status move_vat(const Vec3& offset);
  /// Opens or closes an emitter. Particles in the tube of a closed emitter continue to flow. Fails
  /// if no emitter has this name.
  Status set_emitter(std::string_view name, bool open);
  /// Turns a deformable body into a liquid body of a material. Particles have unchanged positions,
  /// velocities and masses; their springs are removed, and fixed particles are released. Ends the
  /// grabs and applied forces of the body. Fails if the body or the material does not exist, the
  /// body is not deformable, or the material does not suit liquids or these particles.
  Status melt_body(BodyId id, const std::string& material);
  /// Sets gravity [m/s^2]. Fails if a component exceeds kMaxGravity in magnitude.
  Status set_gravity(const Vec3& gravity);
  /// Changes the numerics; the tick and the solver are unchanged. Fails like Simulation::create(),
  /// with the names of the values as paths. Also fails if the step would change within a tick, or
  /// in a scene with emitters.
  Status set_numerics(const NumericsChange& change);
  /// Sets the integrator and the nominal step [s].
  Status set_numerics(IntegratorId integrator, Real step);
  /// Adds or replaces an interface. Fails like Simulation::create(), with paths under "/interface".
  Status set_interface(const InterfaceDescription& interface);
  /// Applies a force [N] to the whole body, as equal accelerations of its particles, for `duration`
  /// [s]. The duration is rounded up to whole steps, and the force is reduced so that the impulse
  /// is unchanged. Fails if
  ///
  /// - the body does not exist or is empty;
  /// - a component of the force exceeds kMaxForce;
  /// - the duration is not in (0, kMaxForceTime];
  /// - kMaxAppliedForces forces already act.
  Status apply_force(BodyId id, const Vec3& force, Real duration);

  /// Connects a particle to a target by a critically damped spring. In deformable and liquid
  /// bodies, the spring acts on the particles around it. The caller chooses the identifier `grab`.
  /// If a grab with this identifier exists, it moves to the new particle. Fails if the body or the
  /// particle does not exist, `target` [m] is not within kMaxLength, or there are kMaxGrabs other
  /// grabs.
  Status grab_start(std::uint64_t grab, BodyId id, Index particle, const Vec3& target);
  /// Moves the target [m]. Fails if the grab does not exist or the target exceeds kMaxLength.
  Status grab_move(std::uint64_t grab, const Vec3& target);
  /// Ends a grab. Fails if the grab does not exist, for example because its body was removed.
  Status grab_end(std::uint64_t grab);
  /// Returns the target of a grab [m], or an empty optional if the grab does not exist.
  std::optional<Vec3> grab_target(std::uint64_t grab) const;

 protected:
  HostInterface();
  HostInterface(HostInterface&&) noexcept;
  HostInterface& operator=(HostInterface&&) noexcept;
  ~HostInterface();

  /// The data of a simulation. Access by -> or * first reads the state from the device, if it is
  /// there. After access that may change the state, the device starts from the changed state.
  class Data {
   public:
    Data();
    Data(Data&&) noexcept;
    Data& operator=(Data&&) noexcept;
    ~Data();

    SimulationImpl* operator->() const;
    SimulationImpl* operator->();
    SimulationImpl& operator*() const { return *operator->(); }
    SimulationImpl& operator*() { return *operator->(); }
    /// Returns the data without reading the state from the device.
    SimulationImpl& unread() const { return *impl_; }

   private:
    std::unique_ptr<SimulationImpl> impl_;
  };

  Data impl_;
};

}  // namespace vat
