// Files that were made for clients, each to be fetched once.

#include "server/http/downloads.h"

#include <gtest/gtest.h>

namespace vat::test::downloads_test {
namespace {

using namespace std::chrono_literals;

TEST(Downloads, AreFetchedOnceAndInTime) {
  Downloads downloads;
  const Downloads::Clock::time_point now{};
  const std::string first = downloads.add({"a", "one"}, now).value();
  const std::string second = downloads.add({"b", "two"}, now).value();
  EXPECT_NE(first, second);
  EXPECT_FALSE(downloads.take("/downloads/", now).has_value());
  EXPECT_EQ(downloads.take(first, now)->content, "one");
  EXPECT_FALSE(downloads.take(first, now).has_value());
  EXPECT_FALSE(downloads.take(second, now + Downloads::kPatience).has_value());
}

TEST(Downloads, AreForgottenInTime) {
  Downloads downloads;
  const Downloads::Clock::time_point now{};
  downloads.add({"a", "one"}, now);
  downloads.add({"b", "three"}, now + 1s);
  EXPECT_EQ(downloads.forget_old(now + Downloads::kPatience - 1ms), 8U);
  EXPECT_EQ(downloads.forget_old(now + Downloads::kPatience), 5U);
}

TEST(Downloads, AreServedByTheSite) {
  Downloads downloads;
  const HttpHandler site = with_downloads(
      [](std::string_view, std::string_view) {
        return HttpResponse{404, "", "", {}};
      },
      downloads);
  const std::string path = downloads.add({"a.vatrec", "one"}, Downloads::Clock::now()).value();
  EXPECT_EQ(site("POST", path).status, 404);
  EXPECT_EQ(site("HEAD", path).status, 404);
  const HttpResponse response = site("GET", path);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, "one");
  EXPECT_EQ(site("GET", path).status, 404);
}

}  // namespace
}  // namespace vat::test::downloads_test
