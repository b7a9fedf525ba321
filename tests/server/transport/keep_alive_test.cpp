// Several HTTP requests on one connection.

#include "tests/server/transport/transport_fixture.h"

namespace vat::test::keep_alive_test {
namespace {

class KeepAliveTest : public TransportTest {};

TEST_F(KeepAliveTest, AConnectionServesManyRequests) {
  start();
  RawClient client(port);
  for (int i = 0; i < 100; ++i) {
    const std::string target = "/" + std::to_string(i);
    const HttpReply reply = http_again(client, target);
    EXPECT_EQ(reply.status, 200);
    EXPECT_EQ(reply.body, target);
    EXPECT_EQ(reply.header("Connection"), "");
  }
}

TEST_F(KeepAliveTest, AWebSocketCanFollow) {
  recorder.echo = true;
  start();
  RawClient client(port);
  EXPECT_EQ(http_again(client, "/page").body, "/page");
  client.write("GET /ws HTTP/1.1\r\nHost: localhost\r\n" + upgrade_headers() + "\r\n");
  std::string reply;
  while (reply.find("\r\n\r\n") == std::string::npos) {
    const std::string part = client.read_some();
    ASSERT_NE(part, "") << "the connection is closed";
    reply += part;
  }
  EXPECT_EQ(parse_reply(reply).status, 101);
  client.write(client_frame(1, "hello"));
  EXPECT_EQ(client.read_exactly(7).substr(2), "hello");
  EXPECT_EQ(recorder.connection(1)->address(), "127.0.0.1");
}

// The transport closes the connection if it cannot tell where the next request begins.
TEST_F(KeepAliveTest, EndsAfterOtherRequests) {
  start();
  const std::string head = "GET /first HTTP/1.1\r\nHost: localhost\r\n";
  const std::string second = "GET /second HTTP/1.1\r\nHost: localhost\r\n\r\n";
  for (const std::string& request :
       {head + "Connection: close\r\n\r\n", head + "Connection: x, Close\r\n\r\n",
        std::string("GET /first HTTP/1.0\r\nHost: localhost\r\n\r\n"), head + "\r\n" + second,
        head + "Content-Length: 3\r\n\r\nabc", head + "Content-Length: 0, 3\r\n\r\n",
        head + "Content-Length: x\r\n\r\n",
        head + "Transfer-Encoding: chunked\r\n\r\n0\r\n\r\n" + second,
        head + "Transfer-Encoding: chunked\r\n\r\n"}) {
    RawClient client(port);
    client.write(request);
    const HttpReply reply = parse_reply(client.read_all());
    EXPECT_EQ(reply.body, "/first") << request;
    EXPECT_EQ(reply.header("Connection"), "close") << request;
  }
}

TEST_F(KeepAliveTest, AnIdleConnectionIsClosedInTime) {
  settings.handshake_timeout = std::chrono::milliseconds(300);
  start();
  RawClient client(port);
  EXPECT_EQ(http_again(client, "/").status, 200);
  EXPECT_EQ(client.read_all(), "");
}

TEST_F(KeepAliveTest, EndsWithAMalformedRequest) {
  start();
  RawClient client(port);
  EXPECT_EQ(http_again(client, "/").status, 200);
  client.write("nonsense\r\n\r\n");
  EXPECT_EQ(parse_reply(client.read_all()).status, 400);
}

// Idle connections leave room for others.
TEST_F(KeepAliveTest, ConnectionsAreKeptUpToALimit) {
  constexpr std::size_t kMaxKeptSockets = 128;
  start();
  std::vector<std::unique_ptr<RawClient>> kept;
  for (std::size_t i = 0; i < kMaxKeptSockets; ++i) {
    const std::string address = "127.0.0." + std::to_string(2 + i / 50);
    kept.push_back(std::make_unique<RawClient>(port, address.c_str()));
    EXPECT_EQ(http_again(*kept.back(), "/").header("Connection"), "") << i;
  }
  RawClient next(port, "127.0.0.9");
  EXPECT_EQ(http_again(next, "/").header("Connection"), "close");
  EXPECT_EQ(next.read_all(), "");
}

TEST_F(KeepAliveTest, AKeptConnectionCountsOnceForItsAddress) {
  constexpr std::size_t kMaxSockets = 1 + 64;  // WebSockets and other sockets of an address
  settings.max_connections_per_address = 1;
  start();
  std::vector<std::unique_ptr<RawClient>> clients;
  for (std::size_t i = 0; i < kMaxSockets; ++i)
    clients.push_back(std::make_unique<RawClient>(port));
  for (int round = 0; round < 3; ++round) {
    for (const auto& client : clients) ASSERT_EQ(http_again(*client, "/").status, 200) << round;
  }
  EXPECT_EQ(RawClient(port).read_all(), "");
}

// Each request on a proxy's connection can come from another client.
TEST_F(KeepAliveTest, EachRequestOfAProxyHasItsOwnClient) {
  settings.trusted_proxies = {"127.0.0.1"};
  start();
  RawClient client(port);
  EXPECT_EQ(http_again(client, "/", "X-Forwarded-For: 198.51.100.1\r\n").status, 200);
  client.write("GET /ws HTTP/1.1\r\nHost: localhost\r\nX-Forwarded-For: 198.51.100.2\r\n" +
               upgrade_headers() + "\r\n");
  ASSERT_TRUE(recorder.wait_opened(1));
  EXPECT_EQ(recorder.connection(1)->address(), "198.51.100.2");
}

}  // namespace
}  // namespace vat::test::keep_alive_test
