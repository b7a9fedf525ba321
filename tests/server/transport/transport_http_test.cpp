#include <gmock/gmock.h>

#include <future>

#include "server/transport/ws_upgrade.h"
#include "tests/server/transport/transport_fixture.h"

namespace vat::test::transport_http_test {
namespace {

class TransportHttpTest : public TransportTest {};

TEST_F(TransportHttpTest, PassesOnTheHandlersAnswer) {
  http_handler = [](const HttpRequest& request) {
    return HttpResponse{404,
                        "text/plain",
                        std::string(request.method) + " " + std::string(request.target),
                        {{"X-Test", "yes"}}};
  };
  start();
  const HttpReply reply = http(port, "GET", "/a/../b%00?q=1");
  EXPECT_EQ(reply.status, 404);
  EXPECT_EQ(reply.body, "GET /a/../b%00?q=1");
  EXPECT_EQ(reply.header("Content-Type"), "text/plain");
  EXPECT_EQ(reply.header("Content-Length"), std::to_string(reply.body.size()));
  EXPECT_EQ(reply.header("X-Test"), "yes");
  EXPECT_EQ(reply.header("Connection"), "close");
  EXPECT_EQ(http(port, "BREW", "/").body, "BREW /");
  const HttpReply head = http(port, "HEAD", "/x");
  EXPECT_EQ(head.status, 404);
  EXPECT_EQ(head.header("Content-Length"), "7");
  EXPECT_EQ(head.body, "");
}

TEST_F(TransportHttpTest, AResponseMayFollowFromAnotherThread) {
  std::promise<std::function<void(HttpResponse)>> asked;
  http_handler = [&](const HttpRequest& request) {
    HttpResponse response{200, "text/plain", std::string(request.target), {}};
    if (request.target != "/late") return response;
    response.later = [&](std::function<void(HttpResponse)> answer) {
      asked.set_value(std::move(answer));
    };
    return response;
  };
  start();
  auto late = std::async(std::launch::async, [&] { return http(port, "GET", "/late"); });
  const auto answer = asked.get_future().get();
  EXPECT_EQ(http(port, "GET", "/other").body, "/other");
  answer({201, "text/plain", "now", {{"X-Test", "yes"}}});
  answer({500, "text/plain", "again", {}});
  const HttpReply reply = late.get();
  EXPECT_EQ(reply.status, 201);
  EXPECT_EQ(reply.body, "now");
  EXPECT_EQ(reply.header("X-Test"), "yes");
}

TEST_F(TransportHttpTest, AResponseMayFollowAfterTheEnd) {
  std::promise<std::function<void(HttpResponse)>> asked;
  http_handler = [&](const HttpRequest&) {
    HttpResponse response;
    response.later = [&](std::function<void(HttpResponse)> answer) {
      asked.set_value(std::move(answer));
    };
    return response;
  };
  start();
  RawClient client(port);
  client.write("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  const auto answer = asked.get_future().get();
  transport->stop();
  answer({200, "text/plain", "too late", {}});
  transport.reset();
  answer({200, "text/plain", "too late", {}});
  EXPECT_EQ(client.read_all(), "");
}

TEST_F(TransportHttpTest, SendsALargeBodyWhole) {
  std::string large(16 * 1024 * 1024, '\0');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * 31 >> 8);
  http_handler = [&](const HttpRequest&) {
    return HttpResponse{200, "application/octet-stream", large, {}};
  };
  start();
  const HttpReply reply = http(port, "GET", "/");
  EXPECT_EQ(reply.header("Content-Length"), std::to_string(large.size()));
  EXPECT_TRUE(reply.body == large);
}

TEST_F(TransportHttpTest, AHandlerThatThrowsGives500) {
  http_handler = [](const HttpRequest&) -> HttpResponse { throw std::runtime_error("broken"); };
  expected_faults = {"http: broken"};
  start();
  EXPECT_EQ(http(port, "GET", "/").status, 500);
}

TEST_F(TransportHttpTest, ABodyThatIsTooLongGets413WhileThePeerSends) {
  settings.max_http_request_bytes = 1000;
  start();
  EXPECT_EQ(http(port, "POST", "/", "Content-Length: 1000\r\n", std::string(1000, 'x')).status,
            200);
  const std::string body(4 * 1024 * 1024, 'x');
  const HttpReply reply =
      http(port, "POST", "/", "Content-Length: " + std::to_string(body.size()) + "\r\n", body);
  EXPECT_EQ(reply.status, 413);
}

TEST_F(TransportHttpTest, MalformedRequestsGetAnError) {
  start();
  const auto status = [&](const std::string& request) {
    RawClient client(port);
    client.write(request);
    return parse_reply(client.read_all()).status;
  };
  EXPECT_EQ(status("GET / HTTP/1.1\r\n\r\n"), 400);  // no Host
  EXPECT_EQ(status("GET /\r\nHost: localhost\r\n\r\n"), 400);
  EXPECT_EQ(status("G\x01T / HTTP/1.1\r\nHost: localhost\r\n\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x:99999999\r\n\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nnonsense\r\n\r\n"), 400);
  EXPECT_EQ(
      status("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20000, 'x') + "\r\n\r\n"),
      431);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n"), 200);
}

// A page at a name that resolves to this server (DNS rebinding) reaches neither files nor
// WebSocket.
TEST_F(TransportHttpTest, AForeignHostGets421) {
  settings.public_names = {"vat.example"};
  start();
  const auto statuses = [&](const std::string& host) {
    const std::string origin = "Origin: http://" + host + "\r\n";
    return std::pair(status_for_host(port, host),
                     status_for_host(port, host, upgrade_headers() + origin));
  };
  for (const char* good : {"localhost", "127.0.0.1:80", "[::1]", "192.0.2.1", "Vat.Example:1"}) {
    EXPECT_EQ(statuses(good), std::pair(200, 101)) << good;
  }
  for (const char* foreign : {"evil.example", "vat.example.evil", "localhost, evil.example"}) {
    EXPECT_EQ(statuses(foreign), std::pair(421, 421)) << foreign;
  }
}

TEST_F(TransportHttpTest, TheReplyToAForeignHostNamesTheSetting) {
  start();
  RawClient client(port);
  client.write("GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n");
  const HttpReply reply = parse_reply(client.read_all());
  EXPECT_EQ(reply.head.substr(0, reply.head.find("\r\n")), "HTTP/1.1 421 Misdirected Request");
  EXPECT_NE(reply.body.find("--public-name"), std::string::npos) << reply.body;
}

TEST_F(TransportHttpTest, OnlyResponsesWithoutContentHaveNoLength) {
  for (const int status : {200, 204, 304}) {
    http_handler = [=](const HttpRequest&) {
      return HttpResponse{status, "text/plain", "", {{"ETag", "\"x\""}}};
    };
    start();
    const HttpReply reply = http(port, "GET", "/");
    EXPECT_EQ(reply.status, status);
    EXPECT_EQ(reply.header("Content-Length"), status == 200 ? "0" : "");
    EXPECT_EQ(reply.header("Content-Type"), status == 200 ? "text/plain" : "");
    EXPECT_EQ(reply.header("ETag"), "\"x\"");
    transport->stop();
  }
}

TEST_F(TransportHttpTest, PassesOnTheHeadersOfTheRequest) {
  http_handler = [](const HttpRequest& request) {
    return HttpResponse{200,
                        "text/plain",
                        std::string(request.accept_encoding) + '|' +
                            std::string(request.if_none_match) + '|' +
                            std::string(request.authorization),
                        {}};
  };
  start();
  EXPECT_EQ(http(port, "GET", "/").body, "||");
  EXPECT_EQ(http(port, "GET", "/",
                 "accept-encoding: br\r\nAccept-Encoding: gzip\r\nIf-None-Match: \"x\"\r\n"
                 "Authorization: Bearer y\r\n")
                .body,
            "br, gzip|\"x\"|Bearer y");
}

/// A server behind a proxy at 127.0.0.2.
class TransportProxyTest : public TransportTest {
 protected:
  TransportProxyTest() { settings.trusted_proxies = {"127.0.0.2"}; }

  /// Opens a WebSocket for a client of the peer. Returns the status.
  int open(const char* peer, const std::string& client) {
    open_.push_back(std::make_unique<RawClient>(port, peer));
    open_.back()->write("GET /ws HTTP/1.1\r\nHost: localhost\r\n" + upgrade_headers() +
                        "X-Forwarded-For: " + client + "\r\n\r\n");
    return parse_reply(open_.back()->read_some()).status;
  }

 private:
  std::vector<std::unique_ptr<RawClient>> open_;
};

TEST_F(TransportProxyTest, ClientsAreCountedByTheirOwnAddresses) {
  settings.max_connections_per_address = 1;
  start();
  EXPECT_EQ(open("127.0.0.2", "198.51.100.1"), 101);
  EXPECT_EQ(open("127.0.0.2", "198.51.100.2"), 101);
  EXPECT_EQ(open("127.0.0.3", "198.51.100.3"), 101);
  ASSERT_TRUE(recorder.wait_opened(3));
  const auto address_of = [&](ConnectionId id) { return recorder.connection(id)->address(); };
  EXPECT_EQ(address_of(1), "198.51.100.1");
  EXPECT_EQ(address_of(2), "198.51.100.2");
  EXPECT_EQ(address_of(3), "127.0.0.3") << "not a trusted proxy";
}

// More sockets than one address may have. Each client still has the limit of an address.
TEST_F(TransportProxyTest, TheSocketsOfTheProxyAreLimitedByClient) {
  constexpr int kMaxOtherSockets = 64;
  settings.max_connections_per_address = 1;
  std::vector<std::string> refusals;
  settings.count_refusal = [&](std::string_view limit) { refusals.emplace_back(limit); };
  start();
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < kMaxOtherSockets + 20; ++i) {
    silent.push_back(std::make_unique<RawClient>(port, "127.0.0.2"));
  }
  EXPECT_EQ(open("127.0.0.2", "198.51.100.1"), 101);
  int status = 101;
  for (int i = 0; i <= kMaxOtherSockets && status == 101; ++i) {
    status = open("127.0.0.2", "198.51.100.1");
  }
  EXPECT_EQ(status, 429);
  EXPECT_EQ(open("127.0.0.2", "198.51.100.2"), 101);
  transport->stop();
  EXPECT_THAT(refusals, testing::Each("connections_per_address"));
  EXPECT_FALSE(refusals.empty());
}

class TransportUpgradeTest : public TransportTest {
 protected:
  TransportUpgradeTest() { start(); }
};

TEST_F(TransportUpgradeTest, GrantsTheSubprotocol) {
  const HttpReply reply = try_upgrade(port, "/ws?name=x", upgrade_headers("vat.v2, vat.v1"));
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Protocol"), "vat.v1");
  // The reply to this key in RFC 6455, section 1.3.
  EXPECT_EQ(reply.header("Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_TRUE(recorder.wait_closed(1));
}

TEST_F(TransportUpgradeTest, RefusesOtherVersionsAndNamesItsOwn) {
  for (const char* version : {"", "0", "7", "8", "12", "14", "-1", "thirteen"}) {
    const HttpReply reply = try_upgrade(port, "/ws", upgrade_headers("vat.v1", version));
    EXPECT_EQ(reply.status, 400) << version;
    EXPECT_EQ(reply.header("Sec-WebSocket-Version"), "13") << version;
    EXPECT_EQ(reply.body, "Sec-WebSocket-Version must be 13.\n") << version;
  }
}

TEST_F(TransportUpgradeTest, AdmitsPagesOfThisServerOnly) {
  const std::string host = "127.0.0.1:" + std::to_string(port);
  for (const auto& [origin, status] :
       {std::pair("http://" + host, 101), std::pair("https://" + host, 101),
        std::pair(std::string("http://127.0.0.1"), 403), std::pair("http://" + host + "0", 403)}) {
    const std::string headers = upgrade_headers() + "Origin: " + origin + "\r\n";
    EXPECT_EQ(try_upgrade(port, "/ws", headers).status, status) << origin;
  }
}

/// Returns the status of a refusal, or 101.
int status_of(const UpgradeRequest& request) {
  const std::vector<std::string> allowed{"https://example.org", "http://b.example:8443"};
  const auto refusal = refuse_upgrade(request, allowed);
  return refusal ? refusal->status : 101;
}

const std::vector<std::string> kOffered{"vat.v1"};

TEST(UpgradeRules, RefuseOtherPathsAndSubprotocols) {
  for (const char* target : {"/ws", "/ws?name=x"}) {
    EXPECT_EQ(status_of({target, "host:80", "", "13", kOffered}), 101) << target;
  }
  for (const char* target : {"/", "/ws/", "/WS", "/wss", "/x/ws", "//ws", "/%77s", "/?/ws"}) {
    EXPECT_EQ(status_of({target, "host:80", "", "13", kOffered}), 400) << target;
  }
  for (const char* other : {"", "vat.v2", "VAT.V1", "vat.v10"}) {
    const std::vector<std::string> offered{other};
    EXPECT_EQ(status_of({"/ws", "host:80", "", "13", offered}), 400) << other;
  }
  const std::vector<std::string> several{"vat.v2", "vat.v1"};
  EXPECT_EQ(status_of({"/ws", "host:80", "", "13", several}), 101);
}

// Origins are compared by their complete names, without regard to case.
TEST(UpgradeRules, RefuseOtherOrigins) {
  for (const char* good : {"https://example.org", "https://EXAMPLE.org", "http://b.example:8443",
                           "http://host:80", "https://host:80", ""}) {
    EXPECT_EQ(status_of({"/ws", "host:80", good, "13", kOffered}), 101) << good;
  }
  for (const char* foreign :
       {"http://example.org", "https://example.org:8443", "https://a.example.org",
        "https://example.org.evil", "https://b.example:8443", "null", "https://", "*",
        "http://host", "http://host:80.example.org", "http://host:800", "host:80",
        "http://example.org/http://host:80"}) {
    EXPECT_EQ(status_of({"/ws", "host:80", foreign, "13", kOffered}), 403) << foreign;
  }
}

TEST_F(TransportUpgradeTest, NeverCompresses) {
  const HttpReply reply = try_upgrade(
      port, "/ws", upgrade_headers() + "Sec-WebSocket-Extensions: permessage-deflate\r\n");
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Extensions"), "");
}

TEST_F(TransportUpgradeTest, ARefusedClientIsNotAnnounced) {
  const HttpReply reply = try_upgrade(port, "/ws", upgrade_headers("vat.v2"));
  EXPECT_EQ(reply.status, 400);
  EXPECT_NE(reply.body.find("vat.v1"), std::string::npos) << reply.body;
  EXPECT_EQ(try_upgrade(port, "/", upgrade_headers()).status, 400);
  WsClient good(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  EXPECT_EQ(recorder.connections.size(), 1u);
}

}  // namespace
}  // namespace vat::test::transport_http_test
