#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/bench/accuracy/accuracy_report.h"
#include "tests/bench/accuracy/control_report.h"
#include "tests/bench/accuracy/law_report.h"
#include "tests/bench/report/plot.h"
#include "tests/cli/program.h"

namespace vat::bench::bench_accuracy_test {
namespace {

constexpr Method kVerlet{IntegratorId::velocity_verlet, StepControl::fixed};
constexpr Method kHeun{IntegratorId::heun, StepControl::adaptive};

Solution solution(const Method& method, Real step, Real error, Real evaluations, double seconds) {
  return {.method = method,
          .step = step,
          .error = error,
          .seconds = seconds,
          .evaluations_per_particle = evaluations,
          .failure = {}};
}

std::vector<Solution> some_solutions() {
  Solution failed = solution(kVerlet, 1, std::numeric_limits<Real>::quiet_NaN(), 0, 0);
  failed.failure = "the guard undid a step";
  return {failed,
          solution(kVerlet, 0.5, 1e-3, 10, 5),  // low error by chance
          solution(kVerlet, 0.25, 1e-2, 20, 9),
          solution(kVerlet, 0.125, 1e-4, 40, 18),
          solution(kHeun, 0.5, 1e-2, 30, 4),
          solution(kHeun, 0.25, 1e-3, 60, 30)};
}

std::vector<Real> steps_of(const std::vector<Solution>& solutions) {
  std::vector<Real> steps;
  for (const Solution& one : solutions) steps.push_back(one.step);
  return steps;
}

TEST(BenchAccuracy, FrontHasTheUnbeatenRuns) {
  const auto by_count = pareto_front(some_solutions(), evaluations_of);
  EXPECT_THAT(steps_of(by_count), testing::ElementsAre(0.5, 0.125));
  const auto by_time = pareto_front(some_solutions(), seconds_of);
  EXPECT_THAT(steps_of(by_time), testing::ElementsAre(0.5, 0.5, 0.125));
}

TEST(BenchAccuracy, CheapestDoesNotTrustLuck) {
  const auto rough = cheapest(some_solutions(), 1e-2, evaluations_of);
  ASSERT_TRUE(rough);
  EXPECT_EQ(rough->step, 0.5);
  const auto finer = cheapest(some_solutions(), 1e-3, evaluations_of);
  ASSERT_TRUE(finer);
  EXPECT_EQ(finer->step, 0.125);
  EXPECT_EQ(cheapest(some_solutions(), 1e-2, seconds_of)->method.integrator, IntegratorId::heun);
  EXPECT_FALSE(cheapest(some_solutions(), 1e-5, evaluations_of));
}

// Interpolated between 20 evaluations at 1e-2 and 40 at 1e-4. The error at 10 evaluations is low by
// chance.
TEST(BenchAccuracy, PriceIsReadBetweenSolutions) {
  const auto price = [](StepControl control, Real error) {
    return least_price(some_solutions(), control, error, evaluations_of);
  };
  EXPECT_NEAR(price(StepControl::fixed, 1e-3)->cost, 20 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(price(StepControl::fixed, 1e-2)->cost, 10);
  EXPECT_EQ(price(StepControl::fixed, 1e-2)->method.integrator, IntegratorId::velocity_verlet);
  EXPECT_EQ(price(StepControl::adaptive, 1e-3)->cost, 60);
  EXPECT_FALSE(price(StepControl::fixed, 1e-5));
  EXPECT_FALSE(price(StepControl::local, 1));
}

TEST(BenchAccuracy, VariedStepsAreComparedWithFixedOnes) {
  const Table table = control_table({{"X", "t", "e", some_solutions()}});
  ASSERT_EQ(table.rows.size(), kTargetErrors.size());
  EXPECT_EQ(to_csv({table.columns, {table.rows[1]}}),
            "case,error at most,best fixed,its evaluations per particle,best adaptive,"
            "evaluations / fixed,time / fixed,local: evaluations / fixed,local: time / fixed\n"
            "X,0.01,velocity_verlet,10,heun,3,0.8,,\n");
}

TEST(BenchAccuracy, PlotHasTheFrontAndEveryMethodThatWorked) {
  const LogPlot plot = error_against_evaluations({"X", "t", "e", some_solutions()});
  ASSERT_EQ(plot.series.size(), 3u);
  EXPECT_TRUE(plot.series[0].broad);
  EXPECT_EQ(plot.series[1].label, "velocity_verlet, fixed");
  EXPECT_EQ(plot.series[1].points.size(), 3u);
  EXPECT_EQ(plot.series[2].label, "heun, adaptive");
}

TEST(BenchAccuracy, LawsStandBesideEachOther) {
  const std::vector<ProblemResult> results = {{"X", "t", "e", some_solutions()},
                                              {"Y-implicit", "t", "e", some_solutions()},
                                              {"X-projection", "t", "e", some_solutions()}};
  const std::vector<LawPair> pairs = pairs_of_laws(results);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].first, &results[0]);
  EXPECT_EQ(pairs[0].second, &results[2]);
  const Table table = laws_table(pairs);
  ASSERT_EQ(table.rows.size(), 2 * kTargetErrors.size());
  EXPECT_EQ(to_csv({table.columns, {table.rows[1], table.rows[kTargetErrors.size() + 2]}}),
            "problem,law,error at most,least time,step [s],evaluations per particle,seconds\n"
            "X,penalties,0.01,\"heun, adaptive\",0.5,30,4\n"
            "X,projection,0.001,\"velocity_verlet, fixed\",0.125,40,18\n");
  const LogPlot plot = laws_plot(pairs[0]);
  ASSERT_EQ(plot.series.size(), 2u);
  EXPECT_EQ(plot.series[1].label, "projection");
  EXPECT_EQ(plot.series[1].points.size(), 3u);
}

TEST(BenchAccuracy, RowsAreTheSameButForTheSeconds) {
  const auto entry = std::ranges::find(all_problems(), "RIG-5", &ProblemEntry::name);
  ASSERT_NE(entry, all_problems().end());
  const Problem problem = entry->make(nullptr);
  const SweepSettings settings{.repetitions = 1, .stride = 4};
  const auto table = [&] {
    Table result = solutions_table({{entry->name, problem.title, problem.error_name,
                                     sweep(problem, kHeun, settings, nullptr)}});
    for (std::vector<Cell>& row : result.rows) row.at(6) = 0.0;
    return result;
  };
  const Table first = table();
  ASSERT_EQ(first.columns[6], "seconds");
  ASSERT_EQ(first.rows.size(), 3u);
  EXPECT_EQ(to_csv(first), to_csv(table()));
}

TEST(BenchAccuracy, CommandWritesTablesAndPlots) {
  ASSERT_TRUE(find_gnuplot());
  const test::TemporaryFolder folder;
  const test::ProgramResult result = test::run_bench(
      {"accuracy", "--quick", "--case", "RIG-5", "--output", folder.path().string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"accuracy.csv", "accuracy.json", "accuracy.md", "cheapest.md",
                           "RIG-5-time.svg", "RIG-5-evaluations.svg", "RIG-5-time.dat"}) {
    EXPECT_THAT(folder.names(), testing::Contains(name));
  }
}

}  // namespace
}  // namespace vat::bench::bench_accuracy_test
