#include "core/liquid/incompressible/complementarity.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/support/thread_runner.h"

namespace vat::test::complementarity_test {
namespace {

/// A = B^T B with few entries per row of B, similar to particles with few neighbours.
class Problem {
 public:
  Problem(std::size_t count, unsigned seed) : count_(count), matrix_(count * count, 0) {
    std::mt19937 generator(seed);
    const auto next = [&] { return static_cast<Real>(generator()) / 4294967295.0 - 0.5; };
    std::vector<Real> b(count * count, 0);
    for (std::size_t row = 0; row < count; ++row) {
      for (std::size_t k = 0; k < 6; ++k) b[row * count + (row + k * k) % count] = next();
    }
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t k = 0; k < count; ++k) {
          matrix_[i * count + j] += b[k * count + i] * b[k * count + j];
        }
      }
      matrix_[i * count + i] += 0.01;
      excess_.push_back(next());
    }
  }

  void multiply(const std::vector<Real>& d, std::vector<Real>& product) const {
    for (std::size_t i = 0; i < count_; ++i) {
      product[i] = 0;
      for (std::size_t j = 0; j < count_; ++j) product[i] += matrix_[i * count_ + j] * d[j];
    }
  }

  Complementarity start() const {
    Complementarity problem;
    problem.resize(count_);
    problem.excess = excess_;
    for (std::size_t i = 0; i < count_; ++i) {
      problem.x[i] = 0;
      problem.diagonal[i] = matrix_[i * count_ + i];
      problem.scale[i] = 1;
    }
    return problem;
  }
  SolveReport solve(Complementarity& problem, const SolveLimits& limits,
                    TaskRunner* runner = nullptr) const {
    System system{*this, {}, std::vector<Real>(count_)};
    const SolveReport report = problem.solve(limits, runner, system);
    whole_ = system.whole;
    products_ = system.products;
    return report;
  }
  /// Returns the number of products that the solver has read.
  int products() const { return products_; }
  /// Returns the sum of all steps that the solver applied.
  const std::vector<Real>& whole() const { return whole_; }
  /// Computes the excess anew, not incrementally as the solver does.
  std::vector<Real> excess_at(const std::vector<Real>& x) const {
    std::vector<Real> excess = excess_;
    std::vector<Real> product(count_);
    multiply(x, product);
    for (std::size_t i = 0; i < count_; ++i) excess[i] -= product[i];
    return excess;
  }

 private:
  struct System {
    const Problem& problem;
    std::vector<Real> last;
    std::vector<Real> whole;
    int products = 0;

    Real act(const std::vector<Real>& d) {
      last = d;
      std::vector<Real> product(d.size());
      problem.multiply(d, product);
      Real curvature = 0;
      for (std::size_t i = 0; i < d.size(); ++i) curvature += d[i] * product[i];
      return curvature;
    }
    void find_product(std::vector<Real>& product) {
      problem.multiply(last, product);
      ++products;
    }
    void add(Real share) {
      for (std::size_t i = 0; i < last.size(); ++i) whole[i] += share * last[i];
    }
  };

  std::size_t count_;
  std::vector<Real> matrix_;
  std::vector<Real> excess_;
  mutable std::vector<Real> whole_;
  mutable int products_ = 0;
};

constexpr SolveLimits kClose{1e-10, 1e-9, 10000};

TEST(Complementarity, IsSolvedFromAnyStart) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Problem given(60, seed);
    for (const Real start : {0.0, 3.0}) {
      Complementarity problem = given.start();
      std::ranges::fill(problem.x, start);
      problem.excess = given.excess_at(problem.x);
      const SolveReport report = given.solve(problem, kClose);
      EXPECT_LT(report.iterations, kClose.most_iterations);
      const std::vector<Real> excess = given.excess_at(problem.x);
      std::size_t above = 0;
      for (std::size_t i = 0; i < excess.size(); ++i) {
        EXPECT_GE(problem.x[i], 0);
        EXPECT_LT(excess[i], 2e-9);
        EXPECT_LT(std::min(problem.x[i], -excess[i]), 2e-9);
        above += problem.x[i] > 1e-6 ? 1 : 0;
      }
      EXPECT_GT(above, 5U);
      EXPECT_LT(above, 55U);
    }
  }
}

TEST(Complementarity, TotalEffectIsThatOfTheChange) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Problem given(60, seed);
    Complementarity problem = given.start();
    std::ranges::fill(problem.x, 0.5);
    problem.excess = given.excess_at(problem.x);
    ASSERT_GT(given.solve(problem, {1e-3, 1e-2, 1000}).iterations, 0);
    const std::vector<Real> excess = given.excess_at(problem.x);
    for (std::size_t i = 0; i < problem.x.size(); ++i) {
      EXPECT_GE(problem.x[i], 0);
      EXPECT_NEAR(0.5 + given.whole()[i], problem.x[i], 1e-14);
      EXPECT_NEAR(excess[i], problem.excess[i], 1e-12);
    }
    EXPECT_LT(std::ranges::min(problem.x), 0.01);
  }
}

TEST(Complementarity, TakesNoIterationIfItIsSolved) {
  const Problem given(60, 1);
  Complementarity problem = given.start();
  given.solve(problem, kClose);
  const std::vector<Real> x = problem.x;
  EXPECT_EQ(given.solve(problem, kClose).iterations, 0);
  EXPECT_EQ(problem.x, x);
}

// The limits are met by the expected residuals of the first iteration, of the second, or not.
TEST(Complementarity, ComputesNoResidualsOfAnIterationThatIsExpectedToBeTheLast) {
  const Problem given(60, 5);
  Complementarity measured = given.start();
  const SolveReport start = given.solve(measured, {0, 0, 0});
  for (const int last : {1, 2}) {
    Complementarity problem = given.start();
    SolveReport before = start;
    if (last == 2) before = given.solve(problem, {0, 0, 1});
    problem = given.start();
    SolveLimits limits{before.mean / 4, before.greatest / 4, 3};
    limits.first_reduction = last == 1 ? 0.25 : 1e3;
    limits.later_reduction = 0.25;
    const SolveReport report = given.solve(problem, limits);
    EXPECT_EQ(report.iterations, last);
    EXPECT_EQ(given.products(), last - 1);
    EXPECT_EQ(report.mean, before.mean / 4);
    EXPECT_EQ(report.greatest, before.greatest / 4);
    const std::vector<Real> whole = given.whole();
    EXPECT_EQ(given.solve(measured = given.start(), {0, 0, last}).iterations, last);
    EXPECT_EQ(given.products(), last);
    EXPECT_EQ(problem.x, measured.x);
    EXPECT_EQ(given.whole(), whole);

    limits.mean /= 1.001;
    given.solve(problem = given.start(), limits);
    EXPECT_GE(given.products(), last) << "the expected mean exceeds its limit";
    limits.mean = before.mean;
    limits.greatest /= 1.001;
    given.solve(problem = given.start(), limits);
    EXPECT_GE(given.products(), last) << "the expected maximum exceeds its limit";
  }
}

TEST(Complementarity, EndsInBoundsAtTheLimitOfIterations) {
  const Problem given(60, 2);
  for (int most = 2; most < 20; ++most) {
    Complementarity problem = given.start();
    const SolveReport report = given.solve(problem, {0, 0, most});
    EXPECT_LE(report.iterations, most);
    EXPECT_GT(report.mean, 0);
    EXPECT_GE(std::ranges::min(problem.x), 0);
  }
}

TEST(Complementarity, GivesTheSameBitsForAnyThreads) {
  const Problem given(600, 3);
  Complementarity serial = given.start();
  given.solve(serial, {1e-6, 1e-5, 1000});
  for (const std::size_t threads : {2U, 4U}) {
    ThreadRunner runner(threads);
    Complementarity threaded = given.start();
    given.solve(threaded, {1e-6, 1e-5, 1000}, &runner);
    EXPECT_EQ(threaded.x, serial.x);
  }
}

TEST(Complementarity, EndsAtOnceWithNumbersThatAreNone) {
  const Problem given(60, 4);
  Complementarity problem = given.start();
  problem.excess[7] = std::numeric_limits<Real>::quiet_NaN();
  problem.x[7] = 1;
  EXPECT_EQ(given.solve(problem, kClose).iterations, 0);
}

}  // namespace
}  // namespace vat::test::complementarity_test
