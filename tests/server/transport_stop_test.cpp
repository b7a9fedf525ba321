#include <atomic>
#include <thread>

#include "tests/server/transport_fixture.h"

namespace vat::test::transport_stop_test {

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

class TransportStopTest : public TransportTest {
 protected:
  milliseconds timed_stop() {
    const auto begin = steady_clock::now();
    transport->stop();
    return std::chrono::duration_cast<milliseconds>(steady_clock::now() - begin);
  }
};

TEST_F(TransportStopTest, TellsEveryClient) {
  start();
  std::vector<std::unique_ptr<WsClient>> clients;
  std::atomic<int> told = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 20; ++i) clients.push_back(std::make_unique<WsClient>(port));
  ASSERT_TRUE(recorder.wait_opened(20));
  for (auto& client : clients) {
    threads.emplace_back([&] {
      told += client->read_close() == 1001 ? 1 : 0;
      client->raw().close();
    });
  }
  EXPECT_LT(timed_stop(), milliseconds(1500));
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(told, 20);
  EXPECT_EQ(recorder.ended.size(), 20u);
}

TEST_F(TransportStopTest, WhileBothSidesAreSending) {
  recorder.echo = true;
  start();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      try {
        WsClient client(port);
        for (;;) {
          client.send_text("hello");
          client.read_message();
        }
      } catch (const std::runtime_error&) {  // the server has stopped
      }
    });
  }
  ASSERT_TRUE(recorder.wait([&] { return recorder.received.size() > 200; }));
  std::atomic<bool> sending = true;
  std::thread sender([&] {
    const auto connection = recorder.connection(1);
    const auto bytes = std::make_shared<const std::string>(1000, 'x');
    while (sending) {
      connection->send_binary(bytes);
      std::this_thread::yield();
    }
  });
  EXPECT_LT(timed_stop(), milliseconds(2500));
  sending = false;
  sender.join();
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(recorder.ended.size(), recorder.connections.size());
}

TEST_F(TransportStopTest, DoesNotWaitLongForAPeerThatNeverReads) {
  start();
  WsClient deaf(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  const auto connection = recorder.connection(1);
  connection->send_binary(std::make_shared<const std::string>(64 * 1024 * 1024, 'x'));
  const milliseconds time = timed_stop();
  EXPECT_GE(time, milliseconds(900));
  EXPECT_LT(time, milliseconds(2000));
  EXPECT_EQ(recorder.ended.size(), 1u);
}

TEST_F(TransportStopTest, DoesNotWaitForSocketsThatAreNotWebSockets) {
  start();
  RawClient silent(port);
  RawClient half(port);
  half.write("GET / HTTP/1.1\r\n");
  EXPECT_LT(timed_stop(), milliseconds(500));
}

TEST_F(TransportStopTest, TwiceAndWithoutAStart) {
  start();
  transport->stop();
  transport->stop();
  make_websocket_transport(settings, recorder, http_handler)->stop();
}

TEST_F(TransportStopTest, ThePortIsFreeAtOnce) {
  start();
  {
    WsClient client(port);
    ASSERT_TRUE(recorder.wait_opened(1));
    timed_stop();
  }
  settings.port = port;
  EXPECT_NO_THROW(start());
  EXPECT_EQ(http(port, "GET", "/x").body, "/x");
}

std::string error_of_start(Transport& transport) {
  try {
    transport.start();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(TransportStopTest, APortInUseIsAnErrorThatNamesIt) {
  start();
  settings.port = port;
  const auto second = make_websocket_transport(settings, recorder, http_handler);
  EXPECT_EQ(error_of_start(*second),
            "cannot listen on 127.0.0.1:" + std::to_string(port) + ": Address already in use");
}

TEST_F(TransportStopTest, AnAddressOfNobodyIsAnErrorThatNamesIt) {
  settings.host = "192.0.2.1";  // for documentation only, RFC 5737
  EXPECT_EQ(error_of_start(*make_websocket_transport(settings, recorder, http_handler)),
            "cannot listen on 192.0.2.1:0: Cannot assign requested address");
  settings.host = "example.org";
  EXPECT_EQ(error_of_start(*make_websocket_transport(settings, recorder, http_handler)),
            "cannot listen on example.org:0: the host must be a numeric address");
}

}  // namespace

}  // namespace vat::test::transport_stop_test
