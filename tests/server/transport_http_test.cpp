#include <atomic>
#include <thread>

#include "server/net/ws_upgrade.h"
#include "tests/server/transport_fixture.h"

namespace vat::test::transport_http_test {
namespace {

class TransportHttpTest : public TransportTest {};

TEST_F(TransportHttpTest, PassesOnTheHandlersAnswer) {
  http_handler = [](std::string_view method, std::string_view target) {
    return HttpResponse{
        404, "text/plain", std::string(method) + " " + std::string(target), {{"X-Test", "yes"}}};
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
}

TEST_F(TransportHttpTest, HeadHasTheLengthAndNoBody) {
  start();
  const HttpReply reply = http(port, "HEAD", "/twelve-bytes");
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.header("Content-Length"), "13");
  EXPECT_EQ(reply.body, "");
}

TEST_F(TransportHttpTest, AnEmptyBodyHasALength) {
  http_handler = [](std::string_view, std::string_view) {
    return HttpResponse{204, "text/plain", "", {}};
  };
  start();
  EXPECT_EQ(http(port, "GET", "/").header("Content-Length"), "0");
}

TEST_F(TransportHttpTest, SendsALargeBodyWhole) {
  std::string large(16 * 1024 * 1024, '\0');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * 31 >> 8);
  http_handler = [&](std::string_view, std::string_view) {
    return HttpResponse{200, "application/octet-stream", large, {}};
  };
  start();
  const HttpReply reply = http(port, "GET", "/");
  EXPECT_EQ(reply.header("Content-Length"), std::to_string(large.size()));
  EXPECT_TRUE(reply.body == large);
}

TEST_F(TransportHttpTest, AHandlerThatThrowsGives500) {
  http_handler = [](std::string_view, std::string_view) -> HttpResponse {
    throw std::runtime_error("broken");
  };
  expected_faults = {"http: broken"};
  start();
  EXPECT_EQ(http(port, "GET", "/").status, 500);
}

TEST_F(TransportHttpTest, ABodyThatIsTooLongGets413AlthoughThePeerGoesOnSending) {
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
  EXPECT_EQ(status("GET /\r\nHost: x\r\n\r\n"), 400);
  EXPECT_EQ(status("G\x01T / HTTP/1.1\r\nHost: x\r\n\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x:99999999\r\n\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x\r\nnonsense\r\n\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(20000, 'x') + "\r\n\r\n"), 431);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: x\r\n\r\n"), 200);
}

class TransportUpgradeTest : public TransportTest {
 protected:
  TransportUpgradeTest() { start(); }
  std::string origin(const std::string& value) {
    return upgrade_headers() + "Origin: " + value + "\r\n";
  }
  std::string host() const { return "127.0.0.1:" + std::to_string(port); }
};

TEST_F(TransportUpgradeTest, GrantsTheSubprotocol) {
  const HttpReply reply = try_upgrade(port, "/ws", upgrade_headers());
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Protocol"), "vat.v1");
  // The answer to this key that RFC 6455, section 1.3 prints.
  EXPECT_EQ(reply.header("Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
  EXPECT_TRUE(recorder.wait_closed(1));
}

TEST_F(TransportUpgradeTest, PicksTheSubprotocolFromSeveral) {
  const HttpReply reply = try_upgrade(port, "/ws?name=x", upgrade_headers("vat.v2, vat.v1"));
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Protocol"), "vat.v1");
}

TEST_F(TransportUpgradeTest, RefusesAnotherSubprotocolOrNone) {
  for (const char* subprotocol : {"", "vat.v2", "VAT.V1", "vat.v10"}) {
    const HttpReply reply = try_upgrade(port, "/ws", upgrade_headers(subprotocol));
    EXPECT_EQ(reply.status, 400) << subprotocol;
    EXPECT_NE(reply.body.find("vat.v1"), std::string::npos) << reply.body;
  }
}

TEST_F(TransportUpgradeTest, RefusesOtherPaths) {
  for (const char* target : {"/", "/ws/", "/WS", "/wss", "/x/ws", "//ws", "/%77s", "/?/ws"}) {
    EXPECT_EQ(try_upgrade(port, target, upgrade_headers()).status, 400) << target;
  }
}

TEST_F(TransportUpgradeTest, RefusesOtherVersions) {
  for (const char* version : {"7", "8", "12", "14", "-1", "thirteen"}) {
    EXPECT_EQ(try_upgrade(port, "/ws", upgrade_headers("vat.v1", version)).status, 400) << version;
  }
  // The library takes these for a draft of 2010 and answers without asking.
  for (const char* version : {"", "0"}) {
    EXPECT_GE(try_upgrade(port, "/ws", upgrade_headers("vat.v1", version)).status, 400) << version;
  }
}

TEST_F(TransportUpgradeTest, AdmitsPagesOfThisServerOnly) {
  EXPECT_EQ(try_upgrade(port, "/ws", origin("http://" + host())).status, 101);
  EXPECT_EQ(try_upgrade(port, "/ws", origin("https://" + host())).status, 101);
  const std::vector<std::string> foreign_origins{"http://example.org",
                                                 "null",
                                                 "http://127.0.0.1",
                                                 "http://localhost:" + std::to_string(port),
                                                 "http://" + host() + ".example.org",
                                                 "http://" + host() + "0",
                                                 host(),
                                                 "http://example.org/http://" + host()};
  for (const std::string& foreign : foreign_origins) {
    EXPECT_EQ(try_upgrade(port, "/ws", origin(foreign)).status, 403) << foreign;
  }
}

// By their whole names, whatever the case of their letters.
TEST(TransportOrigins, ThoseOfTheListAreAdmitted) {
  const std::vector<std::string> allowed{"https://example.org", "http://b.example:8443"};
  const std::vector<std::string> offered{"vat.v1"};
  const auto refused = [&](const char* origin) {
    return refuse_upgrade({"/ws", "host:80", origin, "13", offered}, allowed).has_value();
  };
  for (const char* good : {"https://example.org", "https://EXAMPLE.org", "http://b.example:8443",
                           "http://host:80", ""}) {
    EXPECT_FALSE(refused(good)) << good;
  }
  for (const char* foreign :
       {"http://example.org", "https://example.org:8443", "https://a.example.org",
        "https://example.org.evil", "https://b.example:8443", "null", "https://", "*"}) {
    EXPECT_TRUE(refused(foreign)) << foreign;
  }
}

TEST_F(TransportUpgradeTest, NeverCompresses) {
  const HttpReply reply = try_upgrade(
      port, "/ws", upgrade_headers() + "Sec-WebSocket-Extensions: permessage-deflate\r\n");
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.header("Sec-WebSocket-Extensions"), "");
}

TEST_F(TransportUpgradeTest, ARefusedClientIsNotAnnounced) {
  try_upgrade(port, "/ws", upgrade_headers(""));
  try_upgrade(port, "/", upgrade_headers());
  WsClient good(port);
  ASSERT_TRUE(recorder.wait_opened(1));
  EXPECT_EQ(recorder.connections.size(), 1u);
}

}  // namespace
}  // namespace vat::test::transport_http_test
