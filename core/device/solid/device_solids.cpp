#include "core/device/solid/device_solids.h"

#include <algorithm>
#include <span>

#include "core/damping/damping_solve.h"
#include "core/device/common/kernel_values.h"
#include "core/model/acting_forces.h"
#include "core/solid/implicit_springs.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

using opencl::Program;

constexpr std::size_t kVector = 3 * sizeof(double);
constexpr std::size_t kVector4 = 4 * sizeof(double);
constexpr std::size_t kSortedEnd = 8;  // SORTED_END of particles.cl

/// An Oscillation of the kernels.
struct Bound {
  double omega2 = 0;
  double rate = 0;
};

bool keeps_forces(const Model& model) {
  return integrator_of(model.scene.numerics.integrator).keeps_forces();
}

std::size_t groups_of_solids(const Model& model) {
  return static_cast<std::size_t>(groups_of(SolidRange(model).count));
}

}  // namespace

std::optional<MovingSolids> moving_particles(const DeviceSolids* solids) {
  if (solids == nullptr) return {};
  return MovingSolids{solids->position(), solids->velocity_in_forces()};
}

DeviceSolids::DeviceSolids(Program& program, const Model& model, const GuardBounds& bounds)
    : program_(program),
      model_(model),
      range_(model),
      geometry_(model, bounds),
      tables_(program, model, bounds),
      least_bound_(find_bound_of_bodies(model)),
      has_loads_(has_contact_forces(model) || has_wall_forces(model)),
      cells_(program, range_.count, geometry_.cell_count()),
      rigid_(program, model, bounds),
      motion_(program, range_.count),
      saved_motion_(program, range_.count),
      force_(program, range_.count * kVector),
      saved_force_(program, range_.count * kVector),
      predicted_(program, range_.count * kVector),
      order_(program, range_.count * sizeof(std::int32_t)),
      sorted_(program, (range_.count + kSortedEnd) * kVector4),
      memory_(program, model),
      near_bodies_(program, model, range_.free),
      pressure_(program, std::max<std::size_t>(1, model.cells.size()) * sizeof(double)),
      partial_(program, groups_of_solids(model) * sizeof(Bound)),
      bounds_of_bodies_(program,
                        std::max<std::size_t>(1, model.rigid_bodies.size()) * sizeof(Bound)),
      greatest_(program, sizeof(Bound)),
      damping_(program, model) {
  if (!keeps_forces(model)) integration_.emplace(program, model);
  if (model.springs_change) spring_changes_.emplace(program, model);
  if (has_implicit_springs(model)) implicit_springs_.emplace(program, model);
  if (!model.limited_springs.empty()) elongation_.emplace(program, model);
  if (model.has_projection) projection_.emplace(program, model);
  if (model.scene.sleeping) body_motions_.emplace(program, model, range_.first);
  if (model.has_restitution) restitution_.emplace(program, model);
}

std::size_t DeviceSolids::bytes_for(const Model& model) {
  const SolidGeometry geometry(model, guard_bounds(model));
  const std::size_t n = SolidRange(model).count;
  return SolidTables::bytes_for(model) + DeviceCells::bytes_for(n, geometry.cell_count()) +
         n * (2 * DeviceMotion::kBytes + 3 * kVector + kVector4 + sizeof(std::int32_t)) +
         kSortedEnd * kVector4 + RememberedForces::bytes_for(model) +
         DeviceNearBodies::bytes_for(model, SolidRange(model).free) +
         model.cells.size() * sizeof(double) +
         (groups_of_solids(model) + model.rigid_bodies.size() + 1) * sizeof(Bound) +
         DeviceRigidBodies::bytes_for(model) + DeviceDamping::bytes_for(model) +
         (keeps_forces(model) ? 0 : DeviceIntegration::bytes_for(model)) +
         (model.springs_change ? DeviceSpringChanges::bytes_for(model) : 0) +
         (has_implicit_springs(model) ? DeviceImplicitSprings::bytes_for(model) : 0) +
         (model.limited_springs.empty() ? 0 : DeviceElongation::bytes_for(model)) +
         (model.has_projection ? DeviceProjection::bytes_for(model) : 0) +
         (model.scene.sleeping ? DeviceBodyMotions::bytes_for(model) : 0) +
         (model.has_restitution ? DeviceRestitution::bytes_for(model) : 0);
}

void DeviceSolids::write(const State& state) {
  motion_.write(state.now, range_.first);
  bound_ = state.bound;
  VAT_CHECK(state.forces.particle.size() == model_.particle_count);
  program_.write(force_, std::span<const Vec3>(state.forces.particle).subspan(range_.first));
  rigid_.write(model_, state);
  damping_.find_mass(model_, state.step_count);
  if (spring_changes_) spring_changes_->write(model_, state.now, tables_);
  if (projection_) projection_->write(state.now);
}

void DeviceSolids::read() {
  read_forces_.resize(range_.free);
  if (range_.free > 0) {
    read_.read(program_, motion_, range_.free);
    program_.read(force_, std::span<Vec3>(read_forces_));
  }
  rigid_.read();
  if (spring_changes_) spring_changes_->read(tables_);
  if (projection_) projection_->read();
}

void DeviceSolids::copy_to(State& state) const {
  read_.copy_to(state.now, range_.first);
  // The forces on the particles of rigid bodies are in the resultants.
  Forces& forces = state.forces;
  VAT_CHECK(forces.particle.size() == model_.particle_count);
  const auto begin = forces.particle.begin() + static_cast<std::ptrdiff_t>(range_.first);
  std::ranges::copy(read_forces_, begin);
  std::fill(begin + static_cast<std::ptrdiff_t>(range_.free), forces.particle.end(), Vec3::Zero());
  if (model_.has_friction) forces.friction_torque.assign(model_.particle_count, Vec3::Zero());
  rigid_.copy_to(state);
  if (spring_changes_) spring_changes_->copy_to(state.now);
  if (projection_) projection_->copy_to(state.now);
  for (std::size_t b = 0; b < rigid_.count(); ++b) {
    pose_rigid_body(model_, model_.rigid_bodies[b], state.now.rigid[b], state.now);
  }
}

void DeviceSolids::read_motions(BodyMotions& motions) {
  VAT_CHECK(body_motions_.has_value());
  rigid_.read_states(motions.rigid);
  body_motions_->read(motion_, motions.particles);
}

void DeviceSolids::save() {
  saved_motion_.copy_from(motion_);
  program_.copy(force_, saved_force_, range_.count * kVector);
  rigid_.save();
  if (spring_changes_) spring_changes_->save(tables_);
  if (implicit_springs_) implicit_springs_->clear_counts();
  if (elongation_) elongation_->clear_counts();
  if (projection_) projection_->save();
  saved_bound_ = bound_;
}

void DeviceSolids::restore() {
  motion_.copy_from(saved_motion_);
  program_.copy(saved_force_, force_, range_.count * kVector);
  rigid_.restore();
  if (spring_changes_) spring_changes_->restore(tables_);
  if (projection_) projection_->restore();
  bound_ = saved_bound_;
}

void DeviceSolids::enter(const SolidParameters& before, const SolidParameters& after,
                         const opencl::Buffer& counters) {
  const SolidTables& t = tables_;
  rigid_.pose(after, motion_.position, predicted_, counters);
  cells_.clear();
  program_.run("move_solids", range_.count, before, motion_.position, motion_.velocity, predicted_,
               force_, t.mobility, t.body_of, t.bodies, cells_.cell_of, cells_.rank, cells_.counts,
               counters);
  cells_.sort();
  program_.run("collect_solids", range_.count, after, cells_.cell_of, cells_.begins,
               cells_.unsorted, motion_.position, t.body_of, order_, sorted_);
}

void DeviceSolids::place(Real time, const opencl::Buffer& counters) {
  const SolidParameters p = parameters(time);
  rigid_.move(p, p.step, counters);
  enter(p, p, counters);
}

void DeviceSolids::move(const StepMoment& start, Real end, Real step,
                        const opencl::Buffer& counters) {
  const SolidTables& t = tables_;
  SolidParameters before = geometry_.at(model_, start);
  const SolidParameters after = parameters(end);
  if (has_divided_kicks()) divide_kicks(before, start.time, step, counters);
  rigid_.move(before, step, counters);
  start.drift > 0 ? rigid_.drive(model_, start.time, end)
                  : rigid_.begin_drive(model_, start.time, step);
  if (has_divided_kicks()) before.closing = before.opening = 0;
  enter(before, after, counters);
  if (start.drift > 0) change_springs();
  if (model_.cells.empty()) return;
  program_.run(
      "find_cell_pressure", model_.cells.size(), static_cast<std::int32_t>(model_.cells.size()),
      static_cast<std::int32_t>(model_.scene.dimensions), motion_.position, t.cells, pressure_);
}

void DeviceSolids::kick(Real dt) {
  if (projection_) rigid_.kick(dt);
  if (range_.free == 0) return;
  program_.run("kick_solids", range_.free, number_of(range_.free), dt, motion_.velocity, force_,
               tables_.mobility);
}

void DeviceSolids::limit_springs(Real dt) {
  if (!elongation_) return;
  elongation_->limit(dt, spring_changes_ ? &spring_changes_->are_torn() : nullptr, motion_.position,
                     motion_.velocity, tables_.mobility);
}

void DeviceSolids::end_divided_step(const SolidParameters& p, Real time, Real step,
                                    const opencl::Buffer& counters) {
  if (p.closing == 0) return;
  kick(p.closing);
  if (projection_) projection_->finish(model_, p, time, step, projected(), counters);
  if (implicit_springs_) {
    implicit_springs_->damp(p.closing, tables_, motion_.position, motion_.velocity);
  }
  check(p, step, counters);
}

void DeviceSolids::project_step(Real start, Real end, Real dt, const opencl::Buffer& counters) {
  const SolidParameters p = parameters(end);
  projection_->drift(model_, p, start, dt, projected(), counters);
  projection_->finish(model_, p, end, dt, projected(), counters);
  check(p, model_.scene.numerics.step, counters);
}

void DeviceSolids::kick_euler_step(Real dt) {
  if (!projection_) rigid_.kick(dt);
  kick(dt);
  limit_springs(dt);
}

void DeviceSolids::drift_euler_step(Real start, Real end, Real dt, const opencl::Buffer& counters) {
  const SolidParameters at_end = parameters(end);
  if (projection_) {
    projection_->drift(model_, at_end, start, dt, projected(), counters);
  } else {
    if (range_.free > 0) {
      program_.run("predict_particles", range_.free, number_of(range_.free), dt, motion_.position,
                   motion_.velocity, motion_.position);
    }
    rigid_.move(geometry_.at(model_, {start, 0, 0, dt, 0}), dt, counters);
    rigid_.drive(model_, start, end);
  }
  rigid_.pose(at_end, motion_.position, predicted_, counters);
}

void DeviceSolids::probe(Real start, Real dt, const opencl::Buffer& counters) {
  VAT_CHECK(range_.free == 0);
  const StepMoment moment{start, 0, dt / 2, dt, 0};
  rigid_.move(geometry_.at(model_, moment), dt, counters);
  rigid_.drift_driven(model_, start, dt);
  SolidParameters anywhere = parameters(start + dt);
  anywhere.walls = 0;
  rigid_.pose(anywhere, motion_.position, predicted_, counters);
}

void DeviceSolids::end_euler_step(Real end, Real dt, const opencl::Buffer& counters) {
  SolidParameters p = parameters(end);
  p.step = dt;
  change_springs();
  if (projection_) {
    projection_->finish(model_, p, end, dt, projected(), counters);
  } else {
    rigid_.check(p, dt, counters);
  }
  check(p, dt, counters);
}

void DeviceSolids::check(const SolidParameters& p, Real step, const opencl::Buffer& counters) {
  if (projection_) rigid_.check(p, step, counters);
  if (range_.free == 0) return;
  const SolidTables& t = tables_;
  program_.run("check_solids", range_.free, p, motion_.position, motion_.velocity, t.mobility,
               t.body_of, t.bodies, counters);
}

void DeviceSolids::divide_kicks(SolidParameters& p, Real time, Real step,
                                const opencl::Buffer& counters) {
  end_divided_step(p, time, step, counters);
  if (p.drift > 0) {
    const SolidTables& t = tables_;
    if (implicit_springs_) {
      implicit_springs_->damp(p.opening, t, motion_.position, motion_.velocity);
    }
    kick(p.opening);
    limit_springs(p.drift);
    // Impulses of projected contacts precede the implicit springs, so that they stretch no spring.
    if (projection_) {
      projection_->drift(model_, parameters(time + p.drift), time, p.drift, projected(), counters);
    }
    if (implicit_springs_) {
      const opencl::Buffer& from = projection_ ? projection_->start_position() : motion_.position;
      implicit_springs_->drift(p.drift, t, from, motion_.position, motion_.velocity);
    }
    if (projection_) p.drift = 0;
  }
  // Otherwise, the kernels of rigid bodies kick them.
  if (projection_) p.closing = p.opening = 0;
}

void DeviceSolids::find_forces(Real end) {
  const SolidTables& t = tables_;
  near_bodies_.find(rigid_.rigid, rigid_.poses);
  const SolidParameters p = parameters(end);
  if (restitution_) restitution_->find(p, placed());
  program_.run("find_solid_forces", range_.count, p, cells_.begins, order_, sorted_,
               motion_.position, predicted_, rigid_.spins, t.mass, t.mobility, t.radius, t.body_of,
               t.bodies, t.laws, t.exclusion_begin, t.exclusions, t.spring_begin, t.springs,
               t.corner_begin, t.corners, t.cells, pressure_, contact_mobilities(), force_,
               rigid_.torque, rigid_.loads, partial_, memory_.is_used, memory_.contact_counts,
               memory_.contacts, memory_.ways, near_bodies_.search(), rigid_.rigid_of,
               near_bodies_.spheres, near_bodies_.counts, near_bodies_.near);
}

void DeviceSolids::gather() {
  rigid_.gather(model_.has_friction, motion_.position, tables_.radius, force_, bounds_of_bodies_);
  find_bound();
}

void DeviceSolids::find_bound() {
  if (!model_.damping.any || !keeps_forces(model_)) return;
  bound_ = least_bound_;
  if (!has_loads_) return;
  Bound bound{least_bound_.omega2, least_bound_.rate};
  program_.run("find_bound_of_forces", Program::kGroup, groups_of(range_.count),
               static_cast<std::int32_t>(rigid_.count()), bound, partial_, bounds_of_bodies_,
               greatest_);
  program_.read(greatest_, std::span(&bound, 1));
  bound_ = {bound.omega2, bound.rate};
}

bool DeviceSolids::must_solve(Real dt) const {
  return model_.damping.any && must_solve_damping(bound_, dt);
}

std::uint32_t DeviceSolids::solve_damping(Real end, Real dt) {
  return damping_.solve(parameters(end), placed(), dt, force_);
}

void DeviceSolids::finish(const StepMoment& moment, Real step, const opencl::Buffer& counters) {
  const SolidParameters p = geometry_.at(model_, moment);
  if (has_divided_kicks()) end_divided_step(p, moment.time, step, counters);
  if (!projection_) rigid_.finish(p, step, counters);
  if (range_.free == 0 || has_divided_kicks()) return;
  program_.run("finish_solids", range_.free, p, motion_.position, motion_.velocity, force_,
               tables_.mobility, tables_.body_of, tables_.bodies, counters);
}

}  // namespace vat
