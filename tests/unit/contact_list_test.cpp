#include "core/forces/contact_list.h"

#include <gtest/gtest.h>

#include <random>

#include "core/forces/liquid.h"
#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"

namespace vat {
namespace {

using namespace test;

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

/// A list over particles that are moved by hand, each on its own.
struct Moved {
  explicit Moved(const Scene& scene) : probe(scene) {}

  StepContext context() {
    return {probe.model(), controls, 0, 0, probe.state().now, probe.state().forces, work, nullptr};
  }
  void update(Real slack) {
    StepContext c = context();
    if (!list.is_current(c, slack)) sort_liquid(c);
    list.update(c, slack);
  }
  bool is_current(Real slack) { return list.is_current(context(), slack); }

  ForceProbe probe;
  Controls controls;
  Workspace work;
  ContactList list;
};

using Found = std::vector<std::pair<Index, Real>>;

Found in_list(Moved& moved, Index i, Real slack) {
  Found found;
  moved.list.for_each(
      moved.probe.model(), moved.probe.state().now, i,
      [&](const Contact& c) { found.emplace_back(c.other, c.distance); }, slack);
  return found;
}

Found by_brute_force(Moved& moved, Index i, Real slack) {
  const Model& model = moved.probe.model();
  const std::vector<Vec3>& at = moved.probe.state().now.position;
  const ContactRules rules(model, i);
  const auto is_liquid = [&](Index k) { return k < model.liquid_count; };
  Found found;
  for (Index j = 0; j < model.particle_count; ++j) {
    Contact contact;
    if (is_liquid(i) && is_liquid(j) && model.material[i] == model.material[j]) continue;
    if (!rules.find_law(j, contact) || rules.excluded(j)) continue;
    const Vec3 x =
        model.periodic.nearest(Vec3(model.periodic.wrap(at[i]) - model.periodic.wrap(at[j])));
    if (x.norm() < contact.threshold + slack) found.emplace_back(j, x.norm());
  }
  return found;
}

void expect_all_contacts(Moved& moved, Real slack) {
  std::size_t count = 0;
  for (Index i = 0; i < moved.probe.model().particle_count; ++i) {
    const Found found = in_list(moved, i, slack);
    const Found expected = by_brute_force(moved, i, slack);
    ASSERT_EQ(found.size(), expected.size()) << i;
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_EQ(found[k].first, expected[k].first);
      EXPECT_NEAR(found[k].second, expected[k].second, 1e-14);
    }
    count += found.size();
  }
  EXPECT_GT(count, 20U);
}

/// Every particle goes a random way of its own, some of the times none at all.
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
    expect_all_contacts(moved, slack);
    for (Vec3& p : moved.probe.state().now.position) p += Vec3(way(random), way(random), 0);
  }
  EXPECT_GT(kept, 40);
  EXPECT_LT(kept, 60);
}

TEST(ContactList, HasAllContactsWhileItIsKept) {
  expect_all_contacts_of_moving(make_crowd());
}

TEST(ContactList, HasAllContactsAcrossTheSeamsOfAPeriodicWorld) {
  Scene scene = make_crowd();
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

}  // namespace
}  // namespace vat
