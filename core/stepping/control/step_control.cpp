#include "core/stepping/control/step_control.h"
#include "core/contact/scratch.h"
#include "core/state/controls.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "core/contact/contacts.h"
#include "core/damping/damping_solve.h"
#include "core/limits.h"
#include "core/liquid/gas/liquid.h"
#include "core/numerics/error_model.h"
#include "core/numerics/step_limits.h"
#include "core/rigid/rigid.h"
#include "core/state/rigid_motion.h"
#include "core/stepping/control/step_control_liquid.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

/// 2 lambda_max(sum_j k_ij n n^T) / m_i at the start, for one of the constants of the springs.
template <class Constant>
Real spring_load(const Model& model, const ModelBody& body, Index i, Constant&& constant) {
  const std::vector<Vec3>& at = body.sample->positions;
  const Index first = body.particles.begin;
  Mat3 load = Mat3::Zero();
  for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
    const SpringEnd& spring = model.spring_ends[s];
    const Vec3 x = at[i - first] - at[spring.other - first];
    const Real length2 = x.squaredNorm();
    load += constant(spring) *
            (length2 > 0 ? Mat3(x * x.transpose() / length2) : Mat3(Mat3::Identity()));
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(load, Eigen::EigenvaluesOnly);
  return 2 * solver.eigenvalues()[2] * model.inverse_mass[i];
}

/// The part of the own bounds of bodies that limits steps; see OscillatingPart::limiting().
Oscillation limiting(const Model& model, const Oscillation& own) {
  return {own.omega2, solves_damping(model.scene) ? 0 : own.rate};
}

/// Sets the bounds of a body's particles, which are equal.
void bound_liquid(const Model& model, std::size_t b, StepBounds& bounds) {
  const IndexRange& particles = model.bodies[b].particles;
  const bool has_level_of_its_own = model.scene.numerics.control == StepControl::local;
  const Oscillation own = has_level_of_its_own
                              ? Oscillation{}
                              : limiting(model, compressed(model, model.damping.own[b]));
  const Real step = safe_step(model.scene.numerics, own);
  const Real step_at_rest = safe_step(model.scene.numerics, {});
  for (Index i = particles.begin; i < particles.end; ++i) {
    const bool is_free = model.inverse_mass[i] > 0;
    bounds.own[i] = is_free ? own : Oscillation{};
    bounds.own_step[i] = is_free ? step : step_at_rest;
  }
}

/// The step of a body whose scene asks for sub-steps.
Real wanted_step(const Model& model, std::size_t body) {
  const Numerics& numerics = model.scene.numerics;
  const std::uint32_t parts = model.scene.bodies[body].sub_steps;
  return numerics.control == StepControl::local && parts > 1 ? numerics.step / parts : kInfinity;
}

void bound_deformable(const Model& model, std::size_t b, StepBounds& bounds) {
  const ModelBody& body = model.bodies[b];
  const Real wanted = wanted_step(model, b);
  const Oscillation cells{
      model.scene.forces.springs && !body.sample->cells.empty()
          ? bound_cells(*body.sample, model.scene.materials[body.material].bulk_modulus,
                        model.scene.dimensions)
          : 0,
      0};
  for (Index i = body.particles.begin; i < body.particles.end; ++i) {
    Oscillation own;
    if (model.inverse_mass[i] > 0) {
      if (i < model.implicit_begin && model.spring_begin[i] != model.spring_begin[i + 1]) {
        own = {spring_load(model, body, i, [](const SpringEnd& s) { return s.stiffness; }),
               spring_load(model, body, i, [](const SpringEnd& s) { return s.damping; })};
      }
      own.omega2 += cells.omega2;
    }
    bounds.own[i] = limiting(model, own);
    bounds.own_step[i] = std::min(safe_step(model.scene.numerics, bounds.own[i]), wanted);
  }
}

Real find_scene_step(const Model& model) {
  const Numerics& numerics = model.scene.numerics;
  Real step = kInfinity;
  if (model.scene.forces.gravity && model.scene.central_field &&
      model.scene.central_field->angular_frequency > 0) {
    step = resolving_phase_of_places(numerics) / model.scene.central_field->angular_frequency;
  }
  for (std::size_t b = 0; model.is_coupled && b < model.bodies.size(); ++b) {
    if (model.bodies[b].kind == BodyKind::liquid) continue;
    // With local control, the springs of the body limit its sub-steps only.
    const bool is_local = numerics.control == StepControl::local;
    const Oscillation& own = is_local ? model.damping.by_liquids[b] : model.damping.own[b];
    step = std::min(step, safe_step(numerics, limiting(model, compressed(model, own))));
  }
  return step;
}

void bound_body(const Model& model, std::size_t b, StepBounds& bounds) {
  const ModelBody& body = model.bodies[b];
  if (body.kind == BodyKind::liquid) bound_liquid(model, b, bounds);
  if (body.kind == BodyKind::deformable) bound_deformable(model, b, bounds);
}

}  // namespace

StepBounds find_step_bounds(const Model& model) {
  StepBounds bounds;
  if (model.scene.numerics.control == StepControl::fixed) return bounds;
  bounds.own.resize(model.free_count);
  bounds.own_step.resize(model.free_count);
  for (std::size_t b = 0; b < model.bodies.size(); ++b) bound_body(model, b, bounds);
  bounds.scene_step = find_scene_step(model);
  return bounds;
}

StepBounds step_bounds_of_moved(const Model& model, std::size_t body, StepBounds bounds) {
  if (model.scene.numerics.control == StepControl::fixed) return bounds;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const bool is_liquid = model.bodies[b].kind == BodyKind::liquid;
    if (b == body || is_liquid) bound_body(model, b, bounds);
  }
  bounds.scene_step = find_scene_step(model);
  return bounds;
}

namespace {

/// The bounds that the present state implies.
struct PresentBounds {
  const Model& model;
  const State& state;
  const StepBounds& bounds;
  const GuardBounds& guard;

  /// Local control stores forces in parts.
  bool forces_known() const {
    return state.forces_current && model.scene.numerics.control != StepControl::local;
  }
  Real acceleration(Index i) const {
    return forces_known() ? model.inverse_mass[i] * state.forces.particle[i].norm() : 0;
  }
};

void limit_free_travel(const PresentBounds& present, TaskRunner* runner, std::vector<Real>& steps) {
  for_blocks(runner, present.model.free_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const auto i = static_cast<Index>(k);
      const Real way = kTravelShare * present.guard.travel[present.model.body[i]];
      const Real speed = present.state.now.velocity[i].norm();
      steps[i] = std::min({present.bounds.own_step[i], present.bounds.scene_step,
                           travel_time(way, speed, present.acceleration(i))});
    }
  });
}

void limit_rigid_travel(const PresentBounds& present, std::vector<Real>& steps) {
  for (std::size_t b = 0; b < present.model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = present.model.rigid_bodies[b];
    const RigidState& state = present.state.now.rigid[b];
    const Real turning = angular_velocity(rigid, state.orientation, state.angular_momentum).norm();
    const Real speed =
        rigid.inverse_mass * state.momentum.norm() + present.guard.extent[b] * turning;
    const Real acceleration = present.forces_known()
                                  ? rigid.inverse_mass * present.state.forces.rigid_force[b].norm()
                                  : 0;
    const Real way = kTravelShare * present.guard.travel[rigid.body];
    steps[b] = std::min({present.bounds.scene_step, wanted_step(present.model, rigid.body),
                         travel_time(way, speed, acceleration),
                         turning > 0 ? kGreatestTurn / turning : kInfinity});
  }
}

Vec3 mean_liquid_velocity(const PresentBounds& present, TaskRunner* runner,
                          std::vector<Vec3>& parts) {
  const Index count = present.model.liquid_count;
  parts.resize(block_count(count));
  for_blocks(runner, count, [&](std::size_t begin, std::size_t end) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = begin; i < end; ++i) sum += present.state.now.velocity[i];
    parts[begin / kBlockSize] = sum;
  });
  Vec3 total = Vec3::Zero();
  for (const Vec3& part : parts) total += part;
  return count > 0 ? Vec3(total / count) : total;
}

/// Returns the maximum squared speed relative to `mean` and the maximum acceleration.
std::array<Real, 2> greatest_motion(const PresentBounds& present, const IndexRange& particles,
                                    const Vec3& mean, TaskRunner* runner,
                                    std::vector<std::array<Real, 2>>& parts) {
  parts.resize(block_count(particles.size()));
  const auto join = [](std::array<Real, 2>& most, Real speed2, Real acceleration) {
    most = {std::max(most[0], speed2), std::max(most[1], acceleration)};
  };
  for_blocks(runner, particles.size(), [&](std::size_t begin, std::size_t end) {
    std::array<Real, 2> most{};
    for (std::size_t k = begin; k < end; ++k) {
      const Index i = particles.begin + static_cast<Index>(k);
      join(most, (present.state.now.velocity[i] - mean).squaredNorm(), present.acceleration(i));
    }
    parts[begin / kBlockSize] = most;
  });
  std::array<Real, 2> most{};
  for (const auto& [speed2, acceleration] : parts) join(most, speed2, acceleration);
  return most;
}

/// An acceleration of coupled liquids if the forces are not known.
Real unknown_acceleration(const PresentBounds& present) {
  const Scene& scene = present.model.scene;
  const bool is_local = scene.numerics.control == StepControl::local;
  return is_local && present.model.is_coupled && scene.forces.gravity ? scene.gravity.norm() : 0;
}

Real liquid_step(const PresentBounds& present, TaskRunner* runner, LiquidStepScratch& scratch) {
  const Vec3 mean = mean_liquid_velocity(present, runner, scratch.velocities);
  Real step = kInfinity;
  for (std::size_t b = 0; b < present.model.bodies.size(); ++b) {
    const ModelBody& body = present.model.bodies[b];
    if (body.kind != BodyKind::liquid) continue;
    const auto [speed2, acceleration] =
        greatest_motion(present, body.particles, mean, runner, scratch.motions);
    LiquidMotion motion;
    motion.speed = std::sqrt(speed2);
    motion.acceleration = std::max(unknown_acceleration(present), acceleration);
    if (present.model.is_incompressible) {
      const std::span<const Real> pressures = present.state.now.pressure;
      motion.pressure = lasting_pressure(
          pressures.subspan(body.particles.begin, body.particles.size()), scratch.pressures);
    }
    step = std::min(step, step_of_liquid(present.model, b, motion));
  }
  return step;
}

void limit_grabs(const ForceModel& f, PresentSteps& steps) {
  for (const Grab& grab : f.controls.grabs) {
    const Real step = safe_step(f.model.scene.numerics,
                                {grab.stiffness / grab.held_mass, grab.damping / grab.held_mass});
    const ModelBody& body = f.model.bodies[grab.body];
    if (body.kind == BodyKind::rigid) {
      steps.rigid[body.rigid] = std::min(steps.rigid[body.rigid], step);
      continue;
    }
    for (const Index held : grab.held) {
      Real& own = steps.particle[body.particles.begin + held];
      own = std::min(own, step);
    }
  }
}

/// The maximum distance by which two particles can approach each other in a step of `longest`,
/// limited to the travel of a step.
Real greatest_approach(const PresentBounds& present, Real longest) {
  Real greatest = 0;
  const auto take = [&](Index body, Real speed) {
    greatest =
        std::max(greatest, std::min(speed * longest, kTravelShare * present.guard.travel[body]));
  };
  const Real gained = present.model.scene.gravity.norm() * longest;
  for (Index i = 0; i < present.model.free_count; ++i) {
    take(present.model.body[i], present.state.now.velocity[i].norm() + gained);
  }
  for (std::size_t b = 0; b < present.model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = present.model.rigid_bodies[b];
    for (Index i = rigid.particles.begin; i < rigid.particles.end; ++i) {
      take(rigid.body, present.state.now.velocity[i].norm() + gained);
    }
  }
  return 2 * greatest;
}

}  // namespace

Real greatest_base_step(const ForceModel& f, const State& state, const StepBounds& bounds,
                        const GuardBounds& guard, LiquidStepScratch& scratch) {
  const Model& model = f.model;
  Real step = bounds.scene_step;
  if (model.is_coupled) {
    step = std::min(step, liquid_step({model, state, bounds, guard}, f.runner, scratch));
  }
  for (const Grab& grab : f.controls.grabs) {
    step = std::min(step, safe_step(model.scene.numerics, {grab.stiffness / grab.held_mass,
                                                           grab.damping / grab.held_mass}));
  }
  if (model.contact_reach <= 0) return step;
  Real speed2 = 0;
  for (const Vec3& velocity : state.now.velocity) speed2 = std::max(speed2, velocity.squaredNorm());
  const Real pull = model.scene.forces.gravity ? model.scene.gravity.norm() : 0;
  return std::min(step, travel_time(model.contact_reach / 2, std::sqrt(speed2), pull));
}

Real PresentSteps::least() const {
  Real least = liquid;
  for (const Real step : particle) least = std::min(least, step);
  for (const Real step : rigid) least = std::min(least, step);
  return least;
}

void find_present_steps(const ForceModel& f, State& state, Real time, Real longest,
                        const StepBounds& bounds, const GuardBounds& guard, PresentSteps& steps) {
  VAT_CHECK(longest > 0);
  ContactForceScratch& contact_buffers = f.work.of<ContactForceScratch>();
  const Model& model = f.model;
  StepContext context{model, f.controls, time, f.step, state.now, state.forces, f.work, f.runner};
  pose_rigid_bodies(context);
  const PresentBounds present{model, state, bounds, guard};
  steps.particle.resize(model.free_count);
  steps.rigid.resize(model.rigid_bodies.size());
  limit_free_travel(present, f.runner, steps.particle);
  limit_rigid_travel(present, steps.rigid);
  steps.liquid = liquid_step(present, f.runner, steps.liquid_scratch);
  limit_grabs(f, steps);
  const Real approach = model.contact_reach > 0 ? greatest_approach(present, longest) : 0;
  if (model.contact_reach > 0 && !contact_buffers.contacts.is_current(context, approach)) {
    if (model.liquid_count > 0) sort_liquid(context);
    contact_buffers.contacts.update(context, approach);
  }
  find_contact_steps(f, state.now, time, {longest, approach}, bounds, steps.contacts,
                     steps.particle, steps.rigid);
}

Real without_viscosity_solve(const Model& model, Real step) {
  if (!model.is_incompressible || !must_solve_own_damping(model, step)) return step;
  Real longest = step;
  for (const auto& [omega2, rate] : model.damping.own) {
    if (rate > 0) longest = std::min(longest, 2 / (rate + std::sqrt(rate * rate + omega2)));
  }
  constexpr Real kRounding = 1e-9;
  return longest > step / 2 ? (1 - kRounding) * longest : step;
}

Real limit_by_rate(const Model& model, Real step, Real observed_rate) {
  const Numerics& numerics = model.scene.numerics;
  if (observed_rate > 0) {
    step = std::min(step, resolving_phase_of_places(numerics) / observed_rate);
  }
  return without_viscosity_solve(model, std::min(step, numerics.step));
}

std::uint32_t level_of(Real step, Real nominal) {
  std::uint32_t level = 0;
  VAT_CHECK(nominal > 0);
  while (level < kMaxStepLevel && std::ldexp(nominal, -static_cast<int>(level)) > step) ++level;
  return level;
}

namespace {

std::uint32_t steps_of(Real step, Real left, Real nominal) {
  constexpr Real kRounding = 1e-9;
  if (!(step < left)) return 1;  // also for a NaN, which the guard detects
  const Real longest = std::max(step, std::ldexp(nominal, -kMaxStepLevel));
  return static_cast<std::uint32_t>(std::ceil(left / longest * (1 - kRounding)));
}

}  // namespace

std::uint32_t choose_step_count(Real wanted, Real left, Real nominal, StepHistory& history) {
  const std::uint32_t needed = steps_of(wanted, left, nominal);
  VAT_CHECK(left > 0 && nominal > 0);
  std::uint32_t count = history.step > 0 ? steps_of(history.step, left, nominal) : needed;
  if (needed > count) {
    count = needed;
    history.held = 0;
  } else if (needed < count && history.held >= kHeldSteps) {
    count = std::max(needed, (count + 1) / 2);
    history.held = 0;
  }
  history.step = left / count;
  return count;
}

}  // namespace vat
