#include <gtest/gtest.h>

#include <cctype>
#include <iostream>
#include <set>

#include "tests/stability/adversarial/adversarial.h"
#include "tests/support/name_of.h"

namespace vat::stability::adversarial_test {
namespace {

class Adversarial : public testing::TestWithParam<std::string> {};

const std::vector<AdversarialCase>& all_cases() {
  static const std::vector<AdversarialCase> kCases = adversarial_cases();
  return kCases;
}

std::vector<std::string> all_groups() {
  std::vector<std::string> groups;
  for (const AdversarialCase& adversarial : all_cases()) {
    if (std::find(groups.begin(), groups.end(), adversarial.group) == groups.end()) {
      groups.push_back(adversarial.group);
    }
  }
  return groups;
}

TEST_P(Adversarial, EndsAsItMust) {
  for (const AdversarialCase& adversarial : all_cases()) {
    if (adversarial.group != GetParam()) continue;
    const Outcome outcome = run(adversarial);
    EXPECT_EQ(outcome.fault, "") << adversarial.name;
    std::cout << adversarial.name << ": " << to_string(outcome.ending) << ", " << outcome.undone
              << " undone of " << outcome.attempts << " steps, " << outcome.wall_stops
              << " wall stops. " << outcome.message << '\n';
  }
}

INSTANTIATE_TEST_SUITE_P(All, Adversarial, testing::ValuesIn(all_groups()), test::NameOf());

TEST(AdversarialCases, AreManyAndDiffer) {
  std::set<std::string> names;
  for (const AdversarialCase& adversarial : all_cases()) names.insert(adversarial.name);
  EXPECT_EQ(names.size(), all_cases().size());
  EXPECT_GE(names.size(), 200U);
  EXPECT_GE(all_groups().size(), 60U);
}

}  // namespace
}  // namespace vat::stability::adversarial_test
