#include <gtest/gtest.h>

#include <future>

#include "server/nats/bucket.h"
#include "tests/cluster/nats_servers.h"
#include "tests/support/certificate.h"
#include "tests/support/wait.h"

namespace vat::test::nats_test {
namespace {

using std::chrono::milliseconds;

/// Returns the kind of the error that `operation` throws, or nothing.
template <class Operation>
std::optional<NatsError::Kind> failure(const Operation& operation) {
  try {
    operation();
  } catch (const NatsError& error) {
    return error.kind();
  }
  return {};
}

class Nats : public testing::Test {
 protected:
  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
};

TEST_F(Nats, AWriteToABucketRequiresTheRevisionThatItReplaces) {
  Bucket bucket(connection, "sessions", milliseconds(0));
  EXPECT_EQ(bucket.get("s1"), std::nullopt);
  const auto first = bucket.create("s1", "a");
  EXPECT_EQ(failure([&] { bucket.create("s1", "b"); }), NatsError::Kind::conflict);
  const auto second = bucket.put("s1", "c", first);
  EXPECT_EQ(failure([&] { bucket.put("s1", "d", first); }), NatsError::Kind::conflict);
  EXPECT_EQ(bucket.get("s1")->value, "c");
  EXPECT_EQ(failure([&] { bucket.remove("s1", first); }), NatsError::Kind::conflict);
  bucket.remove("s1", second);
  EXPECT_EQ(bucket.get("s1"), std::nullopt);
  bucket.create("s1", "e");
  bucket.create("s2", "f");
  EXPECT_EQ(bucket.all().size(), 2U);
}

TEST_F(Nats, ABucketOfAnOlderVersionRemembersIdentifiersLonger) {
  const auto ask = [&](const std::string& method, const Json& params) {
    return Json::parse(
        connection
            .request("$JS.API.STREAM." + method + ".KV_old", params.dump(), milliseconds(5000))
            .data);
  };
  ask("CREATE", {{"name", "KV_old"},
                 {"subjects", {"$KV.old.>"}},
                 {"storage", "file"},
                 {"max_msgs_per_subject", 1},
                 {"discard", "new"},
                 {"duplicate_window", 100'000'000}});
  Bucket bucket(connection, "old", milliseconds(0));
  EXPECT_EQ(ask("INFO", Json::object()).at("config").at("duplicate_window"), 10'000'000'000);
  EXPECT_GT(bucket.create("s1", "a"), 0U);
}

/// Concurrent writes to one key of a group of servers. The parameter: whether the key has a value.
class ConcurrentWriters : public testing::TestWithParam<bool> {};

TEST_P(ConcurrentWriters, OnlyOneReplacesARevision) {
  constexpr std::size_t kWriters = 8;
  constexpr int kRounds = 20;
  NatsServers servers(3);
  std::vector<std::unique_ptr<NatsConnection>> connections;
  std::vector<std::unique_ptr<Bucket>> buckets;
  for (std::size_t i = 0; i < kWriters; ++i) {
    connections.push_back(std::make_unique<NatsConnection>(
        NatsSettings{{servers.urls()[i % servers.size()]}, "test", {}, {}, {}, {}}));
    buckets.push_back(std::make_unique<Bucket>(*connections.back(), "sessions", milliseconds(0)));
  }
  for (int round = 0; round < kRounds; ++round) {
    const std::string key = "s" + std::to_string(round);
    const std::uint64_t revision = GetParam() ? buckets[0]->create(key, "0") : Bucket::kNone;
    std::vector<std::future<std::optional<NatsError::Kind>>> writes;
    for (std::size_t i = 0; i < kWriters; ++i) {
      writes.push_back(std::async(std::launch::async, [&, i] {
        return failure([&] { buckets[i]->put(key, std::to_string(i), revision); });
      }));
    }
    std::size_t writer = kWriters;
    for (std::size_t i = 0; i < kWriters; ++i) {
      const auto error = writes[i].get();
      if (!error) {
        EXPECT_EQ(writer, kWriters) << "another one has written";
        writer = i;
      } else {
        EXPECT_EQ(error, NatsError::Kind::conflict);
      }
    }
    EXPECT_EQ(buckets[0]->get(key)->value, std::to_string(writer));
  }
}

INSTANTIATE_TEST_SUITE_P(OfAKey, ConcurrentWriters, testing::Bool());

TEST_F(Nats, APurgeRemovesTheKeysOfAPattern) {
  Bucket bucket(connection, "sessions", milliseconds(0));
  bucket.create("s1.a", "1");
  bucket.create("s1.b", "2");
  bucket.create("s2.a", "3");
  bucket.purge("s1.>");
  ASSERT_EQ(bucket.all().size(), 1U);
  EXPECT_EQ(bucket.all().front().key, "s2.a");
  bucket.put("s1.a", "4", Bucket::kNone);  // no revision remains
}

TEST(NatsTls, AUserConnectsToServersWithTrustedCertificatesOnly) {
  const TemporaryFolder folder;
  const std::string certificate = folder.file("certificate.pem");
  write_certificate(certificate, folder.file("key.pem"), "IP:127.0.0.1");
  NatsServers servers(1, "tls { cert_file: \"" + certificate + "\", key_file: \"" +
                             folder.file("key.pem") + "\" }\n" +
                             "authorization { user: a, password: secret }\n");
  const std::string address = servers.urls().front().substr(std::string("nats://").size());
  const auto connect = [&](const std::string& user, const std::string& trusted) {
    NatsConnection connection({{"tls://" + user + address}, "test", trusted, {}, {}, {}});
    Bucket(connection, "sessions", milliseconds(0)).create("s1", "a");
  };
  EXPECT_TRUE(failure([&] { connect("a:secret@", ""); })) << "the system does not trust it";
  EXPECT_TRUE(failure([&] { connect("a:wrong@", certificate); }));
  EXPECT_TRUE(failure([&] { connect("", certificate); }));
  EXPECT_FALSE(failure([&] { connect("a:secret@", certificate); }));
}

TEST_F(Nats, AWatchReportsChangesAndRemovals) {
  Bucket bucket(connection, "sessions", milliseconds(0));
  std::mutex mutex;
  std::vector<Bucket::Entry> seen;
  const auto watch = bucket.watch([&](const Bucket::Entry& entry) {
    const std::lock_guard lock(mutex);
    seen.push_back(entry);
  });
  connection.flush(milliseconds(5000));
  const auto revision = bucket.create("s1", "a");
  bucket.remove("s1", revision);
  ASSERT_TRUE(wait_until([&] {
    const std::lock_guard lock(mutex);
    return seen.size() == 2;
  }));
  EXPECT_EQ(seen[0].key, "s1");
  EXPECT_EQ(seen[0].value, "a");
  EXPECT_EQ(seen[0].revision, revision);
  EXPECT_FALSE(seen[0].is_removed);
  EXPECT_TRUE(seen[1].is_removed);
}

TEST_F(Nats, AValueThatIsNotRenewedIsRemoved) {
  Bucket bucket(connection, "nodes", milliseconds(200));
  bucket.create("a", "1");
  EXPECT_TRUE(wait_until([&] { return !bucket.get("a"); }));
}

TEST_F(Nats, OnlyOneOfTwoWritersAppendsToASubject) {
  Stream stream(connection, {"log", "log.*", milliseconds(0), 0, {}});
  const auto first = stream.append("log.1", "a", 0);
  stream.append("log.2", "b", 0);
  EXPECT_EQ(failure([&] { stream.append("log.1", "c", 0); }), NatsError::Kind::conflict);
  const auto third = stream.append("log.1", "d", first, {{"Epoch", "7"}});
  EXPECT_EQ(stream.last("log.1")->data, "d");
  EXPECT_EQ(stream.last("log.1")->headers.at("Epoch"), "7");
  EXPECT_EQ(stream.next("log.1", first + 1)->sequence, third);
  EXPECT_FALSE(stream.next("log.1", third + 1));
  stream.purge("log.1", 1);
  EXPECT_TRUE(stream.find(first));
  stream.purge("log.1", third);
  EXPECT_FALSE(stream.find(first));
  EXPECT_EQ(stream.find(third)->data, "d");
}

TEST_F(Nats, ARequestIsAnsweredByTheSubscriber) {
  const auto subscription = connection.subscribe("echo", [&](const NatsMessage& request) {
    connection.publish(request.reply_to, request.data);
  });
  connection.flush(milliseconds(5000));
  EXPECT_EQ(connection.request("echo", "hello", milliseconds(5000)).data, "hello");
  EXPECT_EQ(failure([&] { connection.request("nobody", "hello", milliseconds(5000)); }),
            NatsError::Kind::unreachable);
}

TEST_F(Nats, WithoutServersRequestsFailUntilTheConnectionIsBack) {
  Stream stream(connection, {"log", "log.*", milliseconds(0), 0, {}});
  std::promise<void> back;
  connection.on_reconnect([&] { back.set_value(); });
  servers.kill(0);
  ASSERT_TRUE(wait_until([&] { return !connection.is_connected(); }));
  EXPECT_EQ(failure([&] { stream.append("log.1", "a", 0); }), NatsError::Kind::disconnected);
  servers.restart(0);
  back.get_future().wait();
  std::uint64_t sequence = 0;
  // JetStream reads its files after the port accepts.
  EXPECT_TRUE(
      wait_until([&] { return !failure([&] { sequence = stream.append("log.1", "a", 0); }); }));
  EXPECT_EQ(sequence, 1U);
}

}  // namespace
}  // namespace vat::test::nats_test
