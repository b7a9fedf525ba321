#include "core/device/solid/solid_method.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "core/damping/damping_solve.h"
#include "core/device/common/device_cells.h"
#include "core/device/common/device_counters.h"
#include "core/device/common/device_motion.h"
#include "core/device/common/kernel_values.h"
#include "core/device/solid/device_damping.h"
#include "core/device/solid/device_rigid_bodies.h"
#include "core/device/solid/solid_geometry.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/acting_forces.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Buffer;
using opencl::Program;

constexpr std::size_t kVector = 3 * sizeof(double);
constexpr std::size_t kVector4 = 4 * sizeof(double);

/// An Oscillation of the kernels.
struct Bound {
  double omega2 = 0;
  double rate = 0;
};

/// The integrated variables, in the order of particles.
struct SolidState {
  SolidState(Program& program, std::size_t particles)
      : motion(program, particles), force(program, particles * kVector) {}

  static constexpr std::size_t kBytes = DeviceMotion::kBytes + kVector;

  DeviceMotion motion;
  Buffer force;
};

class SolidMethod : public DeviceMethod {
 public:
  SolidMethod(Program& program, std::shared_ptr<const Model> model, const GuardBounds& bounds);

  bool take_steps(const EngineInput& input, std::uint32_t steps) override;
  void read(State& state) override;

 private:
  void upload(const State& state);
  void copy(const SolidState& from, SolidState& to);
  void find_forces(const SolidParameters& p);
  void find_bound();
  /// Moves the particles by `start`, and evaluates the forces at the time of `end`.
  void evaluate(const StepMoment& start, const StepMoment& end);
  /// Takes a step whose kick and drift begin with `moment`.
  void take_step(StepMoment moment, Real end, AdvanceReport& report);
  /// Ends the last step of a call.
  void finish(const SolidParameters& p);

  Program& program_;
  const std::shared_ptr<const Model> model_;
  const SolidGeometry geometry_;
  const SolidTables tables_;
  const Oscillation least_bound_;  ///< of forces without contacts
  const bool has_loads_;           ///< contacts can increase the bound
  DeviceCells cells_;
  DeviceCounters counters_;
  DeviceRigidBodies rigid_;
  SolidState now_;
  SolidState start_;  ///< state before a call, for a failed step
  Buffer predicted_;  ///< velocities in forces
  Buffer order_, sorted_position_;
  Buffer pressure_;                               ///< by cell of deformable bodies
  Buffer partial_, bounds_of_bodies_, greatest_;  ///< bounds of groups, rigid bodies, and all
  DeviceDamping damping_;
  ReadMotion read_;
  std::vector<Vec3> forces_;
  Oscillation bound_;  ///< of the last forces
};

SolidMethod::SolidMethod(Program& program, std::shared_ptr<const Model> model,
                         const GuardBounds& bounds)
    : program_(program),
      model_(std::move(model)),
      geometry_(*model_, bounds),
      tables_(program, *model_, bounds),
      least_bound_(find_bound_of_bodies(*model_)),
      has_loads_(has_contact_forces(*model_) || has_wall_forces(*model_)),
      cells_(program, model_->particle_count, geometry_.cell_count()),
      counters_(program),
      rigid_(program, *model_, bounds),
      now_(program, model_->particle_count),
      start_(program, model_->particle_count),
      predicted_(program, model_->particle_count * kVector),
      order_(program, model_->particle_count * sizeof(std::int32_t)),
      sorted_position_(program, model_->particle_count * kVector4),
      pressure_(program, std::max<std::size_t>(1, model_->cells.size()) * sizeof(double)),
      partial_(program,
               static_cast<std::size_t>(groups_of(model_->particle_count)) * sizeof(Bound)),
      bounds_of_bodies_(program,
                        std::max<std::size_t>(1, model_->rigid_bodies.size()) * sizeof(Bound)),
      greatest_(program, sizeof(Bound)),
      damping_(program, *model_) {}

void SolidMethod::upload(const State& state) {
  now_.motion.write(state.now);
  bound_ = state.bound;
  VAT_CHECK(state.forces.particle.size() == model_->particle_count);
  program_.write(now_.force, std::span<const Vec3>(state.forces.particle));
  rigid_.write(state);
}

void SolidMethod::read(State& state) {
  const std::size_t n = model_->free_count;
  forces_.resize(n);
  if (n > 0) {
    read_.read(program_, now_.motion, n);
    program_.read(now_.force, std::span<Vec3>(forces_));
  }
  rigid_.read();
  read_.copy_to(state.now);
  // The forces on the particles of rigid bodies are in the resultants.
  Forces& forces = state.forces;
  forces.particle.assign(model_->particle_count, Vec3::Zero());
  std::ranges::copy(forces_, forces.particle.begin());
  if (model_->has_friction) forces.friction_torque.assign(model_->particle_count, Vec3::Zero());
  rigid_.copy_to(state);
  for (std::size_t b = 0; b < rigid_.count(); ++b) {
    pose_rigid_body(*model_, model_->rigid_bodies[b], state.now.rigid[b], state.now);
  }
  state.forces_current = true;
  if (model_->damping.any) state.bound = bound_;
}

void SolidMethod::copy(const SolidState& from, SolidState& to) {
  to.motion.copy_from(from.motion);
  program_.copy(from.force, to.force, model_->particle_count * kVector);
}

void SolidMethod::find_forces(const SolidParameters& p) {
  const std::size_t n = model_->particle_count;
  const SolidTables& t = tables_;
  program_.run("find_solid_forces", n, p, cells_.begins, order_, sorted_position_,
               now_.motion.position, predicted_, rigid_.spins, t.mass, t.mobility, t.radius,
               t.body_of, t.bodies, t.laws, t.exclusion_begin, t.exclusions, t.spring_begin,
               t.springs, t.corner_begin, t.corners, t.cells, pressure_, now_.force, rigid_.torque,
               rigid_.loads, partial_);
  rigid_.gather(model_->has_friction, now_.motion.position, t.radius, now_.force,
                bounds_of_bodies_);
}

void SolidMethod::find_bound() {
  if (!model_->damping.any) return;
  bound_ = least_bound_;
  if (!has_loads_) return;
  Bound bound{least_bound_.omega2, least_bound_.rate};
  program_.run("find_bound_of_forces", Program::kGroup, groups_of(model_->particle_count),
               static_cast<std::int32_t>(rigid_.count()), bound, partial_, bounds_of_bodies_,
               greatest_);
  program_.read(greatest_, std::span(&bound, 1));
  bound_ = {bound.omega2, bound.rate};
}

void SolidMethod::evaluate(const StepMoment& start, const StepMoment& end) {
  const std::size_t n = model_->particle_count;
  const SolidTables& t = tables_;
  const SolidParameters before = geometry_.at(*model_, start);
  const SolidParameters after = geometry_.at(*model_, end);
  rigid_.move(before, model_->scene.numerics.step, counters_.buffer);
  rigid_.pose(after, now_.motion.position, predicted_, counters_.buffer);
  cells_.clear();
  program_.run("move_solids", n, before, now_.motion.position, now_.motion.velocity, predicted_,
               now_.force, t.mobility, t.body_of, t.bodies, cells_.cell_of, cells_.rank,
               cells_.counts, counters_.buffer);
  cells_.sort();
  program_.run("collect_solids", n, static_cast<std::int32_t>(n), cells_.cell_of, cells_.begins,
               cells_.unsorted, now_.motion.position, order_, sorted_position_);
  if (!model_->cells.empty()) {
    program_.run("find_cell_pressure", model_->cells.size(),
                 static_cast<std::int32_t>(model_->cells.size()),
                 static_cast<std::int32_t>(model_->scene.dimensions), now_.motion.position, t.cells,
                 pressure_);
  }
  find_forces(after);
  find_bound();
}

void SolidMethod::take_step(StepMoment moment, Real end, AdvanceReport& report) {
  const bool must_solve = model_->damping.any && must_solve_damping(bound_, moment.drift);
  // Forces with a solve depend on the velocities before it; see evaluate_at_end().
  moment.prediction = model_->damping.any && !must_solve ? moment.opening : 0;
  evaluate(moment, {end});
  if (!must_solve) return;
  const PlacedSolids solids{tables_,    cells_, order_, sorted_position_, now_.motion.position,
                            predicted_, rigid_};
  report.iterations.damping +=
      damping_.solve(geometry_.at(*model_, {end}), solids, moment.opening, now_.force);
}

void SolidMethod::finish(const SolidParameters& p) {
  rigid_.finish(p, model_->scene.numerics.step, counters_.buffer);
  if (model_->free_count == 0) return;
  program_.run("finish_solids", model_->free_count, p, now_.motion.position, now_.motion.velocity,
               now_.force, tables_.mobility, tables_.body_of, tables_.bodies, counters_.buffer);
}

bool SolidMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  const State& state = input.state;
  const Real dt = model_->scene.numerics.step;
  const auto time = [&](std::uint32_t s) { return static_cast<Real>(state.step_count + s) * dt; };
  if (!input.continues) upload(state);
  copy(now_, start_);
  rigid_.save();
  const Oscillation bound_before = bound_;
  counters_.clear();
  AdvanceReport report = input.report;
  if (!input.continues && !state.forces_current) {
    evaluate({time(0)}, {time(0)});
    report.count_evaluation(model_->particle_count);
  }
  StepMoment moment{0, 0, dt / 2, dt, 0};
  for (std::uint32_t s = 0; s < steps; ++s) {
    moment.time = time(s);
    take_step(moment, time(s + 1), report);
    report.count_evaluation(model_->particle_count);
    moment.closing = dt / 2;
  }
  moment.time = time(steps);
  finish(geometry_.at(*model_, moment));
  const Counters counters = counters_.read();
  if (counters.faults != 0) {
    copy(start_, now_);
    rigid_.restore();
    bound_ = bound_before;
    return false;
  }
  report.count_steps(steps, dt, dt);
  report.wall_stops += static_cast<std::uint64_t>(counters.stops);
  input.report = std::move(report);
  return true;
}

}  // namespace

std::size_t bytes_for_solids(const Model& model) {
  const SolidGeometry geometry(model, guard_bounds(model));
  const std::size_t n = model.particle_count;
  return SolidTables::bytes_for(model) + DeviceCells::bytes_for(n, geometry.cell_count()) +
         2 * n * SolidState::kBytes + n * (kVector + kVector4 + sizeof(std::int32_t)) +
         model.cells.size() * sizeof(double) +
         (static_cast<std::size_t>(groups_of(n)) + model.rigid_bodies.size() + 1) * sizeof(Bound) +
         DeviceRigidBodies::bytes_for(model) + DeviceDamping::bytes_for(model);
}

std::unique_ptr<DeviceMethod> make_solid_method(Program& program,
                                                std::shared_ptr<const Model> model) {
  const GuardBounds bounds = guard_bounds(*model);
  return std::make_unique<SolidMethod>(program, std::move(model), bounds);
}

}  // namespace vat
