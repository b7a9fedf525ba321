#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/device/common/device_body_motions.h"
#include "core/device/common/device_cells.h"
#include "core/device/common/device_counters.h"
#include "core/device/common/device_motion.h"
#include "core/device/contact/device_near_bodies.h"
#include "core/device/contact/solid_geometry.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_damping.h"
#include "core/device/solid/device_elongation.h"
#include "core/device/solid/device_implicit_springs.h"
#include "core/device/solid/device_integration.h"
#include "core/device/solid/device_projection.h"
#include "core/device/solid/device_restitution.h"
#include "core/device/solid/device_rigid_bodies.h"
#include "core/device/solid/device_spring_changes.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/model.h"
#include "core/state/state.h"
#include "core/stepping/integrator.h"
#include "core/stepping/runge_kutta.h"
#include "core/support/check.h"

namespace vat {

class DeviceSolids;

/// Returns the particles of bodies in a liquid, if any.
std::optional<MovingSolids> moving_particles(const DeviceSolids* solids);

/// The bodies of a model on a device, see SolidRange: their state, and the parts of a step. A step
/// calls move(), find_forces(), gather() and then, if must_solve() holds, solve_damping(). The
/// functions throw opencl::DeviceFailure.
class DeviceSolids {
 public:
  DeviceSolids(opencl::Program& program, const Model& model, const GuardBounds& bounds);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Writes the part of a state with current forces, or before its first evaluation.
  void write(const State& state);
  /// Releases the bodies that are free from `step` on.
  void release(std::uint64_t step) {
    rigid_.hold(model_, step);
    damping_.find_mass(model_, step);
  }
  /// Reads the state. The function copy_to() then writes it.
  void read();
  void copy_to(State& state) const;
  /// Reads the motion of the bodies at the end of a step. The scene must have sleeping.
  void read_motions(BodyMotions& motions);
  /// Saves the present state, or returns to the saved one.
  void save();
  void restore();

  /// Ends a step, and begins the next one with a kick and a drift from start.time to `end` [s].
  /// Without a drift, sets the velocities of the first evaluation of a step of `step` [s].
  void move(const StepMoment& start, Real end, Real step, const opencl::Buffer& counters);
  /// Finds the particles and cells of the present positions at `time` [s], with the present
  /// velocities.
  void place(Real time, const opencl::Buffer& counters);
  /// Kicks rigid bodies for dt / 2 [s] and drifts them for `dt` from `start` [s], as
  /// Stepper::probe_start(). Requires that no solid particle is free.
  void probe(Real start, Real dt, const opencl::Buffer& counters);
  /// Computes the forces at the time `end` [s] after move(), without those of a liquid.
  void find_forces(Real end);
  /// Sums the forces on rigid bodies, and finds the bound of oscillations.
  void gather();
  /// Returns whether a step of `dt` [s] must solve for the damping by the last forces.
  bool must_solve(Real dt) const;
  /// Solves for the damping in a step of `dt` [s] that ends at the time `end` [s]. Returns the
  /// number of conjugate-gradient iterations.
  std::uint32_t solve_damping(Real end, Real dt);
  /// Adds the work of the solves for springs since save() to a report.
  void count_work(AdvanceReport& report) {
    if (implicit_springs_) implicit_springs_->count(report);
    if (elongation_) elongation_->count(report);
    if (projection_) projection_->count(report);
  }
  /// Moves liquid particles into a periodic world, see DeviceMotion::wrap_liquid().
  void wrap_liquid() { motion_.wrap_liquid(model_); }
  /// Ends the last step of a call at its time.
  void finish(const StepMoment& moment, Real step, const opencl::Buffer& counters);

  /// Takes a step of an integrator without a closing kick, from `start` to `end` [s]. Calls
  /// evaluate(time), which must end with gather(), for the forces of each stage.
  template <class F>
  void integrate(Real start, Real end, Real dt, const opencl::Buffer& counters, F&& evaluate) {
    VAT_CHECK(integration_.has_value());
    const SolidParameters at_end = parameters(end);
    const SteppedSolids solids{motion_, force_, tables_, rigid_};
    const std::span<const RungeKuttaStage> stages =
        runge_kutta_stages(model_.scene.numerics.integrator);
    if (stages.empty()) {
      evaluate(start);
      const bool is_divided = has_divided_kicks();
      if (is_divided) kick(dt);
      limit_springs(dt);
      if (projection_) {
        project_step(start, end, dt, counters);
      } else {
        integration_->take_euler_step(at_end, is_divided ? 0 : dt, dt, solids, counters);
      }
    } else {
      integration_->begin(solids);
      for (std::size_t s = 0; s < stages.size(); ++s) {
        evaluate(start + stages[s].reach * dt);
        const Real next = s + 1 < stages.size() ? stages[s + 1].reach : 0;
        integration_->advance(stages[s].weight, next * dt, solids);
      }
      integration_->end(at_end, dt, solids, counters);
    }
    rigid_.pose(at_end, motion_.position, predicted_, counters);
    change_springs();
  }
  /// The parts of a step of symplectic Euler of `dt` [s] with an incompressible liquid, after
  /// gather(): the kick, the drift from `start` to `end` [s], and the end of the step.
  void kick_euler_step(Real dt);
  void drift_euler_step(Real start, Real end, Real dt, const opencl::Buffer& counters);
  void end_euler_step(Real end, Real dt, const opencl::Buffer& counters);
  /// Returns whether springs flow or tear.
  bool springs_change() const { return spring_changes_.has_value(); }

  /// Returns the parameters of the kernels of forces at the time `end` [s].
  SolidParameters parameters(Real end) const { return geometry_.at(model_, {end, 0, 0, 0, 0}); }
  /// Returns the particles after move().
  PlacedSolids placed() const {
    return {tables_,          cells_,     order_, sorted_, motion_.position,
            motion_.velocity, predicted_, rigid_, memory_, contact_mobilities()};
  }
  /// Returns DeviceRestitution::mobilities(), or another buffer in scenes without restitution.
  const opencl::Buffer& contact_mobilities() const {
    return restitution_ ? restitution_->mobilities() : tables_.mobility;
  }

  // Buffers in the order of particles:
  const opencl::Buffer& position() const { return motion_.position; }
  const opencl::Buffer& velocity_in_forces() const { return predicted_; }
  const opencl::Buffer& force() const { return force_; }
  /// Returns the bound of the oscillations of the last forces.
  const Oscillation& bound() const { return bound_; }

 private:
  void find_bound();
  /// Poses rigid bodies at the time of `after`, moves free particles by `before`, and finds the
  /// cells.
  void enter(const SolidParameters& before, const SolidParameters& after,
             const opencl::Buffer& counters);
  /// Returns whether there is work between the kicks of two steps, or between a kick and a drift.
  bool has_divided_kicks() const {
    return implicit_springs_.has_value() || elongation_.has_value() || projection_.has_value();
  }
  /// The kicks of move(), and all work between them and the drift. The remaining parts of `p` are
  /// those of the kernel move_solids.
  void divide_kicks(SolidParameters& p, Real time, Real step, const opencl::Buffer& counters);
  /// Stops particles at walls, and checks the state at the end of a step.
  void check(const SolidParameters& p, Real step, const opencl::Buffer& counters);
  /// Ends a step with its closing kick at `time` [s], and checks the state.
  void end_divided_step(const SolidParameters& p, Real time, Real step,
                        const opencl::Buffer& counters);
  ProjectedSolids projected() {
    return {tables_, motion_, rigid_, cells_, order_, sorted_, predicted_};
  }
  void kick(Real dt);
  /// Ends a step of symplectic Euler with contacts by projection after its kick.
  void project_step(Real start, Real end, Real dt, const opencl::Buffer& counters);
  /// Limits the elongation of springs in the next drift of `dt` [s].
  void limit_springs(Real dt);
  void change_springs() {
    if (spring_changes_) spring_changes_->change(motion_.position, tables_);
  }

  opencl::Program& program_;
  const Model& model_;
  const SolidRange range_;
  const SolidGeometry geometry_;
  const SolidTables tables_;
  const Oscillation least_bound_;  ///< of forces without contacts
  const bool has_loads_;           ///< contacts can increase the bound
  DeviceCells cells_;
  DeviceRigidBodies rigid_;
  DeviceMotion motion_, saved_motion_;
  opencl::Buffer force_, saved_force_;
  opencl::Buffer predicted_;  ///< velocities in forces
  opencl::Buffer order_, sorted_;
  const RememberedForces memory_;
  DeviceNearBodies near_bodies_;
  opencl::Buffer pressure_;                               ///< by cell of deformable bodies
  opencl::Buffer partial_, bounds_of_bodies_, greatest_;  ///< bounds of groups, rigid bodies, all
  DeviceDamping damping_;
  std::optional<DeviceIntegration> integration_;       ///< of integrators without a closing kick
  std::optional<DeviceSpringChanges> spring_changes_;  ///< only if springs change
  std::optional<DeviceImplicitSprings> implicit_springs_;
  std::optional<DeviceElongation> elongation_;  ///< only if springs are limited
  std::optional<DeviceProjection> projection_;
  std::optional<DeviceBodyMotions> body_motions_;  ///< only with sleeping
  std::optional<DeviceRestitution> restitution_;   ///< only if contacts have a restitution
  ReadMotion read_;
  std::vector<Vec3> read_forces_;
  Oscillation bound_, saved_bound_;  ///< of the last forces
};

}  // namespace vat
