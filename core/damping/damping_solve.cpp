#include "core/damping/damping_solve.h"
#include "core/contact/scratch.h"

#include <algorithm>
#include <cmath>

#include "core/model/model.h"
#include "core/state/rigid_motion.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// The constants of the solve.
struct Equation {
  const StepContext& context;
  const std::vector<Vec3>& from;  ///< velocities before the forces act, by particle
  Real dt;
  DampingScratch& scratch;

  const Model& model() const { return context.model; }
  /// Returns the velocity of a particle before the forces act, relative to `at`.
  Vec3 past_velocity(std::size_t i) const { return from[i] - context.configuration.velocity[i]; }
};

void resize(const Model& model, Motion& motion) {
  motion.particle.resize(model.particle_count);
  motion.linear.resize(model.rigid_bodies.size());
  motion.angular.resize(model.rigid_bodies.size());
}

/// Calls f(n, begin, end) for the free particles [begin, end) of the n-th block with damping. The
/// other free particles have w = v - at = M^-1 r, and no equation has to be solved for them.
template <class F>
void for_damped_blocks(const Equation& eq, F&& f) {
  const std::vector<std::size_t>& blocks = eq.scratch.matrix.blocks();
  for_blocks<1>(eq.context.runner, blocks.size(), [&](std::size_t n, std::size_t) {
    const std::size_t begin = blocks[n] * kBlockSize;
    f(n, begin, std::min<std::size_t>(begin + kBlockSize, eq.model().free_count));
  });
}

template <class Sums>
Sums total_of(const std::vector<Sums>& partial) {
  Sums total{};
  for (const Sums& sum : partial) total += sum;
  return total;
}

/// The sum of f(i) over the particles of for_damped_blocks(), in blocks in their order.
template <class Sums, class F>
Sums sum_over_particles(const Equation& eq, std::vector<Sums>& partial, F&& f) {
  partial.assign(eq.scratch.matrix.blocks().size(), Sums{});
  for_damped_blocks(eq, [&](std::size_t n, std::size_t begin, std::size_t end) {
    Sums sum{};
    for (std::size_t i = begin; i < end; ++i) f(i, sum);
    partial[n] = sum;
  });
  return total_of(partial);
}

void find_inertias(const Equation& eq) {
  const Model& model = eq.model();
  std::vector<DampedBody>& bodies = eq.scratch.bodies;
  bodies.resize(model.rigid_bodies.size());
  for (std::size_t r = 0; r < bodies.size(); ++r) {
    const RigidModel& rigid = model.rigid_bodies[r];
    const Mat3 turn = eq.context.configuration.rigid[r].orientation.toRotationMatrix();
    const bool is_held = rigid.is_held(eq.context.step);
    bodies[r] = {
        rigid.mass, is_held ? 0 : rigid.inverse_mass, turn * rigid.inertia * turn.transpose(),
        is_held ? Mat3(Mat3::Zero()) : Mat3(turn * rigid.inverse_inertia * turn.transpose())};
  }
}

/// force = D w; writes the entries of rigid particles in w.
void apply_damping(const Equation& eq, Motion& w, Motion& force) {
  const Model& model = eq.model();
  std::vector<Vec3>& friction_torque = eq.scratch.friction_torque;
  const auto for_rigid_particles = [&](auto&& f) {
    for (const Index e : eq.scratch.matrix.rigid_particles()) {
      const Index r = model.bodies[model.body[e]].rigid;
      f(r, e,
        Vec3(eq.context.configuration.position[e] -
             eq.context.configuration.rigid[r].center_of_mass));
    }
  };
  for_rigid_particles([&](Index r, Index e, const Vec3& arm) {
    w.particle[e] = w.linear[r] + w.angular[r].cross(arm);
    if (model.has_friction) friction_torque[e].setZero();
  });
  eq.scratch.matrix.multiply(eq.context, w.particle, w.angular, force.particle, friction_torque);
  std::ranges::fill(force.linear, Vec3::Zero());
  std::ranges::fill(force.angular, Vec3::Zero());
  for_rigid_particles([&](Index r, Index e, const Vec3& arm) {
    force.linear[r] += force.particle[e];
    force.angular[r] += arm.cross(force.particle[e]);
    if (model.has_friction) force.angular[r] += friction_torque[e];
  });
}

/// r = dt f + M (from - at), p = M^-1 r, w = 0, D w = 0.
DampingSums start(const Equation& eq, const Forces& forces) {
  const Model& model = eq.model();
  const std::vector<DampedBody>& bodies = eq.scratch.bodies;
  Motion& w = eq.scratch.change;
  Motion& force = eq.scratch.force;
  Motion& r = eq.scratch.residual;
  Motion& p = eq.scratch.direction;
  DampingSums total = sum_over_particles(eq, eq.scratch.sums, [&](std::size_t i, DampingSums& sum) {
    r.particle[i] = eq.dt * forces.particle[i] + model.mass[i] * eq.past_velocity(i);
    p.particle[i] = model.inverse_mass[i] * r.particle[i];
    w.particle[i].setZero();
    force.particle[i].setZero();
    sum.error += r.particle[i].dot(p.particle[i]);
    sum.size += model.mass[i] * eq.past_velocity(i).squaredNorm();
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    r.linear[b] = eq.dt * forces.rigid_force[b];
    r.angular[b] = eq.dt * forces.rigid_torque[b];
    p.linear[b] = bodies[b].inverse_mass * r.linear[b];
    p.angular[b] = bodies[b].inverse_inertia * r.angular[b];
    for (std::vector<Vec3>* zero : {&w.linear, &w.angular, &force.linear, &force.angular}) {
      (*zero)[b].setZero();
    }
    total.error += r.linear[b].dot(p.linear[b]) + r.angular[b].dot(p.angular[b]);
  }
  return total;
}

/// <p, (M - dt D) p> with q = D p.
Real curvature_along(const Equation& eq) {
  const Model& model = eq.model();
  const std::vector<DampedBody>& bodies = eq.scratch.bodies;
  const Motion& p = eq.scratch.direction;
  const Motion& q = eq.scratch.product;
  Real sum = sum_over_particles(eq, eq.scratch.partial_sums, [&](std::size_t i, Real& part) {
    part += p.particle[i].dot(model.mass[i] * p.particle[i] - eq.dt * q.particle[i]);
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    sum += p.linear[b].dot(bodies[b].mass * p.linear[b] - eq.dt * q.linear[b]);
    sum += p.angular[b].dot(bodies[b].inertia * p.angular[b] - eq.dt * q.angular[b]);
  }
  return sum;
}

/// w += length p; updates D w and r.
DampingSums advance_along(const Equation& eq, Real length) {
  const Model& model = eq.model();
  const std::vector<DampedBody>& bodies = eq.scratch.bodies;
  Motion& w = eq.scratch.change;
  Motion& force = eq.scratch.force;
  Motion& r = eq.scratch.residual;
  const Motion& p = eq.scratch.direction;
  const Motion& q = eq.scratch.product;
  DampingSums total = sum_over_particles(eq, eq.scratch.sums, [&](std::size_t i, DampingSums& sum) {
    w.particle[i] += length * p.particle[i];
    force.particle[i] += length * q.particle[i];
    r.particle[i] -= length * (model.mass[i] * p.particle[i] - eq.dt * q.particle[i]);
    sum.error += model.inverse_mass[i] * r.particle[i].squaredNorm();
    sum.size += model.mass[i] * (w.particle[i] - eq.past_velocity(i)).squaredNorm();
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const DampedBody& body = bodies[b];
    w.linear[b] += length * p.linear[b];
    w.angular[b] += length * p.angular[b];
    force.linear[b] += length * q.linear[b];
    force.angular[b] += length * q.angular[b];
    r.linear[b] -= length * (body.mass * p.linear[b] - eq.dt * q.linear[b]);
    r.angular[b] -= length * (body.inertia * p.angular[b] - eq.dt * q.angular[b]);
    total.error += body.inverse_mass * r.linear[b].squaredNorm() +
                   r.angular[b].dot(body.inverse_inertia * r.angular[b]);
    total.size +=
        body.mass * w.linear[b].squaredNorm() + w.angular[b].dot(body.inertia * w.angular[b]);
  }
  return total;
}

/// p = M^-1 r + share p.
void turn_direction(const Equation& eq, Real share) {
  const Model& model = eq.model();
  const std::vector<DampedBody>& bodies = eq.scratch.bodies;
  const Motion& r = eq.scratch.residual;
  Motion& p = eq.scratch.direction;
  for_damped_blocks(eq, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      p.particle[i] = model.inverse_mass[i] * r.particle[i] + share * p.particle[i];
    }
  });
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    p.linear[b] = bodies[b].inverse_mass * r.linear[b] + share * p.linear[b];
    p.angular[b] = bodies[b].inverse_inertia * r.angular[b] + share * p.angular[b];
  }
}

/// Returns the square of the error of w that the velocities permit. Their mean does not count, so
/// that the result does not depend on the frame of reference.
Real permitted_error(const Equation& eq) {
  const Model& model = eq.model();
  const Configuration& at = eq.context.configuration;
  const auto add = [](MomentSums& sums, Real mass, const Vec3& velocity) {
    sums += {mass, mass * velocity, mass * velocity.squaredNorm()};
  };
  std::vector<MomentSums>& partial = eq.scratch.moments;
  partial.assign(block_count(model.free_count), {});
  for_blocks(eq.context.runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    MomentSums sums;
    for (std::size_t i = begin; i < end; ++i) {
      if (model.inverse_mass[i] > 0) add(sums, model.mass[i], at.velocity[i]);
    }
    partial[begin / kBlockSize] = sums;
  });
  MomentSums total = total_of(partial);
  for (std::size_t b = 0; b < eq.scratch.bodies.size(); ++b) {
    const DampedBody& body = eq.scratch.bodies[b];
    if (body.inverse_mass > 0) add(total, body.mass, at.rigid[b].momentum * body.inverse_mass);
  }
  return kDampingVelocityTolerance * kDampingVelocityTolerance * total.spread();
}

/// Conjugate gradients from w = 0, preconditioned with M. Returns the number of products.
int iterate(const Equation& eq, DampingSums sums) {
  const Real permitted = permitted_error(eq);
  for (int iteration = 0; iteration < kMaxDampingPasses; ++iteration) {
    if (!(sums.error > std::max(kDampingTolerance * kDampingTolerance * sums.size, permitted)))
      return iteration;
    apply_damping(eq, eq.scratch.direction, eq.scratch.product);
    const Real curvature = curvature_along(eq);
    if (!(curvature > 0)) return iteration + 1;  // too small for the precision of numbers
    const DampingSums advance = advance_along(eq, sums.error / curvature);
    turn_direction(eq, advance.error / sums.error);
    sums = advance;
  }
  return kMaxDampingPasses;
}

Oscillation greater(const Oscillation& a, const Oscillation& b) {
  return {std::max(a.omega2, b.omega2), std::max(a.rate, b.rate)};
}

}  // namespace

Oscillation find_bound_of_bodies(const Model& model) {
  Oscillation bound;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (body.kind == BodyKind::rigid) continue;
    const auto mobility =
        std::span(model.inverse_mass).subspan(body.particles.begin, body.particles.size());
    if (std::ranges::any_of(mobility, [](Real each) { return each > 0; })) {
      bound = greater(bound, model.damping.own[b]);
    }
  }
  return bound;
}

Oscillation find_bound(const ForceModel& f, const Configuration& at) {
  ContactForceScratch& contact_buffers = f.work.of<ContactForceScratch>();
  const Model& model = f.model;
  VAT_CHECK(f.model.damping.own.size() == f.model.bodies.size());
  const std::vector<ContactLoad>& loads = contact_buffers.contact_loads;
  Oscillation bound = find_bound_of_bodies(model);
  if (loads.empty()) return bound;
  const auto take = [&](const Oscillation& o) { bound = greater(bound, o); };
  std::vector<Oscillation>& by_block = contact_buffers.load_bounds;
  by_block.resize(block_count(model.free_count));
  for_blocks(f.runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    Oscillation& of_block = by_block[begin / kBlockSize];
    of_block = {};
    for (std::size_t i = begin; i < end; ++i) {
      if (loads[i].stiffness == 0 && loads[i].damping == 0) continue;
      const Real mobility = model.inverse_mass[i];
      if (mobility == 0) continue;
      of_block = greater(
          of_block, model.damping.own[model.body[i]] +
                        Oscillation{mobility * loads[i].stiffness, mobility * loads[i].damping});
    }
  });
  std::ranges::for_each(by_block, take);
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const RigidModel& rigid = model.rigid_bodies[r];
    Oscillation sum;
    for (Index e = rigid.particles.begin; e < rigid.particles.end; ++e) {
      if (loads[e].stiffness == 0 && loads[e].damping == 0) continue;
      Real arm2 = (at.position[e] - at.rigid[r].center_of_mass).squaredNorm();
      if (model.has_friction) arm2 = std::pow(std::sqrt(arm2) + model.radius[e], 2);
      const Real mobility = rigid.inverse_mass + arm2 * rigid.inverse_moments.maxCoeff();
      sum = sum + Oscillation{mobility * loads[e].stiffness, mobility * loads[e].damping};
    }
    take(sum);
  }
  return bound;
}

bool must_solve_damping(const Oscillation& bound, Real dt) {
  return bound.rate > 0 && bound.omega2 * dt * dt + 4 * bound.rate * dt > 4;
}

bool must_solve_viscosity(const Model& model, Real dt) {
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].kind == BodyKind::liquid && must_solve_damping(model.damping.own[b], dt)) {
      return true;
    }
  }
  return false;
}

bool must_solve_own_damping(const Model& model, Real dt) {
  return std::ranges::any_of(model.damping.own,
                             [&](const Oscillation& own) { return must_solve_damping(own, dt); });
}

void solve_damping(const ForceModel& f, const Configuration& from, Configuration& at, Real time,
                   Real dt, bool viscosity, Forces& forces, DampingScratch& scratch) {
  const StepContext context{f.model, f.controls, time, f.step, at, forces, f.work, f.runner};
  const Equation eq{context, from.velocity, dt, scratch};
  VAT_CHECK(forces.particle.size() == f.model.particle_count &&
            from.velocity.size() == at.velocity.size());
  scratch.matrix.collect(context, viscosity);
  for (Motion* motion :
       {&scratch.change, &scratch.force, &scratch.residual, &scratch.direction, &scratch.product}) {
    resize(f.model, *motion);
  }
  if (f.model.has_friction) scratch.friction_torque.resize(f.model.particle_count);
  find_inertias(eq);
  const int products = iterate(eq, start(eq, forces));
  if (f.report != nullptr) f.report->iterations.damping += static_cast<std::uint64_t>(products);
  for_damped_blocks(eq, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) forces.particle[i] += scratch.force.particle[i];
  });
  for (std::size_t r = 0; r < f.model.rigid_bodies.size(); ++r) {
    if (f.model.rigid_bodies[r].is_held(f.step)) continue;
    apply_axle(f.model.rigid_bodies[r], scratch.force.linear[r], scratch.force.angular[r]);
    forces.rigid_force[r] += scratch.force.linear[r];
    forces.rigid_torque[r] += scratch.force.angular[r];
  }
}

}  // namespace vat
