#include "server/cluster/session_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/thread_pool.hpp>
#include <future>
#include <random>

#include "server/cluster/session_reader.h"
#include "server/storage/sqlite/compression.h"
#include "server/support/base64.h"
#include "tests/cluster/nats_servers.h"
#include "tests/support/wait.h"

namespace vat::test::session_stream_test {
namespace {

using testing::ElementsAre;
using Failure = std::optional<StorageError::Kind>;

constexpr std::uint64_t kSession = 7;

LogEntry make_entry(std::uint64_t sequence, const std::string& params = "{}") {
  return {sequence, 10 * sequence, 10 * sequence, 1, "world.set_gravity", params, false};
}

std::vector<std::uint64_t> sequences_of(const SessionImage& image) {
  std::vector<std::uint64_t> sequences;
  for (const LogEntry& entry : image.entries) sequences.push_back(entry.sequence);
  return sequences;
}

class SessionStreamTest : public testing::Test {
 protected:
  ~SessionStreamTest() override {
    connection.close();
    threads.join();
  }

  std::shared_ptr<SessionStream> open(SessionStream::Place place) {
    place.session = kSession;
    return std::make_shared<SessionStream>(
        streams, lease, clock, threads.get_executor(), std::move(place), [this] { ++lost; },
        [this](const std::string& name) { rename(name); });
  }
  std::shared_ptr<SessionStream> create() {
    SessionStream::Place place;
    place.epoch = 1;
    return open(std::move(place));
  }
  static Failure wait(const std::function<void(Journal::Done)>& start) {
    std::promise<Failure> done;
    start([&done](Failure failure) { done.set_value(failure); });
    return done.get_future().get();
  }
  static Failure append(SessionStream& stream, const std::vector<LogEntry>& entries) {
    return wait([&](Journal::Done done) { stream.append(entries, std::move(done)); });
  }
  /// Takes the session for the next owner.
  SessionImage take(std::uint64_t epoch) {
    LocatedSession session;
    session.number = kSession;
    session.owner = "b";
    session.epoch = epoch;
    return take_image(streams, session);
  }
  static SessionStream::Place place_after(const SessionImage& image, std::uint64_t epoch) {
    SessionStream::Place place;
    place.epoch = epoch;
    place.last_messages = image.last_messages;
    place.last_entry = image.entries.back().sequence;
    place.manifest = image.manifest;
    place.manifest_message = image.manifest_message;
    return place;
  }
  /// Returns incompressible bytes.
  static std::vector<std::uint8_t> make_bytes(std::size_t count) {
    std::mt19937 random(1);
    std::vector<std::uint8_t> bytes(count);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    return bytes;
  }
  static void write_state(SessionStream& stream, std::uint64_t sequence, std::size_t bytes) {
    const Checkpoint state{kSession, 10 * sequence, sequence, "{\"tick\": 1}",
                           compress(make_bytes(bytes))};
    stream.write_state(state, make_entry(1), stream.mark(), true);
    EXPECT_EQ(wait([&](Journal::Done done) { stream.flush(std::move(done)); }), Failure());
  }

  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  SystemClock clock;
  Lease lease{clock};
  boost::asio::thread_pool threads{2};
  ClusterStreams streams{connection};
  std::atomic<int> lost = 0;
  std::function<void(const std::string& name)> rename = [](const std::string&) {};
};

TEST_F(SessionStreamTest, AnotherNodeReadsWhatWasStored) {
  const auto stream = create();
  EXPECT_EQ(append(*stream, {make_entry(1), make_entry(2, std::string(100'000, 'x'))}), Failure());
  EXPECT_EQ(append(*stream, {make_entry(3)}), Failure());
  stream->refuse(3);
  EXPECT_EQ(wait([&](auto done) { stream->reach(44, done); }), Failure());
  EXPECT_EQ(wait([&](auto done) { stream->configure("lake", "{}", done); }), Failure());
  SessionProgress progress;
  progress.position = 41;
  progress.hash = 0xffffffffffffffff;
  progress.participants = "[]";
  EXPECT_EQ(wait([&](auto done) { stream->write_progress(progress, done); }), Failure());
  const SessionImage image = take(2);
  ASSERT_THAT(sequences_of(image), ElementsAre(1, 2, 3));
  EXPECT_EQ(image.entries[1].params, std::string(100'000, 'x'));
  EXPECT_TRUE(image.entries[2].refused);
  EXPECT_EQ(image.stored.reached, 44U);
  EXPECT_EQ(image.stored.name, "lake");
  ASSERT_TRUE(image.stored.progress);
  EXPECT_EQ(image.stored.progress->position, 41U);
  EXPECT_EQ(image.stored.progress->hash, 0xffffffffffffffff);
  EXPECT_FALSE(image.state);
}

// A saved state that is loaded, or a scene with meshes.
TEST_F(SessionStreamTest, ALongMessageIsStoredInParts) {
  const auto stream = create();
  const std::vector<std::uint8_t> bytes = make_bytes(3 * LogPart::kBytes);
  const std::string params = Json(to_base64(bytes)).dump();
  EXPECT_EQ(append(*stream, {make_entry(1), make_entry(2, params)}), Failure());
  EXPECT_GT(streams.logs[0].last_sequence(), 3U);
  EXPECT_EQ(append(*stream, {make_entry(3)}), Failure());
  const SessionImage image = take(2);
  EXPECT_THAT(sequences_of(image), ElementsAre(1, 2, 3));
  EXPECT_TRUE(image.entries[1].params == params);
}

// The parts of a message whose owner lost the session have no effect.
TEST_F(SessionStreamTest, APartWithoutTheRestIsIgnored) {
  const auto stream = create();
  EXPECT_EQ(append(*stream, {make_entry(1)}), Failure());
  const auto last = streams.logs[0].last(log_subject(kSession, 0));
  ASSERT_TRUE(last);
  const std::string message =
      write_records({EntriesRecord{{make_entry(2, to_base64(make_bytes(2 * LogPart::kBytes)))}}});
  const LogPart part = split_message(message).front();
  streams.logs[0].append(log_subject(kSession, 0), part.bytes, last->sequence,
                         {{kEpochHeader, "1"}, {kWriteHeader, "1.2"}, {kPartHeader, part.header}});
  const SessionImage image = take(2);
  EXPECT_THAT(sequences_of(image), ElementsAre(1));
  const auto next = open(place_after(image, 2));
  EXPECT_EQ(append(*next, {make_entry(2)}), Failure());
  EXPECT_THAT(sequences_of(take(3)), ElementsAre(1, 2));
}

TEST(LogPartsTest, AreJoinedInTheirOrder) {
  LogParts parts;
  EXPECT_EQ(parts.take("", "whole"), "whole");
  EXPECT_FALSE(parts.take("0/3", "a"));
  EXPECT_FALSE(parts.take("1/3", "b"));
  EXPECT_EQ(parts.take("2/3", "c"), "abc");
  EXPECT_FALSE(parts.take("0/2", "x"));
  EXPECT_EQ(parts.take("", "whole"), "whole");
  EXPECT_FALSE(parts.take("0/2", "y"));
  EXPECT_EQ(parts.take("0/1", "short"), "short");
  for (const char* const header : {"1/2", "x", "0", "0/", "/2"}) {
    EXPECT_THROW(parts.take(header, ""), StorageError) << header;
  }
  for (const std::size_t size : {std::size_t{0}, LogPart::kBytes, LogPart::kBytes + 1}) {
    const std::string message(size, 'm');
    std::optional<std::string> joined;
    for (const LogPart& part : split_message(message)) {
      EXPECT_FALSE(joined) << size;
      joined = parts.take(part.header, part.bytes);
    }
    EXPECT_TRUE(joined == message) << size;
  }
}

TEST_F(SessionStreamTest, ThePreviousOwnerStoresNothingAfterATakeOver) {
  const auto old = create();
  ASSERT_EQ(append(*old, {make_entry(1)}), Failure());
  const SessionImage image = take(2);
  EXPECT_EQ(append(*old, {make_entry(2)}), StorageError::Kind::unreachable);
  EXPECT_TRUE(wait_until([&] { return lost == 1; }));
  EXPECT_EQ(append(*old, {make_entry(2)}), StorageError::Kind::unreachable);
  const auto next = open(place_after(image, 2));
  EXPECT_EQ(append(*next, {make_entry(2)}), Failure());
  EXPECT_THAT(sequences_of(take(3)), ElementsAre(1, 2));
}

TEST_F(SessionStreamTest, AMessageBeforeATakeOverCountsAsStored) {
  const auto old = create();
  // As if the acknowledgement of the first message was lost, and the stream sends it again.
  streams.logs[0].append(log_subject(kSession, 0), write_records({EntriesRecord{{make_entry(1)}}}),
                         0, {{kEpochHeader, "1"}, {kWriteHeader, "1.1"}});
  EXPECT_THAT(sequences_of(take(2)), ElementsAre(1));
  EXPECT_EQ(append(*old, {make_entry(1)}), Failure());
  EXPECT_EQ(append(*old, {make_entry(2)}), StorageError::Kind::unreachable);
  EXPECT_THAT(sequences_of(take(3)), ElementsAre(1));
}

// As if the owner had changed between the streams, without the acknowledgement of the write 1.2.
TEST_F(SessionStreamTest, TwoStreamsAreReadInTheOrderOfTheWrites) {
  const std::vector<std::pair<std::size_t, std::uint64_t>> writes{{0, 1}, {0, 2}, {1, 2},
                                                                  {1, 3}, {0, 4}, {1, 10}};
  LogEnds last{};
  for (const auto& [stream, write] : writes) {
    last[stream] = streams.logs[stream].append(
        log_subject(kSession, stream), write_records({EntriesRecord{{make_entry(write)}}}),
        last[stream], {{kEpochHeader, "1"}, {kWriteHeader, "1." + std::to_string(write)}});
  }
  EXPECT_EQ(last_messages(streams, kSession), last);
  const SessionImage image = take(2);
  EXPECT_THAT(sequences_of(image), ElementsAre(1, 2, 3, 4, 10));
  for (std::size_t i = 0; i < kLogStreams; ++i) EXPECT_GT(image.last_messages[i], last[i]);
  // The next owner needs no messages before a state.
  const auto next = open(place_after(image, 2));
  write_state(*next, 10, 1000);
  ASSERT_EQ(append(*next, {make_entry(11)}), Failure());
  EXPECT_THAT(sequences_of(take(3)), ElementsAre(1, 11));
}

TEST_F(SessionStreamTest, AnEarlierMessageOfTheOwnerInAStreamIsNoConflict) {
  const auto stream = create();
  for (const char* const id : {"1.0.0", "1.0.1"}) {
    streams.logs[0].append(log_subject(kSession, 0), write_records({ReachedRecord{1}}),
                           last_messages(streams, kSession)[0],
                           {{kEpochHeader, "1"}, {kWriteHeader, id}});
  }
  EXPECT_EQ(append(*stream, {make_entry(1)}), Failure());
  EXPECT_EQ(lost, 0);
  EXPECT_THAT(sequences_of(take(2)), ElementsAre(1));
}

TEST_F(SessionStreamTest, AFailedRenamingHasItsReason) {
  const auto stream = create();
  const auto configure = [&] {
    return wait([&](Journal::Done done) { stream->configure("sea", "{}", std::move(done)); });
  };
  ASSERT_EQ(configure(), Failure());
  rename = [](const std::string& name) { throw NameInUse(name); };
  EXPECT_EQ(configure(), StorageError::Kind::name_used);
  for (const auto kind : {NatsError::Kind::conflict, NatsError::Kind::unreachable}) {
    rename = [kind](const std::string&) { throw NatsError(kind, "the session has moved"); };
    EXPECT_EQ(configure(), StorageError::Kind::unreachable) << static_cast<int>(kind);
  }
  EXPECT_EQ(take(2).stored.name, "sea");
}

TEST_F(SessionStreamTest, AFlushWaitsForTheProgress) {
  const auto stream = create();
  ASSERT_EQ(append(*stream, {make_entry(1)}), Failure());
  SessionProgress progress;
  progress.participants = "[]";
  std::atomic<int> written = 0;
  for (int i = 0; i < 50; ++i) {
    stream->write_progress(progress, [&](Failure failure) { written += failure ? 0 : 1; });
  }
  std::promise<int> flushed;
  stream->flush([&](Failure) { flushed.set_value(written); });
  EXPECT_EQ(flushed.get_future().get(), 50);
}

TEST_F(SessionStreamTest, ATakeOverBeginsAtTheNewestState) {
  const auto stream = create();
  for (std::uint64_t i = 1; i <= 4; ++i) ASSERT_EQ(append(*stream, {make_entry(i)}), Failure());
  write_state(*stream, 2, 1000);
  ASSERT_EQ(append(*stream, {make_entry(5)}), Failure());
  write_state(*stream, 4, 2'000'000);  // several chunks
  const SessionImage image = take(2);
  ASSERT_TRUE(image.state);
  EXPECT_EQ(image.state->sequence, 4U);
  EXPECT_TRUE(decompress(image.state->state, kMaxStateBytes) == make_bytes(2'000'000));
  EXPECT_THAT(sequences_of(image), ElementsAre(1, 5));
}

TEST_F(SessionStreamTest, MessagesBeforeTheOlderOfTwoStatesAreRemoved) {
  const auto stream = create();
  for (std::uint64_t i = 1; i <= 9; ++i) {
    ASSERT_EQ(append(*stream, {make_entry(i)}), Failure());
    write_state(*stream, i, 1000);
  }
  EXPECT_TRUE(wait_until([&] {
    const auto first = streams.logs[0].next(log_subject(kSession, 0), 1);
    return first && first->sequence >= 8;
  }));
  const SessionImage image = take(2);
  EXPECT_EQ(image.state->sequence, 9U);
  EXPECT_THAT(sequences_of(image), ElementsAre(1));
}

TEST_F(SessionStreamTest, AStateOfThePreviousOwnerDoesNotCount) {
  const auto old = create();
  ASSERT_EQ(append(*old, {make_entry(1)}), Failure());
  write_state(*old, 1, 1000);
  const SessionImage image = take(2);
  Checkpoint state{kSession, 500, 1, "{}", compress(std::vector<std::uint8_t>(10))};
  old->write_state(state, make_entry(1), old->mark(), true);
  wait([&](auto done) { old->flush(done); });
  EXPECT_EQ(take(3).state->position, image.state->position);
}

TEST_F(SessionStreamTest, WithoutServersItRefusesAtOnceAndResumesLater) {
  const auto stream = create();
  ASSERT_EQ(append(*stream, {make_entry(1)}), Failure());
  servers.kill(0);
  ASSERT_TRUE(wait_until([&] { return !connection.is_connected(); }));
  EXPECT_EQ(append(*stream, {make_entry(2)}), StorageError::Kind::unreachable);
  servers.restart(0);
  ASSERT_TRUE(wait_until([&] { return connection.is_connected(); }));
  EXPECT_EQ(append(*stream, {make_entry(2)}), Failure());
  EXPECT_THAT(sequences_of(take(2)), ElementsAre(1, 2));
}

TEST_F(SessionStreamTest, RecordsAreReadAsTheyWereWritten) {
  EXPECT_THROW(read_records(""), StorageError);
  EXPECT_THROW(read_records("j{"), StorageError);
  EXPECT_THROW(read_records("j[{}]"), StorageError);
  EXPECT_THROW(read_records("zno frame"), StorageError);
  EXPECT_THROW(unpack_state("no state"), StorageError);
  EXPECT_THROW(unpack_state("999\n"), StorageError);
  EXPECT_THROW(read_manifest("[]"), StorageError);
  const auto records = read_records(write_records({OwnerRecord{"b", 3}, RefusedRecord{9}}));
  ASSERT_EQ(records.size(), 2U);
  EXPECT_EQ(std::get<OwnerRecord>(records[0]).epoch, 3U);
  EXPECT_EQ(std::get<RefusedRecord>(records[1]).sequence, 9U);
}

}  // namespace
}  // namespace vat::test::session_stream_test
