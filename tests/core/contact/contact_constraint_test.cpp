#include "core/contact/projection/contact_constraint.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace vat::contact_constraint_test {
namespace {

constexpr Real kDt = 0.01;
constexpr Real kSlow = 0.2;

/// A contact of two free particles of 1 kg whose force changes from `last` to `force`.
ContactConstraint make_contact(Index first, Index second, Real last, Real force, Real approach) {
  ContactConstraint contact;
  contact.ends[0] = {.particle = first, .inverse_mass = 1};
  contact.ends[1] = {.particle = second, .inverse_mass = 1};
  contact.normal = {0, 0, 1};
  contact.last.drift = last * contact.normal;
  contact.last.finish = last * contact.normal;
  contact.drift = kDt * force * contact.normal;
  contact.push = 2 * kDt * force;
  contact.approach = approach;
  return contact;
}

TEST(ContactConstraint, IsSteadyUnlessAnImpactOfItsBodiesIncreasesItsForce) {
  // Particles 0, 1 and 2 are a stack. The other particles do not touch the stack.
  const std::vector<ContactConstraint> contacts = {
      make_contact(0, 1, 1, 10, -0.1),  make_contact(1, 2, 0, 10, 0),
      make_contact(3, 4, 1, 10, -0.3),   // an impact
      make_contact(4, 5, 1, 10, 0.1),    // a contact of particle 4, which has an impact
      make_contact(4, 6, 1, 2, 0.1),     // another one, whose force hardly changes
      make_contact(7, 8, 1, 1.5, -0.3),  // an impact of a contact that pushed already
  };
  Model model;
  model.free_count = 9;
  std::vector<std::uint8_t> scratch;
  std::vector<ContactImpulse> recorded;
  record(model, contacts, kDt, kSlow, scratch, recorded);
  ASSERT_EQ(recorded.size(), contacts.size());
  const std::vector<bool> expected = {true, true, false, false, true, true};
  for (std::size_t n = 0; n < expected.size(); ++n) {
    EXPECT_EQ(recorded[n].is_steady, expected[n]) << n;
    EXPECT_NEAR(recorded[n].drift.z(), contacts[n].drift.z() / kDt, 1e-12) << n;
    EXPECT_NEAR(recorded[n].finish.z(), contacts[n].drift.z() / kDt, 1e-12) << n;
  }
}

TEST(ContactConstraint, AnEndThatDoesNotMoveHasNoImpact) {
  // Both particles touch particle 2, which is held.
  std::vector<ContactConstraint> contacts = {make_contact(0, 2, 1, 10, -0.3),
                                             make_contact(1, 2, 1, 10, 0)};
  for (ContactConstraint& contact : contacts) contact.ends[1].inverse_mass = 0;
  Model model;
  model.free_count = 3;
  std::vector<std::uint8_t> scratch;
  std::vector<ContactImpulse> recorded;
  record(model, contacts, kDt, kSlow, scratch, recorded);
  EXPECT_FALSE(recorded[0].is_steady);
  EXPECT_TRUE(recorded[1].is_steady);
}

TEST(ContactConstraint, RecallsTheForcesOfTheSameContact) {
  std::vector<ContactConstraint> contacts = {
      make_contact(0, 1, 0, 0, 0), make_contact(1, 2, 0, 0, 0), make_contact(1, 3, 0, 0, 0)};
  recall({{0, kWallCount + 2, {1, 0, 0}, {}, true}, {1, kWallCount + 2, {2, 0, 0}, {}, true}},
         contacts);
  EXPECT_TRUE(contacts[0].is_new);
  EXPECT_FALSE(contacts[1].is_new);
  EXPECT_EQ(contacts[1].last.drift.x(), 2);
  EXPECT_TRUE(contacts[1].last.is_steady);
  EXPECT_TRUE(contacts[2].is_new);
}

}  // namespace
}  // namespace vat::contact_constraint_test
