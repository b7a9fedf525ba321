#include <algorithm>
#include <random>

#include "tests/server/transport/transport_fixture.h"
#include "tests/support/wait.h"

namespace vat::test::transport_hostile_test {

namespace {

using std::chrono::milliseconds;

class TransportHostileTest : public TransportTest {
 protected:
  void expect_alive() {
    recorder.echo = true;
    WsClient client(port);
    client.send_text("alive?");
    EXPECT_EQ(client.read_message().payload, "alive?");
  }
};

TEST_F(TransportHostileTest, GarbageInPlaceOfARequest) {
  settings.handshake_timeout = milliseconds(100);
  start();
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    std::string garbage(random() % 40000, '\0');
    for (char& byte : garbage) byte = static_cast<char>(random());
    if (round % 2 == 0) garbage += "\r\n\r\n";
    RawClient client(port);
    try {
      client.write(garbage);
      client.read_all();  // ends with an error page or at the time limit
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).find("patience"), std::string::npos);
    }
  }
  expect_alive();
}

TEST_F(TransportHostileTest, GarbageInPlaceOfFrames) {
  start();
  std::mt19937 random(2);
  for (int round = 0; round < 50; ++round) {
    std::string garbage(1 + random() % 4000, '\0');
    for (char& byte : garbage) byte = static_cast<char>(random());
    WsClient client(port);
    try {
      client.raw().write(garbage);
    } catch (const std::runtime_error&) {  // the server closed first
    }
  }
  ASSERT_TRUE(recorder.wait_closed(50));
  expect_alive();
}

TEST_F(TransportHostileTest, AHandshakeThatNeverEndsIsCutOff) {
  settings.handshake_timeout = milliseconds(300);
  start();
  RawClient silent(port);
  RawClient half(port);
  half.write("GET /ws HTTP/1.1\r\nHost: localhost\r\n");
  const auto begin = std::chrono::steady_clock::now();
  std::vector<std::thread> drips;  // Slowloris: one byte of a header or a body at a time
  for (const char* request :
       {"GET /ws HTTP/1.1\r\nHost: localhost\r\nX-Header: ",
        "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10000\r\n\r\n"}) {
    drips.emplace_back([this, request] {
      RawClient slow(port);
      try {
        slow.write(request);
        for (;; pause(milliseconds(50))) slow.write("X");
      } catch (const std::runtime_error&) {  // closed as expected
      }
    });
  }
  EXPECT_EQ(silent.read_all(), "");
  EXPECT_EQ(half.read_all(), "");
  for (std::thread& drip : drips) drip.join();
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(200));
  expect_alive();
}

TEST_F(TransportHostileTest, APeerThatDropsInTheMiddleOfAMessage) {
  start();
  const std::string frame = client_frame(1, std::string(1000, 'x'));
  for (const std::size_t size : {1U, 3U, 7U, 500U}) {
    WsClient client(port);
    client.raw().write(frame.substr(0, size));
    if (size % 2 == 1) {
      client.raw().reset();
    } else {
      client.raw().close();
    }
  }
  ASSERT_TRUE(recorder.wait_closed(4));
  EXPECT_TRUE(recorder.received.empty());
  expect_alive();
}

TEST_F(TransportHostileTest, APeerThatVanishesDuringTheHandshake) {
  start();
  const std::string request =
      "GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\n" + upgrade_headers() + "\r\n";
  for (int i = 0; i < 200; ++i) {
    RawClient client(port);
    client.write(request);
    if (i % 2 == 0) client.reset();
  }
  expect_alive();
}

TEST_F(TransportHostileTest, ASilentPeerIsDropped) {
  settings.ping_interval = milliseconds(100);
  start();
  WsClient silent(port);
  ASSERT_TRUE(recorder.wait_closed(1));
  const auto frame = silent.read_frame();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->opcode, 9);
}

TEST_F(TransportHostileTest, APeerThatAnswersPingsStays) {
  settings.ping_interval = milliseconds(100);
  start();
  WsClient client(port);
  for (int i = 0; i < 8; ++i) {
    const auto frame = client.read_frame();
    ASSERT_TRUE(frame);
    ASSERT_EQ(frame->opcode, 9);
    client.raw().write(client_frame(10, frame->payload));
  }
  EXPECT_EQ(recorder.ended.size(), 0u);
}

// Pongs for all pings would be 25 MB, more than the kernel's buffers hold. Unless the server skips
// some, they accumulate in its memory.
TEST_F(TransportHostileTest, AFloodOfPingsFromAPeerThatNeverReads) {
  start();
  WsClient client(port);
  constexpr std::size_t kBatches = 2000;
  constexpr std::size_t kPerBatch = 100;
  std::string batch;
  for (std::size_t i = 0; i < kPerBatch; ++i) batch += client_frame(9, std::string(125, 'p'));
  for (std::size_t i = 0; i < kBatches; ++i) client.raw().write(batch);
  client.send_text("done");
  ASSERT_TRUE(recorder.wait([&] { return recorder.received.size() == 1; }));
  recorder.connection(1)->send_text("count");
  std::size_t pongs = 0;
  for (auto frame = client.read_frame(); frame && frame->opcode == 10;
       frame = client.read_frame()) {
    ++pongs;
  }
  EXPECT_GT(pongs, 0u);
  EXPECT_LT(pongs, kBatches * kPerBatch / 2);
}

TEST_F(TransportHostileTest, SocketsThatSayNothingAreLimited) {
  settings.max_connections = 4;
  start();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 300; ++i) idle.push_back(std::make_unique<RawClient>(port));
  EXPECT_EQ(idle.back()->read_all(), "");  // immediately, long before the handshake's time limit
  idle.clear();
  const auto is_accepted = [&] {  // after the server has noticed the disconnections
    try {
      expect_alive();
      return true;
    } catch (const std::runtime_error&) {
      return false;
    }
  };
  EXPECT_TRUE(wait_until(is_accepted));
}

TEST_F(TransportHostileTest, AnAddressHasItsShareOfTheConnections) {
  settings.max_connections = 100;
  settings.max_connections_per_address = 3;
  std::vector<std::string> refusals;
  std::vector<std::uint16_t> closes;
  settings.count_refusal = [&](std::string_view limit) { refusals.emplace_back(limit); };
  settings.count_close = [&](std::uint16_t code) { closes.push_back(code); };
  start();
  std::vector<std::unique_ptr<WsClient>> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(std::make_unique<WsClient>(port));
  EXPECT_EQ(WsClient(port).read_close(), 1013);
  ASSERT_TRUE(recorder.wait_opened(3));
  EXPECT_EQ(recorder.connection(1)->address(), "127.0.0.1");
  clients.pop_back();
  ASSERT_TRUE(recorder.wait_closed(1));
  expect_alive();
  transport->stop();
  EXPECT_EQ(refusals, std::vector<std::string>{"connections_per_address"});
  EXPECT_EQ(std::count(closes.begin(), closes.end(), 1001), 2) << "closed by the server's stop";
}

// Silent sockets count too. Other addresses can still connect.
TEST_F(TransportHostileTest, AnAddressHasItsShareOfTheSockets) {
  settings.max_connections_per_address = 4;
  start();
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 100; ++i) idle.push_back(std::make_unique<RawClient>(port));
  EXPECT_EQ(idle.back()->read_all(), "");  // immediately, long before the handshake's time limit
  RawClient elsewhere(port, "127.0.0.2");
  elsewhere.write("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_NE(elsewhere.read_all().find(" 200 "), std::string::npos);
}

TEST_F(TransportHostileTest, AHandlerThatThrowsCostsThatConnectionOnly) {
  expected_faults = {"message: the handler failed"};
  start();
  WsClient other(port);
  WsClient client(port);
  client.send_text("throw");
  EXPECT_EQ(client.read_close(), 1011);
  expect_alive();
  recorder.echo = true;
  other.send_text("me too");
  EXPECT_EQ(other.read_message().payload, "me too");
}

}  // namespace

}  // namespace vat::test::transport_hostile_test
