// Replies of the server to every kind of text.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_request_test {
namespace {

struct BadText {
  std::string text;
  int code;
  Json id;  // id of the reply
};

const std::vector<BadText>& bad_texts() {
  static const std::vector<BadText> kTexts = {
      {"hello", -32700, nullptr},
      {R"({"jsonrpc":"2.0","id":1,"id":2,"method":"server.info"})", -32700, nullptr},
      {"1", -32600, nullptr},
      {R"([{"jsonrpc":"2.0","id":1,"method":"server.info"}])", -32600, nullptr},
      {"{}", -32600, nullptr},
      {R"({"id":1,"method":"server.info"})", -32600, 1},
      {R"({"jsonrpc":"1.0","id":1,"method":"server.info"})", -32600, 1},
      {R"({"jsonrpc":2.0,"id":1,"method":"server.info"})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":7})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":")" + std::string(65, 'm') + "\"}", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":[]})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":null})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":"server.info","extra":0})", -32600, 1},
      {R"({"jsonrpc":"2.0","id":1.5,"method":"server.info"})", -32600, nullptr},
      {R"({"jsonrpc":"2.0","id":null,"method":"server.info"})", -32600, nullptr},
      {R"({"jsonrpc":"2.0","id":{},"method":"server.info"})", -32600, nullptr},
      {R"({"jsonrpc":"2.0","id":true,"method":"server.info"})", -32600, nullptr},
      {R"({"jsonrpc":"2.0","id":")" + std::string(65, 'i') + R"(","method":"server.info"})", -32600,
       nullptr},
      {R"({"jsonrpc":"2.0","id":1,"method":"server.stop"})", -32601, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":""})", -32601, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":"session.closed"})", -32601, 1},
      {R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":{"x":1}})", -32602, 1},
  };
  return kTexts;
}

class Requests : public SessionTest {};

TEST_F(Requests, ThatAreWrongAreAnsweredOnceByTheirCodeAndChangeNothing) {
  const std::string before = hash();
  for (const BadText& bad : bad_texts()) {
    SCOPED_TRACE(bad.text.substr(0, 100));
    const std::size_t from = client->connection->texts().size();
    client->send_raw(bad.text, true);
    const Json reply = client->connection->wait_text(
        [](const Json& text) { return text.contains("error"); }, from);
    EXPECT_EQ(reply.at("jsonrpc"), "2.0");
    EXPECT_EQ(reply.at("error").at("code"), bad.code) << reply;
    EXPECT_EQ(reply.at("id"), bad.id) << reply;
    EXPECT_FALSE(reply.at("error").at("message").get<std::string>().empty());
    EXPECT_TRUE(reply.at("error").at("data").contains("kind"));
    EXPECT_EQ(hash(), before);
    const std::vector<Json> texts = client->connection->texts();
    EXPECT_EQ(std::count_if(texts.begin() + static_cast<std::ptrdiff_t>(from), texts.end(),
                            [](const Json& text) { return text.contains("error"); }),
              1);
  }
  EXPECT_FALSE(client->connection->close_code().has_value());
}

TEST_F(Requests, TheIdIsReturnedUnchanged) {
  const std::vector<Json> ids = {
      0, -1, 9007199254740993, "", "a\"\\\u00e4\n", std::string(64, 'x')};
  for (const Json& id : ids) {
    client->send_raw(Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", "scene.list"}}.dump());
    const Json reply = client->connection->wait_text(
        [&](const Json& text) { return text.contains("result") && text.at("id") == id; });
    EXPECT_EQ(reply.at("id").dump(), id.dump());
    EXPECT_EQ(reply.at("result").at("scenes").size(), 2u);
  }
}

TEST_F(Requests, NotificationsAreCarriedOutAndNeverAnswered) {
  const std::size_t before = client->connection->texts().size();
  client->notify("control.set_speed", {{"speed", 2}});
  client->notify_wrong("control.set_speed", {{"speed", 1000}});
  client->notify("server.info");
  client->notify("session.join", {{"session", "s9"}});
  client->notify_wrong("no.such.method");
  client->wait_event("session.status", [](const Json& status) { return status["speed"] == 2; });
  client->result("session.hash");
  const auto texts = client->connection->texts();
  for (std::size_t i = before; i + 1 < texts.size(); ++i) {
    EXPECT_TRUE(texts[i].contains("method")) << texts[i];
  }
}

TEST_F(Requests, BinaryMessagesAreRefused) {
  server.binary_received(client->connection->id(), "VATF");
  const Json reply =
      client->connection->wait_text([](const Json& text) { return text.contains("error"); });
  EXPECT_EQ(reply.at("error").at("code"), -32600);
  EXPECT_EQ(reply.at("id"), nullptr);
}

TEST_F(Requests, OfAConnectionThatIsGoneHaveNoEffect) {
  auto other = join();
  const auto connection = other->connection;
  other->disconnect();
  const std::size_t texts = connection->texts().size();
  server.text_received(connection->id(), R"({"jsonrpc":"2.0","id":1,"method":"server.info"})");
  server.binary_received(connection->id(), "x");
  server.closed(connection->id());
  server.text_received(12345, R"({"jsonrpc":"2.0","id":1,"method":"server.info"})");
  EXPECT_EQ(connection->texts().size(), texts);
}

}  // namespace
}  // namespace vat::test::session_request_test
