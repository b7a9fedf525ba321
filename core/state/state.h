#pragma once

#include <cstdint>
#include <vector>

#include "core/diagnostics.h"
#include "core/model/model.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Pose and momenta of a rigid body. The angular momentum, not the angular velocity, is state: it
/// is exactly constant where no torque acts.
struct RigidState {
  Vec3 center_of_mass;    ///< r_cm [m]
  Quat orientation;       ///< body axes to world axes
  Vec3 momentum;          ///< M v_cm [kg m/s]
  Vec3 angular_momentum;  ///< L about r_cm, world axes [kg m^2/s]
};

/// What a contact by projection did in the last step, from which the next solve starts: over the
/// step's length, on the particle.
struct ContactImpulse {
  Index particle = 0;
  std::uint64_t other = 0;     ///< a wall, or kWallCount and the other particle's index
  Vec3 drift = Vec3::Zero();   ///< at the step's start [N]
  Vec3 finish = Vec3::Zero();  ///< at its end [N]
  bool is_steady = false;      ///< not much more than in the step before
};

/// What becomes of one spring that may flow or tear, kept at each of its ends.
struct SpringState {
  Real rest_length = 0;  ///< [m]
  bool is_torn = false;
};

/// What is integrated. Positions and velocities of rigid particles follow from the rigid states and
/// are kept here so that every force sees one geometry.
struct Configuration {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
  std::vector<RigidState> rigid;
  std::vector<ContactImpulse> contacts{};  ///< by projection, by particle and other
  std::vector<SpringState> springs{};      ///< by end; empty where no spring may flow or tear
  std::vector<Real> pressure{};  ///< of liquid, that the next step starts from; incompressible [Pa]
};

/// to = from, many particles side by side.
void copy(const Configuration& from, TaskRunner* runner, Configuration& to);

/// Forces at a configuration: on every particle [N], and their resultants on rigid bodies.
struct Forces {
  std::vector<Vec3> particle;
  std::vector<Vec3> rigid_force;   ///< f_res, Boldt eq. 5 [N]
  std::vector<Vec3> rigid_torque;  ///< tau about r_cm, Boldt eq. 6 [N m]
  /// Of friction on rigid particles, about their centres [N m]; empty where there is none. Read by
  /// rigid_torque alone.
  std::vector<Vec3> friction_torque{};
  std::vector<Vec3>
      transport;  ///< of liquids that fill their world, see core/liquid/tait/transport.h
};

/// What adaptive step control remembers from one step to the next.
struct StepHistory {
  Real step = 0;           ///< the last one; 0: there was none [s]
  std::uint32_t held = 0;  ///< steps since it changed
  Real observed_rate = 0;  ///< of motion in bodies, in the last step [rad/s]
};

/// The levels of local step control: a particle of level l takes steps of the whole one over 2^l.
struct LocalLevels {
  std::vector<std::uint8_t> particle;
  std::uint8_t liquid = 0;  ///< of the liquids' own forces
  Real skin = 0;            ///< how much beyond its threshold a contact is looked after [m]
};

/// All that is needed to go on with the same bits.
struct State {
  Configuration now;
  std::uint64_t step_count = 0;  ///< nominal steps since time 0
  /// Of the last evaluation; velocity Verlet opens a step with them. With local control, each
  /// connection's over 2^level.
  Forces forces;
  /// Upper bound of the oscillations that those forces allow; read by velocity Verlet.
  Oscillation bound;
  bool forces_current = false;  ///< false: something but the integrator changed what they depend on
  StepHistory history;
  VolumeReport volume;        ///< of the last step, for diagnostics
  LocalLevels levels;         ///< with which the forces were evaluated; local control only
  std::uint64_t emitted = 0;  ///< particles, since time 0
  std::uint64_t drained = 0;  ///< the same
  /// By body, for how many looks it has been slow; where the scene has sleeping.
  std::vector<std::uint32_t> slow_looks{};
};

/// The state at time 0.
State initial_state(const Model& model);

/// The initial configuration of one body, written over its part of `state`.
void place_body(const Model& model, const ModelBody& body, Configuration& configuration);

}  // namespace vat
