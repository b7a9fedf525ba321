// The cost of a viewer that stops reading, over a real socket.

#include <memory>
#include <random>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "server/frames/frame_delivery.h"
#include "server/messages/limits.h"
#include "server/operations/heap.h"
#include "tests/server/transport/transport_fixture.h"
#include "tests/support/memory/allocator.h"
#include "tests/support/wait.h"

namespace vat::test::stalled_reader_test {
namespace {

class NoWaker final : public FrameWaker {
 public:
  void wake(ConnectionId) override {}
  void frame_rejected(ConnectionId, std::uint32_t) override {}
};

/// Random particle positions in each state. Frames are unpredictable and therefore large.
PublishedState make_state(std::uint64_t tick, std::mt19937& random) {
  constexpr std::size_t kParticles = 60'000;
  std::uniform_real_distribution<double> place(0, 1);
  PublishedState state;
  state.header.epoch = 1;
  state.header.tick = tick;
  state.bodies.resize(1);
  state.bodies[0].id = 1;
  state.bodies[0].positions.resize(kParticles);
  for (Vec3& position : state.bodies[0].positions) {
    position = Vec3(place(random), place(random), place(random));
  }
  return state;
}

class StalledReader : public TransportTest {};

TEST_F(StalledReader, OneFrameAtMostWaitsOutsideTheSystem) {
  start();
  WsClient client(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  const auto connection = recorder.connection(1);
  const auto outbox = std::make_shared<ClientOutbox>(connection);
  const std::uint64_t membership = outbox->join();
  outbox->start_epoch(membership, 1);
  ServerMetrics metrics;
  FrameDelivery delivery(Vat{Vec3::Zero(), Vec3::Ones(), true, {}}, metrics);
  const auto waker = std::make_shared<NoWaker>();
  SteadyClock::time_point now{std::chrono::hours(1)};
  delivery.add(outbox, outbox->subscribe(membership, waker, now), {});

  std::mt19937 random(1);
  std::size_t most_queued = 0;
  for (std::uint64_t tick = 1; tick <= 50; ++tick) {
    PublishedState state = make_state(tick, random);
    delivery.publish(state, now += std::chrono::milliseconds(20));
    most_queued = std::max(most_queued, connection->queued_bytes());
  }
  const std::string frame = client.read_message().payload;
  EXPECT_GT(frame.size(), 200'000U) << "larger than the system's buffers";
  EXPECT_GT(most_queued, 0U);
  EXPECT_LT(most_queued, frame.size() + frame.size() / 2) << "one frame of about this size";
  // The viewer reads again, and receives only the frames in flight.
  std::size_t frames = 1;
  client.send_text("done");
  ASSERT_TRUE(recorder.wait([&] { return recorder.received.size() == 1; }));
  while (connection->queued_bytes() > 0) {
    client.read_message();
    ++frames;
  }
  EXPECT_LE(frames, kFrameWindow);

  outbox->close_if_silent(now + std::chrono::seconds(31), std::chrono::seconds(30));
  EXPECT_EQ(client.read_close(), 4008);
}

#if VAT_HAS_SYSTEM_ALLOCATOR
// Overhead dominates the memory of short messages.
TEST_F(StalledReader, AMessageThatWaitsTakesNoMoreThanItCountsFor) {
  constexpr std::size_t kMessages = 20'000;
  constexpr std::size_t kText = 60;
  start();
  WsClient client(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  ClientOutbox outbox(recorder.connection(1), std::size_t{1} << 30);
  outbox.send(std::string(std::size_t{4} << 20, 'x'));  // exceeds the system's buffers
  const std::size_t before = heap_in_use();
  for (std::size_t i = 0; i < kMessages; ++i) outbox.send(std::string(kText, 'y'));
  const auto taken = [&] { return (heap_in_use() - before) / kMessages; };
  // The transport's queue also contains the messages until its thread has taken them.
  constexpr std::size_t kCounted = kText + ControlQueue::kMessageCost;
  EXPECT_TRUE(wait_until([&] { return taken() <= kCounted; }));
  EXPECT_GE(taken(), kCounted / 2) << "memory is close to the accounted size";
}

TEST_F(StalledReader, AnEventThatWaitsForManyIsStoredOnce) {
  constexpr std::size_t kClients = 20;
  constexpr std::size_t kMostOfEach = std::size_t{64} << 10;
  start();
  std::vector<std::unique_ptr<WsClient>> clients;
  std::vector<std::unique_ptr<ClientOutbox>> outboxes;
  for (std::size_t i = 1; i <= kClients; ++i) {
    clients.push_back(std::make_unique<WsClient>(port));
    ASSERT_TRUE(recorder.wait_opened(i));
    outboxes.push_back(std::make_unique<ClientOutbox>(recorder.connection(i)));
    outboxes.back()->join();
  }
  // Exceeds the system's buffers.
  const auto event = std::make_shared<const std::string>(std::size_t{8} << 20, 'x');
  const std::size_t before = heap_in_use();
  for (const auto& outbox : outboxes) outbox->send_event(1, event);
  clients.front()->send_text("the transport has begun to write");
  ASSERT_TRUE(recorder.wait([&] { return recorder.received.size() == 1; }));
  EXPECT_EQ(event.use_count(), 1 + static_cast<long>(kClients)) << "the event waits for all";
  EXPECT_LT(heap_in_use(), before + kClients * kMostOfEach);
}
#endif

}  // namespace
}  // namespace vat::test::stalled_reader_test
