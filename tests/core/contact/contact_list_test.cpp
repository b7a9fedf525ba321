#include "core/contact/contact_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <random>

#include "core/liquid/gas/liquid.h"
#include "tests/support/distance.h"
#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"

namespace vat::test::contact_list_test {
namespace {

/// Bodies of all kinds, some near each other and some not.
Scene make_crowd() {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
  const auto add = [&](const std::string& name, BodyKind kind, const char* material,
                       const Vec3& center) {
    scene.bodies.push_back(make_block(name, kind, material, 3, center, Vec3::Zero()));
  };
  add("pool", BodyKind::liquid, "a", {0, 0, 0});
  add("oil", BodyKind::liquid, "b", {0.16, 0, 0});
  add("jelly", BodyKind::deformable, "a", {0.1, 0, 0.17});
  add("crate", BodyKind::rigid, "b", {0.02, 0.12, 0.1});
  add("box", BodyKind::rigid, "a", {0.2, 0.1, 0.1});
  add("moon", BodyKind::rigid, "a", {2, 2, 2});
  return scene;
}

/// A contact list over particles that the test moves individually.
struct Moved {
  explicit Moved(const Scene& scene) : probe(scene) {}

  StepContext context() {
    return {probe.model(), controls, 0, 0, probe.state().now, probe.state().forces, work, nullptr};
  }
  void update(Real slack) {
    StepContext c = context();
    if (probe.model().liquid_count > 0 && !list.is_current(c, slack)) sort_liquid(c);
    list.update(c, slack);
  }
  bool is_current(Real slack) { return list.is_current(context(), slack); }

  ForceProbe probe;
  Controls controls;
  Workspace work;
  ContactList list;
};

using Found = std::vector<std::pair<Index, Real>>;

Found in_list(const Moved& moved, Index i, Real slack) {
  Found found;
  moved.list.for_each(
      moved.probe.model(), moved.probe.state().now, i,
      [&](const Contact& c) { found.emplace_back(c.other, c.distance); }, slack);
  return found;
}

Real distance_in(const PeriodicBox& box, const Vec3& a, const Vec3& b) {
  if (!box.any()) return distance_between(a, b);
  return box.nearest(Vec3(box.wrap(a) - box.wrap(b))).norm();
}

Found by_brute_force(const Moved& moved, Index i, Real slack) {
  const Model& model = moved.probe.model();
  const std::vector<Vec3>& at = moved.probe.state().now.position;
  const ContactRules rules(model, i);
  const auto is_liquid = [&](Index k) { return k < model.liquid_count; };
  Found found;
  for (Index j = 0; j < model.particle_count; ++j) {
    Contact contact;
    if (is_liquid(i) && is_liquid(j) && model.material[i] == model.material[j]) continue;
    if (!rules.find_law(j, contact) || rules.excluded(j)) continue;
    const Real distance = distance_in(model.periodic, at[i], at[j]);
    if (distance < contact.threshold + slack) found.emplace_back(j, distance);
  }
  std::stable_partition(found.begin(), found.end(),
                        [&](const auto& pair) { return model.body[pair.first] != model.body[i]; });
  return found;
}

/// Returns the number of contacts.
std::size_t expect_all_contacts(const Moved& moved, Real slack) {
  std::size_t count = 0;
  for (Index i = 0; i < moved.probe.model().particle_count; ++i) {
    const Found found = in_list(moved, i, slack);
    const Found expected = by_brute_force(moved, i, slack);
    EXPECT_EQ(found.size(), expected.size()) << i;
    if (found.size() != expected.size()) return 0;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].first, expected[k].first);
      EXPECT_NEAR(found[k].second, expected[k].second, 1e-14);
    }
    count += found.size();
  }
  return count;
}

/// Expects that the list's particles of each block include all particles with contacts.
void expect_all_particles(const Moved& moved, Real slack) {
  const Model& model = moved.probe.model();
  for (Index i = 0; i < model.particle_count; ++i) {
    if (in_list(moved, i, slack).empty()) continue;
    EXPECT_TRUE(std::ranges::binary_search(moved.list.particles(i / kBlockSize), i)) << i;
  }
}

/// Moves every particle by a random distance before each update. The list is reused in some
/// updates.
void expect_all_contacts_of_moving(const Scene& scene) {
  Moved moved(scene);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<Real> way(-1e-3, 1e-3);
  int kept = 0;
  for (int n = 0; n < 60; ++n) {
    const Real slack = n % 3 == 0 ? 0.01 : 0;
    kept += moved.is_current(slack) ? 1 : 0;
    moved.update(slack);
    EXPECT_TRUE(moved.is_current(slack));
    EXPECT_GT(expect_all_contacts(moved, slack), 20U);
    expect_all_particles(moved, slack);
    for (Vec3& p : moved.probe.state().now.position) p += Vec3(way(random), way(random), 0);
  }
  EXPECT_GT(kept, 40);
  EXPECT_LT(kept, 60);
}

TEST(ContactList, HasAllContactsWhileItIsKept) {
  Scene scene = make_crowd();
  expect_all_contacts_of_moving(scene);
  scene.bodies.pop_back();
  scene.periodic = Periodicity{{-0.09, -0.5, -0.5}, {0.28, 0.5, 0.5}, {true, false, false}};
  expect_all_contacts_of_moving(scene);
}

TEST(ContactList, IsOutOfDateWhenOneParticleHasMovedHalfASkin) {
  Moved moved(make_crowd());
  EXPECT_FALSE(moved.is_current(0));
  moved.update(0);
  EXPECT_TRUE(moved.is_current(0));
  const Real skin = 0.5 * moved.probe.model().contact_reach;
  EXPECT_FALSE(moved.is_current(skin));
  Vec3& position = moved.probe.state().now.position.back();
  position.x() += 0.49 * skin;
  EXPECT_TRUE(moved.is_current(0));
  EXPECT_FALSE(moved.is_current(0.1 * skin));
  position.x() += 0.02 * skin;
  EXPECT_FALSE(moved.is_current(0));
  position.x() = std::nan("");
  EXPECT_FALSE(moved.is_current(0));
}

/// A sheet that is rolled into a tube. `closed` is 0 if a fifth of the tube is open, and 1 if it is
/// closed.
std::vector<Vec3> roll(Real closed) {
  constexpr int kRound = 12;
  std::vector<Vec3> positions;
  for (int layer = 0; layer < 30; ++layer) {
    for (int k = 0; k <= kRound; ++k) {
      const Real angle = 2 * std::numbers::pi * k / kRound * (0.8 + 0.2 * closed);
      positions.push_back({0.2 * std::cos(angle), 0.09 * layer, 0.2 * std::sin(angle)});
    }
  }
  return positions;
}

Scene make_roll() {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
  const std::vector<Vec3> positions = roll(0);
  scene.bodies = {
      make_body("roll", BodyKind::deformable, "a", make_particles(positions, 0.1), 0.06)};
  scene.bodies[0].springs = join_near(positions, 0.12, {2000, 4});
  return scene;
}

// The list is kept in rigid motion, and made again when the shape has changed.
TEST(ContactList, OfABodyWithItselfHasAllContactsWhileItChangesItsShape) {
  Moved moved(make_roll());
  std::vector<Vec3>& positions = moved.probe.state().now.position;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<Real> way(-1e-3, 1e-3);
  SelfContactList alone(moved.probe.model().bodies[0].particles);
  int searches = 0;
  std::size_t contacts = 0;
  for (int n = 0; n < 100; ++n) {
    const Eigen::AngleAxis<Real> turn(0.05 * n, Vec3(1, 2, 3).normalized());
    positions = roll(0.01 * n);
    const Vec3 shift(0.05 * n, 0, -0.1 * n);
    for (Vec3& p : positions) p = turn * p + shift + Vec3(way(random), way(random), way(random));
    searches += alone.update(moved.context(), 0) ? 1 : 0;
    moved.update(0);
    contacts = expect_all_contacts(moved, 0);
  }
  EXPECT_GT(contacts, 100U);
  EXPECT_GT(searches, 2);
  EXPECT_LT(searches, 20);
}

}  // namespace
}  // namespace vat::test::contact_list_test
