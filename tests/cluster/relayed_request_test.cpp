// Requests to the owner of a session that the client has not joined, without an owner.

#include "server/relay/relayed_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>

#include "server/relay/relay_door.h"
#include "tests/cluster/nats_servers.h"
#include "tests/server/fixture/fake_connection.h"
#include "tests/support/manual_clock.h"
#include "tests/support/wait.h"

namespace vat::test::relayed_request_test {
namespace {

using std::chrono::seconds;

class RelayedRequestTest : public testing::Test {
 protected:
  RelayedRequestTest() {
    subscription = connection.subscribe("owner", [this](const NatsMessage& message) {
      const std::lock_guard lock(mutex);
      sent.push_back(read_relay_message(message.data).value());
    });
    connection.flush(seconds(5));
  }
  ~RelayedRequestTest() override { connection.close(); }

  /// Sends session.close of s1, with a token.
  std::shared_ptr<RelayedRequest> send() {
    auto request = std::make_shared<RelayedRequest>(
        RelayPlace{"s1", "b", 3, "ws://a/ws", "clients"},
        std::make_unique<RelayLine>(connection, "owner", "a.x.1"),
        RelayedRequest::Links{[this] { ++moves; }, [](Json& result) { result.erase("ticket"); }},
        clock);
    RelayEntry entry;
    entry.access = {Role::controller, "s1", true};
    entry.token = "the token";
    entry.granted = [this](const Grant& grant) { granted.push_back(grant.role); };
    request->send(PendingReply(outbox, Json(7)), entry, "session.close", {{"session", "s1"}});
    return request;
  }
  /// Passes a message of the owner.
  void receive(RelayedRequest& request, const Json& body) {
    request.receive({RelayKind::text, "a.x.1", ++number, false, Json::object(), body.dump()});
  }
  std::vector<RelayMessage> messages(std::size_t count) {
    EXPECT_TRUE(wait_until([&] {
      const std::lock_guard lock(mutex);
      return sent.size() >= count;
    }));
    const std::lock_guard lock(mutex);
    return sent;
  }
  std::string kind_of_reply() const {
    const auto texts = peer->texts();
    if (texts.empty()) return "none";
    const Json& reply = texts.front();
    return reply.contains("error") ? reply.at("error").at("data").at("kind") : Json("result");
  }

  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  std::mutex mutex;
  std::vector<RelayMessage> sent;
  std::unique_ptr<NatsConnection::Subscription> subscription;
  ManualClock clock;
  std::shared_ptr<FakeConnection> peer = std::make_shared<FakeConnection>(1, "10.0.0.7");
  std::shared_ptr<ClientOutbox> outbox = std::make_shared<ClientOutbox>(peer);
  int moves = 0;
  std::vector<Role> granted;
  std::uint64_t number = 0;
};

TEST_F(RelayedRequestTest, ShowsTheAccessOfTheClientAndPassesTheResult) {
  const auto request = send();
  auto opened = messages(2);
  EXPECT_EQ(opened[0].kind, RelayKind::open);
  EXPECT_EQ(opened[0].fields.at("address"), "10.0.0.7");
  EXPECT_EQ(opened[0].fields.at("subject"), "clients");
  EXPECT_EQ(opened[0].fields.at("access").at("role"), static_cast<int>(Role::controller));
  EXPECT_EQ(Json::parse(opened[1].body).at("params").at("token"), "the token");
  receive(*request, {{"id", "vat.enter"}, {"result", {{"role", "owner"}}}});
  opened = messages(3);
  const Json asked = Json::parse(opened[2].body);
  EXPECT_EQ(asked.at("method"), "session.close");
  EXPECT_EQ(asked.at("params").at("session"), "s1");

  receive(*request, {{"method", "server.draining"}, {"params", Json::object()}});
  EXPECT_EQ(kind_of_reply(), "none");
  receive(*request, {{"id", "vat.request"}, {"result", {{"tick", 5}, {"ticket", "t"}}}});
  EXPECT_THAT(granted, testing::ElementsAre(Role::owner));
  ASSERT_EQ(peer->texts().size(), 1U);
  EXPECT_EQ(peer->texts()[0].at("id"), 7);
  EXPECT_EQ(peer->texts()[0].at("result"), Json({{"tick", 5}}));
  EXPECT_EQ(messages(4)[3].kind, RelayKind::end);
}

TEST_F(RelayedRequestTest, AnswersOnceInEachCase) {
  const auto error = [](const char* id, const char* kind) {
    return Json{{"id", id}, {"error", {{"message", "no"}, {"data", {{"kind", kind}}}}}};
  };
  const auto end = [](RelayedRequest& request) {
    request.receive({RelayKind::end, "a.x.1", 1, false, {{"code", 1001}}, ""});
  };
  const auto lose = [](RelayedRequest& request) {
    request.receive({RelayKind::alive, "a.x.1", 2, false, Json::object(), ""});
  };
  struct Case {
    const char* name;
    std::function<void(RelayedRequest&)> happens;
    const char* kind;
    int moves;
  };
  const std::vector<Case> cases{
      {"an error", [&](auto& request) { receive(request, error("vat.request", "not_allowed")); },
       "not_allowed", 0},
      {"an invalid token",
       [&](auto& request) { receive(request, error("vat.enter", "not_authenticated")); },
       "not_authenticated", 0},
      {"a move", [&](auto& request) { receive(request, error("vat.request", "moved")); }, "moved",
       1},
      {"an end", end, "storage_failed", 0},
      {"a loss", lose, "storage_failed", 0},
      {"a silent owner",
       [&](auto& request) {
         clock.advance(kOwnerSilence + seconds(1));
         request.look();
       },
       "storage_failed", 0},
      {"a change of the owner",
       [&](auto& request) {
         request.owner_changed();  // the node that moves the session answers
         receive(request, {{"id", "vat.request"}, {"result", Json::object()}});
       },
       "result", 0},
  };
  for (const Case& one : cases) {
    peer = std::make_shared<FakeConnection>(1);
    outbox = std::make_shared<ClientOutbox>(peer);
    number = 0;
    moves = 0;
    const auto request = send();
    one.happens(*request);
    request->fail();
    EXPECT_EQ(peer->texts().size(), 1U) << one.name;
    EXPECT_EQ(kind_of_reply(), one.kind) << one.name;
    EXPECT_EQ(moves, one.moves) << one.name;
    if (moves > 0) {
      EXPECT_EQ(peer->texts()[0].at("error").at("data").at("url"), "ws://a/ws") << one.name;
    }
  }
}

TEST_F(RelayedRequestTest, AsksWhetherTheOwnerExists) {
  const auto request = send();
  messages(2);
  clock.advance(kQuestionInterval + seconds(1));
  request->look();
  EXPECT_EQ(messages(3)[2].kind, RelayKind::alive);
  receive(*request, {{"method", "server.draining"}});  // any message shows that it exists
  clock.advance(kOwnerSilence - seconds(1));
  request->look();
  EXPECT_EQ(kind_of_reply(), "none");
  request->fail();
}

// The owner may need time to decide about the token.
TEST_F(RelayedRequestTest, IsNotSentWithAnInvalidToken) {
  const auto request = send();
  receive(*request, {{"id", "vat.enter"},
                     {"error", {{"message", "no"}, {"data", {{"kind", "not_authenticated"}}}}}});
  const auto all = messages(3);
  EXPECT_EQ(all[0].kind, RelayKind::open);
  EXPECT_EQ(Json::parse(all[1].body).at("method"), "access.enter");
  EXPECT_EQ(all[2].kind, RelayKind::end);
}

// The reply may follow long after the client has ended its connection.
TEST_F(RelayedRequestTest, ExistsUntilItsReply) {
  std::weak_ptr<RelayedRequest> request = send();
  {
    const auto waiting = request.lock();
    ASSERT_TRUE(waiting);
    receive(*waiting, {{"id", "vat.enter"}, {"result", {{"role", "owner"}}}});
    receive(*waiting, {{"id", "vat.request"}, {"result", Json::object()}});
  }
  EXPECT_TRUE(request.expired());
}

}  // namespace
}  // namespace vat::test::relayed_request_test
