// Methods and downloads at nodes that do not own the session.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/nats/stream.h"
#include "tests/cluster/nodes.h"
#include "tests/server/transport/transport_client.h"
#include "tests/support/wait.h"

namespace vat::test::any_node_test {
namespace {

constexpr const char* kSession = "s1";
constexpr const char* kAdmin = "the admin's token of the cluster";

/// Nodes with a common key, of which `owner` has the session.
class AnyNode : public testing::Test {
 protected:
  AnyNode() {
    folder.write("admin", std::string(kAdmin) + "\n");
    folder.write("key", "a key of the cluster with sufficient length\n");
  }
  void start(std::size_t count, const std::string& route,
             std::map<std::string, std::size_t> threads = {}) {
    nodes.emplace(
        count,
        std::vector<std::string>{"--route", route, "--admin-token-file", folder.file("admin"),
                                 "--cluster-key-file", folder.file("key")},
        std::move(threads));
    owner = nodes->owner_of(kSession, "a");
    relay = nodes->others(owner).front();
  }
  WaitingClient connect(const std::string& node, const std::string& token) const {
    WaitingClient client = nodes->connect(node);
    client.result("access.enter", {{"token", token}});
    return client;
  }
  HttpReply download(const std::string& node, const std::string& path) const {
    const std::string url = nodes->url(node);
    const auto end = url.rfind('/');
    const auto begin = url.rfind(':', end) + 1;
    return http(static_cast<std::uint16_t>(std::stoi(url.substr(begin, end - begin))), "GET", path);
  }
  static Json find_in_list(WaitingClient& client, const std::string& session) {
    const Json list = client.result("session.list");
    for (const Json& one : list.at("sessions")) {
      if (one.at("session") == session) return one;
    }
    return {};
  }

  TemporaryFolder folder;
  std::optional<Nodes> nodes;
  std::string owner;
  std::string relay;
};

// No client of this test has joined the session.
TEST_F(AnyNode, RelaysRequestsThatNameASession) {
  start(3, "relay");
  const std::string third = nodes->others(owner).back();
  WaitingClient admin = connect(relay, kAdmin);
  const Json ticket = admin.result("access.ticket", {{"role", "viewer"}, {"session", kSession}});
  WaitingClient guest = connect(third, ticket.at("token"));
  EXPECT_EQ(guest.result("session.join").at("role"), "viewer");

  WaitingClient stranger = nodes->connect(relay);
  const Json refused = stranger.call("replay.open", {{"session", kSession}});
  EXPECT_EQ(refused.at("error").at("data").at("kind"), "not_allowed") << refused;
  const Json opened = admin.result("replay.open", {{"session", kSession}, {"name", "the past"}});
  EXPECT_FALSE(opened.contains("ticket"));
  const std::string replay = opened.at("session");
  EXPECT_EQ(admin.result("session.join", {{"session", replay}}).at("session"), replay);

  WaitingClient other = connect(third, kAdmin);
  EXPECT_EQ(other.result("session.join", {{"session", replay}}).at("session"), replay);
  const Json listed = find_in_list(other, replay);
  EXPECT_EQ(listed.at("name"), "the past");
  EXPECT_EQ(listed.at("node"), owner);
  EXPECT_EQ(listed.at("kind"), "replay");
  EXPECT_EQ(other.result("session.close", {{"session", replay}}).count("tick"), 1U);
  EXPECT_EQ(admin.wait("session.closed").at("params").at("session"), replay);
  EXPECT_EQ(other.call("session.join", {{"session", replay}}).at("error").at("data").at("kind"),
            "no_such_session");

  const Json move{{"session", kSession}, {"node", third}};
  EXPECT_EQ(admin.result("server.move", move).at("session"), kSession);
  EXPECT_EQ(nodes->owner_of(kSession, relay, owner), third);
  Json closed;
  ASSERT_TRUE(wait_until([&] {  // until the new owner has recovered the session
    closed = admin.call("session.close", {{"session", kSession}});
    return closed.contains("result");
  })) << closed;
}

TEST_F(AnyNode, AParticipantAtARelayOwnsItsReplay) {
  start(2, "relay");
  WaitingClient client = nodes->connect(relay);
  client.result("session.join", {{"session", kSession}});
  const Json opened = client.result("replay.open", {{"session", kSession}});
  EXPECT_FALSE(opened.contains("ticket"));
  const std::string replay = opened.at("session");
  EXPECT_EQ(client.result("session.join", {{"session", replay}}).at("role"), "owner");
  EXPECT_TRUE(client.result("replay.seek", {{"position", opened.at("begin")}}).contains("tick"));
  client.result("frames.subscribe");
  const std::string token =
      client.result("session.invite", {{"role", "viewer"}, {"uses", 1}}).at("token");
  WaitingClient guest = connect(relay, token);
  EXPECT_EQ(guest.result("session.join").at("session"), replay);
  client.result("session.close", {{"session", replay}});
  EXPECT_EQ(guest.wait("session.closed").at("params").at("session"), replay);
}

TEST_F(AnyNode, AnAdminOfAConnectionIsAnAdminAtTheOwner) {
  start(2, "relay");
  WaitingClient client = nodes->connect(relay);
  client.result("session.join", {{"session", kSession}, {"role", "viewer"}});
  EXPECT_TRUE(client.call("session.close", {{"session", kSession}}).contains("error"));
  client.result("access.enter", {{"token", kAdmin}});
  client.result("session.close", {{"session", kSession}});
  EXPECT_EQ(client.wait("session.closed").at("params").at("session"), kSession);
}

TEST_F(AnyNode, ACreatorClosesItsSessionWithoutJoining) {
  start(2, "relay", {{"a", 1}, {"b", 8}});
  WaitingClient creator = nodes->connect("a");
  std::string id;
  std::string name = "lake";
  ASSERT_TRUE(wait_until([&] {  // until the node knows the unused cores of the other one
    name += "s";                // that of a closed session may still be in use
    const Json reply = creator.call("session.create", {{"name", name}, {"scene", "pool"}});
    if (!reply.contains("result")) return false;  // too many scenes per second
    id = reply.at("result").at("session");
    if (nodes->owner_of(id, "a") == "b") return true;
    creator.result("session.close", {{"session", id}});
    return false;
  }));
  WaitingClient stranger = nodes->connect("a");
  EXPECT_EQ(stranger.call("session.close", {{"session", id}}).at("error").at("data").at("kind"),
            "not_allowed");
  creator.result("session.close", {{"session", id}});
}

TEST_F(AnyNode, AParticipantAtARelayOwnsASessionOfItsScene) {
  start(2, "relay");
  WaitingClient client = nodes->connect(relay);
  client.result("session.join", {{"session", kSession}});
  const Json saved = client.result("scene.save", {{"name", "bay"}});
  EXPECT_THAT(client.result("scene.list").dump(), testing::HasSubstr("\"bay\""));
  const Json created = client.result("session.create", {{"name", "bay"}, {"scene", "bay"}});
  const Json joined = client.result("session.join", {{"session", created.at("session")}});
  EXPECT_EQ(joined.at("role"), "owner");
  client.result("session.join", {{"session", kSession}});
  client.result("scene.delete", {{"name", "bay"}, {"key", saved.at("key")}});
  EXPECT_THAT(client.result("scene.list").dump(), testing::Not(testing::HasSubstr("\"bay\"")));
}

// Results of all nodes, except ticks.
TEST_F(AnyNode, SavedDataIsTheSameAtEachNode) {
  start(3, "relay");
  std::vector<WaitingClient> clients;
  for (const char* const node : {"a", "b", "c"}) {
    clients.push_back(nodes->connect(node));
    clients.back().result("session.join", {{"session", kSession}});
  }
  const struct {
    const char* method;
    Json params;
    const char* content;  // of the result
  } cases[] = {
      {"session.saves", Json::object(), R"("name":"calm")"},
      {"scene.list", Json::object(), R"("name":"bay")"},
      {"scene.get", {{"scene", "bay"}}, R"("name":"bay")"},
      {"session.load", {{"name", "calm"}}, "{"},
      {"scene.load", {{"scene", "bay"}}, "{"},
      {"scene.levels", {{"scene", "pool"}}, R"("level":"normal")"},
  };
  std::string key;
  for (std::size_t saver = 0; saver < clients.size(); ++saver) {
    clients[saver].result("session.save", {{"name", "calm"}});
    key = clients[saver].result("scene.save", {{"name", "bay"}, {"key", key}}).value("key", key);
    for (const auto& one : cases) {
      std::vector<Json> results;
      for (WaitingClient& client : clients) {
        results.push_back(client.result(one.method, one.params));
        EXPECT_THAT(results.back().dump(), testing::HasSubstr(one.content)) << one.method;
        results.back().erase("tick");
        if (one.method != std::string("scene.levels")) {  // measured
          EXPECT_EQ(results.back(), results.front()) << one.method;
        }
      }
    }
  }
  clients[0].result("session.delete_save", {{"name", "calm"}});
  clients[1].result("scene.delete", {{"name", "bay"}, {"key", key}});
  for (WaitingClient& client : clients) {
    EXPECT_TRUE(client.result("session.saves").at("states").empty());
    EXPECT_THAT(client.result("scene.list").dump(),
                testing::Not(testing::HasSubstr(R"("name":"bay")")));
    const Json missing = client.call("session.load", {{"name", "calm"}});
    EXPECT_EQ(missing.at("error").at("data").at("path"), "/name");
    EXPECT_EQ(client.call("scene.get", {{"scene", "bay"}}).at("error").at("data").at("kind"),
              "no_such_scene");
  }
}

TEST_F(AnyNode, SavedDataOutlivesItsNodeAndGoesWithTheSession) {
  start(2, "redirect");
  auto joined = nodes->join(kSession, owner, {{"name", "Ada"}});
  joined.client.result("session.save", {{"name", "calm"}});
  joined.client.result("scene.save", {{"name", "bay"}});
  const Json before = joined.client.result("session.saves").at("states");
  nodes->process(owner).kill();
  auto next = nodes->join(kSession, relay);
  ASSERT_EQ(next.node, relay);
  EXPECT_EQ(next.client.result("session.saves").at("states"), before);
  next.client.result("control.pause");
  next.client.result("session.load", {{"name", "calm"}});
  EXPECT_EQ(next.client.result("session.hash").at("hash"), before.at(0).at("hash"));
  const Json created = next.client.result("session.create", {{"name", "bay"}, {"scene", "bay"}});
  EXPECT_EQ(created.count("session"), 1U);

  WaitingClient admin = connect(relay, kAdmin);
  admin.result("session.close", {{"session", kSession}});
  NatsConnection connection({nodes->nats().urls(), "test", {}, {}, {}, {}});
  Stream contents(connection, {"vat-saved", "vat.saved.>", Stream::Milliseconds(0), 0, {}});
  ASSERT_TRUE(wait_until([&] { return contents.subjects("vat.saved.s1.>").empty(); }));
  EXPECT_THAT(admin.result("scene.list").dump(), testing::HasSubstr(R"("name":"bay")"));
}

TEST_F(AnyNode, AnAdminSeesAllParticipantsAtEachNode) {
  for (const std::string route : {"relay", "redirect"}) {
    start(2, route);
    auto joined = nodes->join(kSession, relay, {{"name", "Ada"}});
    const std::string replay =
        joined.client.result("replay.open", {{"session", kSession}}).at("session");
    std::optional<WaitingClient> viewer(nodes->connect(joined.node));
    viewer->result("session.join", {{"session", replay}, {"name", "Bo"}});
    for (const std::string& node : {owner, relay}) {
      WaitingClient admin = connect(node, kAdmin);
      std::map<std::string, Json> sessions;
      const Json list = admin.result("server.sessions");
      for (const Json& session : list.at("sessions")) sessions[session.at("session")] = session;
      ASSERT_TRUE(sessions.contains(kSession) && sessions.contains(replay)) << list;
      for (const auto& [id, name] : {std::pair<std::string, std::string>(kSession, "Ada"),
                                     std::pair<std::string, std::string>(replay, "Bo")}) {
        const Json& session = sessions.at(id);
        EXPECT_EQ(session.at("node"), owner) << route << id;
        EXPECT_EQ(session.at("state"), node == owner ? "running" : "elsewhere") << route << id;
        EXPECT_EQ(session.at("scene"), "pool") << route << id;
        EXPECT_GT(session.at("particles"), 0) << route << id;
        EXPECT_EQ(session.at("hibernating"), false) << route << id;
        ASSERT_EQ(session.at("participants").size(), 1U) << route << id;
        const Json& person = session.at("participants").at(0);
        EXPECT_EQ(person.at("name"), name) << route;
        EXPECT_EQ(person.at("away"), false) << route;
        EXPECT_EQ(person.at("address"), "127.0.0.1") << route;
      }
    }
  }
}

TEST_F(AnyNode, ServesADownloadOfAnotherNode) {
  for (const std::string route : {"relay", "redirect"}) {
    start(3, route);
    WaitingClient client = nodes->connect(route == "relay" ? relay : owner);
    client.result("session.join", {{"session", kSession}});
    const Json made = client.result("recording.export");
    const std::string third = nodes->others(owner).back();
    const HttpReply reply = download(third, made.at("path"));
    EXPECT_EQ(reply.status, 200) << route;
    EXPECT_EQ(reply.body.size(), made.at("bytes")) << route;
    EXPECT_THAT(reply.header("Content-Disposition"), testing::HasSubstr("s1.vatrec")) << route;
    EXPECT_EQ(download(third, made.at("path")).status, 404) << route;
    const Json again = client.result("recording.export");
    EXPECT_EQ(download(owner, again.at("path")).body.size(), again.at("bytes")) << route;
  }
}

TEST_F(AnyNode, RedirectsRequestsThatNameASession) {
  start(2, "redirect");
  WaitingClient admin = connect(relay, kAdmin);
  const auto expect_moved = [&](const std::string& method, const Json& params) {
    const Json data = admin.call(method, params).at("error").at("data");
    EXPECT_EQ(data.at("kind"), "moved") << method;
    EXPECT_EQ(data.at("url"), nodes->url(owner)) << method;
  };
  expect_moved("session.close", {{"session", kSession}});
  expect_moved("access.ticket", {{"session", kSession}, {"role", "viewer"}});
  expect_moved("replay.open", {{"session", kSession}});
  expect_moved("server.move", {{"session", kSession}, {"node", relay}});
  WaitingClient there = connect(owner, kAdmin);
  const std::string replay = there.result("replay.open", {{"session", kSession}}).at("session");
  expect_moved("session.join", {{"session", replay}});
  expect_moved("session.close", {{"session", replay}});
}

}  // namespace
}  // namespace vat::test::any_node_test
