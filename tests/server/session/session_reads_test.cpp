// Reads of a session: shared results, budgets, and independence of the session.

#include "server/session/session_reads.h"

#include <thread>

#include "server/session/core/session_core.h"
#include "server/session/core/session_view.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/lone_environment.h"

namespace vat::test::session_reads_test {
namespace {

using namespace std::chrono_literals;

struct Reader {
  std::shared_ptr<FakeConnection> connection;
  std::shared_ptr<ClientOutbox> outbox;
};

class SessionReadsTest : public testing::Test {
 protected:
  SessionReadsTest() {
    environment.limits.burst_seconds = 1;
    // The processor time of a read depends on the machine.
    environment.limits.max_read_seconds_per_second = 1000;
    environment.limits.max_session_read_seconds_per_second = 1000;
    environment.limits.max_read_bytes_per_second = 1000;
    environment.limits.max_session_read_bytes_per_second = 2500;
  }
  Reader connect() {
    Reader reader;
    reader.connection = std::make_shared<FakeConnection>(++last_id_);
    reader.outbox = std::make_shared<ClientOutbox>(reader.connection);
    reader.outbox->set_read_budget(client_read_budget(environment.limits, environment.clock.now()));
    return reader;
  }
  /// Adds a read whose result has about `bytes` bytes.
  void add(SessionReads& reads, const Reader& reader, const std::string& key, std::size_t bytes) {
    Read read{true,
              [this, bytes](SessionView& view) -> RpcResult {
                ++computed;
                return Json{{"time", view.simulation().time()}, {"text", std::string(bytes, 'x')}};
              },
              {}};
    reads.add({PendingReply(reader.outbox, Json(key)), std::move(read), key});
  }
  /// Runs the batch on another thread, because it lowers the thread's priority.
  static void run(const std::shared_ptr<ReadBatch>& batch) {
    ASSERT_NE(batch, nullptr);
    std::thread([&] { batch->run(); }).join();
  }
  void run_all(SessionReads& reads) {
    run(reads.begin_batch(core.run()));
    reads.end_batch();
  }

  LoneEnvironment environment;
  SessionCore core{"s", SessionSettings{"n"}, mixed_simulation(), environment.shared};
  int computed = 0;

 private:
  ConnectionId last_id_ = 0;
};

TEST_F(SessionReadsTest, EqualReadsShareOneResult) {
  SessionReads reads(environment.shared);
  const Reader a = connect();
  const Reader b = connect();
  add(reads, a, "same", 100);
  add(reads, b, "same", 100);
  add(reads, b, "other", 100);
  run_all(reads);
  EXPECT_EQ(computed, 2);
  ASSERT_EQ(a.connection->tails().size(), 1U);
  ASSERT_EQ(b.connection->tails().size(), 2U);
  EXPECT_EQ(a.connection->tails()[0], b.connection->tails()[0]);
  EXPECT_NE(b.connection->tails()[0], b.connection->tails()[1]);
  const Json text = a.connection->texts().at(0);
  EXPECT_EQ(text.at("id"), "same");
  EXPECT_EQ(text.at("result").at("tick"), 0);
}

// The session continues while the read thread computes.
TEST_F(SessionReadsTest, AreOfTheStateAtTheirStart) {
  SessionReads reads(environment.shared);
  const Reader a = connect();
  add(reads, a, "early", 1);
  const auto early = reads.begin_batch(core.run());
  for (int i = 0; i < 5; ++i) core.tick(environment.clock.now(), false);
  add(reads, a, "late", 1);
  EXPECT_EQ(reads.begin_batch(core.run()), nullptr) << "one batch is computed at a time";
  run(early);
  reads.end_batch();
  run_all(reads);
  const auto texts = a.connection->texts();
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_EQ(texts[0].at("result").at("tick"), 0);
  EXPECT_EQ(texts[0].at("result").at("time"), 0);
  EXPECT_EQ(texts[1].at("result").at("tick"), 5);
  EXPECT_DOUBLE_EQ(texts[1].at("result").at("time"), 0.1);
  EXPECT_EQ(reads.begin_batch(core.run()), nullptr) << "no read waits";
}

TEST_F(SessionReadsTest, BeyondTheBytesOfTheirClientAreRefusedForATime) {
  SessionReads reads(environment.shared);
  const Reader a = connect();
  add(reads, a, "1", 1400);
  add(reads, a, "2", 10);
  run_all(reads);
  ASSERT_EQ(a.connection->texts().size(), 2U);
  const Json error = a.connection->texts()[1].at("error");
  EXPECT_EQ(error.at("code"), 1009);
  EXPECT_EQ(error.at("data").at("limit"), "read_bytes_per_second");
  EXPECT_EQ(error.at("data").at("maximum"), 1000);
  const double retry_after = error.at("data").at("retry_after");
  EXPECT_NEAR(retry_after, 0.45, 0.05) << "about 450 bytes too many";
  add(reads, a, "3", 10);
  EXPECT_EQ(reads.begin_batch(core.run()), nullptr) << "refused before a view is made";
  EXPECT_TRUE(a.connection->texts().back().contains("error"));
  environment.clock.advance(
      std::chrono::ceil<SteadyClock::duration>(std::chrono::duration<double>(retry_after)));
  add(reads, a, "4", 10);
  run_all(reads);
  EXPECT_TRUE(a.connection->texts().back().contains("result"));
}

TEST_F(SessionReadsTest, OfAllClientsHaveABudgetToo) {
  SessionReads reads(environment.shared);
  std::vector<Reader> readers;
  for (int i = 0; i < 4; ++i) {
    readers.push_back(connect());
    add(reads, readers.back(), std::to_string(i), 900);
  }
  run_all(reads);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(readers[i].connection->texts().at(0).contains("result"));
  }
  const Json error = readers[3].connection->texts().at(0).at("error");
  EXPECT_EQ(error.at("data").at("limit"), "session_read_bytes_per_second");
}

// A client that sends reads quickly must not fill its queue by their results.
TEST_F(SessionReadsTest, AreRefusedIfTheirResultsWouldFillTheQueueOfTheClient) {
  environment.limits.max_read_bytes_per_second = 1e8;
  environment.limits.max_session_read_bytes_per_second = 1e8;
  const std::size_t maximum = environment.limits.max_control_queue_bytes;
  for (const std::size_t bytes : {maximum / 3, maximum + 1}) {
    SessionReads reads(environment.shared);
    const Reader slow = connect();
    const Reader other = connect();
    slow.connection->stall(true);
    for (int i = 0; i < 5; ++i) add(reads, slow, "same", bytes);
    add(reads, other, "same", bytes);
    run_all(reads);
    EXPECT_FALSE(slow.connection->close_code().has_value()) << bytes;
    const auto texts = slow.connection->texts();
    ASSERT_EQ(texts.size(), 5U);
    EXPECT_TRUE(texts.front().contains("result"));
    EXPECT_TRUE(other.connection->texts().at(0).contains("result"));
    const Json error = texts.back().at("error");
    EXPECT_EQ(error.at("code"), 1009);
    EXPECT_EQ(error.at("data").at("limit"), "control_queue_bytes");
    EXPECT_GT(error.at("data").at("retry_after"), 0);
    slow.connection->stall(false);
    add(reads, slow, "same", bytes);
    run_all(reads);
    EXPECT_TRUE(slow.connection->texts().back().contains("result"));
  }
}

TEST_F(SessionReadsTest, ThatFailAreAnsweredEach) {
  SessionReads reads(environment.shared);
  const Reader a = connect();
  for (const char* id : {"1", "2"}) {
    Read read{false, [](SessionView&) -> RpcResult { throw std::runtime_error("no memory"); }, {}};
    reads.add({PendingReply(a.outbox, Json(id)), std::move(read), "key"});
  }
  run_all(reads);
  ASSERT_EQ(a.connection->texts().size(), 2U);
  for (const Json& text : a.connection->texts()) EXPECT_EQ(text.at("error").at("code"), -32603);
}

TEST_F(SessionReadsTest, AreAnsweredThoughTheConnectionOfAnotherFails) {
  SessionReads reads(environment.shared);
  const Reader failing = connect();
  const Reader other = connect();
  failing.connection->fail(true);
  add(reads, failing, "1", 10);
  add(reads, other, "2", 10);
  run_all(reads);
  EXPECT_EQ(other.connection->texts().size(), 1U);
}

// The strand of the session executes commands. It must not execute long ones.
TEST_F(SessionReadsTest, AreAllMethodsWithALongResult) {
  const std::pair<const char*, Json> methods[] = {
      {"state.query", Json::object()},  {"state.connections", Json::object()},
      {"scene.get", Json::object()},    {"scene.get", {{"current", true}}},
      {"session.hash", Json::object()}, {"session.stats", {{"diagnostics", true}}},
  };
  Participant& participant = core.participants().add("n", Role::owner);
  for (const auto& [name, params] : methods) {
    const SessionCommand command = environment.shared.methods.make(name, params);
    const ParticipantCommand by_participant{participant.number, command};
    const auto results = core.execute(core.prepare({&by_participant, 1}), {});
    ASSERT_TRUE(std::holds_alternative<Read>(results.front())) << name;
    const Read& read = std::get<Read>(results.front());
    SessionView view(std::as_const(core).run(), read.needs_state);
    EXPECT_TRUE(std::holds_alternative<Json>(read.make(view))) << name << params;
  }
}

// The statistics are copied when the request is executed, and then belong to the request.
TEST_F(SessionReadsTest, DifferIfTheirCopiedValuesDiffer) {
  const auto copied = [this] {
    const SessionCommand command =
        environment.shared.methods.make("session.stats", {{"diagnostics", true}});
    const ParticipantCommand by_participant{1, command};
    return std::get<Read>(core.execute(core.prepare({&by_participant, 1}), {}).front()).copied;
  };
  const std::string before = copied();
  EXPECT_EQ(copied(), before);
  core.tick(environment.clock.now(), false);
  EXPECT_NE(copied(), before);
}

TEST(ReadBudget, IsExceededByBytesOrByTime) {
  const SteadyClock::time_point start;
  const auto make = [&] {
    return std::make_unique<ReadBudget>(ReadBudget::Rate{"bytes", 100},
                                        ReadBudget::Rate{"seconds", 0.1}, 2, start);
  };
  auto budget = make();
  budget->charge(200, 0.2s, start);
  EXPECT_FALSE(budget->find_excess(start)) << "at the limit";
  budget->charge(1, 0s, start);
  EXPECT_EQ(budget->find_excess(start).value().limit, "bytes");
  EXPECT_DOUBLE_EQ(budget->find_excess(start).value().retry_after.count(), 0.01);
  EXPECT_FALSE(budget->find_excess(start + 10ms));
  budget = make();
  budget->charge(0, 0.25s, start);
  const RateExcess excess = budget->find_excess(start).value();
  EXPECT_EQ(excess.limit, "seconds");
  EXPECT_DOUBLE_EQ(excess.maximum, 0.1);
  EXPECT_NEAR(excess.retry_after.count(), 0.5, 1e-9);
  EXPECT_FALSE(excess.is_flood);
}

}  // namespace
}  // namespace vat::test::session_reads_test
