// Downloads of files that another node has.

#include "server/relay/relay_downloads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "tests/cluster/nats_servers.h"
#include "tests/support/manual_clock.h"

namespace vat::test::relay_downloads_test {
namespace {

constexpr std::size_t kLarge = 2 * RelayDownloads::kPartBytes + 1234;

class RelayDownloadsTest : public testing::Test {
 protected:
  RelayDownloadsTest() { connection.flush(std::chrono::seconds(5)); }
  ~RelayDownloadsTest() override { connection.close(); }

  /// Fetches a file at the node "b".
  HttpResponse fetch(const std::string& node, const std::string& path) {
    std::promise<HttpResponse> answered;
    b.fetch(node, path, [&](HttpResponse response) { answered.set_value(std::move(response)); });
    return answered.get_future().get();
  }
  static std::string make_content(std::size_t size) {
    std::string content(size, '\0');
    for (std::size_t i = 0; i < size; ++i) content[i] = static_cast<char>(i * 31 >> 8);
    return content;
  }

  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  ManualClock clock;
  Downloads files_a{2 * kLarge, "a"};
  Downloads files_b{kLarge, "b"};
  RelayDownloads a{"a", connection, files_a, clock};
  RelayDownloads b{"b", connection, files_b, clock};
};

TEST_F(RelayDownloadsTest, AFileArrivesOnceAndWhole) {
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{5}, RelayDownloads::kPartBytes, kLarge}) {
    const std::string content = make_content(size);
    const std::string path = files_a.add({"s1.vatrec", content}, clock.now()).value();
    const HttpResponse response = fetch("a", path);
    EXPECT_EQ(response.status, 200) << size;
    EXPECT_TRUE(response.body == content) << size;
    const std::pair<std::string, std::string> name{"Content-Disposition",
                                                   "attachment; filename=\"s1.vatrec\""};
    EXPECT_EQ(std::ranges::count(response.headers, name), 1) << size;
    EXPECT_EQ(fetch("a", path).status, 404) << size;
    EXPECT_EQ(files_a.forget_old(clock.now()), 0U) << size;
    EXPECT_EQ(files_b.forget_old(clock.now()), 0U) << size << ": room that remains";
  }
}

TEST_F(RelayDownloadsTest, APartHasABoundedSize) {
  std::atomic<std::size_t> greatest = 0;
  std::atomic<int> parts = 0;
  const auto subscription = connection.subscribe("_INBOX.>", [&](const NatsMessage& message) {
    greatest = std::max(greatest.load(), message.data.size());
    ++parts;
  });
  connection.flush(std::chrono::seconds(5));
  const std::string path = files_a.add({"f", make_content(kLarge)}, clock.now()).value();
  EXPECT_EQ(fetch("a", path).status, 200);
  connection.flush(std::chrono::seconds(5));
  EXPECT_GE(parts, 3);
  EXPECT_LE(greatest, RelayDownloads::kPartBytes + 100);  // the first line
}

TEST_F(RelayDownloadsTest, AFailureHasAStatus) {
  const std::string large = files_a.add({"f", make_content(kLarge)}, clock.now()).value();
  const auto taken = files_b.reserve(1, clock.now());
  ASSERT_TRUE(taken);
  EXPECT_EQ(fetch("a", large).status, 503) << "no room at the node";
  EXPECT_EQ(files_b.forget_old(clock.now()), 1U);
  const struct {
    const char* node;
    const char* path;
    int status;
  } cases[] = {{"a", "/downloads/a/unknown", 404},
               {"a", "/downloads/a/\xff", 404},
               {"a.>", "/downloads/a.>/x", 404},
               {"", "/downloads//x", 404},
               {"c", "/downloads/c/x", 503}};
  for (const auto& one : cases) EXPECT_EQ(fetch(one.node, one.path).status, one.status) << one.path;
}

TEST_F(RelayDownloadsTest, OtherMessagesAreNoFiles) {
  const auto foreign =
      connection.subscribe(RelayDownloads::subject_of("z"), [&](const NatsMessage& request) {
        const Json wanted = Json::parse(request.data);
        const std::string path = wanted.at("path");
        connection.publish(request.reply_to, path);
      });
  connection.flush(std::chrono::seconds(5));
  const struct {
    const char* reply;
    int status;
  } cases[] = {{"no line", 404},
               {"no JSON\nbytes", 404},
               {"{\"name\":\"f\"}\nbytes", 404},
               {"{\"name\":\"f\",\"size\":3}\nbytes", 404},
               {"{\"name\":\"f\",\"size\":3}\n", 404},
               {"{\"name\":\"f\",\"size\":\"3\"}\nbyt", 503}};
  for (const auto& one : cases) EXPECT_EQ(fetch("z", one.reply).status, one.status) << one.reply;
}

}  // namespace
}  // namespace vat::test::relay_downloads_test
