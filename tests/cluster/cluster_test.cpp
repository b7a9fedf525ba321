#include <gmock/gmock.h>

#include <csignal>
#include <future>
#include <iostream>

#include "protocol/client/client.h"
#include "server/cluster/cluster_streams.h"
#include "server/cluster/lease.h"
#include "server/cluster/log_records.h"
#include "server/cluster/session_reader.h"
#include "server/nats/bucket.h"
#include "tests/cluster/nodes.h"
#include "tests/recovery/load.h"
#include "tests/recovery/past.h"
#include "tests/server/transport/transport_client.h"
#include "tests/support/pool_scene.h"
#include "tests/support/wait.h"

namespace vat::test::cluster_test {
namespace {

constexpr const char* kSession = "s1";
const Json kGravity{{"gravity", {0, 0, -9}}};

/// The log of a session, and for each owner the last position that the next owner repeats.
struct ClusterPast {
  StoredPast past;
  std::vector<std::uint64_t> ends;
};

ClusterPast read_cluster_log(const std::vector<std::string>& urls) {
  NatsConnection connection({urls, "test", {}, {}, {}, {}});
  ClusterStreams streams(connection);
  ClusterPast read;
  std::vector<LogEntry>& log = read.past.log;
  std::uint64_t position = 0;
  LogParts parts;
  for (StoredMessage& message : read_log(streams, 1, {}, last_messages(streams, 1))) {
    const auto whole = parts.take(message.headers[kPartHeader], message.data);
    if (!whole) continue;
    for (const LogRecord& record : read_records(*whole)) {
      if (const auto* entries = std::get_if<EntriesRecord>(&record)) {
        for (const LogEntry& entry : entries->entries) {
          EXPECT_EQ(entry.sequence, log.size() + 1);  // each entry once, in one order
          log.push_back(entry);
          position = std::max(position, entry.position);
        }
      } else if (const auto* refused = std::get_if<RefusedRecord>(&record)) {
        log.at(refused->sequence - 1).refused = true;
      } else if (const auto* reached = std::get_if<ReachedRecord>(&record)) {
        position = std::max(position, reached->position);
      } else if (const auto* progress = std::get_if<SessionProgress>(&record)) {
        position = std::max(position, progress->position);
      } else if (std::holds_alternative<OwnerRecord>(record)) {
        read.ends.push_back(position);
      }
    }
  }
  read.ends.push_back(position);
  read.past.name = "pool";
  read.past.position = position;
  return read;
}

void load_until(const Nodes& nodes, const std::string& node, std::size_t answers, Told& told,
                const std::function<void()>& end) {
  static std::uint64_t last_client = 0;
  std::vector<std::thread> clients;
  for (int i = 0; i < 2; ++i) {
    clients.emplace_back([&told, client = nodes.connect(node), name = ++last_client]() mutable {
      load_session(std::move(client), kSession, name, told);
    });
  }
  EXPECT_TRUE(wait_until([&] { return told.answer_count() >= answers; }));
  end();
  for (std::thread& client : clients) client.join();
}

TEST(Cluster, AKilledNodeLosesNothingThatWasAnswered) {
  Nodes nodes(3, {"--checkpoint-seconds", "3600"});  // the complete log remains
  std::vector<Told> lives(2);
  std::string asked = "a";
  std::string owner = nodes.owner_of(kSession, asked);
  for (Told& told : lives) {
    asked = nodes.others(owner).front();
    load_until(nodes, owner, 200, told, [&] { nodes.process(owner).kill(); });
    EXPECT_THAT(told.faults, testing::IsEmpty());
    const auto next = nodes.join(kSession, asked);
    EXPECT_NE(next.node, owner);
    nodes.start(owner);
    owner = next.node;
  }
  const ClusterPast log = read_cluster_log(nodes.nats().urls());
  ASSERT_EQ(log.ends.size(), 3U);
  std::multiset<std::pair<std::string, std::string>> logged;
  for (const LogEntry& entry : log.past.log) {
    if (!entry.refused) logged.emplace(entry.method, entry.params);
  }
  const TemporaryFolder scenes;
  scenes.write("pool.json", kPoolScene);
  const Catalogue catalogue = Catalogue::open(scenes.path().string()).value();
  const auto hashes = hashes_of(log.past, catalogue);
  std::size_t commands = 0;
  std::size_t states = 0;
  for (std::size_t life = 0; life < lives.size(); ++life) {
    for (const Answered& answered : lives[life].answered) {
      EXPECT_TRUE(logged.contains({answered.method, answered.params}))
          << answered.method << " " << answered.params << " is lost";
      ++commands;
    }
    for (const Seen& seen : lives[life].seen) {
      if (seen.position > log.ends[life]) continue;
      ++states;
      const auto at = hashes.find(seen.position);
      ASSERT_NE(at, hashes.end()) << seen.position;
      EXPECT_TRUE(at->second.contains(seen.hash)) << "at " << seen.position;
    }
  }
  std::cout << commands << " commands answered, " << states << " states compared\n";
  EXPECT_GT(commands, 100U);
  EXPECT_GT(states, 30U);
}

TEST(Cluster, ASessionContinuesFromItsStateWithItsParticipants) {
  Nodes nodes(2, {"--checkpoint-seconds", "0.001"});
  const std::string first = nodes.owner_of(kSession, "a");
  const std::string second = nodes.others(first).front();
  auto joined = nodes.join(kSession, second, {{"name", "Ada"}});
  EXPECT_EQ(joined.node, first);
  const Json grab = joined.client.result(
      "grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.5}}});
  Json hash;
  for (int i = 0; i < 20; ++i) {
    joined.client.result("world.set_gravity", kGravity);
    joined.client.result("control.step", {{"ticks", 2}});
    hash = joined.client.result("session.hash");
  }
  nodes.process(first).kill();
  auto back = nodes.join(kSession, second, {{"resume", joined.result.at("resume")}});
  EXPECT_EQ(back.node, second);
  EXPECT_TRUE(back.result.at("resumed"));
  EXPECT_EQ(back.result.at("participant"), joined.result.at("participant"));
  EXPECT_EQ(back.result.at("name"), "Ada");
  EXPECT_EQ(back.result.at("role"), joined.result.at("role"));
  EXPECT_GE(back.client.result("session.hash").at("position"), hash.at("position"));
  // The grab is still there, and a diverged session would be paused.
  back.client.result("grab.move", {{"grab", grab.at("grab")}, {"target", {0.4, 0.5, 0.5}}});
  back.client.wait("session.status");
}

TEST(Cluster, ASuspendedOwnerAcknowledgesNothing) {
  Nodes nodes(2);
  const std::string first = nodes.owner_of(kSession, "a");
  const std::string second = nodes.others(first).front();
  auto old = nodes.join(kSession, first);
  old.client.result("world.set_gravity", kGravity);
  nodes.signal(first, SIGSTOP);
  auto late = std::async(std::launch::async, [&old] {
    try {
      return old.client.call("world.apply_force",
                             {{"body", 2}, {"force", {0, 0, 1}}, {"duration", 0.1}});
    } catch (const Gone&) {
      return Json{{"closed", true}};
    }
  });
  EXPECT_EQ(nodes.owner_of(kSession, second, first), second);
  auto next = nodes.join(kSession, second);
  next.client.result("world.set_gravity", kGravity);
  nodes.signal(first, SIGCONT);
  const Json reply = late.get();
  EXPECT_FALSE(reply.contains("result")) << reply;
  next.client.result("world.set_gravity", kGravity);
  EXPECT_EQ(nodes.owner_of(kSession, first), second);
  const ClusterPast log = read_cluster_log(nodes.nats().urls());
  for (const LogEntry& entry : log.past.log) {
    EXPECT_NE(entry.method, "world.apply_force");
  }
}

TEST(Cluster, AStoppedNodeHandsItsSessionOver) {
  Nodes nodes(2, {"--drain-seconds", "5"});
  const std::string first = nodes.owner_of(kSession, "a");
  const std::string second = nodes.others(first).front();
  auto joined = nodes.join(kSession, first);
  const Json before = joined.client.result("world.set_gravity", kGravity);
  auto stopped = std::async(std::launch::async, [&] { return nodes.process(first).stop(); });
  const Json moved = joined.client.wait("session.moved").at("params");
  EXPECT_EQ(moved.at("session"), kSession);
  EXPECT_EQ(moved.at("url"), nodes.url(second));
  auto back = nodes.join(kSession, second, {{"resume", joined.result.at("resume")}});
  EXPECT_TRUE(back.result.at("resumed"));
  EXPECT_GE(back.result.at("tick"), before.at("tick"));
  back.client.result("world.set_gravity", kGravity);
  joined.client.close();
  EXPECT_EQ(stopped.get(), 0);
}

std::string leader_of(Stream& stream) {
  std::optional<std::string> leader;
  EXPECT_TRUE(wait_until([&] { return (leader = stream.leader()).has_value(); }));
  return *leader;
}

/// Lets this server lead the stream.
void let_lead(const std::string& server, Stream& stream) {
  ASSERT_TRUE(wait_until([&] {
    if (leader_of(stream) == server) return true;
    stream.change_leader();
    return false;
  }));
}

// NATS needs at least 4 s for the election of a leader, and a lease ends after 2 s.
TEST(Cluster, CommandsDoNotWaitForAnElection) {
  Nodes nodes(1, {"--checkpoint-seconds", "3600"});  // the complete log remains
  auto joined = nodes.join(kSession, "a");
  NatsConnection connection({nodes.nats().urls(), "test", {}, {}, {}, {}});
  ClusterStreams streams(connection);
  Stream& log = streams.logs[0];
  Stream& spare_log = streams.logs[1];
  Bucket renewals(connection, "vat-nodes", Lease::kOthersTime);
  Bucket spare_renewals(connection, "vat-spare-nodes", Lease::kOthersTime);
  const std::string server = leader_of(log);
  let_lead(server, renewals.stream());
  let_lead(server, spare_log);
  EXPECT_TRUE(wait_until([&] {
    return leader_of(spare_log) != server && leader_of(spare_renewals.stream()) != server;
  })) << "the node lets another server lead the spare streams";

  nodes.nats().kill(static_cast<std::size_t>(server.back() - '0'));
  std::size_t answered = 0;
  const auto election = std::async(std::launch::async, [&] {
    leader_of(log);
    leader_of(renewals.stream());
  });
  while (election.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    const auto begin = std::chrono::steady_clock::now();
    const Json reply = joined.client.call("world.set_gravity", kGravity);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
    if (reply.contains("result")) {
      ++answered;
    } else {  // the node is connecting to another server
      EXPECT_EQ(reply.at("error").at("data").at("kind"), "storage_failed");
    }
  }
  EXPECT_GT(answered, 0U);
  EXPECT_GT(last_messages(streams, 1)[1], 0U);
  const ClusterPast past = read_cluster_log(nodes.nats().urls());
  EXPECT_GE(past.past.log.size(), answered);
}

TEST(Cluster, WithoutNatsCommandsAreRefusedAndThenTheSessionResumes) {
  Nodes nodes(1);
  auto joined = nodes.join(kSession, "a");
  joined.client.result("world.set_gravity", kGravity);
  for (std::size_t i = 0; i < nodes.nats().size(); ++i) nodes.nats().kill(i);
  Json reply;
  EXPECT_TRUE(wait_until([&] {
    try {
      reply = joined.client.call("world.set_gravity", kGravity);
    } catch (const std::runtime_error&) {  // the lease has ended, and the connection with it
      return true;
    }
    return reply.contains("error");
  }));
  if (reply.contains("error")) {
    EXPECT_EQ(reply.at("error").at("data").at("kind"), "storage_failed");
    EXPECT_GT(reply.at("error").at("data").at("retry_after"), 0);
  }
  for (std::size_t i = 0; i < nodes.nats().size(); ++i) nodes.nats().restart(i);
  auto back = nodes.join(kSession, "a", {{"resume", joined.result.at("resume")}});
  EXPECT_TRUE(wait_until(
      [&] { return back.client.call("world.set_gravity", kGravity).contains("result"); }));
}

TEST(Cluster, AProcessWhoseNameAnotherProcessTakesServesNoSession) {
  Nodes nodes(1);
  auto joined = nodes.join(kSession, "a");
  joined.client.result("world.set_gravity", kGravity);
  NatsConnection connection({nodes.nats().urls(), "test", {}, {}, {}, {}});
  Bucket bucket(connection, "vat-nodes", Lease::kOthersTime);
  ASSERT_TRUE(wait_until([&] {
    const auto entry = bucket.get("a");
    Json other = Json::parse(entry->value);
    other["instance"] = "another process";
    try {
      bucket.put("a", other.dump(), entry->revision);
      return true;
    } catch (const NatsError&) {  // the node has renewed its entry
      return false;
    }
  }));
  EXPECT_TRUE(wait_until([&] {
    try {
      joined.client.call("world.set_gravity", kGravity);
      return false;
    } catch (const Gone&) {
      return true;
    }
  }));
  EXPECT_TRUE(wait_until([&] { return !bucket.get("a"); }));  // it is not renewed
  const std::string url = nodes.url("a");
  const auto port = static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
  for (const char* const path : {"/healthz", "/readyz"}) {
    const HttpReply reply = http(port, "GET", path);
    EXPECT_EQ(reply.status, 503) << path;
    EXPECT_EQ(Json::parse(reply.body).at("status"), "replaced") << path;
  }
}

TEST(Cluster, AClientFollowsItsSessionWhenItsNodeFails) {
  Nodes nodes(2);
  const std::string first = nodes.owner_of(kSession, "a");
  std::atomic<int> frames = 0;
  std::atomic<int> resumed = 0;
  client::Handlers handlers;
  handlers.on_frame = [&](const client::Frame&) { ++frames; };
  handlers.on_rejoined = [&](const auto& joined) { resumed += joined.resumed; };
  client::Client client(nodes.url(nodes.others(first).front()), {}, handlers);
  client::SessionJoin::Params join;
  join.session = kSession;
  EXPECT_EQ(client.call<client::SessionJoin>(join).get().session, kSession);
  client.call<client::FramesSubscribe>({}).get();
  ASSERT_TRUE(wait_until([&] { return frames > 0; }));

  nodes.process(first).kill();
  ASSERT_TRUE(wait_until([&] { return resumed == 1; }));
  frames = 0;
  ASSERT_TRUE(wait_until([&] { return frames > 0; }));
  EXPECT_EQ(client.call<client::SessionJoin>(join).get().session, kSession) << "at its new node";
}

TEST(Cluster, EachNodeListsCreatesMovesAndClosesSessions) {
  const std::string token = "a token of sufficient length";
  const TemporaryFolder folder;
  folder.write("token", token + "\n");
  Nodes nodes(2, {"--admin-token-file", folder.file("token")});
  WaitingClient a = nodes.connect("a");
  WaitingClient b = nodes.connect("b");
  const Json created = a.result("session.create", {{"name", "lake"}, {"scene", "pool"}});
  const std::string id = created.at("session");
  EXPECT_NE(id, kSession);
  const Json refused = b.call("session.create", {{"name", "lake"}, {"scene", "pool"}});
  EXPECT_EQ(refused.at("error").at("data").at("path"), "/name");
  const std::string first = nodes.owner_of(id, "a");
  EXPECT_EQ(nodes.owner_of(id, "b"), first);
  const std::string second = nodes.others(first).front();

  auto joined = nodes.join(id, second);
  EXPECT_EQ(joined.node, first);
  const Json info = joined.client.result("server.info");
  EXPECT_EQ(info.at("node"), first);
  EXPECT_EQ(info.at("nodes").size(), 2U);

  WaitingClient admin = nodes.connect(first);
  admin.result("access.enter", {{"token", token}});
  const Json move{{"session", id}, {"node", second}};
  const int request = admin.send("server.move", move);
  const int same_request = admin.send("server.move", move);
  EXPECT_EQ(admin.wait(request).at("result").at("url"), nodes.url(second));
  const Json same = admin.wait(same_request);  // the session has possibly moved before
  EXPECT_TRUE(same.contains("result") ? same.at("result").at("url") == nodes.url(second)
                                      : same.at("error").at("code") == 1012)
      << same;
  EXPECT_EQ(joined.client.wait("session.moved").at("params").at("url"), nodes.url(second));
  EXPECT_EQ(nodes.owner_of(id, first, first), second);
  EXPECT_EQ(admin.call("server.move", {{"session", id}, {"node", first}}).at("error").at("code"),
            1012);
  EXPECT_EQ(admin.call("session.close", {{"session", id}}).at("error").at("code"), 1012);

  WaitingClient there = nodes.connect(second);
  there.result("access.enter", {{"token", token}});
  there.result("session.join", {{"session", id}});  // waits for the session
  EXPECT_EQ(
      there.call("server.move", {{"session", id}, {"node", "z"}}).at("error").at("data").at("path"),
      "/node");
  const Json renamed = there.call("session.configure", {{"name", "pool"}});
  EXPECT_EQ(renamed.at("error").at("data").at("path"), "/name");
  there.result("session.configure", {{"name", "sea"}});
  admin.result("session.create", {{"name", "lake"}, {"scene", "pool"}});
  there.result("session.close", {{"session", id}});
  EXPECT_TRUE(wait_until([&] {
    const Json listed = admin.result("session.list");
    return listed.at("sessions").size() == 2;
  }));
  admin.result("session.create", {{"name", "sea"}, {"scene", "pool"}});
}

}  // namespace
}  // namespace vat::test::cluster_test
