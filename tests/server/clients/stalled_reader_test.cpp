// The memory of messages that wait for a real socket.

#include "server/clients/client_outbox.h"
#include "server/operations/heap.h"
#include "tests/server/transport/transport_fixture.h"
#include "tests/support/memory/allocator.h"
#include "tests/support/wait.h"

#if VAT_HAS_SYSTEM_ALLOCATOR

namespace vat::test::stalled_reader_test {
namespace {

class StalledReader : public TransportTest {};

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

}  // namespace
}  // namespace vat::test::stalled_reader_test
#endif  // VAT_HAS_SYSTEM_ALLOCATOR
