#include <array>

#include "tests/server/transport/transport_fixture.h"
#include "tests/support/wait.h"

namespace vat::test::transport_message_test {

namespace {

class TransportMessageTest : public TransportTest {
 protected:
  std::shared_ptr<Connection> only_connection() {
    EXPECT_TRUE(recorder.wait_opened(1));
    return recorder.connection(1);
  }
  std::size_t messages_received() {
    return recorder.read([this] { return recorder.received.size(); });
  }
};

TEST_F(TransportMessageTest, EchoesInOrder) {
  recorder.echo = true;
  start();
  WsClient client(port);
  constexpr int kCount = 2000;
  std::string all;
  for (int i = 0; i < kCount; ++i) all += client_frame(i % 2 + 1, "message " + std::to_string(i));
  client.raw().write(all);
  for (int i = 0; i < kCount; ++i) {
    const Frame frame = client.read_message();
    ASSERT_EQ(frame.payload, "message " + std::to_string(i));
    ASSERT_EQ(frame.opcode, i % 2 + 1);
  }
}

TEST_F(TransportMessageTest, AMessageOfTheGreatestSizePassesAndAByteMoreCloses) {
  settings.max_message_bytes = 1000;
  recorder.echo = true;
  start();
  WsClient client(port);
  client.send_text(std::string(1000, 'x'));
  EXPECT_EQ(client.read_message().payload.size(), 1000u);
  client.send_text(std::string(1001, 'x'));
  EXPECT_EQ(client.read_close(), 1009);
  EXPECT_EQ(messages_received(), 1u);
}

TEST_F(TransportMessageTest, FragmentsCountTogether) {
  settings.max_message_bytes = 1000;
  start();
  WsClient client(port);
  client.raw().write(client_frame(1, std::string(600, 'x'), false) +
                     client_frame(0, std::string(600, 'x'), true));
  EXPECT_EQ(client.read_close(), 1009);
}

// The peer receives the reason although it still sends, because the server continues to read for
// some time.
TEST_F(TransportMessageTest, TheCloseFrameReachesAPeerInTheMiddleOfALargeMessage) {
  settings.max_message_bytes = 1000;
  start();
  for (int i = 0; i < 20; ++i) {
    WsClient client(port);
    client.send_binary(std::string(8 * 1024 * 1024, 'x'));
    ASSERT_EQ(client.read_close(), 1009);
  }
}

TEST_F(TransportMessageTest, SendsFromManyThreadsKeepEachThreadsOrder) {
  start();
  WsClient client(port);
  const auto connection = only_connection();
  constexpr std::size_t kThreads = 8;
  constexpr std::size_t kCount = 500;
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < kCount; ++i) {
        const std::string message = std::to_string(t) + " " + std::to_string(i);
        if (i % 2 == 0) {
          connection->send_text(message);
        } else {
          connection->send_binary(std::make_shared<const std::string>(message));
        }
      }
    });
  }
  std::array<std::size_t, kThreads> next{};
  for (std::size_t n = 0; n < kThreads * kCount; ++n) {
    const Frame frame = client.read_message();
    const std::size_t thread = static_cast<std::size_t>(frame.payload[0] - '0');
    ASSERT_LT(thread, kThreads);
    ASSERT_EQ(frame.payload.substr(2), std::to_string(next[thread]));
    ASSERT_EQ(frame.opcode, next[thread] % 2 == 0 ? 1 : 2);
    ++next[thread];
  }
  for (std::thread& thread : threads) thread.join();
}

// Exceeds the kernel's buffers at both ends.
TEST_F(TransportMessageTest, CountsTheBytesThatTheSocketHasNotTaken) {
  start();
  WsClient client(port);
  const auto connection = only_connection();
  const auto bytes = std::make_shared<const std::string>(32 * 1024 * 1024, 'x');
  connection->send_binary(bytes);
  connection->send_binary(bytes);
  EXPECT_EQ(connection->queued_bytes(), 2 * bytes->size());
  EXPECT_EQ(client.read_message().payload.size(), bytes->size());
  EXPECT_GE(connection->queued_bytes(), bytes->size());
  EXPECT_EQ(client.read_message().payload.size(), bytes->size());
  client.send_text("all read");
  ASSERT_TRUE(recorder.wait([&] { return recorder.received.size() == 1; }));
  EXPECT_EQ(connection->queued_bytes(), 0u);
  EXPECT_EQ(bytes.use_count(), 1) << "shared bytes are still held";
}

/// Sends bytes to a peer that does not read, until one message of 16 KiB waits for a second.
/// Returns the number of accepted bytes.
std::size_t bytes_taken(Connection& connection) {
  constexpr std::size_t kMost = 16 * 1024 * 1024;
  const auto bytes = std::make_shared<const std::string>(16 * 1024, 'x');
  for (std::size_t taken = 0; taken < kMost; taken += bytes->size()) {
    connection.send_binary(bytes);
    const auto is_taken = [&] { return connection.queued_bytes() == 0; };
    if (!wait_until(is_taken, std::chrono::seconds(2))) return taken;
  }
  return kMost;
}

// Bytes in the system's buffers cannot be withdrawn. The server's side holds twice its setting
// (socket(7)), the peer's side its initial buffer size.
TEST_F(TransportMessageTest, TheSystemTakesLittleForAPeerThatDoesNotRead) {
  start();
  WsClient client(port);
  const std::size_t little = bytes_taken(*only_connection());
  EXPECT_GE(little, std::size_t{64} * 1024);
  EXPECT_LE(little, std::size_t{1024} * 1024);
}

TEST_F(TransportMessageTest, BytesForALostPeerAreFreedAndItsConnectionOutlivesTheTransport) {
  start();
  WsClient client(port);
  const auto connection = only_connection();
  const auto bytes = std::make_shared<const std::string>(64 * 1024 * 1024, 'x');
  connection->send_binary(bytes);
  connection->send_binary(bytes);
  client.read_frame();
  client.raw().reset();
  ASSERT_TRUE(recorder.wait_closed(1));
  connection->send_binary(bytes);
  transport->stop();
  transport.reset();
  connection->send_text("nobody");
  connection->close(1000, "");
  EXPECT_EQ(connection->queued_bytes(), 0u);
  EXPECT_EQ(connection->id(), 1u);
  EXPECT_EQ(bytes.use_count(), 1);
}

TEST_F(TransportMessageTest, ClosesWithTheGivenCodeAndSendsNothingAfterwards) {
  start();
  WsClient client(port);
  const auto connection = only_connection();
  connection->send_text("before");
  connection->close(4008, "too slow");
  connection->send_text("after");
  connection->close(4000, "again");
  EXPECT_EQ(client.read_message().payload, "before");
  const auto frame = client.read_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 8);
  EXPECT_EQ(frame->payload, std::string("\x0f\xa8") + "too slow");
  client.raw().write(client_frame(8, frame->payload.substr(0, 2)));
  EXPECT_FALSE(client.read_frame());
  EXPECT_EQ(connection->queued_bytes(), 0u);
}

// 123 bytes fit. Each of these characters has two bytes.
TEST_F(TransportMessageTest, AReasonTooLongForACloseFrameIsCutAtACharacter) {
  start();
  WsClient client(port);
  std::string reason;
  for (int i = 0; i < 100; ++i) reason += "\xc3\xa4";
  only_connection()->close(4000, reason);
  const auto frame = client.read_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 8);
  EXPECT_EQ(frame->payload, std::string("\x0f\xa0") + reason.substr(0, 122));
}

}  // namespace

}  // namespace vat::test::transport_message_test
