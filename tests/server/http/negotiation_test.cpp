// Content codings and entity tags that a request names.

#include "server/http/negotiation.h"

#include <gtest/gtest.h>

namespace vat::test::negotiation_test {
namespace {

TEST(Negotiation, AnEncodingHasTheWeightOfItsHeader) {
  struct Case {
    const char* header;
    double brotli, gzip;
  };
  for (const Case& one : {Case{"", 0, 0}, Case{"br", 1, 0}, Case{"BR , Gzip", 1, 1},
                          Case{"br;q=0.5,gzip;q=0.25", 0.5, 0.25}, Case{"br ; Q=0.5", 0.5, 0},
                          Case{"*", 1, 1}, Case{"*;q=0.1, gzip", 0.1, 1}, Case{"br;q=0, *", 0, 1},
                          Case{"brr, x-br", 0, 0}, Case{",,br,", 1, 0}}) {
    EXPECT_DOUBLE_EQ(weight_of(Encoding::brotli, one.header), one.brotli) << one.header;
    EXPECT_DOUBLE_EQ(weight_of(Encoding::gzip, one.header), one.gzip) << one.header;
  }
}

TEST(Negotiation, MalformedWeightsAreZero) {
  for (const char* header : {"br;q=", "br;q=x", "br;q=2", "br;q=-1", "br;q=0.5x", "br;level=9",
                             "br;q=nan", "br;q=inf"}) {
    EXPECT_EQ(weight_of(Encoding::brotli, header), 0) << header;
  }
}

TEST(Negotiation, IdentityIsTheLastChoiceUnlessExcluded) {
  const double unnamed = weight_of(Encoding::identity, "gzip;q=0.001");
  EXPECT_GT(unnamed, 0);
  EXPECT_LT(unnamed, 0.001);
  EXPECT_EQ(weight_of(Encoding::identity, "identity;q=0"), 0);
  EXPECT_EQ(weight_of(Encoding::identity, "*;q=0"), 0);
  EXPECT_EQ(weight_of(Encoding::identity, "identity"), 1);
}

TEST(Negotiation, TagsAreComparedWithTheirQuotes) {
  for (const char* header : {"\"a\"", "W/\"a\"", "\"b\", \"a\"", "\"b\",W/\"a\"", "*"}) {
    EXPECT_TRUE(contains_tag(header, "\"a\"")) << header;
  }
  for (const char* header : {"", "a", "\"b\"", "\"aa\"", "w/\"a\"", "\"a", ",", "W/"}) {
    EXPECT_FALSE(contains_tag(header, "\"a\"")) << header;
  }
}

}  // namespace
}  // namespace vat::test::negotiation_test
