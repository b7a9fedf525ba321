#include "tests/stability/random/random_vat.h"

#include <gtest/gtest.h>

#include <set>

#include "core/validation/validate.h"
#include "protocol/scene/scene_json.h"
#include "tests/support/name_of.h"

namespace vat::stability::random_vat_test {
namespace {

constexpr std::uint64_t kVats = 6;
constexpr PressureSolver kSolvers[] = {PressureSolver::gas, PressureSolver::tait,
                                       PressureSolver::incompressible};

TEST(RandomVats, AreValidAndTheSameForTheSameSeed) {
  std::set<std::string> texts;
  for (const PressureSolver solver : kSolvers) {
    for (std::uint64_t seed = 1; seed <= kVats; ++seed) {
      const Scene scene = random_vat(seed, solver).scene;
      EXPECT_TRUE(find_errors(scene).empty()) << scene.name;
      EXPECT_EQ(write_scene(scene), write_scene(random_vat(seed, solver).scene));
      texts.insert(write_scene(scene).dump());
    }
  }
  EXPECT_EQ(texts.size(), std::size(kSolvers) * kVats);
}

class RandomVatsOf : public testing::TestWithParam<PressureSolver> {};

TEST_P(RandomVatsOf, LoseNothing) {
  for (std::uint64_t seed = 1; seed <= kVats; ++seed) {
    const VatReport report = shake(random_vat(seed, GetParam()));
    EXPECT_EQ(report.fault, "") << "seed " << seed;
    EXPECT_GT(report.greatest_speed, 0.001) << "seed " << seed;
  }
}

TEST_P(RandomVatsOf, LoseNothingWithSubSteps) {
  for (std::uint64_t seed = 1; seed <= kVats; ++seed) {
    EXPECT_EQ(shake(with_sub_steps(random_vat(seed, GetParam()))).fault, "") << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Solvers, RandomVatsOf, testing::ValuesIn(kSolvers), test::NameOf());

}  // namespace
}  // namespace vat::stability::random_vat_test
