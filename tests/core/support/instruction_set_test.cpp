#include "core/support/instruction_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/simulation/simulation.h"
#include "tests/support/shaken_vat.h"

namespace vat::test::instruction_set_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr auto kAll = {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512};

/// Hides the instruction sets above a given one during its lifetime.
class Limited {
 public:
  explicit Limited(InstructionSet greatest) { limit_instruction_sets(greatest); }
  ~Limited() { limit_instruction_sets(InstructionSet::avx512); }
  Limited(const Limited&) = delete;
  Limited& operator=(const Limited&) = delete;
};

TEST(InstructionSet, NamesAreReadBack) {
  for (const InstructionSet set : kAll) {
    EXPECT_EQ(parse_instruction_set(to_string(set)).value(), set);
  }
  const Result<InstructionSet> unknown = parse_instruction_set("avx");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.errors()[0].message,
              AllOf(HasSubstr("'avx'"), HasSubstr("baseline, avx2, avx512")));
}

TEST(InstructionSet, TheBestIsTheLastOfThoseThere) {
  const std::vector<InstructionSet> sets = available_instruction_sets();
  EXPECT_EQ(sets.front(), InstructionSet::baseline);
  EXPECT_TRUE(std::ranges::is_sorted(sets));
  EXPECT_EQ(sets.back(), best_instruction_set());
  for (const InstructionSet set : kAll) {
    EXPECT_EQ(check_available(set).ok(), std::ranges::count(sets, set) == 1) << to_string(set);
  }
}

TEST(InstructionSet, AMachineWithoutAnyHasTheBaseline) {
  const Limited plain(InstructionSet::baseline);
  EXPECT_THAT(available_instruction_sets(), ElementsAre(InstructionSet::baseline));
}

TEST(InstructionSet, ASimulationIsRefusedOneThatTheMachineLacks) {
  const Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
  const Limited without_avx512(InstructionSet::avx2);
  EXPECT_LT(best_instruction_set(), InstructionSet::avx512);
  const Result<Simulation> refused = Simulation::create(scene, nullptr, InstructionSet::avx512);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.errors()[0].code, "not_available");
  EXPECT_THAT(refused.errors()[0].message,
              AllOf(HasSubstr("no avx512"), HasSubstr("sets are baseline")));
  EXPECT_TRUE(Simulation::create(scene));
}

TEST(InstructionSet, ASimulationKeepsItsOwn) {
  const Scene scene = make_shaken_vat(IntegratorId::velocity_verlet);
  for (const InstructionSet set : available_instruction_sets()) {
    Simulation simulation = Simulation::create(scene, nullptr, set).value();
    EXPECT_EQ(simulation.instruction_set(), set);
    const Snapshot start = simulation.snapshot();
    simulation.advance(2);
    EXPECT_TRUE(simulation.remove_body(simulation.bodies().back().id));
    EXPECT_EQ(simulation.instruction_set(), set) << "after a change of bodies";
    simulation.restore(start);
    EXPECT_EQ(simulation.instruction_set(), set) << "restored";
  }
}

}  // namespace
}  // namespace vat::test::instruction_set_test
