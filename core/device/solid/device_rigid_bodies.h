#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/guard/guard.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// Rigid bodies on a device, see rigid.cl. Particles are counted from the first solid particle. The
/// functions have no effect if there are none. They throw opencl::DeviceFailure.
class DeviceRigidBodies {
 public:
  DeviceRigidBodies(opencl::Program& program, const Model& model, const GuardBounds& bounds);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Returns the number of bodies.
  std::size_t count() const { return count_; }

  /// Writes the motion and forces, and which bodies are held in the next step.
  void write(const Model& model, const State& state);
  /// Writes which bodies are held in `step`.
  void hold(const Model& model, std::uint64_t step);
  /// Reads the poses and forces. The functions copy_to() then write them.
  void read();
  void copy_to(State& state) const;
  /// Reads the motion of the bodies only.
  void read_states(std::vector<RigidState>& states);
  /// Saves the present state, or returns to the saved one.
  void save();
  void restore();

  /// Ends a step, and begins the next one; see move_rigid_bodies.
  void move(const SolidParameters& p, Real step, const opencl::Buffer& counters);
  /// Moves the centres of the driven bodies from their positions at `start` to those at `end` [s].
  /// They receive the velocities at `end`. Their rotation is a part of move().
  void drive(const Model& model, Real start, Real end);
  /// Gives the driven bodies their mean velocities in a step of `step` from `start` [s].
  void begin_drive(const Model& model, Real start, Real step);
  /// Moves the centres of the driven bodies for `dt` [s] with their velocities at `start` [s].
  void drift_driven(const Model& model, Real start, Real dt);
  /// Kicks the bodies by the forces over `dt` [s].
  void kick(Real dt);
  /// Checks the state at the end of a step.
  void check(const SolidParameters& p, Real step, const opencl::Buffer& counters);
  /// Ends the last step of a call.
  void finish(const SolidParameters& p, Real step, const opencl::Buffer& counters);
  /// Sets the positions and velocities of the particles.
  void pose(const SolidParameters& p, const opencl::Buffer& position,
            const opencl::Buffer& predicted, const opencl::Buffer& counters);
  /// Sums the forces on the particles. `bounds` receives the bound of each body.
  void gather(bool has_friction, const opencl::Buffer& position, const opencl::Buffer& radius,
              const opencl::Buffer& particle_force, const opencl::Buffer& bounds);

  /// Returns the velocities by body of the scene.
  const opencl::Buffer& speeds() const { return speeds_; }

  opencl::Buffer rigid, rigid_of, poses, force;
  opencl::Buffer spins;   ///< by body of the scene; 0 for deformable bodies [rad/s]
  opencl::Buffer torque;  ///< of friction, by particle
  opencl::Buffer loads;   ///< ContactLoad, by particle

 private:
  /// The struct Rigid of rigid.cl.
  struct Constants {
    double mass;
    double inverse_mass;
    double extent;
    double travel;
    double greatest_inverse_moment;
    double inertia[9];
    double inverse_inertia[9];
    double principal_axes[4];
    double inverse_moments[3];
    double axle[3];
    double brake;  ///< angular momentum after / before the brake of an axle in a nominal step
    std::int32_t splitting[3];
    std::int32_t begin;
    std::int32_t end;
    std::int32_t body;
    std::int32_t is_held;
    std::int32_t has_axle;
    std::int32_t is_driven;
    std::int32_t padding;
  };
  /// The struct Pose of rigid.cl.
  struct Pose {
    double center[3];
    double orientation[4];
    double momentum[3];
    double angular_momentum[3];
  };

 public:
  /// Bytes of a pose.
  static constexpr std::size_t kPoseBytes = sizeof(Pose);

 private:
  static RigidState state_of(const Pose& pose);
  static Constants constants_of(const Model& model, const GuardBounds& bounds, std::size_t b);
  void drive_body(std::size_t b, const Vec3& way, const Vec3& velocity);

  opencl::Program& program_;
  const std::size_t count_;
  const std::size_t particles_;  ///< of rigid bodies
  opencl::Buffer local_position_, speeds_, saved_poses_, saved_force_;
  std::vector<Constants> constants_;
  std::vector<Pose> read_poses_;
  std::vector<Vec3> read_forces_;  ///< force and torque of each body
};

}  // namespace vat
