#include "protocol/tune/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/numerics/error_model.h"
#include "core/numerics/step_limits.h"
#include "core/validation/validate.h"

namespace vat::tune {
namespace {

constexpr std::array kIntegrators{IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
                                  IntegratorId::runge_kutta_4};
constexpr std::array kVariableControls{StepControl::adaptive, StepControl::local};
constexpr std::array<Real, 5> kFixedShares{1, 0.7071, 0.5, 0.3536, 0.25};
constexpr std::array<Real, 2> kVariableShares{2, 1};  // of the longest fixed step
constexpr std::array<Real, 4> kTolerances{0.1, 0.03, 0.01, 0.003};
constexpr Real kFineShare = 1.0 / 12;  // a third of the shortest fixed step
constexpr Real kCoarseShare = 1.0 / 8;
constexpr Real kReferenceVolumeTolerance = 1e-5;  // catalogue: the density error is then 10^-5
// Density and divergence tolerances. Above 1 %, the time does not decrease (core/ACCURACY.md).
constexpr std::array<std::array<Real, 2>, 4> kVolumeTolerances{
    {{5e-4, 1e-5}, {1e-3, 1e-4}, {3e-3, 1e-3}, {1e-2, 1e-2}}};
constexpr Real kRungeKuttaStages = 4;
constexpr Real kSolvedStep = 4;  // cost of an incompressible step; 2 to 11 (core/ACCURACY.md)

bool has_solid_in(const Scene& scene) {
  return std::ranges::any_of(
      scene.bodies, [](const BodyDescription& body) { return body.kind != BodyKind::liquid; });
}

bool has_liquid_in(const Scene& scene) {
  return std::ranges::any_of(scene.bodies, [](const BodyDescription& body) {
    return body.kind == BodyKind::liquid || body.melting;
  });
}

/// Returns the longest whole part of the tick that is at most `step`.
Real part_of_tick(Real tick, Real step) {
  constexpr Real kRounding = 1e-9;
  const Real least = std::max(Real(1), tick / kMaxStep);
  const Real count = std::max(std::ceil(tick / step * (1 - kRounding)), std::ceil(least));
  return tick / std::min(count, static_cast<Real>(kMaxStepsPerTick));
}

/// Combinations of one solver with one integrator.
class Method {
 public:
  Method(Scene scene, IntegratorId integrator, const std::vector<SampledBody>& samples,
         Real trusted_step)
      : scene_(std::move(scene)), tick_(scene_.numerics.tick) {
    scene_.numerics.integrator = integrator;
    scene_.numerics.control = StepControl::fixed;
    Real limit = tick_;
    for (const StepLimit& step_limit : find_step_limits(scene_, samples)) {
      limit = std::min(limit, step_limit.step);
    }
    longest_ = std::min(tick_, std::max(limit, trusted_step));
  }

  /// Returns 0 if no step is stable.
  Real longest() const { return longest_; }

  Candidate with(StepControl control, Real step, Real tolerance) const {
    Candidate candidate = candidate_of(scene_);
    candidate.numerics.control = control;
    candidate.numerics.step = part_of_tick(tick_, step);
    candidate.numerics.tolerance = tolerance;
    return candidate;
  }

  bool is_valid(StepControl control) const {
    return longest_ > 0 &&
           find_errors(with_candidate(scene_, with(control, longest_, kTolerances.front())))
               .empty();
  }

  void append_all(std::vector<Candidate>& all) const {
    if (is_valid(StepControl::fixed)) {
      for (const Real share : kFixedShares) {
        all.push_back(with(StepControl::fixed, share * longest_, scene_.numerics.tolerance));
      }
    }
    for (const StepControl control : kVariableControls) {
      if (!is_valid(control)) continue;
      for (const Real share : kVariableShares) {
        for (const Real tolerance : kTolerances) {
          all.push_back(with(control, share * longest_, tolerance));
        }
      }
    }
  }

 private:
  Scene scene_;
  Real tick_;
  Real longest_ = 0;
};

/// `has_contacts`: whether solids can have contacts, whose steps depend on the tolerance.
bool uses_tolerance(const Numerics& numerics, bool has_contacts) {
  const bool is_fixed = numerics.control == StepControl::fixed;
  return !is_fixed && (has_contacts || estimates_errors(numerics));
}

bool are_equal(const Candidate& a, const Candidate& b, bool has_contacts) {
  const bool same_tolerance =
      !uses_tolerance(a.numerics, has_contacts) || a.numerics.tolerance == b.numerics.tolerance;
  const bool same_solve =
      a.pressure_solver != PressureSolver::incompressible ||
      (a.incompressible.density_tolerance == b.incompressible.density_tolerance &&
       a.incompressible.divergence_tolerance == b.incompressible.divergence_tolerance);
  return a.pressure_solver == b.pressure_solver && same_solve && same_tolerance &&
         a.numerics.integrator == b.numerics.integrator &&
         a.numerics.control == b.numerics.control && a.numerics.step == b.numerics.step;
}

std::vector<Scene> solver_variants(const Scene& scene, bool has_liquid) {
  std::vector<Scene> variants{scene};
  if (!has_liquid || scene.pressure_solver == PressureSolver::gas) return variants;
  Scene other = scene;
  other.pressure_solver = scene.pressure_solver == PressureSolver::tait
                              ? PressureSolver::incompressible
                              : PressureSolver::tait;
  variants.push_back(other);
  std::vector<Scene> all;
  for (const Scene& variant : variants) {
    all.push_back(variant);
    if (variant.pressure_solver != PressureSolver::incompressible) continue;
    for (const auto& [density, divergence] : kVolumeTolerances) {
      all.push_back(variant);
      all.back().incompressible.density_tolerance = density;
      all.back().incompressible.divergence_tolerance = divergence;
    }
  }
  return all;
}

/// Returns the step of the scene if it is fixed, and otherwise 0: the longest step of variable
/// control is no stable fixed step.
Real trusted_step_of(const Scene& scene) {
  return scene.numerics.control == StepControl::fixed ? scene.numerics.step : 0;
}

/// Sets the numerics of the references, from the scene's own method: velocity Verlet if the
/// scene supports it, and otherwise the scene's integrator.
void set_references(const Scene& own, const std::vector<SampledBody>& samples, CandidateSet& set) {
  Scene tight = own;
  tight.incompressible.density_tolerance =
      std::min(own.incompressible.density_tolerance, kReferenceVolumeTolerance);
  tight.incompressible.divergence_tolerance =
      std::min(own.incompressible.divergence_tolerance, kReferenceVolumeTolerance);
  const Real trusted_step = trusted_step_of(own);
  Method method(tight, IntegratorId::velocity_verlet, samples, trusted_step);
  if (!method.is_valid(StepControl::fixed)) {
    method = Method(tight, own.numerics.integrator, samples, trusted_step);
  }
  const Real tolerance = own.numerics.tolerance;
  set.fine = method.with(StepControl::fixed, kFineShare * method.longest(), tolerance);
  set.coarse = method.with(StepControl::fixed, kCoarseShare * method.longest(), tolerance);
}

}  // namespace

Candidate candidate_of(const Scene& scene) {
  if (!scene.numerics.accuracy) {
    return {scene.pressure_solver, scene.incompressible, scene.numerics};
  }
  Scene resolved = scene;
  resolve_accuracy(resolved);
  resolved.numerics.accuracy.reset();
  return {resolved.pressure_solver, resolved.incompressible, resolved.numerics};
}

Scene with_candidate(Scene scene, const Candidate& candidate) {
  scene.pressure_solver = candidate.pressure_solver;
  scene.incompressible = candidate.incompressible;
  scene.numerics = candidate.numerics;
  return scene;
}

bool can_change(const Candidate& a, const Candidate& b, const Scene& scene) {
  return a.pressure_solver == b.pressure_solver &&
         (scene.emitters.empty() || a.numerics.step == b.numerics.step);
}

NumericsChange change_to(const Candidate& candidate, bool has_liquid) {
  const Numerics& numerics = candidate.numerics;
  NumericsChange change{
      .integrator = numerics.integrator, .step = numerics.step, .control = numerics.control};
  if (numerics.control != StepControl::fixed) change.tolerance = numerics.tolerance;
  if (has_liquid && candidate.pressure_solver == PressureSolver::incompressible) {
    change.density_tolerance = candidate.incompressible.density_tolerance;
    change.divergence_tolerance = candidate.incompressible.divergence_tolerance;
  }
  return change;
}

std::string describe(const Candidate& candidate, bool has_liquid) {
  constexpr Real kMilliseconds = 1e3;
  constexpr int kDigits = 4;
  std::ostringstream text;
  text.precision(kDigits);
  const Numerics& numerics = candidate.numerics;
  if (has_liquid) text << to_string(candidate.pressure_solver) << ", ";
  if (has_liquid && candidate.pressure_solver == PressureSolver::incompressible) {
    text << candidate.incompressible.density_tolerance << " / "
         << candidate.incompressible.divergence_tolerance << ", ";
  }
  text << to_string(numerics.integrator) << ", " << to_string(numerics.control);
  if (numerics.control != StepControl::fixed) text << ' ' << numerics.tolerance;
  text << ", " << kMilliseconds * numerics.step << " ms";
  return text.str();
}

Real expected_work(const Candidate& candidate) {
  Real work = 1 / candidate.numerics.step;
  if (candidate.numerics.integrator == IntegratorId::runge_kutta_4) work *= kRungeKuttaStages;
  if (candidate.pressure_solver == PressureSolver::incompressible) work *= kSolvedStep;
  return work;
}

CandidateSet find_candidates(const Scene& scene) {
  CandidateSet set;
  const Candidate own = candidate_of(scene);
  const Scene resolved = with_candidate(scene, own);
  set.has_liquid = has_liquid_in(scene);
  const std::vector<SampledBody> samples = sample_bodies(scene);
  set_references(resolved, samples, set);
  std::vector<Candidate> all{own};
  for (const Scene& variant : solver_variants(resolved, set.has_liquid)) {
    const bool is_own = variant.pressure_solver == scene.pressure_solver;
    const Real trusted_step = is_own ? trusted_step_of(resolved) : 0;
    for (const IntegratorId integrator : kIntegrators) {
      Method(variant, integrator, samples, trusted_step).append_all(all);
    }
  }
  const bool has_contacts = has_solid_in(scene);
  for (const Candidate& candidate : all) {
    const auto is_same = [&](const Candidate& other) {
      return are_equal(other, candidate, has_contacts);
    };
    if (std::ranges::none_of(set.candidates, is_same)) set.candidates.push_back(candidate);
  }
  std::ranges::stable_sort(set.candidates, {}, expected_work);
  const auto is_own = [&](const Candidate& candidate) {
    return are_equal(candidate, own, has_contacts);
  };
  set.own = static_cast<std::size_t>(std::ranges::find_if(set.candidates, is_own) -
                                     set.candidates.begin());
  return set;
}

}  // namespace vat::tune
