#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <future>

#include "tests/server/transport/transport_fixture.h"
#include "tests/support/wait.h"

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

TEST_F(TransportStopTest, NotifiesEveryClient) {
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
  RawClient kept(port);
  EXPECT_EQ(http_again(kept, "/").status, 200);
  EXPECT_LT(timed_stop(), milliseconds(500));
  transport.reset();
  EXPECT_EQ(kept.read_all(), "");
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

// Two programs that share a port would receive each other's clients.
TEST_F(TransportStopTest, AnAddressThatCannotBeUsedIsNamed) {
  const auto error_of_start = [this](const std::string& host, std::uint16_t at) -> std::string {
    settings.host = host;
    settings.port = at;
    try {
      make_websocket_transport(settings, recorder, http_handler)->start();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  start();
  EXPECT_EQ(error_of_start("127.0.0.1", port),
            "cannot listen on 127.0.0.1:" + std::to_string(port) + ": Address already in use");
  EXPECT_EQ(error_of_start("192.0.2.1", 0),  // reserved for documentation, RFC 5737
            "cannot listen on 192.0.2.1:0: Cannot assign requested address");
  EXPECT_EQ(error_of_start("example.org", 0),
            "cannot listen on example.org:0: the host must be a numeric address");
}

// Socket options that the transport sets. The tests find its sockets among all of this process.

std::uint16_t local_port(int file) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  return address.sin_family == AF_INET ? ntohs(address.sin_port) : 0;
}

/// Returns the value of a socket option; absent if the server has closed the socket in the
/// meantime.
std::optional<int> option(int file, int level, int name) {
  int value = -1;
  socklen_t size = sizeof value;
  if (getsockopt(file, level, name, &value, &size) != 0) return {};
  return value;
}

/// Returns the server's listening sockets, or the sockets of its connections.
std::vector<int> sockets_of(std::uint16_t port, bool listening) {
  constexpr int kMaxFiles = 4096;
  std::vector<int> files;
  for (int file = 0; file < kMaxFiles; ++file) {
    if (local_port(file) != port) continue;
    if (option(file, SOL_SOCKET, SO_ACCEPTCONN) == (listening ? 1 : 0)) files.push_back(file);
  }
  return files;
}

class TransportSocketsTest : public TransportTest {};

// Otherwise the end of a frame may wait for an acknowledgement that the peer delays by 40 ms.
TEST_F(TransportSocketsTest, SendAtOnce) {
  settings.endpoints = 2;
  start();
  std::vector<std::unique_ptr<WsClient>> clients;
  for (int i = 0; i < 8; ++i) clients.push_back(std::make_unique<WsClient>(port));
  ASSERT_TRUE(recorder.wait_opened(8));
  const std::vector<int> sockets = sockets_of(port, false);
  ASSERT_EQ(sockets.size(), 8U);
  for (const int socket : sockets) EXPECT_EQ(option(socket, IPPROTO_TCP, TCP_NODELAY), 1);
}

// socket(7): the system doubles the setting for its own use.
TEST_F(TransportSocketsTest, HoldLittle) {
  settings.send_buffer_bytes = 100'000;
  start();
  WsClient client(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  const std::vector<int> sockets = sockets_of(port, false);
  ASSERT_EQ(sockets.size(), 1U);
  EXPECT_EQ(option(sockets[0], SOL_SOCKET, SO_SNDBUF), 200'000);
}

bool wait_for_no_socket(std::uint16_t port) {
  return wait_until([port] { return sockets_of(port, false).empty(); });
}

/// An HTTP handler that blocks until the test lets it answer.
class SlowHandler {
 public:
  HttpResponse operator()() {
    entered_.set_value();
    may_answer_.get_future().wait();
    return {200, "text/plain", "slow", {}};
  }
  void wait_until_asked() { entered_.get_future().wait(); }
  void answer() { may_answer_.set_value(); }

 private:
  std::promise<void> entered_;
  std::promise<void> may_answer_;
};

// The sequence of browsers: the client answers the close frame, and closes after the server has
// closed its half. The server is busy meanwhile, and processes all of this at once.
TEST_F(TransportSocketsTest, AreGivenBackAfterTheServerHasClosed) {
  SlowHandler handler;
  http_handler = [&](const HttpRequest&) { return handler(); };
  start();
  WsClient client(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  recorder.connection(1)->close(4003, "kicked");
  EXPECT_EQ(client.read_close(), 4003);
  client.raw().read_all();
  RawClient slow(port);
  slow.write("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
  handler.wait_until_asked();
  client.raw().close();
  handler.answer();
  slow.read_all();
  slow.close();
  EXPECT_TRUE(wait_for_no_socket(port));
}

// Immediately, not after the second that a peer may take to close its half.
TEST_F(TransportSocketsTest, AreGivenBackAfterTheClientHasClosed) {
  constexpr std::size_t kClients = 8;
  start();
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < kClients; ++i) {
    WsClient client(port);
    ASSERT_TRUE(recorder.wait_opened(i + 1));
    client.raw().write(client_frame(8, "\x03\xe8"));
    client.raw().read_all();
    client.raw().close();
    EXPECT_TRUE(wait_for_no_socket(port));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kClients * std::chrono::seconds(1) / 2);
  EXPECT_TRUE(recorder.wait_closed(kClients));
}

// After a restart of the server many clients connect at once. For a listening socket, tcpi_sacked
// is the length of its queue.
TEST_F(TransportSocketsTest, ManyMayWaitToBeAccepted) {
  start();
  const std::vector<int> sockets = sockets_of(port, true);
  ASSERT_EQ(sockets.size(), 1U);
  tcp_info info{};
  socklen_t size = sizeof info;
  ASSERT_EQ(getsockopt(sockets[0], IPPROTO_TCP, TCP_INFO, &info, &size), 0);
  unsigned most = 0;
  std::ifstream("/proc/sys/net/core/somaxconn") >> most;
  EXPECT_GE(info.tcpi_sacked, std::min(1024U, most));
}

// A slow handler delays the clients that connect meanwhile, but does not close their connections.
TEST_F(TransportSocketsTest, ANewConnectionIsServedDuringASlowHandler) {
  SlowHandler handler;
  http_handler = [&](const HttpRequest&) { return handler(); };
  recorder.echo = true;
  start();
  RawClient slow(port);
  slow.write("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n");
  std::vector<std::unique_ptr<RawClient>> waiting;
  const std::string request =
      "GET /ws HTTP/1.1\r\nHost: 127.0.0.1\r\n" + upgrade_headers() + "\r\n";
  for (int i = 0; i < 100; ++i) {
    waiting.push_back(std::make_unique<RawClient>(port));
    waiting.back()->write(request);
  }
  handler.wait_until_asked();
  handler.answer();
  EXPECT_TRUE(recorder.wait_opened(100));
}

}  // namespace
}  // namespace vat::test::transport_stop_test
