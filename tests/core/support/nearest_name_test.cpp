#include "core/support/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace vat::nearest_name_test {
namespace {

struct Case {
  std::string wrong;
  std::vector<std::string> candidates;
  std::string suggestion;
};

TEST(NearestName, IsSuggestedIfItCanBeMeant) {
  for (const Case& each : std::vector<Case>{
           {"dam-brake", {"clay", "dam-break", "dam"}, "dam-break"},  // a letter at another place
           {"radus", {"mass", "radius"}, "radius"},                   // a letter too few
           {"spacinng", {"spacing", "shape"}, "spacing"},             // a letter too many
           {"kynd", {"kind", "name"}, "kind"},                        // another letter
           {"Density", {"velocity", "density"}, "density"},           // another case
           {"ab", {"ba"}, "ba"},                                      // an exchange counts once
           {"abc", {"acb"}, "acb"},     // the limit: one for three letters
           {"abc", {"xbz"}, ""},        // two for three letters
           {"abcd", {"abxy"}, "abxy"},  // two for four letters
           {"abcd", {"axyz"}, ""},
           {"wax", {"wad", "way"}, "wad"},  // the first of equal ones
           {"fly", {"control.play", "scene.list"}, ""},
           {"", {"a"}, ""},
           {"a", {}, ""},
           {std::string(64, 'x') + "y", {std::string(64, 'x')}, ""}}) {
    EXPECT_EQ(NearestName(each.wrong).consider_all(each.candidates, std::identity()).suggestion(),
              each.suggestion)
        << each.wrong;
  }
}

TEST(NearestName, IsKnownWithoutASuggestion) {
  NearestName nearest("viewers");
  nearest.consider("port");
  nearest.consider("max_clients");
  EXPECT_EQ(nearest.nearest(), "port");
  EXPECT_EQ(nearest.suggestion(), "");
}

TEST(UnknownName, SuggestsInTheMessageAndAsAMember) {
  const std::vector<std::string> names{"water", "honey"};
  const Error error =
      unknown_name({}, "/material", "must be a material", "hony", names, std::identity());
  EXPECT_EQ(error.code, "unknown_name");
  EXPECT_EQ(error.path, "/material");
  EXPECT_EQ(error.message, "must be a material; did you mean \"honey\"?");
  EXPECT_EQ(error.suggestion, "honey");
  const Error plain = unknown_name({}, "", "must be a material", "sand", names, std::identity());
  EXPECT_EQ(plain.message, "must be a material");
  EXPECT_EQ(plain.suggestion, "");
}

TEST(UnknownName, SuggestsForTheFirstErrorsOnly) {
  const std::vector<std::string> names{"honey"};
  Errors earlier(kMaxSuggestions - 1);
  EXPECT_EQ(unknown_name(earlier, "", "", "hony", names, std::identity()).suggestion, "honey");
  earlier.emplace_back();
  EXPECT_EQ(unknown_name(earlier, "", "", "hony", names, std::identity()).suggestion, "");
}

}  // namespace
}  // namespace vat::nearest_name_test
