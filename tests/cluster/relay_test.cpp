// Nodes that relay the messages and frames of sessions on other nodes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <vector>

#include "protocol/client/client.h"
#include "server/relay/frame_facts.h"
#include "server/relay/frame_state.h"
#include "server/relay/relay_feed.h"
#include "server/relay/relay_message.h"
#include "tests/cluster/nodes.h"
#include "tests/cluster/received_frames.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/wait.h"

namespace vat::test::relay_test {
namespace {

constexpr const char* kSession = "s1";
const std::vector<std::string> kRelay{"--route", "relay"};

TEST(RelayMessages, AreReadAsTheyWereWritten) {
  const RelayMessage written{RelayKind::frame,   "a.x.7", 12, true, {{"code", 4003}},
                             "body\nand \0 more"};
  const auto read = read_relay_message(write_relay_message(written));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->kind, written.kind);
  EXPECT_EQ(read->link, written.link);
  EXPECT_EQ(read->number, written.number);
  EXPECT_EQ(read->is_part, written.is_part);
  EXPECT_EQ(read->fields, written.fields);
  EXPECT_EQ(read->body, written.body);
  for (const char* const bytes :
       {"", "{}", "{}\n", "no JSON\n",
        R"({"kind":"steal","link":"a","number":1,"is_part":false,"fields":{}})"
        "\n",
        R"({"kind":"text","link":"a","number":1,"is_part":false,"fields":[]})"
        "\n",
        R"({"kind":"text","link":"a","number":"1","is_part":false,"fields":{}})"
        "\n"}) {
    EXPECT_FALSE(read_relay_message(bytes)) << bytes;
  }
}

TEST(RelayMessages, AreJoinedFromTheirParts) {
  RelayInput input;
  const auto take = [&](std::uint64_t number, bool is_part, const char* body) {
    RelayMessage message{RelayKind::text, "a.x.7", number, is_part, Json::object(), body};
    const RelayInput::Taken taken = input.take(message);
    return std::pair(taken, message.body);
  };
  EXPECT_EQ(take(1, false, "one"), std::pair(RelayInput::Taken::whole, std::string("one")));
  EXPECT_EQ(take(2, true, "t").first, RelayInput::Taken::part);
  EXPECT_EQ(take(3, true, "w").first, RelayInput::Taken::part);
  EXPECT_EQ(take(4, false, "o"), std::pair(RelayInput::Taken::whole, std::string("two")));
  EXPECT_EQ(take(5, false, ""), std::pair(RelayInput::Taken::whole, std::string()));
  EXPECT_EQ(take(7, false, "").first, RelayInput::Taken::lost);
}

TEST(RelayFrames, FactsAreReadAsTheyWereWritten) {
  FrameFacts facts{{}, 0.25};
  EXPECT_FALSE(read_frame_facts(write_frame_facts(facts)).vat);
  facts.vat = Vat{{0, -1, 2}, {3, 4, 5}, false, SlideMotion{{1, 2, 0}, 0.5, 3}, {}};
  const FrameFacts read = read_frame_facts(write_frame_facts(facts));
  EXPECT_EQ(read.default_error, 0.25);
  ASSERT_TRUE(read.vat && read.vat->motion);
  EXPECT_EQ(read.vat->min, facts.vat->min);
  EXPECT_EQ(read.vat->max, facts.vat->max);
  EXPECT_EQ(read.vat->motion->axis, facts.vat->motion->axis);
  EXPECT_EQ(read.vat->motion->stroke, 0.5);
}

// A relay quantises the state of a decoded frame again.
TEST(RelayFrames, AStateHasTheContentOfItsFrame) {
  const ByAttribute<bool> all{true, true, true, true};
  const PublishedState published = publish(
      make_simulation(make_wet_mixture(IntegratorId::velocity_verlet, PressureSolver::tait)), all);
  const FrameScale scale{make_frame_grid({-1, -1, -1}, {2, 2, 2}, 1e-4), {1e-3, 1e-2, 0.1, 1e-3}};
  GridFrame frame;
  make_grid_frame(published, scale, frame);
  PublishedState state;
  for (int repetition = 0; repetition < 2; ++repetition) {  // the second one reuses the memory
    read_frame_state(frame, state);
    EXPECT_EQ(state.header.tick, frame.header.tick);
    ASSERT_EQ(state.bodies.size(), published.bodies.size());
    for (std::size_t b = 0; b < state.bodies.size(); ++b) {
      EXPECT_EQ(state.bodies[b].id, published.bodies[b].id);
      EXPECT_EQ(state.bodies[b].kind, published.bodies[b].kind);
      EXPECT_GE(state.bodies[b].bounding_radius, published.bodies[b].bounding_radius);
    }
    GridFrame again;
    make_grid_frame(state, scale, again);
    EXPECT_TRUE(show_the_same(frame, again));
  }
}

TEST(Relay, GivesTheAnswersAndFramesOfTheOwner) {
  Nodes nodes(2, kRelay);
  const std::string owner = nodes.owner_of(kSession, "a");
  const std::string relay = nodes.others(owner).front();
  Received direct;
  Received relayed;
  client::Client at_owner(nodes.url(owner), {}, direct.handlers());
  client::Client at_relay(nodes.url(relay), {}, relayed.handlers());
  client::SessionJoin::Params join;
  join.session = kSession;
  at_owner.call<client::SessionJoin>(join).get();
  const auto joined = at_relay.call<client::SessionJoin>(join).get();
  EXPECT_EQ(joined.session, kSession);
  EXPECT_EQ(joined.participants.size(), 2U);
  const auto paused = at_relay.call<client::ControlPause>({}).get();
  client::FramesSubscribe::Params wish;
  wish.max_error = 1e-3;
  at_owner.call<client::FramesSubscribe>(wish).get();
  at_relay.call<client::FramesSubscribe>(wish).get();
  ASSERT_TRUE(wait_until([&] { return direct.count > 0 && relayed.count > 0; }));
  const auto stepped = at_relay.call<client::ControlStep>({}).get();
  EXPECT_EQ(stepped.tick, paused.tick + 1);
  ASSERT_TRUE(wait_until([&] {
    const std::scoped_lock lock(direct.mutex, relayed.mutex);
    return direct.tick == stepped.tick && relayed.tick == stepped.tick;
  }));
  const std::scoped_lock lock(direct.mutex, relayed.mutex);
  expect_same_positions(direct, relayed);
  EXPECT_FALSE(relayed.has_speed);
}

/// A viewer at a relay, whose session is paused.
struct ViewerOfPause {
  ViewerOfPause() {
    client::SessionJoin::Params join;
    join.session = kSession;
    client.call<client::SessionJoin>(join).get();
    client.call<client::ControlPause>({}).get();
    client.call<client::FramesSubscribe>({}).get();
  }

  Nodes nodes{2, kRelay};
  Received received;
  client::Client client{
      nodes.url(nodes.others(nodes.owner_of(kSession, "a")).front()), {}, received.handlers()};
};

// The frame of the new epoch may be faster than its description.
TEST(Relay, AViewerOfAPausedSessionSeesItsReset) {
  ViewerOfPause paused;
  client::Client& viewer = paused.client;
  Received& relayed = paused.received;
  for (int i = 0; i < 5; ++i) {
    const auto stepped = viewer.call<client::ControlStep>({}).get();
    ASSERT_TRUE(wait_until([&] {
      const std::lock_guard lock(relayed.mutex);
      return relayed.tick == stepped.tick;
    }));
    viewer.call<client::ControlReset>({}).get();
    ASSERT_TRUE(wait_until([&] {
      const std::lock_guard lock(relayed.mutex);
      return relayed.tick == 0;
    })) << i;
  }
}

TEST(Relay, AViewerGetsTheAttributesThatItWants) {
  ViewerOfPause paused;
  client::Client& viewer = paused.client;
  Received& relayed = paused.received;
  ASSERT_TRUE(wait_until([&] { return relayed.count > 0; }));
  client::FramesSubscribe::Params wish;
  wish.attributes = client::FramesSubscribe::Params::Attributes{.speed = 0.01};
  viewer.call<client::FramesSubscribe>(wish).get();
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard lock(relayed.mutex);
    return relayed.has_speed;
  }));
  viewer.call<client::FramesUnsubscribe>({}).get();
}

TEST(Relay, OneStreamOfFramesServesAllViewers) {
  Nodes nodes(2, kRelay);
  const std::string owner = nodes.owner_of(kSession, "a");
  const std::string relay = nodes.others(owner).front();
  NatsConnection connection({nodes.nats().urls(), "test", {}, {}, {}, {}});
  std::mutex mutex;
  std::set<std::string> subjects;
  const auto subscription =
      connection.subscribe("vat.relay." + relay + ".feed.*", [&](const NatsMessage& message) {
        const std::lock_guard lock(mutex);
        subjects.insert(message.subject);
      });
  connection.flush(std::chrono::seconds(5));
  Received received[3];
  std::vector<std::unique_ptr<client::Client>> viewers;
  for (Received& one : received) {
    viewers.push_back(
        std::make_unique<client::Client>(nodes.url(relay), client::Options{}, one.handlers()));
    client::SessionJoin::Params join;
    join.session = kSession;
    viewers.back()->call<client::SessionJoin>(join).get();
    viewers.back()->call<client::FramesSubscribe>({}).get();
  }
  ASSERT_TRUE(wait_until([&] {
    return std::ranges::all_of(received, [](const Received& one) { return one.count > 3; });
  }));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(subjects.size(), 1U);
}

TEST(Relay, RolesAndErrorsAreThoseOfTheOwner) {
  Nodes nodes(2, kRelay);
  const std::string owner = nodes.owner_of(kSession, "a");
  const std::string relay = nodes.others(owner).front();
  auto joined = nodes.join(kSession, relay, {{"role", "viewer"}, {"name", "Ada"}});
  EXPECT_EQ(joined.node, relay);
  EXPECT_EQ(joined.result.at("role"), "viewer");
  EXPECT_EQ(joined.result.at("name"), "Ada");
  const Json refused = joined.client.call("world.set_gravity", {{"gravity", {0, 0, -1}}});
  EXPECT_EQ(refused.at("error").at("data").at("kind"), "not_allowed") << refused;
  const Json invalid = joined.client.call("frames.subscribe", {{"every", 0}});
  EXPECT_EQ(invalid.at("error").at("data").at("path"), "/every") << invalid;
  EXPECT_TRUE(joined.client.result("session.leave").contains("tick"));
  const Json outside = joined.client.call("session.hash");
  EXPECT_EQ(outside.at("error").at("data").at("kind"), "not_joined") << outside;
  auto other = nodes.join(kSession, owner);
  ASSERT_TRUE(wait_until([&] {
    return other.client.result("presence.list").dump().find("Ada") == std::string::npos;
  }));
  const Json missing = joined.client.call("session.join", {{"session", "s99"}});
  EXPECT_EQ(missing.at("error").at("data").at("kind"), "no_such_session");
}

// The node with the most unused cores creates a session.
TEST(Relay, ACreatorOwnsItsSessionOnAnotherNode) {
  Nodes nodes(2, kRelay, {{"a", 1}, {"b", 8}});
  WaitingClient creator = nodes.connect("a");
  // On a busy machine, the entry of the other node may be late. Then the first node has the
  // session.
  std::string id;
  std::string name = "lake";
  ASSERT_TRUE(wait_until([&] {
    name += "s";  // that of a closed session may still be in use
    const Json reply = creator.call("session.create", {{"name", name}, {"scene", "pool"}});
    if (!reply.contains("result")) return false;  // too many scenes per second
    id = reply.at("result").at("session");
    if (nodes.owner_of(id, "a") == "b") return true;
    creator.result("session.close", {{"session", id}});
    return false;
  }));
  const Json joined = creator.result("session.join", {{"session", id}});
  EXPECT_EQ(joined.at("role"), "owner");
  creator.result("session.close", {{"session", id}});
  EXPECT_EQ(creator.wait("session.closed").at("params").at("session"), id);
}

/// Checks that a viewer at a relay continues after the end of the owner.
void expect_continuation(Nodes& nodes, const std::function<void(const std::string&)>& end_owner) {
  const std::string owner = nodes.owner_of(kSession, "a");
  Received received;
  std::atomic<int> resumed = 0;
  client::Handlers handlers = received.handlers();
  handlers.on_rejoined = [&](const client::SessionJoin::Result& joined) {
    resumed += joined.resumed;
  };
  client::Client viewer(nodes.url(nodes.others(owner).front()), {}, handlers);
  client::SessionJoin::Params join;
  join.session = kSession;
  // A node whose lease has lapsed for a moment closes the connection, and the client reconnects.
  ASSERT_TRUE(wait_until([&] {
    try {
      viewer.call<client::SessionJoin>(join).get();
      viewer.call<client::FramesSubscribe>({}).get();
      return true;
    } catch (const client::CallError& error) {
      if (error.kind() != "disconnected") throw;
      return false;
    }
  }));
  ASSERT_TRUE(wait_until([&] { return received.count > 0; }));
  end_owner(owner);
  ASSERT_TRUE(wait_until([&] { return resumed > 0; }));
  received.count = 0;
  ASSERT_TRUE(wait_until([&] { return received.count > 0; }));
}

TEST(Relay, AClientContinuesWhenTheOwnerFails) {
  Nodes nodes(3, kRelay);
  expect_continuation(nodes, [&](const std::string& owner) { nodes.process(owner).kill(); });
}

TEST(Relay, AClientContinuesWhenTheOwnerStops) {
  Nodes nodes(3, {"--route", "relay", "--drain-seconds", "5"});
  expect_continuation(nodes, [&](const std::string& owner) { nodes.process(owner).stop(); });
}

TEST(Relay, AClientContinuesWhenTheOwnerIsRestarted) {
  Nodes nodes(2, kRelay);
  expect_continuation(nodes, [&](const std::string& owner) {
    nodes.process(owner).kill();
    nodes.start(owner);
  });
}

TEST(Relay, AClientContinuesAfterAnEndOfNats) {
  Nodes nodes(2, kRelay);
  expect_continuation(nodes, [&](const std::string&) {
    for (std::size_t n = 0; n < nodes.nats().size(); ++n) nodes.nats().kill(n);
    for (std::size_t n = 0; n < nodes.nats().size(); ++n) nodes.nats().restart(n);
  });
}

// With access by token, the owner decides about the token once.
TEST(Relay, ATokenCountsOnceForAConnection) {
  constexpr const char* kAdmin = "the admin's token of the cluster";
  TemporaryFolder folder;
  folder.write("admin", std::string(kAdmin) + "\n");
  folder.write("key", "a key of the cluster with sufficient length\n");
  Nodes nodes(2, {"--route", "relay", "--access", "token", "--admin-token-file",
                  folder.file("admin"), "--cluster-key-file", folder.file("key")});
  WaitingClient admin = nodes.connect("a");
  admin.result("access.enter", {{"token", kAdmin}});
  admin.result("session.join", {{"session", kSession}});
  const std::string token =
      admin.result("session.invite", {{"role", "controller"}, {"uses", 1}}).at("token");
  const std::string owner = admin.result("session.list").at("sessions").at(0).at("node");
  const std::string relay = nodes.others(owner).front();
  WaitingClient guest = nodes.connect(relay);
  guest.result("access.enter", {{"token", token}});
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(guest.result("session.join", {{"session", kSession}}).at("role"), "controller");
    guest.result("session.leave");
  }
  WaitingClient late = nodes.connect(relay);
  late.result("access.enter", {{"token", token}});  // the relay cannot count the uses
  const Json refused = late.call("session.join", {{"session", kSession}});
  EXPECT_EQ(refused.at("error").at("data").at("kind"), "not_authenticated") << refused;
}

// The owner drops the participants of a relay that has failed.
TEST(Relay, AFailedRelayLeavesNoParticipant) {
  Nodes nodes(2, {"--route", "relay", "--resume-seconds", "0"});
  const std::string owner = nodes.owner_of(kSession, "a");
  const std::string relay = nodes.others(owner).front();
  auto at_owner = nodes.join(kSession, owner);
  auto at_relay = nodes.join(kSession, relay);
  const auto people = [&] {
    return at_owner.client.result("presence.list").at("participants").size();
  };
  EXPECT_EQ(people(), 2U);
  nodes.process(relay).kill();
  ASSERT_TRUE(wait_until([&] { return people() == 1; }));
}

}  // namespace
}  // namespace vat::test::relay_test
