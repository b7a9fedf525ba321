#include "core/stepping/local_step.h"
#include "core/contact/scratch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/contact/contacts.h"
#include "core/contact/walls.h"
#include "core/external/external.h"
#include "core/laws/connection.h"
#include "core/laws/lennard_jones.h"
#include "core/laws/pair_direction.h"
#include "core/limits.h"
#include "core/liquid/gas/liquid.h"
#include "core/rigid/rigid.h"
#include "core/solid/springs.h"
#include "core/state/kick_drift.h"
#include "core/stepping/liquid_solver.h"
#include "core/stepping/local_levels.h"
#include "core/support/check.h"

namespace vat {

/// State and time at which forces are evaluated.
struct LocalStepper::Moment {
  const ForceModel& force_model;
  State& state;
  Real time;

  const Model& model() const { return force_model.model; }
  const Configuration& at() const { return state.now; }
  const std::vector<Vec3>& spins() const {
    return force_model.work.of<ContactForceScratch>().spins;
  }
  StepContext context(Forces& forces) const {
    const ForceModel& f = force_model;
    return {f.model, f.controls, time, f.step, state.now, forces, f.work, f.runner};
  }
  VatMotion vat() const {
    return model().walls.empty() ? VatMotion{} : vat_motion(*model().scene.vat, time);
  }
};

namespace {

/// The step of a level, relative to that of level 0.
Real share_of(int level) {
  return Real{1} / static_cast<Real>(1U << level);
}

ContactForce force_of(const Model& model, const Configuration& at, const std::vector<Vec3>& spins,
                      Index i, const LocalPair& pair) {
  Vec3 x = at.position[i] - at.position[pair.other];
  if (pair.is_contact && model.periodic.any()) {
    x = model.periodic.nearest(model.periodic.wrap(at.position[i]) -
                               model.periodic.wrap(at.position[pair.other]));
  }
  const Real distance = x.norm();
  if (pair.is_contact && distance >= pair.rest_length) return {};
  const Vec3 n = pair_direction(x, distance, i, pair.other, model.scene.dimensions);
  if (pair.layer > 0) {
    return {layer_push(pair.stiffness, pair.layer, pair.rest_length, distance) * n};
  }
  const Vec3 velocity = at.velocity[i] - at.velocity[pair.other];
  const Real speed = velocity.dot(n);
  const Real push =
      connection_push(pair.stiffness, pair.damping, pair.rest_length, distance, speed);
  if (!pair.is_contact) return {push * n};
  if (push <= 0) return {};
  if (!model.has_friction) return {push * n};
  const Friction friction = pair_friction(model, i, pair.other, pair.stiffness);
  if (!friction.acts()) return {push * n};
  const ContactArms arms = pair_arms(model, i, pair.other, distance * n);
  const Vec3 slip = slip_velocity(velocity, speed, n) +
                    turning_velocity(model, spins, i, arms.self) -
                    turning_velocity(model, spins, pair.other, arms.other);
  const Vec3 friction_force = friction.drag(push, slip) * slip;
  return {push * n - friction_force, -arms.self.cross(friction_force)};
}

/// Returns the end of the particles on which liquids have forces.
Index liquid_end(const Model& model) {
  return model.is_coupled ? model.particle_count : model.liquid_count;
}

/// Returns whether the forces at the end of a step are those at the start of the next. A solve of
/// velocities needs the pairs of its evaluation, and follows the kick of a whole step.
bool keeps_forces(const Model& model) {
  const LiquidSolver* solver = acting_liquid_solver(model);
  return solver == nullptr || solver->solve_velocities == nullptr;
}

/// Returns whether the stage belongs to the forces of liquids: all stages that this file does not
/// replace.
bool is_of_liquids(const Stage& stage) {
  return stage.run != &pose_rigid_bodies && stage.run != &set_external_forces &&
         stage.run != &find_contacts && stage.run != &add_contacts &&
         stage.run != &add_spring_forces && stage.run != &add_wall_forces &&
         stage.run != &gather_rigid_forces;
}

void add(Real share, const ContactForce& part, ContactForce& sum) {
  sum.force += share * part.force;
  sum.torque += share * part.torque;
}

void resize(const Model& model, Forces& forces) {
  forces.particle.resize(model.particle_count, Vec3::Zero());
  forces.rigid_force.resize(model.rigid_bodies.size(), Vec3::Zero());
  forces.rigid_torque.resize(model.rigid_bodies.size(), Vec3::Zero());
  if (model.has_friction) forces.friction_torque.resize(model.particle_count, Vec3::Zero());
}

/// The skin of the list of contacts. Short skins are rebuilt often, long ones contain many pairs
/// that never touch.
Real skin_for(const Model& model, const Configuration& at, Real dt) {
  Real speed2 = 0;
  for (const Vec3& velocity : at.velocity) speed2 = std::max(speed2, velocity.squaredNorm());
  const Real way = 2.5 * std::sqrt(speed2) * dt;
  return std::clamp(way, 0.05 * model.contact_reach, 0.5 * model.contact_reach);
}

}  // namespace

void LocalStepper::set_levels(const Moment& now, State& state, Real dt, const StepBounds& bounds,
                              const GuardBounds& guard) {
  now.force_model.enter("choose_levels");
  find_present_steps(now.force_model, state, now.time, dt, bounds, guard, present_);
  choose_local_levels(now.model(), present_, dt, state.levels);
  state.levels.skin = skin_for(now.model(), now.at(), dt);
}

void LocalStepper::build_pairs(const Moment& now) {
  now.force_model.enter("build_pairs");
  if (now.model().contact_reach > 0) {
    StepContext context = now.context(due_);
    ContactList& contacts = now.force_model.work.of<ContactForceScratch>().contacts;
    if (!contacts.is_current(context, now.state.levels.skin)) {
      if (now.model().liquid_count > 0) sort_liquid(context);
      contacts.update(context, now.state.levels.skin);
    }
  }
  pairs_.build(now.force_model, now.at(), now.state.levels, !pairs_current_);
  pairs_current_ = true;
}

const Forces& LocalStepper::evaluate_liquid(const Moment& now) {
  VAT_CHECK(liquid_.particle.size() == now.model().particle_count);
  std::fill_n(liquid_.particle.begin(), liquid_end(now.model()), Vec3::Zero());
  StepContext context = now.context(liquid_);
  for (const Stage& stage : now.model().plan.stages) {
    if (!is_of_liquids(stage)) continue;
    now.force_model.enter(stage.name);
    stage.run(context);
  }
  return liquid_;
}

void LocalStepper::sum_connections(const Moment& now, const LocalLevels& closing,
                                   const LocalLevels& opening, Forces& closing_forces,
                                   Forces& opening_forces) {
  now.force_model.enter("connections");
  const Model& model = now.model();
  const VatMotion vat = now.vat();
  const std::span<const Index> order = pairs_.due(0);
  for_blocks(now.force_model.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (const Index i : order.subspan(begin, end - begin)) {
      ContactForce close;
      ContactForce open;
      pairs_.for_each_due(i, 0, [&](const LocalPair& pair) {
        const ContactForce part = force_of(model, now.at(), now.spins(), i, pair);
        add(share_of(std::max(closing.particle[i], closing.particle[pair.other])), part, close);
        add(share_of(pair.level), part, open);
      });
      const bool is_mirrored = model.is_coupled && i < model.liquid_count;
      if (!model.walls.empty() && !is_mirrored) {
        const ContactForce part = wall_force(model, vat, now.at(), now.spins(), i);
        add(share_of(closing.particle[i]), part, close);
        add(share_of(opening.particle[i]), part, open);
      }
      closing_forces.particle[i] += close.force;
      opening_forces.particle[i] += open.force;
      if (!model.has_friction) continue;
      closing_forces.friction_torque[i] += close.torque;
      opening_forces.friction_torque[i] += open.torque;
    }
  });
}

/// Adds the forces of liquids, also those on solids. The external forces on coupled liquids have
/// the same kicks.
void LocalStepper::add_liquid_forces(const Moment& now, const LocalLevels& closing,
                                     const LocalLevels& opening, LiquidKicks kicks,
                                     Forces& closing_forces, Forces& opening_forces) {
  const Model& model = now.model();
  for (Index i = 0; model.is_coupled && i < model.liquid_count; ++i) {
    closing_forces.particle[i] *= kicks.closing;
    opening_forces.particle[i] *= kicks.opening;
  }
  if (kicks.are_none()) return;
  const Forces& own = evaluate_liquid(now);
  const Real closing_share = kicks.closing * share_of(closing.liquid);
  const Real opening_share = kicks.opening * share_of(opening.liquid);
  for (Index i = 0; i < liquid_end(model); ++i) {
    closing_forces.particle[i] += closing_share * own.particle[i];
    opening_forces.particle[i] += opening_share * own.particle[i];
  }
  opening_forces.transport = own.transport;
}

void LocalStepper::evaluate_all(const Moment& now, const LocalLevels& closing,
                                const LocalLevels& opening, LiquidKicks kicks,
                                Forces& closing_forces, Forces& opening_forces) {
  const Model& model = now.model();
  now.force_model.enter("external_forces");
  StepContext context = now.context(opening_forces);
  set_external_forces(context);
  closing_forces.particle = opening_forces.particle;
  closing_forces.friction_torque = opening_forces.friction_torque;
  if (model.liquid_count > 0) {
    add_liquid_forces(now, closing, opening, kicks, closing_forces, opening_forces);
  }
  sum_connections(now, closing, opening, closing_forces, opening_forces);
  if (!model.rigid_bodies.empty()) now.force_model.enter("gather_rigid_forces");
  for (Forces* forces : {&closing_forces, &opening_forces}) {
    StepContext gathered = now.context(*forces);
    gather_rigid_forces(gathered);
  }
  if (now.force_model.report == nullptr) return;
  if (kicks.are_none()) {
    now.force_model.report->particle_evaluations += model.particle_count - model.liquid_count;
  } else {
    now.force_model.report->count_evaluation(model.particle_count);
  }
}

void LocalStepper::kick_liquid(const Moment& now, Real dt) {
  const Model& model = now.model();
  const std::vector<Vec3>& own = evaluate_liquid(now).particle;
  for (Index i = 0; i < model.liquid_count; ++i) {
    now.state.now.velocity[i] +=
        (dt * share_of(now.state.levels.liquid) * model.inverse_mass[i]) * own[i];
  }
  if (now.force_model.report != nullptr) {
    now.force_model.report->particle_evaluations += model.liquid_count;
  }
}

void LocalStepper::kick_rigid(const Moment& now, Real dt) {
  StepContext context = now.context(due_);
  gather_rigid_forces(context);
  for (std::size_t b = 0; b < now.model().rigid_bodies.size(); ++b) {
    now.state.now.rigid[b].momentum += dt * due_.rigid_force[b];
    now.state.now.rigid[b].angular_momentum += dt * due_.rigid_torque[b];
  }
}

/// The kick between two sub-steps, by every connection of level `due` or finer, over its own step.
/// All forces are summed before velocities change.
void LocalStepper::kick_due(const Moment& now, int due, Real dt) {
  now.force_model.enter("connections");
  const Model& model = now.model();
  VAT_CHECK(due >= 0 && due <= kMaxStepLevel);
  const LocalLevels& levels = now.state.levels;
  const VatMotion vat = now.vat();
  const std::span<const Index> order = pairs_.due(due);
  for_blocks(now.force_model.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (const Index i : order.subspan(begin, end - begin)) {
      ContactForce sum;
      pairs_.for_each_due(i, due, [&](const LocalPair& pair) {
        add(share_of(pair.level), force_of(model, now.at(), now.spins(), i, pair), sum);
      });
      if (!model.walls.empty() && levels.particle[i] >= due) {
        add(share_of(levels.particle[i]), wall_force(model, vat, now.at(), now.spins(), i), sum);
      }
      due_.particle[i] = sum.force;
      if (model.has_friction) due_.friction_torque[i] = sum.torque;
    }
  });
  if (now.force_model.report != nullptr) {
    now.force_model.report->particle_evaluations += order.size();
  }
  if (model.liquid_count > 0 && levels.liquid >= due) kick_liquid(now, dt);
  now.force_model.enter("kick");
  for (const Index i : order) {
    if (i < model.free_count) {
      now.state.now.velocity[i] += (dt * model.inverse_mass[i]) * due_.particle[i];
    }
  }
  if (pairs_.finest_rigid() >= due) kick_rigid(now, dt);
  for (const Index i : order) due_.particle[i].setZero();
  if (model.has_friction) {
    for (const Index i : order) due_.friction_torque[i].setZero();
  }
}

std::optional<Fault> LocalStepper::find_fast(const Model& model, const Configuration& at, Real dt,
                                             const GuardBounds& guard) const {
  VAT_CHECK(guard.travel.size() == model.bodies.size());
  for (Index b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    for (Index i = body.particles.begin; i < body.particles.end; ++i) {
      const Real way = at.velocity[i].norm() * dt * share_of(closing_levels_.particle[i]);
      if (way <= guard.travel[b]) continue;
      const Index particle = body.kind == BodyKind::rigid ? 0 : i - body.particles.begin;
      return Fault{GuardEvent::Cause::too_fast, b, particle};
    }
  }
  return {};
}

void LocalStepper::evaluate_at_start(const Moment& start, Real dt, const StepBounds& bounds,
                                     const GuardBounds& guard) {
  State& state = start.state;
  if (!state.forces_current) {
    set_levels(start, state, dt, bounds, guard);
    build_pairs(start);
    evaluate_all(start, state.levels, state.levels,
                 keeps_forces(start.model()) ? kVerlet : kEulerStart, closing_, state.forces);
  } else if (!pairs_current_) {
    build_pairs(start);
  }
}

void LocalStepper::evaluate_at_end(const Moment& end, Real dt, const StepBounds& bounds,
                                   const GuardBounds& guard) {
  State& state = end.state;
  const bool is_start_of_next = keeps_forces(end.model());
  closing_levels_ = state.levels;
  if (is_start_of_next) set_levels(end, state, dt, bounds, guard);
  build_pairs(end);
  evaluate_all(end, closing_levels_, state.levels, is_start_of_next ? kVerlet : kEulerEnd, closing_,
               state.forces);
}

/// Drifts all particles, and kicks them between the parts of the drift. Coupled liquids have no
/// connections, and drift at once.
void LocalStepper::drift_in_parts(const ForceModel& f, State& state, Real time, Real dt) {
  const bool is_coupled = f.model.is_coupled;
  const auto drift_part = [&](Real part) {
    f.enter("drift");
    if (is_coupled) {
      drift_solids(f.model, f.runner, state.now, part);
    } else {
      drift(f.model, f.runner, state.now, part);
    }
    StepContext context = Moment{f, state, time}.context(due_);
    pose_rigid_bodies(context);
  };
  VAT_CHECK(finest_ >= 0 && finest_ <= kMaxStepLevel && coarsest_ <= finest_);
  const std::uint32_t parts = 1U << finest_;
  const Real part = dt / parts;
  for (std::uint32_t n = 1; n < parts; ++n) {
    drift_part(part);
    const Moment now{f, state, time + n * part};
    if (pairs_.is_stale(f, state.now)) build_pairs(now);
    kick_due(now, finest_ - std::countr_zero(n), dt);
  }
  drift_part(part);
  if (!is_coupled) return;
  drift_liquids(f.model, f.runner, state.now, dt);
  move_with_transport(f.model, f.runner, state.forces, state.now, dt);
}

void LocalStepper::take_step(const ForceModel& f, State& state, Real time, Real dt,
                             const StepBounds& bounds, const GuardBounds& guard) {
  for (Forces* forces : {&closing_, &due_, &liquid_}) resize(f.model, *forces);
  const LiquidSolver* solver = acting_liquid_solver(f.model);
  evaluate_at_start({f, state, time}, dt, bounds, guard);
  finest_ = pairs_.finest();
  coarsest_ = pairs_.coarsest();
  f.enter("kick");
  kick(f.model, f.runner, state.forces, state.now, dt / 2);
  if (solver != nullptr && solver->solve_velocities != nullptr) {
    f.enter("project_velocities");
    solver->solve_velocities(f, state, time, dt);
  }
  drift_in_parts(f, state, time, dt);
  if (solver != nullptr && solver->correct_positions != nullptr) {
    solver->correct_positions(f, state, time + dt);
  }
  evaluate_at_end({f, state, time + dt}, dt, bounds, guard);
  f.enter("kick");
  kick(f.model, f.runner, closing_, state.now, dt / 2);
  state.forces_current = keeps_forces(f.model);
}

}  // namespace vat
