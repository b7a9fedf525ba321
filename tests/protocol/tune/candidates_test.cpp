#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/numerics/choose_numerics.h"
#include "core/validation/validate.h"
#include "protocol/scene/scene_json.h"
#include "protocol/tune/candidates.h"

namespace vat::candidates_test {
namespace {

using tune::Candidate;
using tune::CandidateSet;
using tune::find_candidates;

Scene catalogue_scene(const std::string& name) {
  return read_scene_file(VAT_SOURCE_DIR "/protocol/scenes/" + name + ".json").value();
}

std::set<PressureSolver> solvers_of(const CandidateSet& set) {
  std::set<PressureSolver> solvers;
  for (const Candidate& candidate : set.candidates) solvers.insert(candidate.pressure_solver);
  return solvers;
}

std::set<IntegratorId> integrators_of(const CandidateSet& set) {
  std::set<IntegratorId> integrators;
  for (const Candidate& candidate : set.candidates) {
    integrators.insert(candidate.numerics.integrator);
  }
  return integrators;
}

class Candidates : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, Candidates,
                         testing::Values("dam-break", "deep-tank", "brick-wall", "hammock", "pour",
                                         "melting"));

TEST_P(Candidates, AreValidAndIncludeTheScene) {
  const Scene scene = catalogue_scene(GetParam());
  const CandidateSet set = find_candidates(scene);
  EXPECT_GT(set.candidates.size(), 8u);
  for (const Candidate& candidate : set.candidates) {
    const Errors errors = find_errors(with_candidate(scene, candidate));
    EXPECT_TRUE(errors.empty()) << describe(candidate, true) << errors.front().message;
    EXPECT_EQ(candidate.numerics.tick, scene.numerics.tick);
    EXPECT_LT(set.fine.numerics.step, candidate.numerics.step);
    EXPECT_LT(set.coarse.numerics.step, candidate.numerics.step);
  }
  ASSERT_LT(set.own, set.candidates.size());
  const Candidate& own = set.candidates[set.own];
  EXPECT_EQ(own.numerics.step, scene.numerics.step);
  EXPECT_EQ(own.numerics.integrator, scene.numerics.integrator);
  EXPECT_EQ(own.pressure_solver, scene.pressure_solver);
  EXPECT_TRUE(std::ranges::is_sorted(set.candidates, {}, tune::expected_work));
  std::set<std::string> texts;
  for (const Candidate& candidate : set.candidates) texts.insert(describe(candidate, true));
  EXPECT_EQ(texts.size(), set.candidates.size());
}

TEST(Candidates, LiquidsHaveBothSolvers) {
  EXPECT_EQ(solvers_of(find_candidates(catalogue_scene("dam-break"))),
            (std::set{PressureSolver::tait, PressureSolver::incompressible}));
  Scene gas = catalogue_scene("dam-break");
  gas.pressure_solver = PressureSolver::gas;
  gas.materials[0].liquid->stiffness = 50;
  EXPECT_EQ(solvers_of(find_candidates(gas)), std::set{PressureSolver::gas});
  const CandidateSet solids = find_candidates(catalogue_scene("rigid-stack"));
  EXPECT_FALSE(solids.has_liquid);
  EXPECT_EQ(solvers_of(solids).size(), 1u);
}

TEST(Candidates, MethodsThatTheSceneDoesNotSupportAreAbsent) {
  // Projected contacts support neither Runge-Kutta 4 nor local steps.
  const CandidateSet set = find_candidates(catalogue_scene("brick-wall"));
  EXPECT_EQ(integrators_of(set),
            (std::set{IntegratorId::symplectic_euler, IntegratorId::velocity_verlet}));
  for (const Candidate& candidate : set.candidates) {
    EXPECT_NE(candidate.numerics.control, StepControl::local);
  }
  EXPECT_EQ(integrators_of(find_candidates(catalogue_scene("rigid-stack"))).size(), 3u);
}

// Without solids, only adaptive velocity Verlet and Runge-Kutta 4 depend on the tolerance.
TEST(Candidates, AToleranceWithoutEffectMakesNoSecondCandidate) {
  const CandidateSet set = find_candidates(catalogue_scene("dam-break"));
  std::map<std::string, std::set<Real>> tolerances;
  for (Candidate candidate : set.candidates) {
    if (candidate.numerics.control == StepControl::fixed) continue;
    const Real tolerance = std::exchange(candidate.numerics.tolerance, 1);
    tolerances[describe(candidate, true)].insert(tolerance);
  }
  std::set<std::size_t> counts;
  for (const auto& [numerics, values] : tolerances) {
    const bool is_estimated = numerics.find("adaptive") != std::string::npos &&
                              numerics.find("symplectic") == std::string::npos;
    EXPECT_EQ(values.size(), is_estimated ? 4 : 1) << numerics;
    counts.insert(values.size());
  }
  EXPECT_EQ(counts, (std::set<std::size_t>{1, 4}));
}

// The drop is unstable with fixed steps of 4 ms.
TEST(Candidates, TheLongestStepOfVariableControlIsNoFixedStep) {
  Scene scene = catalogue_scene("deformable-drop");
  scene.numerics.control = StepControl::adaptive;
  scene.numerics.step = 0.01;
  const CandidateSet set = find_candidates(scene);
  for (const Candidate& candidate : set.candidates) {
    if (candidate.numerics.control == StepControl::fixed) {
      EXPECT_LT(candidate.numerics.step, 4e-3);
    }
  }
  EXPECT_LT(set.coarse.numerics.step, 4e-3 / 8);
}

TEST(Candidates, AccuracyIsResolved) {
  Scene scene = catalogue_scene("dam-break");
  scene.numerics.accuracy = 0.01;
  const CandidateSet set = find_candidates(scene);
  Scene resolved = scene;
  resolve_accuracy(resolved);
  const Candidate& own = set.candidates[set.own];
  EXPECT_FALSE(own.numerics.accuracy);
  EXPECT_EQ(own.numerics.control, resolved.numerics.control);
  EXPECT_EQ(own.numerics.step, resolved.numerics.step);
}

TEST(Candidates, TextsNameTheNumerics) {
  Candidate candidate;
  candidate.numerics.step = 0.0025;
  EXPECT_EQ(describe(candidate, false), "velocity_verlet, fixed, 2.5 ms");
  candidate.numerics.control = StepControl::adaptive;
  candidate.pressure_solver = PressureSolver::incompressible;
  EXPECT_EQ(describe(candidate, true),
            "incompressible, 0.0005 / 1e-05, velocity_verlet, adaptive 0.01, 2.5 ms");
}

TEST(CandidateChanges, RunningSessionsKeepTheSolver) {
  const Scene scene = catalogue_scene("dam-break");
  const Scene flowing = catalogue_scene("pour");
  const Candidate own = tune::candidate_of(scene);
  Candidate other = own;
  other.numerics.integrator = IntegratorId::runge_kutta_4;
  other.numerics.control = StepControl::adaptive;
  EXPECT_TRUE(can_change(own, other, scene));
  EXPECT_TRUE(can_change(own, other, flowing));
  other.numerics.step = own.numerics.step / 2;
  EXPECT_TRUE(can_change(own, other, scene));
  EXPECT_FALSE(can_change(own, other, flowing)) << "the scene has an emitter";
  Candidate solved = own;
  solved.pressure_solver = own.pressure_solver == PressureSolver::tait
                               ? PressureSolver::incompressible
                               : PressureSolver::tait;
  EXPECT_FALSE(can_change(own, solved, scene));
}

TEST(CandidateChanges, LeadToTheCandidate) {
  const Scene scene = catalogue_scene("dam-break");
  for (const Candidate& candidate : find_candidates(scene).candidates) {
    Scene solved = scene;
    solved.pressure_solver = candidate.pressure_solver;
    const Scene changed = with_change(solved, change_to(candidate, true));
    EXPECT_EQ(describe(tune::candidate_of(changed), true), describe(candidate, true));
    EXPECT_TRUE(has_numerics(changed, change_to(candidate, true)));
  }
}

}  // namespace
}  // namespace vat::candidates_test
