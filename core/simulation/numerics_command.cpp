// The command that changes the numerics of a simulation.

#include <cmath>

#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/validation/validate.h"

namespace vat {
namespace {

/// The reason why the step length cannot change now; empty if it can.
std::optional<std::string> refuse_other_step(const Scene& scene, bool is_between_ticks) {
  if (!scene.emitters.empty()) return "must stay, because the emitters of the scene depend on it";
  if (!is_between_ticks) return "can change at the end of a tick only";
  return {};
}

/// Converts the rest of a force to whole steps of the new length, with the same impulse.
AppliedForce in_steps(AppliedForce applied, std::uint64_t step, std::uint64_t new_step,
                      Real new_per_old) {
  const Real left = static_cast<Real>(applied.end_step - step) * new_per_old;
  const Real steps = std::ceil(left - 1e-6);  // rounding must not add a step
  applied.acceleration *= left / steps;
  applied.end_step = new_step + static_cast<std::uint64_t>(steps);
  return applied;
}

/// Names the integrator or the control, whichever changes, in errors of their combination and of
/// other parts of the scene.
Errors find_change_errors(const Scene& scene, const NumericsChange& change) {
  Errors errors = find_numerics_errors(scene);
  for (Error& error : errors) {
    if (error.path == "/integrator" && !change.integrator && change.control) {
      error.path = "/control";
    } else if (error.path == "/control" && !change.control) {
      error.path = "/integrator";
    }
  }
  return errors;
}

}  // namespace

Scene with_change(Scene scene, const NumericsChange& change) {
  Numerics& numerics = scene.numerics;
  IncompressibleSolve& solve = scene.incompressible;
  numerics.integrator = change.integrator.value_or(numerics.integrator);
  numerics.step = change.step.value_or(numerics.step);
  numerics.control = change.control.value_or(numerics.control);
  numerics.tolerance = change.tolerance.value_or(numerics.tolerance);
  numerics.accuracy.reset();  // the numerics are resolved
  solve.density_tolerance = change.density_tolerance.value_or(solve.density_tolerance);
  solve.divergence_tolerance = change.divergence_tolerance.value_or(solve.divergence_tolerance);
  return scene;
}

bool has_numerics(const Scene& scene, const NumericsChange& numerics) {
  const auto is = [](const auto& wanted, const auto& present) {
    return !wanted || *wanted == present;
  };
  const auto steps_of = [&](Real step) { return std::llround(scene.numerics.tick / step); };
  const bool has_step = !numerics.step || steps_of(*numerics.step) == steps_of(scene.numerics.step);
  return has_step && is(numerics.integrator, scene.numerics.integrator) &&
         is(numerics.control, scene.numerics.control) &&
         is(numerics.tolerance, scene.numerics.tolerance) &&
         is(numerics.density_tolerance, scene.incompressible.density_tolerance) &&
         is(numerics.divergence_tolerance, scene.incompressible.divergence_tolerance);
}

Status HostInterface::set_numerics(IntegratorId integrator, Real step) {
  return set_numerics({.integrator = integrator, .step = step});
}

Status HostInterface::set_numerics(const NumericsChange& change) {
  const Scene& present = impl_->all().scene;
  const Numerics before = present.numerics;
  Scene scene = with_change(present, change);
  const Real step = scene.numerics.step;
  const std::uint32_t old_steps = impl_->steps_per_tick();
  if (Errors errors = find_change_errors(scene, change); !errors.empty()) return errors;
  if (has_numerics(present, change) && step == before.step) return {};
  const bool is_between_ticks = impl_->state.step_count % old_steps == 0;
  if (const auto reason = refuse_other_step(scene, is_between_ticks);
      reason && step != before.step) {
    return Error{"not_allowed", "/step", *reason};
  }
  impl_->wake_all();
  impl_->recompile(std::move(scene), impl_->ids());
  if (step != before.step) {
    const std::uint64_t count = impl_->state.step_count;
    const std::uint32_t new_steps = impl_->steps_per_tick();
    impl_->state.step_count = count / old_steps * new_steps;
    const Real new_per_old = static_cast<Real>(new_steps) / static_cast<Real>(old_steps);
    for (AppliedForce& applied : impl_->controls.applied_forces) {
      applied = in_steps(applied, count, impl_->state.step_count, new_per_old);
    }
    impl_->tune_grabs();
  }
  impl_->pose_rigid_particles();
  return {};
}

}  // namespace vat
