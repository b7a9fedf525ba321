#pragma once

#include <cstdint>
#include <vector>

#include "core/diagnostics.h"
#include "core/model/model.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Pose and momenta of a rigid body. The state has the angular momentum, because it is exactly
/// constant without torque; the angular velocity is not.
struct RigidState {
  Vec3 center_of_mass;    ///< r_cm [m]
  Quat orientation;       ///< body axes to world axes
  Vec3 momentum;          ///< M v_cm [kg m/s]
  Vec3 angular_momentum;  ///< L about r_cm, world axes [kg m^2/s]
};

/// Forces of a contact by projection in the last step, on the particle, as means over the step. The
/// next solve starts from them.
struct ContactImpulse {
  Index particle = 0;
  std::uint64_t other = 0;     ///< a wall, or kWallCount + index of the other particle
  Vec3 drift = Vec3::Zero();   ///< at the start of the step [N]
  Vec3 finish = Vec3::Zero();  ///< at the end of the step [N]
  bool is_steady = false;      ///< not much larger than in the step before
};

/// State of a spring that may flow or tear, stored at each of its ends.
struct SpringState {
  Real rest_length = 0;  ///< [m]
  bool is_torn = false;
};

/// The integrated variables. Positions and velocities of rigid particles follow from the rigid
/// states, and are stored so that all forces use the same geometry.
struct Configuration {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
  std::vector<RigidState> rigid;
  std::vector<ContactImpulse>
      contacts{};                      ///< contacts by projection, ordered by particle and other
  std::vector<SpringState> springs{};  ///< by spring end; empty if no spring may flow or tear
  std::vector<Real>
      pressure{};  ///< of incompressible liquids, from which the next step starts [Pa]
};

/// to = from, in parallel.
void copy(const Configuration& from, TaskRunner* runner, Configuration& to);

/// Forces at a configuration: on all particles [N], and their resultants on rigid bodies.
struct Forces {
  std::vector<Vec3> particle;
  std::vector<Vec3> rigid_force;   ///< f_res, Boldt eq. 5 [N]
  std::vector<Vec3> rigid_torque;  ///< tau about r_cm, Boldt eq. 6 [N m]
  /// Torque of friction on rigid particles about their centres [N m]; empty without friction. It
  /// enters rigid_torque only.
  std::vector<Vec3> friction_torque{};
  std::vector<Vec3>
      transport;  ///< of liquids that fill their world, see core/liquid/tait/transport.h
};

/// Data of adaptive step control from the last step.
struct StepHistory {
  Real step = 0;           ///< length of the last step; 0: no step yet [s]
  std::uint32_t held = 0;  ///< steps since the last change
  Real observed_rate = 0;  ///< rate of motion within bodies in the last step [rad/s]
};

/// Levels of local step control: the step of a particle of level l is the whole step / 2^l.
struct LocalLevels {
  std::vector<std::uint8_t> particle;
  std::uint8_t liquid = 0;  ///< of the forces of liquids
  Real skin = 0;            ///< distance beyond the threshold up to which contacts are listed [m]
};

/// All variables that are needed to continue with the same bits.
struct State {
  Configuration now;
  std::uint64_t step_count = 0;  ///< nominal steps since time 0
  /// Forces of the last evaluation, with which velocity Verlet starts a step. With local control,
  /// the force of each connection is divided by 2^level.
  Forces forces;
  /// Upper bound of the oscillations that these forces allow; used by velocity Verlet.
  Oscillation bound;
  bool forces_current =
      false;  ///< false: the state has been changed since by something other than the integrator
  StepHistory history;
  VolumeReport volume;        ///< of the last step, for diagnostics
  LocalLevels levels;         ///< levels of the forces; local control only
  std::uint64_t emitted = 0;  ///< number of particles, since time 0
  std::uint64_t drained = 0;  ///< number of particles, since time 0
  /// For each body, the number of checks in which it was slow; in scenes with sleeping.
  std::vector<std::uint32_t> slow_looks{};
};

/// The state at time 0.
State initial_state(const Model& model);

/// Writes the initial configuration of one body to its part of `configuration`.
void place_body(const Model& model, const ModelBody& body, Configuration& configuration);

}  // namespace vat
