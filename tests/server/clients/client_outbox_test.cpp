#include "server/clients/client_outbox.h"

#include <gtest/gtest.h>

#include "tests/server/fixture/fake_connection.h"

namespace vat::test::client_outbox_test {
namespace {

SharedFrame make_frame(const PublishedState& state) {
  GridFrame frame;
  make_grid_frame(state, {make_frame_grid(Vec3::Zero(), Vec3::Ones(), 0), {}}, frame);
  const std::vector<std::uint8_t> bytes = encode_key_frame(frame);
  return std::make_shared<const std::string>(bytes.begin(), bytes.end());
}

SharedFrame make_frame(std::uint32_t number) {
  PublishedState state;
  state.header.number = number;
  return make_frame(state);
}

std::string make_text(std::size_t bytes) {
  return "\"" + std::string(bytes - 2, 'x') + "\"";
}

SharedText share(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

class CountingWaker final : public FrameWaker {
 public:
  void wake(ConnectionId) override { ++count; }
  void frame_rejected(ConnectionId, std::uint32_t number) override { rejected.push_back(number); }
  int count = 0;
  std::vector<std::uint32_t> rejected;
};

constexpr std::uint32_t kEpoch = 5;
constexpr std::size_t kQueueBytes = 1024 * 1024;
constexpr std::size_t kMessageCost = ControlQueue::kMessageCost;

class Outbox : public testing::Test {
 protected:
  Outbox() {
    outbox.start_epoch(membership, kEpoch);
    subscribe();
  }
  void subscribe() { subscription = outbox.subscribe(membership, waker, now); }
  /// Sends frames while the outbox is ready.
  void offer(std::uint32_t first, std::uint32_t last) {
    for (std::uint32_t number = first; number <= last; ++number) {
      if (outbox.frame_channel(subscription).is_ready) send(number);
    }
  }
  void send(std::uint32_t number) {
    outbox.send_frame(subscription, kEpoch, make_frame(number), now);
  }
  std::uint32_t last_number() const { return connection->frames().back().header.number; }
  std::size_t frame_count() const { return connection->frames().size(); }

  SteadyClock::time_point now{std::chrono::hours(1)};
  const std::shared_ptr<FakeConnection> connection = std::make_shared<FakeConnection>(1);
  const std::shared_ptr<CountingWaker> waker = std::make_shared<CountingWaker>();
  ClientOutbox outbox{connection, kQueueBytes};
  std::uint64_t membership = outbox.join();
  std::uint64_t subscription = 0;
};

TEST_F(Outbox, TakesThreeFramesThatAreNotAcknowledged) {
  offer(1, 50);
  ASSERT_EQ(frame_count(), 3u);
  EXPECT_EQ(last_number(), 3u);
  EXPECT_TRUE(outbox.acknowledge(1, now));
  offer(51, 60);
  ASSERT_EQ(frame_count(), 4u);
  EXPECT_EQ(last_number(), 51u);
}

TEST_F(Outbox, WakesOnceIfAFrameWasMissed) {
  offer(1, 3);
  EXPECT_TRUE(outbox.acknowledge(1, now));
  EXPECT_EQ(waker->count, 0) << "no frame was missed";
  offer(4, 10);
  EXPECT_TRUE(outbox.acknowledge(2, now));
  EXPECT_TRUE(outbox.acknowledge(3, now));
  EXPECT_EQ(waker->count, 1);
  offer(11, 20);
  outbox.unsubscribe();
  EXPECT_TRUE(outbox.acknowledge(5, now));
  EXPECT_EQ(waker->count, 1) << "the client no longer subscribes";
}

TEST_F(Outbox, ARejectedFrameIsReportedToItsSourceAndAcknowledged) {
  offer(1, 3);
  EXPECT_FALSE(outbox.acknowledge(4, now, true)) << "this frame was not sent";
  EXPECT_TRUE(waker->rejected.empty());
  EXPECT_TRUE(outbox.acknowledge(2, now, true));
  EXPECT_EQ(waker->rejected, std::vector<std::uint32_t>{2});
  EXPECT_EQ(waker->count, 1) << "the source must send although no frame was missed";
  EXPECT_TRUE(outbox.frame_channel(subscription).is_ready);
  outbox.unsubscribe();
  EXPECT_TRUE(outbox.acknowledge(3, now, true));
  EXPECT_EQ(waker->rejected.size(), 1u) << "the client no longer subscribes";
}

TEST_F(Outbox, RejectedNotificationsAreReportedWhenTheirNumberDoubles) {
  for (int i = 0; i < 9; ++i) outbox.report_rejected("frames.akc", method_not_found("frames.akc"));
  std::vector<int> counts;
  for (const Json& text : connection->texts()) {
    EXPECT_EQ(text.at("method"), "notification.rejected");
    EXPECT_EQ(text.at("params").at("method"), "frames.akc");
    EXPECT_EQ(text.at("params").at("kind"), "method_not_found");
    counts.push_back(text.at("params").at("count"));
  }
  EXPECT_EQ(counts, (std::vector<int>{1, 2, 4, 8}));
}

TEST_F(Outbox, TheReasonOfATooSlowClientNamesItsRejectedNotifications) {
  constexpr std::chrono::seconds kPatience(30);
  const std::string method = "frames." + std::string(57, 'z');
  outbox.report_rejected("control.fly", method_not_found("control.fly"));
  outbox.report_rejected(method, method_not_found(method));
  offer(1, 1);
  outbox.close_if_silent(now + kPatience, kPatience);
  const std::string reason = connection->close_reason();
  EXPECT_TRUE(
      reason.starts_with("too slow: no frame was acknowledged for 30 s; rejected "
                         "notifications: 2, last frames.zzz"))
      << reason;
  EXPECT_EQ(reason.size(), 123u) << "a close frame has no room for more";
}

// The cost of a peer that stops reading, beyond the buffers of the operating system.
TEST_F(Outbox, OneFrameAtMostWaitsForTheSocket) {
  connection->stall(true);
  outbox.send_event(membership, share(R"("event")"));  // does not delay frames
  offer(1, 50);
  EXPECT_EQ(frame_count(), 1u);
  connection->stall(false);
  offer(51, 60);
  EXPECT_EQ(frame_count(), 3u);
}

// The transport may report late that the socket has accepted the frame.
TEST_F(Outbox, AcknowledgedFramesDoNotWait) {
  connection->stall(true);
  offer(1, 1);
  EXPECT_FALSE(outbox.frame_channel(subscription).is_ready);
  EXPECT_TRUE(outbox.acknowledge(1, now));
  EXPECT_TRUE(outbox.frame_channel(subscription).is_ready);
}

TEST_F(Outbox, FramesInFlightDoNotCountAfterAJoin) {
  offer(1, 4);
  membership = outbox.join();
  subscribe();
  offer(10, 12);
  ASSERT_EQ(frame_count(), 6u);
  EXPECT_EQ(last_number(), 12u);
  EXPECT_FALSE(outbox.acknowledge(13, now));
  EXPECT_TRUE(outbox.acknowledge(12, now));
}

TEST_F(Outbox, NothingOfAnEarlierMembershipIsSent) {
  const std::uint64_t old = membership;
  offer(1, 2);
  outbox.leave();
  outbox.send_event(old, share(R"("left")"));
  send(5);
  EXPECT_FALSE(outbox.frame_channel(subscription).is_ready);
  EXPECT_EQ(outbox.subscribe(old, waker, now), 0u);
  EXPECT_EQ(frame_count(), 2u);
  membership = outbox.join();
  outbox.send_event(old, share(R"("late")"));
  send(6);
  EXPECT_EQ(frame_count(), 2u);
  EXPECT_TRUE(connection->texts().empty());
  outbox.send_event(membership, share(R"("new")"));
  EXPECT_EQ(connection->texts(), std::vector<Json>{"new"});
}

TEST_F(Outbox, NothingOfAnEarlierSubscriptionOrEpochIsSent) {
  const std::uint64_t old = subscription;
  subscribe();
  EXPECT_FALSE(outbox.frame_channel(old).is_ready);
  outbox.send_frame(old, kEpoch, make_frame(1), now);
  EXPECT_EQ(frame_count(), 0u);
  outbox.start_epoch(membership, kEpoch + 1);
  send(2);
  EXPECT_EQ(frame_count(), 0u);
  outbox.send_frame(subscription, kEpoch + 1, make_frame(3), now);
  EXPECT_EQ(frame_count(), 1u);
  outbox.unsubscribe();
  outbox.send_frame(subscription, kEpoch + 1, make_frame(4), now);
  EXPECT_EQ(frame_count(), 1u);
}

TEST_F(Outbox, AClientThatReadsNothingIsClosedBeforeItsQueuePassesAMebibyte) {
  connection->stall(true);
  const std::string event = make_text(1024 - kMessageCost);
  for (int i = 0; i < 1024; ++i) outbox.send_event(membership, share(event));
  EXPECT_FALSE(connection->close_code().has_value()) << "1 MiB is allowed";
  outbox.send("1");
  EXPECT_EQ(connection->close_code(), 4008);
  const std::size_t queued = connection->queued();
  EXPECT_LE(queued, kQueueBytes);
  for (int i = 0; i < 1000; ++i) {
    outbox.send(event);
    offer(1, 1);
  }
  EXPECT_EQ(connection->queued(), queued) << "the queue no longer grows";
  EXPECT_EQ(frame_count(), 0u);
}

// The queues of two clients: a frame and an event that both wait for, and a reply.
TEST_F(Outbox, SharedPartsCountOnceInTheMemoryOfAllQueues) {
  const auto other_connection = std::make_shared<FakeConnection>(2);
  ClientOutbox other(other_connection, kQueueBytes);
  const std::uint64_t other_membership = other.join();
  connection->stall(true);
  other_connection->stall(true);
  const SharedText event = share(make_text(100'000));
  const SharedFrame frame = make_frame(1);
  outbox.send_event(membership, event);
  other.send_event(other_membership, event);
  outbox.send_frame(subscription, kEpoch, frame, now);
  other.send_event(other_membership, event);
  other.send(make_text(300));
  QueueMemory memory;
  const std::size_t share_of_one = outbox.add_queue(memory);
  EXPECT_EQ(memory.bytes(), 2 * kMessageCost + event->size() + frame->size());
  EXPECT_LT(share_of_one, memory.bytes()) << "the event has other owners";
  EXPECT_GT(share_of_one, 2 * kMessageCost);
  other.add_queue(memory);
  EXPECT_EQ(memory.bytes(), 5 * kMessageCost + event->size() + frame->size() + 300);
  connection->stall(false);
  QueueMemory later;
  EXPECT_EQ(outbox.add_queue(later), 0U) << "the socket has taken all";
  other.close(4003, "kicked");
  EXPECT_EQ(other.add_queue(later), 0U);
  EXPECT_EQ(later.bytes(), 0U);
}

TEST_F(Outbox, FramesDoNotCountForTheControlQueue) {
  connection->stall(true);
  PublishedState state;
  state.header.number = 1;
  state.bodies.resize(1);
  state.bodies[0].id = 1;
  state.bodies[0].positions.assign(200'000, Vec3::Zero());
  const SharedFrame frame = make_frame(state);
  outbox.send_frame(subscription, kEpoch, frame, now);
  EXPECT_EQ(connection->queued(), frame->size());
  outbox.send("1");
  EXPECT_FALSE(connection->close_code().has_value());
}

TEST_F(Outbox, BytesInTheSocketAreNotQueued) {
  const std::string event = make_text(500'000);
  for (int i = 0; i < 20; ++i) {
    connection->stall(true);
    outbox.send_event(membership, share(event));
    outbox.send_event(membership, share(event));
    connection->stall(false);  // the socket accepts both
  }
  EXPECT_FALSE(connection->close_code().has_value());
}

TEST_F(Outbox, TwoMessagesMayBeLongerThanTheQueue) {
  connection->stall(true);
  constexpr std::size_t kWhole = kQueueBytes - kMessageCost;
  outbox.send(make_text(3 * kQueueBytes));
  outbox.send(make_text(kWhole));
  outbox.send(make_text(kWhole + 1));
  EXPECT_FALSE(connection->close_code().has_value());
  outbox.send(make_text(kWhole + 1));
  EXPECT_EQ(connection->close_code(), 4008);
}

// Otherwise repeated joins would send key frames without limit.
TEST_F(Outbox, AJoinMakesNoRoomForAFrameBesideOneThatWaits) {
  connection->stall(true);
  offer(1, 1);
  membership = outbox.join();
  outbox.start_epoch(membership, kEpoch);
  subscribe();
  EXPECT_FALSE(outbox.frame_channel(subscription).is_ready);
  connection->stall(false);
  EXPECT_FALSE(outbox.acknowledge(1, now)) << "acknowledgement of the previous membership";
  EXPECT_EQ(waker->count, 1) << "the acknowledgement may free space";
  EXPECT_TRUE(outbox.frame_channel(subscription).is_ready);
}

TEST_F(Outbox, AClientWithoutAcknowledgementsIsClosedAfterThePatience) {
  constexpr std::chrono::seconds kPatience(30);
  offer(1, 1);
  now += kPatience / 2;
  offer(2, 2);
  now += kPatience / 2 - std::chrono::milliseconds(1);
  outbox.close_if_silent(now, kPatience);
  EXPECT_FALSE(connection->close_code().has_value());
  EXPECT_TRUE(outbox.acknowledge(1, now));
  now += kPatience / 2;
  outbox.close_if_silent(now, kPatience);
  EXPECT_FALSE(connection->close_code().has_value()) << "the second frame is not older";
  now += std::chrono::milliseconds(1);
  outbox.close_if_silent(now, kPatience);
  EXPECT_EQ(connection->close_code(), 4008);
  EXPECT_FALSE(outbox.frame_channel(subscription).is_open);
}

TEST_F(Outbox, SilenceIsAllowedWithoutUnacknowledgedFrames) {
  constexpr std::chrono::seconds kPatience(30);
  offer(1, 3);
  EXPECT_TRUE(outbox.acknowledge(3, now));
  now += 10 * kPatience;
  outbox.close_if_silent(now, kPatience);
  offer(4, 4);
  outbox.unsubscribe();
  now += 10 * kPatience;
  outbox.close_if_silent(now, kPatience);
  EXPECT_FALSE(connection->close_code().has_value());
  subscribe();
  now += kPatience / 2;
  outbox.close_if_silent(now, kPatience);
  EXPECT_FALSE(connection->close_code().has_value()) << "the subscription is new";
  now += kPatience;
  outbox.close_if_silent(now, kPatience);
  EXPECT_EQ(connection->close_code(), 4008);
}

TEST_F(Outbox, CommandsInFlightAreBounded) {
  EXPECT_FALSE(outbox.begin_command(10, 2, 100));
  EXPECT_EQ(outbox.begin_command(91, 2, 100).value().limit, "command_bytes_in_flight");
  EXPECT_FALSE(outbox.begin_command(90, 2, 100));
  EXPECT_EQ(outbox.begin_command(0, 2, 100).value().limit, "commands_in_flight");
  outbox.end_command(10);
  EXPECT_TRUE(outbox.begin_command(11, 2, 100));
  EXPECT_FALSE(outbox.begin_command(10, 2, 100));
}

}  // namespace
}  // namespace vat::test::client_outbox_test
