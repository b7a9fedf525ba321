#include <gtest/gtest.h>

#include <string>

#include "server/http/request_path.h"

namespace vat::http_request_path_test {

namespace {

TEST(RequestPath, Decodes) {
  EXPECT_EQ(request_path("/"), "/");
  EXPECT_EQ(request_path("/a/b.js"), "/a/b.js");
  EXPECT_EQ(request_path("/a%20b%2Fc%c3%A4"), "/a b/c\xc3\xa4");
  EXPECT_EQ(request_path("/a?../b"), "/a");
  EXPECT_EQ(request_path("/a#b"), "/a");
  EXPECT_EQ(request_path("/%2525"), "/%25");  // once, not twice
  EXPECT_EQ(request_path("/...a/b..c/..d"), "/...a/b..c/..d");
}

TEST(RequestPath, RefusesWhatIsNotAPath) {
  for (const char* target : {"", "a", "*", "?", "http://x/a", "example.org:80", "%2fa"}) {
    EXPECT_EQ(request_path(target), std::nullopt) << target;
  }
}

TEST(RequestPath, RefusesBrokenEscapes) {
  for (const char* target : {"/%", "/%2", "/%zz", "/%2g", "/a%", "/%%41", "/%+1"}) {
    EXPECT_EQ(request_path(target), std::nullopt) << target;
  }
}

TEST(RequestPath, RefusesWaysUp) {
  for (const char* target : {"/..", "/../", "/../../etc/passwd", "/a/..", "/a/../b", "/./a", "/.",
                             "/%2e%2e/a", "/.%2E/a", "/a%2f..%2fb", "/%2e", "/a/..?x", "/..\\..\\a",
                             "/a\\b", "/a%5c..", "/a/%2e%2e"}) {
    EXPECT_EQ(request_path(target), std::nullopt) << target;
  }
}

TEST(RequestPath, RefusesNul) {
  EXPECT_EQ(request_path("/a%00.html"), std::nullopt);
  EXPECT_EQ(request_path(std::string("/a\0b", 4)), std::nullopt);
}

}  // namespace

}  // namespace vat::http_request_path_test
