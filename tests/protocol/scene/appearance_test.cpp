#include "protocol/scene/appearance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "protocol/scene/scene_json.h"

namespace vat::appearance_test {
namespace {

using testing::HasSubstr;

Material named(const std::string& name) {
  Material material;
  material.name = name;
  return material;
}

Material liquid(const std::string& name, Real viscosity) {
  Material material = named(name);
  material.liquid = LiquidConstants{100, viscosity, 0.1};
  return material;
}

Result<Material> read(const Json& appearance) {
  return read_material({{"name", "m"}, {"appearance", appearance}}, "/material");
}

TEST(Appearance, FollowsTheNameOfTheMaterial) {
  const Colour honey = full_appearance(liquid("honey", 600)).colour;
  EXPECT_GT(honey.red, honey.green);
  EXPECT_GT(honey.green, 2 * honey.blue);  // amber
  const Colour blood = full_appearance(liquid("dark blood", 1)).colour;
  EXPECT_GT(blood.red, 5 * blood.green);
  const Colour water = full_appearance(liquid("Water", 1)).colour;
  EXPECT_GT(water.blue, water.red);
  const FullAppearance clay = full_appearance(named("wet-clay 2"));
  EXPECT_EQ(clay.finish, Finish::clay);
  EXPECT_GT(clay.colour.red, clay.colour.blue);  // terracotta
  EXPECT_EQ(full_appearance(named("steel")).metalness, 1);
  EXPECT_EQ(full_appearance(named("brick")).finish, Finish::brick);
}

TEST(Appearance, NamesHaveWholeWordsOnly) {
  EXPECT_EQ(full_appearance(named("oak")).finish, Finish::wood);
  EXPECT_EQ(full_appearance(named("cloak")).colour, full_appearance(named("x")).colour);
  EXPECT_EQ(full_appearance(liquid("bloody", 1)).colour, full_appearance(liquid("x", 1)).colour);
}

TEST(Appearance, FollowsTheConstantsIfTheNameIsUnknown) {
  EXPECT_EQ(full_appearance(liquid("x", 1)).colour, full_appearance(liquid("water", 1)).colour);
  EXPECT_EQ(full_appearance(liquid("x", 100)).colour, full_appearance(liquid("honey", 1)).colour);
  Material solid = named("x");
  solid.density = 500;
  EXPECT_EQ(full_appearance(solid).finish, Finish::wood);
  solid.density = 7800;
  EXPECT_EQ(full_appearance(solid).metalness, 1);
  solid.springs.emplace();
  EXPECT_EQ(full_appearance(solid).finish, Finish::rubber);
  solid.plasticity.emplace();
  EXPECT_EQ(full_appearance(solid).finish, Finish::clay);
}

TEST(Appearance, StatedMembersHavePriority) {
  Material material = named("steel");
  material.appearance.colour = Colour{1, 2, 3};
  material.appearance.roughness = 0.875;
  const FullAppearance full = full_appearance(material);
  EXPECT_EQ(full.colour, (Colour{1, 2, 3}));
  EXPECT_EQ(full.roughness, 0.875);
  EXPECT_EQ(full.finish, Finish::steel);
  EXPECT_FALSE(full.absorption_length);
  const Json json = write_appearance(full);
  EXPECT_EQ(json.at("colour"), "#010203");
  EXPECT_EQ(json.at("finish"), "steel");
  EXPECT_FALSE(json.contains("absorption_length"));
}

TEST(Appearance, ErrorsNamePathAndRange) {
  struct Mistake {
    Json appearance;
    const char* code;
    const char* member;
    const char* range;
  };
  for (const auto& [appearance, code, member, range] : std::vector<Mistake>{
           {{{"roughness", 1.5}}, "out_of_range", "roughness", "from 0 to 1"},
           {{{"metalness", -1}}, "out_of_range", "metalness", "from 0 to 1"},
           {{{"opacity", 2}}, "out_of_range", "opacity", "from 0 to 1"},
           {{{"absorption_length", 0}}, "out_of_range", "absorption_length", "from 1e-06 to"},
           {{{"finish", "velvet"}}, "unknown_name", "finish", "\"brick\""},
           {{{"colour", "#12345"}}, "out_of_range", "colour", "\"#000000\" to \"#ffffff\""},
           {{{"colour", "#12345g"}}, "out_of_range", "colour", "\"#000000\" to \"#ffffff\""},
           {{{"colour", 5}}, "wrong_type", "colour", "\"#000000\" to \"#ffffff\""},
           {{{"gloss", 1}}, "unknown_member", "gloss", ""}}) {
    const Result<Material> material = read(appearance);
    ASSERT_FALSE(material.ok()) << appearance;
    ASSERT_EQ(material.errors().size(), 1U) << appearance;
    EXPECT_EQ(material.errors()[0].code, code) << appearance;
    EXPECT_EQ(material.errors()[0].path, std::string("/material/appearance/") + member);
    EXPECT_THAT(material.errors()[0].message, HasSubstr(range));
  }
}

}  // namespace
}  // namespace vat::appearance_test
