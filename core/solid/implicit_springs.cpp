#include "core/solid/implicit_springs.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/laws/pair_direction.h"
#include "core/model/model.h"
#include "core/solid/spring_changes.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxNewtonSteps = 20;
constexpr int kMaxShortenings = 6;        // of one Newton step
constexpr Real kLinearTolerance = 0.1;    // of the residual, in one Newton step
constexpr Real kDashpotTolerance = 1e-4;  // of the impulse
constexpr int kMaxDriftHalvings = 6;
constexpr int kMaxTurns = 8;

/// Squares in the norm of the inverse masses.
struct ResidualSize {
  Real residual2 = 0;
  Real rounding2 = 0;  ///< of the rounding errors of the forces
};

/// The drift of one body with implicit springs.
class BodyDrift {
 public:
  BodyDrift(const ForceModel& f, const Configuration& at, const ModelBody& body,
            ImplicitSpringsScratch& scratch)
      : model_(f.model),
        at_(at),
        report_(f.report),
        particles_(body.particles),
        system_(f.model, f.runner, body, scratch.system),
        s_(scratch) {
    find_pivot();
  }
  ~BodyDrift() {
    if (report_ == nullptr) return;
    report_->particle_evaluations += system_.passes() * particles_.size();
    report_->iterations.springs += system_.passes();
  }
  BodyDrift(const BodyDrift&) = delete;
  BodyDrift& operator=(const BodyDrift&) = delete;

  /// Applies the springs over `part` of `dt`. Returns false if some part did not converge.
  bool take(Real dt, Real part, int halvings = 0);
  /// Applies the dashpots over `dt` to velocities at positions, both by particle.
  void damp(std::span<const Vec3> positions, std::span<Vec3> velocities, Real dt);

 private:
  std::size_t place_of(Index i) const { return system_.place_of(i); }
  Vec3 push_end(Index i, Index end, Real half);
  ResidualSize find_residual(Real half);
  bool follow_change(Real half, ResidualSize& size);
  void find_pivot();
  bool solve(Real half);
  bool remove_turn(Real half);

  const Model& model_;
  const Configuration& at_;
  AdvanceReport* report_;
  IndexRange particles_;
  SpringSystem system_;
  ImplicitSpringsScratch& s_;
  bool can_turn_ = false;       ///< at most one particle is fixed
  std::optional<Index> pivot_;  ///< the only fixed particle
  bool is_exact_ = false;       ///< the last solve reached the tolerance
};

/// The force at one end. Stores its slope.
Vec3 BodyDrift::push_end(Index i, Index end, Real half) {
  const SpringEnd spring = present_spring(model_, at_, end);
  const std::size_t a = place_of(i);
  const std::size_t b = place_of(spring.other);
  const Vec3 start = s_.position[a] - s_.position[b];
  const Vec3 way = half * (s_.velocity[a] - s_.velocity[b]);
  const Vec3 middle = start + way;
  const Real before = start.norm();
  const Real after = (middle + way).norm();
  const Real mean = (before + after) / 2;
  const Vec3 n = pair_direction(middle, middle.norm(), i, spring.other, model_.scene.dimensions);
  const Real calming =
      2 * half * spring.damping * (model_.inverse_mass[i] + model_.inverse_mass[spring.other]);
  const Real late = calming * calming / (1 + calming * calming);
  const Real stiffness = half * half * spring.stiffness;
  // Two particles at one position are pushed apart as by any spring.
  if (mean == 0) {
    system_.slope(end) = {n, stiffness, 0};
    return spring.stiffness * spring.rest_length * n;
  }
  const Real strain = (mean - spring.rest_length + late * (after - before) / 2) / mean;
  system_.slope(end) = {n, (1 + late) * stiffness, stiffness * std::max(strain, Real{0})};
  return -spring.stiffness * strain * middle;
}

/// The remaining impulse dt/2 f - m (v - v0) at the velocities of the scratch.
ResidualSize BodyDrift::find_residual(Real half) {
  constexpr Real kRounding = 4 * std::numeric_limits<Real>::epsilon();
  system_.count_pass();
  system_.for_particles([&](Index i) {
    const std::size_t k = place_of(i);
    s_.system.residual[k].setZero();
    if (model_.inverse_mass[i] == 0) return;
    Vec3 force = Vec3::Zero();
    for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
      force += push_end(i, e, half);
    }
    s_.system.residual[k] = half * force - model_.mass[i] * (s_.velocity[k] - s_.start_velocity[k]);
  });
  const Real residual2 = system_.sum([&](Index i) {
    return model_.inverse_mass[i] * s_.system.residual[place_of(i)].squaredNorm();
  });
  const Real rounding2 = system_.sum([&](Index i) {
    const std::size_t k = place_of(i);
    Real stiffness = 0;
    for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
      stiffness += model_.spring_ends[e].stiffness;
    }
    const Real rounding =
        half * stiffness * s_.position[k].norm() + model_.mass[i] * s_.start_velocity[k].norm();
    return kRounding * kRounding * model_.inverse_mass[i] * rounding * rounding;
  });
  return {residual2, rounding2};
}

/// Moves along the change as far as the residual decreases. Returns false if it does not.
bool BodyDrift::follow_change(Real half, ResidualSize& size) {
  system_.for_particles([&](Index i) { s_.last_velocity[place_of(i)] = s_.velocity[place_of(i)]; });
  Real length = 1;
  for (int shortening = 0; shortening <= kMaxShortenings; ++shortening, length /= 2) {
    system_.for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      s_.velocity[k] = s_.last_velocity[k] + length * s_.system.change[k];
    });
    remove_turn(half);
    const ResidualSize trial = find_residual(half);
    if (!(trial.residual2 < size.residual2)) continue;
    size = trial;
    return true;
  }
  return false;
}

bool BodyDrift::solve(Real half) {
  system_.for_particles(
      [&](Index i) { s_.velocity[place_of(i)] = s_.start_velocity[place_of(i)]; });
  ResidualSize size = find_residual(half);
  for (int step = 0; step <= kMaxNewtonSteps; ++step) {
    const Real change2 = system_.sum([&](Index i) {
      const std::size_t k = place_of(i);
      return model_.mass[i] * (s_.velocity[k] - s_.start_velocity[k]).squaredNorm();
    });
    const Real enough = kSpringTolerance * kSpringTolerance * change2;
    is_exact_ = size.residual2 <= enough;
    if (is_exact_ || size.residual2 <= size.rounding2) return true;
    if (step == kMaxNewtonSteps) break;
    system_.solve(kLinearTolerance);
    if (!follow_change(half, size)) break;
  }
  return false;
}

/// Finds the fixed particle of a body that has only one.
void BodyDrift::find_pivot() {
  int count = 0;
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    if (model_.inverse_mass[i] > 0) continue;
    pivot_ = i;
    ++count;
  }
  can_turn_ = count <= 1;
}

/// Removes the angular momentum error that the tolerance of the solve and rounding permit. The
/// springs exert no torque about the only fixed particle, or about the centre of mass of a body
/// without fixed particles. Returns false if the error is zero, or if more particles are fixed. The
/// correction moves the midpoints, so that a small part remains.
bool BodyDrift::remove_turn(Real half) {
  if (!can_turn_) return false;
  const auto middle = [&](Index i) {
    return Vec3(s_.position[place_of(i)] + half * s_.velocity[place_of(i)]);
  };
  Vec3 center = Vec3::Zero();
  if (pivot_) {
    center = s_.position[place_of(*pivot_)];
  } else {
    Real mass = 0;
    for (Index i = particles_.begin; i < particles_.end; ++i) {
      center += model_.mass[i] * middle(i);
      mass += model_.mass[i];
    }
    center /= mass;
  }
  Vec3 torque = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  for (Index i = particles_.begin; i < particles_.end; ++i) {
    if (model_.inverse_mass[i] == 0) continue;
    const std::size_t k = place_of(i);
    const Vec3 arm = middle(i) - center;
    torque += model_.mass[i] * arm.cross(s_.velocity[k] - s_.start_velocity[k]);
    inertia += model_.mass[i] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  // Particles in a line have no torque along it, where their inertia is zero.
  inertia += 1e-12 * inertia.trace() * Mat3::Identity();
  if (inertia.trace() == 0) return false;
  const Vec3 turn = inertia.ldlt().solve(torque);
  system_.for_particles([&](Index i) {
    if (model_.inverse_mass[i] == 0) return;
    s_.velocity[place_of(i)] -= turn.cross(middle(i) - center);
  });
  return half * turn.norm() > std::numeric_limits<Real>::epsilon();
}

bool BodyDrift::take(Real dt, Real part, int halvings) {
  VAT_CHECK(part > 0 && dt > 0);
  // Rounding errors of the factor may prevent a solution that conjugate gradients find.
  const bool is_solved = solve(dt * part / 2) || (system_.stop_factoring() && solve(dt * part / 2));
  if (!is_solved && halvings < kMaxDriftHalvings) {
    const bool first = take(dt, part / 2, halvings + 1);
    return take(dt, part / 2, halvings + 1) && first;
  }
  // An error above the tolerance is no small rotation; its correction would stretch the springs.
  for (int round = 0; round < kMaxTurns && is_exact_; ++round) {
    if (!remove_turn(dt * part / 2)) break;
  }
  system_.for_particles([&](Index i) {
    const std::size_t k = place_of(i);
    s_.position[k] += dt * part * s_.velocity[k];
    s_.mean_velocity[k] += part * s_.velocity[k];
    s_.start_velocity[k] = 2 * s_.velocity[k] - s_.start_velocity[k];
  });
  return is_solved;
}

void BodyDrift::damp(std::span<const Vec3> positions, std::span<Vec3> velocities, Real dt) {
  const Real share = 1 - std::sqrt(Real{0.5});
  system_.for_particles([&](Index i) {
    for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
      const SpringEnd spring = present_spring(model_, at_, e);
      const Vec3 x = positions[place_of(i)] - positions[place_of(spring.other)];
      const Vec3 n = pair_direction(x, x.norm(), i, spring.other, model_.scene.dimensions);
      system_.slope(e) = {n, share * dt * spring.damping, 0};
    }
  });
  // Two implicit Euler steps of share dt, the second from v + (1 - share) / share (v1 - v).
  for (const Real onwards : {(1 - share) / share, Real{1}}) {
    system_.count_pass();
    system_.for_particles([&](Index i) {
      const std::size_t k = place_of(i);
      s_.system.residual[k].setZero();
      if (model_.inverse_mass[i] == 0) return;
      for (Index e = model_.spring_begin[i]; e < model_.spring_begin[i + 1]; ++e) {
        const SpringSlope& slope = system_.slope(e);
        const Vec3 v = velocities[k] - velocities[place_of(model_.spring_ends[e].other)];
        s_.system.residual[k] -= (slope.along * v.dot(slope.direction)) * slope.direction;
      }
    });
    system_.solve(kDashpotTolerance);
    system_.for_particles(
        [&](Index i) { velocities[place_of(i)] += onwards * s_.system.change[place_of(i)]; });
  }
}

bool has_damping(const Model& model, const IndexRange& particles) {
  const auto begin = model.spring_ends.begin();
  return std::any_of(begin + model.spring_begin[particles.begin],
                     begin + model.spring_begin[particles.end],
                     [](const SpringEnd& spring) { return spring.damping > 0; });
}

/// Calls f(body) for each body with implicit springs.
template <class F>
void for_bodies(const Model& model, F&& f) {
  for (const ModelBody& body : model.bodies) {
    const IndexRange& particles = body.particles;
    if (particles.begin >= model.implicit_begin && particles.end <= model.free_count) f(body);
  }
}

/// The part of a column for particles from Model::implicit_begin to free_count.
template <class Columns>
auto part_of(const Model& model, Columns& column) {
  return std::span(column).subspan(model.implicit_begin, model.free_count - model.implicit_begin);
}

}  // namespace

void store_implicit_positions(const Model& model, const Configuration& at,
                              ImplicitSpringsScratch& scratch) {
  const std::span<const Vec3> positions = part_of(model, at.position);
  scratch.position.assign(positions.begin(), positions.end());
}

void drift_implicit_springs(const ForceModel& f, Configuration& at, Real dt,
                            ImplicitSpringsScratch& scratch) {
  VAT_CHECK(scratch.position.size() == f.model.free_count - f.model.implicit_begin);
  const std::span<Vec3> positions = part_of(f.model, at.position);
  const std::span<Vec3> velocities = part_of(f.model, at.velocity);
  std::ranges::copy(scratch.position, positions.begin());
  scratch.system.resize(f.model);
  scratch.start_velocity.assign(velocities.begin(), velocities.end());
  scratch.mean_velocity.assign(positions.size(), Vec3::Zero());
  scratch.velocity.resize(positions.size());
  scratch.last_velocity.resize(positions.size());
  for_bodies(f.model, [&](const ModelBody& body) {
    if (!BodyDrift(f, at, body, scratch).take(dt, 1) && f.report != nullptr) {
      ++f.report->unsolved_drifts;
    }
  });
  for (std::size_t k = 0; k < positions.size(); ++k) positions[k] += dt * scratch.mean_velocity[k];
  std::ranges::copy(scratch.start_velocity, velocities.begin());
}

void damp_implicit_springs(const ForceModel& f, Configuration& at, Real dt,
                           ImplicitSpringsScratch& scratch) {
  scratch.system.resize(f.model);
  const std::span<const Vec3> positions = part_of(f.model, at.position);
  const std::span<Vec3> velocities = part_of(f.model, at.velocity);
  for_bodies(f.model, [&](const ModelBody& body) {
    if (!has_damping(f.model, body.particles)) return;
    BodyDrift(f, at, body, scratch).damp(positions, velocities, dt);
  });
}

}  // namespace vat
