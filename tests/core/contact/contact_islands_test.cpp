#include "core/contact/projection/contact_islands.h"

#include <gtest/gtest.h>

#include "core/model/model.h"

namespace vat::contact_islands_test {
namespace {

constexpr Index kFree = 4;

ContactEnd particle(Index index) {
  return {.particle = index, .inverse_mass = 1};
}
ContactEnd rigid(Index body, Index index) {
  return {.particle = kFree + index, .rigid = body, .inverse_mass = 1};
}
ContactEnd held(Index body, Index index) {
  return {.particle = kFree + index, .rigid = body, .inverse_mass = 0};
}
const ContactEnd kWall{};

struct Case {
  const char* name;
  std::vector<std::pair<ContactEnd, ContactEnd>> contacts;
  std::vector<std::vector<Index>> islands;
};

const Case kCases[] = {
    {"no contact", {}, {}},
    {"a wall joins nothing",
     {{particle(0), kWall}, {rigid(1, 3), kWall}, {particle(0), kWall}},
     {{0, 2}, {1}}},
    {"a held body joins nothing",
     {{particle(1), held(0, 2)}, {held(0, 1), particle(2)}, {held(0, 0), rigid(1, 0)}},
     {{0}, {1}, {2}}},
    {"particles of one rigid body join",
     {{particle(3), rigid(0, 0)}, {particle(1), kWall}, {rigid(0, 5), kWall}},
     {{0, 2}, {1}}},
    {"a later contact joins two earlier islands",
     {{particle(3), kWall},
      {particle(0), kWall},
      {rigid(1, 1), particle(3)},
      {particle(2), kWall},
      {particle(0), rigid(1, 2)}},
     {{0, 1, 2, 4}, {3}}},
};

TEST(ContactIslands, JoinContactsThatShareAnEndThatMoves) {
  Model model;
  model.free_count = kFree;
  model.rigid_bodies.resize(2);
  ContactIslands islands;  // of all cases: find() replaces the last result
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    std::vector<ContactConstraint> constraints;
    for (const auto& [first, second] : c.contacts) constraints.push_back({.ends = {first, second}});
    islands.find(model, constraints);
    std::vector<std::vector<Index>> found;
    for (std::size_t i = 0; i < islands.count(); ++i) {
      found.emplace_back(islands[i].begin(), islands[i].end());
    }
    EXPECT_EQ(found, c.islands);
  }
}

}  // namespace
}  // namespace vat::contact_islands_test
