#include "core/integrators/damping_solve.h"

#include <algorithm>
#include <cmath>

#include "core/model/model.h"

namespace vat {
namespace {

constexpr Real kTolerance = 1e-2;  // of the change of velocities, in the norm of M
constexpr int kMaxIterations = 200;

/// The solve's constants.
struct Equation {
  const ForceModel& force_model;
  const Configuration& at;
  Real dt;
  DampingScratch& scratch;

  const Model& model() const { return force_model.model; }
};

Mat3 to_world(const Quat& orientation, const Mat3& tensor) {
  const Mat3 r = orientation.toRotationMatrix();
  return r * tensor * r.transpose();
}

void resize(const Model& model, Motion& motion) {
  motion.particle.resize(model.particle_count);
  motion.linear.resize(model.rigid_bodies.size());
  motion.angular.resize(model.rigid_bodies.size());
}

/// Calls f(x of a, x of b) for each free particle's entry and each rigid body's two.
template <class F>
void for_entries(const Equation& eq, Motion& a, const Motion& b, F&& f) {
  for_blocks(eq.force_model.runner, eq.model().free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(a.particle[i], b.particle[i]);
  });
  for (std::size_t r = 0; r < a.linear.size(); ++r) {
    f(a.linear[r], b.linear[r]);
    f(a.angular[r], b.angular[r]);
  }
}

Real dot(const Equation& eq, const Motion& a, const Motion& b) {
  std::vector<Real>& sums = eq.scratch.partial_sums;
  sums.assign(block_count(eq.model().free_count), 0);
  for_blocks(eq.force_model.runner, eq.model().free_count, [&](std::size_t begin, std::size_t end) {
    Real sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += a.particle[i].dot(b.particle[i]);
    sums[begin / kBlockSize] = sum;
  });
  Real total = 0;
  for (const Real sum : sums) total += sum;
  for (std::size_t r = 0; r < a.linear.size(); ++r) {
    total += a.linear[r].dot(b.linear[r]) + a.angular[r].dot(b.angular[r]);
  }
  return total;
}

/// y = M x of velocities.
void apply_mass(const Equation& eq, const Motion& x, Motion& y) {
  const Model& model = eq.model();
  for_blocks(eq.force_model.runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y.particle[i] = model.mass[i] * x.particle[i];
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const RigidModel& rigid = model.rigid_bodies[r];
    y.linear[r] = x.linear[r] / rigid.inverse_mass;
    y.angular[r] = to_world(eq.at.rigid[r].orientation, rigid.inertia) * x.angular[r];
  }
}

/// y = M^-1 x of forces; zero for what does not move.
void apply_inverse_mass(const Equation& eq, const Motion& x, Motion& y) {
  const Model& model = eq.model();
  for_blocks(eq.force_model.runner, model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) y.particle[i] = model.inverse_mass[i] * x.particle[i];
  });
  for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
    const RigidModel& rigid = model.rigid_bodies[r];
    if (rigid.is_held(eq.force_model.step)) {
      y.linear[r].setZero();
      y.angular[r].setZero();
      continue;
    }
    y.linear[r] = rigid.inverse_mass * x.linear[r];
    y.angular[r] = to_world(eq.at.rigid[r].orientation, rigid.inverse_inertia) * x.angular[r];
  }
}

/// force = D w; writes the rigid particles' entries of w.
void apply_damping(const Equation& eq, Motion& w, Motion& force) {
  const Model& model = eq.model();
  const auto for_rigid_particles = [&](auto&& f) {
    for (std::size_t r = 0; r < model.rigid_bodies.size(); ++r) {
      const IndexRange particles = model.rigid_bodies[r].particles;
      for (Index e = particles.begin; e < particles.end; ++e) {
        f(r, e, Vec3(eq.at.position[e] - eq.at.rigid[r].center_of_mass));
      }
    }
  };
  for_rigid_particles([&](std::size_t r, Index e, const Vec3& arm) {
    w.particle[e] = w.linear[r] + w.angular[r].cross(arm);
  });
  std::vector<Vec3>& rub_torque = eq.scratch.rub_torque;
  eq.scratch.matrix.multiply(eq.force_model, w.particle, w.angular, force.particle, rub_torque);
  std::ranges::fill(force.linear, Vec3::Zero());
  std::ranges::fill(force.angular, Vec3::Zero());
  for_rigid_particles([&](std::size_t r, Index e, const Vec3& arm) {
    force.linear[r] += force.particle[e];
    force.angular[r] += arm.cross(force.particle[e]);
    if (model.has_friction) force.angular[r] += rub_torque[e];
  });
}

/// <w, M w>.
Real size_of(const Equation& eq, const Motion& w) {
  apply_mass(eq, w, eq.scratch.inertia);
  return dot(eq, w, eq.scratch.inertia);
}

/// Conjugate gradients from the change in the scratch, preconditioned with M.
void iterate(const Equation& eq) {
  auto& [matrix, w, residual, direction, inertia, product, rub_torque, partial_sums] = eq.scratch;
  apply_damping(eq, w, residual);
  for_entries(eq, residual, residual, [&](Vec3& r, const Vec3&) { r *= eq.dt; });
  apply_inverse_mass(eq, residual, direction);
  Real error = dot(eq, residual, direction);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!(error > kTolerance * kTolerance * size_of(eq, w))) return;
    apply_damping(eq, direction, product);
    apply_mass(eq, direction, inertia);
    for_entries(eq, product, inertia, [&](Vec3& q, const Vec3& m) { q = m - eq.dt * q; });
    const Real curvature = dot(eq, direction, product);
    if (!(curvature > 0)) return;  // too small for numbers
    const Real length = error / curvature;
    for_entries(eq, w, direction, [&](Vec3& x, const Vec3& p) { x += length * p; });
    for_entries(eq, residual, product, [&](Vec3& r, const Vec3& q) { r -= length * q; });
    apply_inverse_mass(eq, residual, product);
    const Real next = dot(eq, residual, product);
    for_entries(eq, direction, product,
                [&](Vec3& p, const Vec3& z) { p = z + (next / error) * p; });
    error = next;
  }
}

}  // namespace

Oscillation find_bound(const ForceModel& f, const Configuration& at) {
  const Model& model = f.model;
  const std::vector<ContactLoad>& loads = f.work.contact_loads;
  Oscillation bound;
  const auto take = [&](const Oscillation& o) {
    bound = {std::max(bound.omega2, o.omega2), std::max(bound.rate, o.rate)};
  };
  for (Index i = 0; i < model.free_count; ++i) {
    const Real mobility = model.inverse_mass[i];
    if (mobility == 0) continue;
    take(model.damping.own[model.body[i]] +
         Oscillation{mobility * loads[i].stiffness, mobility * loads[i].damping});
  }
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

void solve_damping(const ForceModel& f, const Configuration& from, const Configuration& at,
                   Real time, Real dt, bool viscosity, Forces& forces, DampingScratch& scratch) {
  const Equation eq{f, at, dt, scratch};
  auto& [matrix, w, residual, direction, inertia, product, rub_torque, partial_sums] = scratch;
  matrix.collect(f, at, time, viscosity);
  for (Motion* motion : {&w, &residual, &direction, &inertia, &product}) resize(f.model, *motion);
  if (f.model.has_friction) rub_torque.resize(f.model.particle_count);
  product.particle = forces.particle;  // one by one, which keeps their room
  product.linear = forces.rigid_force;
  product.angular = forces.rigid_torque;
  apply_inverse_mass(eq, product, w);
  for_entries(eq, w, w, [&](Vec3& x, const Vec3&) { x *= eq.dt; });
  for (Index i = 0; i < f.model.free_count; ++i) {
    w.particle[i] += from.velocity[i] - at.velocity[i];
  }
  iterate(eq);
  apply_damping(eq, w, product);
  for (Index i = 0; i < f.model.particle_count; ++i) forces.particle[i] += product.particle[i];
  for (std::size_t r = 0; r < f.model.rigid_bodies.size(); ++r) {
    if (f.model.rigid_bodies[r].is_held(f.step)) continue;
    forces.rigid_force[r] += product.linear[r];
    forces.rigid_torque[r] += product.angular[r];
  }
}

}  // namespace vat
