#pragma once

#include <cstdint>
#include <vector>

#include "core/diagnostics.h"
#include "core/model/model.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Pose and momenta of a rigid body. The state contains the angular momentum instead of the angular
/// velocity, because only the angular momentum is exactly constant without torque.
struct RigidState {
  Vec3 center_of_mass;    ///< r_cm [m]
  Quat orientation;       ///< body axes to world axes
  Vec3 momentum;          ///< M v_cm [kg m/s]
  Vec3 angular_momentum;  ///< L about r_cm, world axes [kg m^2/s]
};

/// The forces of a contact by projection on a particle, averaged over the last step. The next solve
/// starts from these forces.
struct ContactImpulse {
  Index particle = 0;
  std::uint64_t other = 0;     ///< a wall, or kWallCount + index of the other particle
  Vec3 drift = Vec3::Zero();   ///< of the solve at the start of the step [N]
  Vec3 finish = Vec3::Zero();  ///< of the solve at the end of the step [N]
  bool is_steady = false;      ///< the next step may start with these forces
};

/// State of a plastic or tearable spring, stored at each end of the spring.
struct SpringState {
  Real rest_length = 0;  ///< [m]
  bool is_torn = false;
};

/// The integrated variables. The positions and velocities of rigid particles are functions of the
/// rigid states, and are stored so that all forces use the same geometry.
struct Configuration {
  std::vector<Vec3> position;
  std::vector<Vec3> velocity;
  std::vector<RigidState> rigid;
  /// Contacts by projection, ordered by particle and other.
  std::vector<ContactImpulse> contacts{};
  std::vector<SpringState> springs{};  ///< by spring end; empty without plastic or tearable springs
  /// Pressure of incompressible liquids, which is the initial value of the next solve [Pa].
  std::vector<Real> pressure{};
};

/// Copies `from` to `to` in parallel.
void copy(const Configuration& from, TaskRunner* runner, Configuration& to);

/// The forces of a configuration: on each particle [N], and the resultants on each rigid body.
struct Forces {
  std::vector<Vec3> particle;
  std::vector<Vec3> rigid_force;   ///< f_res, Boldt eq. 5 [N]
  std::vector<Vec3> rigid_torque;  ///< tau about r_cm, Boldt eq. 6 [N m]
  /// Torque of friction on rigid particles about their centres [N m]; empty without friction. This
  /// torque affects only rigid_torque.
  std::vector<Vec3> friction_torque{};
  /// Transport velocities w of liquids that fill their world; see core/liquid/tait/transport.h.
  std::vector<Vec3> transport;
};

/// Data that adaptive step control uses in the next step.
struct StepHistory {
  Real step = 0;           ///< length of the last step; 0: no step yet [s]
  std::uint32_t held = 0;  ///< steps since the last change of the step length
  Real observed_rate = 0;  ///< observed rate of motion within bodies in the last step [rad/s]
};

/// The levels of local step control. A particle of level l takes steps of the whole step / 2^l.
struct LocalLevels {
  std::vector<std::uint8_t> particle;
  std::uint8_t liquid = 0;  ///< level of the forces of liquids
  Real skin = 0;            ///< distance beyond the threshold up to which contacts are listed [m]
};

/// All variables that are needed to continue a simulation with bitwise equal results.
struct State {
  Configuration now;
  std::uint64_t step_count = 0;  ///< nominal steps since time 0
  /// The forces of the last evaluation; velocity Verlet starts a step with these forces. With local
  /// control, the force of each connection is divided by 2^level.
  Forces forces;
  /// Upper bound of the oscillations of `forces`; used by velocity Verlet.
  Oscillation bound;
  /// Whether the state has changed only by steps since the last evaluation.
  bool forces_current = false;
  StepHistory history;
  VolumeReport volume;        ///< report of the last step, for diagnostics
  LocalLevels levels;         ///< levels of the forces; local control only
  std::uint64_t emitted = 0;  ///< number of emitted particles since time 0
  std::uint64_t drained = 0;  ///< number of drained particles since time 0
  /// For each body, the number of consecutive checks in which the body was slow; only in scenes
  /// with sleeping.
  std::vector<std::uint32_t> slow_looks{};
};

/// Returns the state at time 0.
State initial_state(const Model& model);

/// Writes the initial configuration of one body to its part of `configuration`.
void place_body(const Model& model, const ModelBody& body, Configuration& configuration);

}  // namespace vat
