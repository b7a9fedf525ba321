// Files that the server made for clients. Each can be downloaded once.

#include <gtest/gtest.h>

#include "server/http/downloads.h"
#include "server/replay/imports.h"
#include "server/support/base64.h"
#include "tests/support/manual_clock.h"

namespace vat::test::downloads_test {
namespace {

using namespace std::chrono_literals;

TEST(Downloads, AreForgottenInTime) {
  Downloads downloads;
  const SteadyClock::time_point now{};
  downloads.add({"a", "one"}, now);
  downloads.add({"b", "three"}, now + 1s);
  EXPECT_EQ(downloads.forget_old(now + Downloads::kPatience - 1ms), 8U);
  EXPECT_EQ(downloads.forget_old(now + Downloads::kPatience), 5U);
}

TEST(Downloads, AreBounded) {
  Downloads downloads(10);
  const SteadyClock::time_point now{};
  const auto first = downloads.add({"a", "123456"}, now);
  EXPECT_TRUE(first.has_value());
  EXPECT_FALSE(downloads.add({"b", "12345"}, now).has_value());
  EXPECT_TRUE(downloads.add({"c", "1234"}, now).has_value());
  EXPECT_FALSE(downloads.add({"d", "1"}, now).has_value());
  downloads.take(*first, now);
  EXPECT_TRUE(downloads.add({"e", "123456"}, now).has_value());
}

TEST(Downloads, AreServedByTheSite) {
  ManualClock clock;
  Downloads downloads;
  const HttpHandler site = with_downloads(
      [](const HttpRequest&) {
        return HttpResponse{404, "", "", {}};
      },
      downloads, clock);
  const std::string path = downloads.add({"a.vatrec", "one"}, clock.now()).value();
  EXPECT_EQ(site({"GET", "/downloads/"}).status, 404);
  EXPECT_EQ(site({"POST", path}).status, 404);
  EXPECT_EQ(site({"HEAD", path}).status, 404);
  const HttpResponse response = site({"GET", path});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.body, "one");
  EXPECT_EQ(site({"GET", path}).status, 404);
  const std::string late = downloads.add({"a.vatrec", "one"}, clock.now()).value();
  EXPECT_NE(late, path);
  clock.advance(Downloads::kPatience);
  EXPECT_EQ(site({"GET", late}).status, 404);
}

TEST(Downloads, AreReadInParts) {
  Downloads downloads(10, "a");
  const SteadyClock::time_point now{};
  const std::string path = downloads.add({"f", "1234567"}, now).value();
  EXPECT_TRUE(path.starts_with("/downloads/a/"));
  EXPECT_FALSE(downloads.read(path, 8, 3, now));
  EXPECT_FALSE(downloads.read(path + "x", 0, 3, now));
  std::string content;
  for (const std::size_t offset : {0U, 3U, 3U, 6U}) {  // the second part was lost once
    const auto part = downloads.read(path, offset, 3, now);
    ASSERT_TRUE(part);
    EXPECT_EQ(part->name, "f");
    EXPECT_EQ(part->size, 7U);
    content = content.substr(0, offset) + part->content;
  }
  EXPECT_EQ(content, "1234567");
  EXPECT_FALSE(downloads.read(path, 6, 3, now));
  EXPECT_EQ(downloads.forget_old(now), 0U);
  const std::string late = downloads.add({"f", "1"}, now).value();
  EXPECT_FALSE(downloads.read(late, 0, 3, now + Downloads::kPatience));
}

TEST(Downloads, ReservedRoomCountsTowardsTheLimit) {
  Downloads downloads(10);
  const SteadyClock::time_point now{};
  Downloads::Room room = downloads.reserve(6, now);
  ASSERT_TRUE(room);
  EXPECT_FALSE(downloads.reserve(5, now));
  EXPECT_FALSE(downloads.reserve(SIZE_MAX, now));
  EXPECT_FALSE(downloads.add({"a", "12345"}, now));
  EXPECT_TRUE(downloads.reserve(4, now));
  room.reset();
  EXPECT_TRUE(downloads.add({"a", "1234567890"}, now));
  EXPECT_FALSE(downloads.reserve(1, now));
  EXPECT_TRUE(downloads.reserve(10, now + Downloads::kPatience));
}

TEST(Downloads, OfOtherNodesAreFetched) {
  ManualClock clock;
  Downloads downloads(10, "a");
  std::string asked;
  const HttpHandler site = with_downloads(
      [](const HttpRequest&) {
        return HttpResponse{404, "", "", {}};
      },
      downloads, clock,
      [&](const std::string& node, const std::string& path, auto answer) {
        asked = node + " " + path;
        answer(download_response({"f", "text"}));
      });
  const HttpResponse response = site({"GET", "/downloads/b/x"});
  ASSERT_TRUE(response.later);
  EXPECT_EQ(asked, "");
  HttpResponse follows;
  response.later([&](HttpResponse answer) { follows = std::move(answer); });
  EXPECT_EQ(asked, "b /downloads/b/x");
  EXPECT_EQ(follows.body, "text");
  for (const char* own : {"/downloads/a/x", "/downloads/x", "/downloads/", "/b/x"}) {
    EXPECT_FALSE(site({"GET", own}).later) << own;
  }
  EXPECT_FALSE(site({"HEAD", "/downloads/b/x"}).later);
}

// Recordings that clients upload in parts.

const SteadyClock::time_point kStart{};

Imports::Chunk first_part(std::size_t bytes) {
  return {{}, 100, 0, std::vector<std::uint8_t>(bytes)};
}

TEST(Imports, AreSoManyAtMost) {
  Imports imports;
  for (std::size_t n = 0; n < Imports::kMaxFiles; ++n) {
    EXPECT_TRUE(std::holds_alternative<Imports::Progress>(imports.add(1, first_part(3), kStart)));
  }
  const auto refused = imports.add(1, first_part(3), kStart);
  ASSERT_TRUE(std::holds_alternative<RpcError>(refused));
  EXPECT_EQ(std::get<RpcError>(refused).data.at("limit"), "imports");
  const auto later = imports.add(1, first_part(3), kStart + 2 * Imports::kPatience);
  EXPECT_TRUE(std::holds_alternative<Imports::Progress>(later));
}

TEST(Imports, AreForgottenInTime) {
  Imports imports;
  imports.add(1, first_part(3), kStart);
  imports.add(1, first_part(4), kStart + std::chrono::seconds(1));
  EXPECT_EQ(imports.forget_old(kStart + Imports::kPatience), 7U);
  EXPECT_EQ(imports.forget_old(kStart + Imports::kPatience + std::chrono::milliseconds(1)), 4U);
}

TEST(Imports, HaveSoManyBytesAtMost) {
  Imports imports(50);
  const auto begun = imports.add(1, first_part(30), kStart);
  const std::string name = std::get<Imports::Progress>(begun).name;
  const Imports::Chunk next{name, 100, 30, std::vector<std::uint8_t>(20)};
  EXPECT_TRUE(std::holds_alternative<Imports::Progress>(imports.add(1, next, kStart)));
  const auto refused = imports.add(1, first_part(1), kStart);
  ASSERT_TRUE(std::holds_alternative<RpcError>(refused));
  EXPECT_EQ(std::get<RpcError>(refused).data.at("limit"), "import_bytes");
}

TEST(Base64, IsReadCompletelyOrRefused) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(from_base64(""), Bytes());
  EXPECT_EQ(from_base64("Zg=="), Bytes{'f'});
  EXPECT_EQ(from_base64("Zm8="), (Bytes{'f', 'o'}));
  EXPECT_EQ(from_base64("Zm9v"), (Bytes{'f', 'o', 'o'}));
  for (const char* bad : {"Z", "Zg=", "Z===", "Zg==Zg==", "Z g=", "Zm9v\n", "Zm9*", "===="}) {
    EXPECT_FALSE(from_base64(bad).has_value()) << bad;
  }
}

}  // namespace
}  // namespace vat::test::downloads_test
