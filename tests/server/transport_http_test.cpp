#include <atomic>
#include <thread>

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

TEST_F(TransportHttpTest, ServesRequestsBesideWebSockets) {
  recorder.echo = true;
  start();
  WsClient socket(port);
  EXPECT_EQ(http(port, "GET", "/page").body, "/page");
  socket.send_text("still here");
  EXPECT_EQ(socket.read_message().payload, "still here");
}

}  // namespace

}  // namespace vat::test::transport_http_test
