// Access by token in a cluster.

#include "tests/cluster/nodes.h"
#include "tests/support/wait.h"

namespace vat::test::cluster_access_test {
namespace {

constexpr const char* kAdmin = "the admin's token of the cluster";

class ClusterAccess : public testing::Test {
 protected:
  ClusterAccess() {
    folder.write("admin", std::string(kAdmin) + "\n");
    folder.write("key", "a key of the cluster with sufficient length\n");
    nodes.emplace(
        2, std::vector<std::string>{"--access", "token", "--admin-token-file", folder.file("admin"),
                                    "--cluster-key-file", folder.file("key")});
    first = enter("a", kAdmin).result("session.list").at("sessions").at(0).at("node");
    second = nodes->others(first).front();
    admin.emplace(enter(first, kAdmin));
    admin->result("session.join", {{"session", "s1"}});
  }

  WaitingClient enter(const std::string& node, const std::string& token) const {
    WaitingClient client = nodes->connect(node);
    client.result("access.enter", {{"token", token}});
    return client;
  }
  std::string invite(const Json& params) {
    return admin->result("session.invite", params).at("token");
  }
  static std::string kind_of(const Json& reply) {
    return reply.contains("error") ? reply.at("error").at("data").at("kind") : Json("result");
  }
  /// Joins at the node of the session. Returns the reply.
  Json join_at_owner(const std::string& token) const {
    WaitingClient client = nodes->connect(first);
    const Json entered = client.call("access.enter", {{"token", token}});
    return entered.contains("error") ? entered : client.call("session.join");
  }
  /// Joins at a node whose predecessor has ended. Returns the first reply that is no redirection.
  static Json join_after_end(WaitingClient& client, const Json& params = Json::object()) {
    Json reply;
    EXPECT_TRUE(wait_until([&] {  // until the node notices the silence of its predecessor
      reply = client.call("session.join", params);
      return kind_of(reply) != "moved";
    }));
    return reply;
  }

  TemporaryFolder folder;
  std::optional<Nodes> nodes;
  std::string first;   ///< node of the session
  std::string second;  ///< the other node
  std::optional<WaitingClient> admin;
};

TEST_F(ClusterAccess, AnInvitationIsUsedByTheOwnerOnly) {
  const std::string token = invite({{"role", "controller"}, {"uses", 1}});
  for (int i = 0; i < 2; ++i) {  // a redirection is no use
    WaitingClient guest = nodes->connect(second);
    const Json entered = guest.result("access.enter", {{"token", token}});
    EXPECT_EQ(entered.at("role"), "controller");
    EXPECT_EQ(entered.at("session"), "s1");
    EXPECT_EQ(kind_of(guest.call("session.create", {{"name", "own"}, {"scene", "pool"}})),
              "not_allowed");
    const Json moved = guest.call("session.join");
    ASSERT_EQ(kind_of(moved), "moved");
    EXPECT_EQ(moved.at("error").at("data").at("url"), nodes->url(first));
  }
  const Json joined = join_at_owner(token);
  ASSERT_TRUE(joined.contains("result")) << joined;
  EXPECT_EQ(joined.at("result").at("role"), "controller");
  EXPECT_EQ(kind_of(join_at_owner(token)), "not_authenticated");
}

TEST_F(ClusterAccess, ATicketForAllSessionsIsUsedOnOneNodeOnly) {
  WaitingClient other = enter(second, kAdmin);
  const std::string token = other.result("access.ticket", {{"role", "admin"}}).at("token");
  WaitingClient there = enter(first, token);
  EXPECT_EQ(there.result("session.join", {{"session", "s1"}}).at("role"), "admin");
  WaitingClient again = nodes->connect(second);
  EXPECT_EQ(kind_of(again.call("access.enter", {{"token", token}})), "not_authenticated");
  EXPECT_EQ(kind_of(again.call("session.list")), "not_authenticated");
}

TEST_F(ClusterAccess, TokensAreValidAfterTheirOwnerHasFailed) {
  const std::string used = invite({{"role", "controller"}, {"uses", 1}});
  const std::string unused = invite({{"role", "viewer"}, {"uses", 1}});
  WaitingClient guest = enter(first, used);
  const Json joined = guest.result("session.join", {{"name", "Ada"}});
  const std::string resume = joined.at("resume");

  nodes->process(first).kill();
  WaitingClient back = enter(second, resume);
  const Json reply = join_after_end(back, {{"session", "s1"}, {"resume", resume}});
  ASSERT_EQ(kind_of(reply), "result") << reply;
  const Json& resumed = reply.at("result");
  EXPECT_TRUE(resumed.at("resumed"));
  EXPECT_EQ(resumed.at("participant"), joined.at("participant"));
  EXPECT_EQ(resumed.at("name"), "Ada");
  EXPECT_EQ(resumed.at("role"), "controller");
  back.result("world.set_gravity", {{"gravity", {0, 0, -9}}});

  EXPECT_EQ(enter(second, unused).result("session.join").at("role"), "viewer");
  for (const std::string& spent : {used, unused}) {
    WaitingClient late = nodes->connect(second);
    EXPECT_EQ(kind_of(late.call("access.enter", {{"token", spent}})), "not_authenticated");
  }
}

TEST_F(ClusterAccess, TheNextOwnerDecidesAboutAWaitingClient) {
  const std::string token = invite({{"role", "controller"}, {"uses", 1}});
  ASSERT_TRUE(join_at_owner(token).contains("result"));
  nodes->process(first).kill();
  WaitingClient late = enter(second, token);  // no node has the session now
  EXPECT_EQ(kind_of(join_after_end(late)), "not_authenticated");
  EXPECT_EQ(kind_of(late.call("session.list")), "not_authenticated");
}

TEST_F(ClusterAccess, AParticipantThatWasRemovedCannotComeBack) {
  WaitingClient guest = enter(first, invite({{"role", "viewer"}}));
  const Json joined = guest.result("session.join");
  const std::string resume = joined.at("resume");
  admin->result("participant.kick", {{"participant", joined.at("participant")}});
  EXPECT_EQ(kind_of(join_at_owner(resume)), "not_authenticated");
}

TEST_F(ClusterAccess, TheTokensOfAnEndedSessionAreInvalid) {
  WaitingClient creator = enter(second, kAdmin);
  const std::string id =
      creator.result("session.create", {{"name", "lake"}, {"scene", "pool"}}).at("session");
  const Json listed = creator.result("session.list").at("sessions");
  std::string node;
  for (const Json& one : listed) {
    if (one.at("session") == id) node = one.at("node");
  }
  WaitingClient owner = enter(node, kAdmin);
  owner.result("session.join", {{"session", id}});
  const std::string token = owner.result("session.invite", {{"role", "viewer"}}).at("token");
  EXPECT_EQ(enter(node, token).result("session.join").at("session"), id);
  owner.result("session.close", {{"session", id}});
  for (const std::string& at : {first, second}) {
    EXPECT_TRUE(wait_until([&] {  // until the node knows the end
      WaitingClient late = nodes->connect(at);
      return kind_of(late.call("access.enter", {{"token", token}})) == "not_authenticated";
    }));
  }
}

}  // namespace
}  // namespace vat::test::cluster_access_test
