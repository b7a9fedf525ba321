// What the server makes of each text that a client can send.

#include "tests/server/session_fixture.h"

namespace vat::test::session_request_test {
namespace {

struct BadText {
  std::string name;
  std::string text;
  int code;
  Json id;  // of the reply
};

std::string nested(std::size_t depth) {
  return std::string(depth, '[') + std::string(depth, ']');
}

std::string many_values(std::size_t count) {
  std::string list = "[1";
  for (std::size_t i = 1; i < count; ++i) list += ",1";
  return R"({"jsonrpc":"2.0","id":1,"method":"scene.load","params":{"scene":)" + list + "]}}";
}

const std::vector<BadText>& bad_texts() {
  static const std::vector<BadText> kTexts = {
      {"Nothing", "", -32700, nullptr},
      {"NotJson", "hello", -32700, nullptr},
      {"HalfAnObject", R"({"jsonrpc":"2.0","id":1)", -32700, nullptr},
      {"TextAfterTheEnd", R"({"jsonrpc":"2.0","id":1,"method":"server.info"} x)", -32700, nullptr},
      {"TwoDocuments", "{}{}", -32700, nullptr},
      {"Comment", "/* a */ {}", -32700, nullptr},
      {"NotANumber", R"({"jsonrpc":"2.0","id":NaN,"method":"server.info"})", -32700, nullptr},
      {"TooDeep", nested(17), -32700, nullptr},
      {"MuchTooDeep", nested(100'000), -32700, nullptr},
      {"DuplicateKey", R"({"jsonrpc":"2.0","id":1,"id":2,"method":"server.info"})", -32700,
       nullptr},
      {"TooManyValues", many_values(100'001), -32700, nullptr},
      {"NotUtf8", "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"\xff\"}", -32700, nullptr},
      {"HalfASurrogatePair", R"({"jsonrpc":"2.0","id":"\ud800","method":"server.info"})", -32700,
       nullptr},
      {"Null", "null", -32600, nullptr},
      {"Number", "1", -32600, nullptr},
      {"Batch", R"([{"jsonrpc":"2.0","id":1,"method":"server.info"}])", -32600, nullptr},
      {"EmptyBatch", "[]", -32600, nullptr},
      {"EmptyObject", "{}", -32600, nullptr},
      {"NoVersion", R"({"id":1,"method":"server.info"})", -32600, 1},
      {"OldVersion", R"({"jsonrpc":"1.0","id":1,"method":"server.info"})", -32600, 1},
      {"VersionAsNumber", R"({"jsonrpc":2.0,"id":1,"method":"server.info"})", -32600, 1},
      {"NoMethod", R"({"jsonrpc":"2.0","id":1})", -32600, 1},
      {"MethodAsNumber", R"({"jsonrpc":"2.0","id":1,"method":7})", -32600, 1},
      {"LongMethod", R"({"jsonrpc":"2.0","id":1,"method":")" + std::string(65, 'm') + "\"}", -32600,
       1},
      {"ParamsAsList", R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":[]})", -32600, 1},
      {"ParamsAsNull", R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":null})", -32600,
       1},
      {"UnknownMember", R"({"jsonrpc":"2.0","id":1,"method":"server.info","extra":0})", -32600, 1},
      {"IdAsFraction", R"({"jsonrpc":"2.0","id":1.5,"method":"server.info"})", -32600, nullptr},
      {"IdAsNull", R"({"jsonrpc":"2.0","id":null,"method":"server.info"})", -32600, nullptr},
      {"IdAsObject", R"({"jsonrpc":"2.0","id":{},"method":"server.info"})", -32600, nullptr},
      {"IdAsBool", R"({"jsonrpc":"2.0","id":true,"method":"server.info"})", -32600, nullptr},
      {"LongId",
       R"({"jsonrpc":"2.0","id":")" + std::string(65, 'i') + R"(","method":"server.info"})", -32600,
       nullptr},
      {"UnknownMethod", R"({"jsonrpc":"2.0","id":1,"method":"server.stop"})", -32601, 1},
      {"EmptyMethod", R"({"jsonrpc":"2.0","id":1,"method":""})", -32601, 1},
      {"AnEventsName", R"({"jsonrpc":"2.0","id":1,"method":"session.closed"})", -32601, 1},
      {"UnknownParameter", R"({"jsonrpc":"2.0","id":1,"method":"server.info","params":{"x":1}})",
       -32602, 1},
  };
  return kTexts;
}

class BadRequests : public SessionTest, public testing::WithParamInterface<BadText> {};

INSTANTIATE_TEST_SUITE_P(Texts, BadRequests, testing::ValuesIn(bad_texts()),
                         [](const auto& text) { return text.param.name; });

TEST_P(BadRequests, AreAnsweredOnceByTheirCodeAndChangeNothing) {
  const std::string before = hash();
  client->mark();
  client->send_raw(GetParam().text, true);
  const Json reply =
      client->connection->wait_text([](const Json& text) { return text.contains("error"); });
  EXPECT_EQ(reply.at("jsonrpc"), "2.0");
  EXPECT_EQ(reply.at("error").at("code"), GetParam().code) << reply;
  EXPECT_EQ(reply.at("id"), GetParam().id) << reply;
  EXPECT_FALSE(reply.at("error").at("message").get<std::string>().empty());
  EXPECT_TRUE(reply.at("error").at("data").contains("kind"));

  EXPECT_EQ(hash(), before);
  EXPECT_FALSE(client->connection->close_code().has_value());
  std::size_t errors = 0;
  for (const Json& text : client->connection->texts()) errors += text.contains("error") ? 1 : 0;
  EXPECT_EQ(errors, 1u);
}

class Requests : public SessionTest {};

TEST_F(Requests, DepthOfSixteenIsNotTooDeep) {
  client->send_raw(nested(16));  // a batch, then
  const Json reply =
      client->connection->wait_text([](const Json& text) { return text.contains("error"); });
  EXPECT_EQ(reply.at("error").at("data").at("kind"), "invalid_request");
}

TEST_F(Requests, TheIdComesBackAsItWas) {
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

TEST_F(Requests, LongMessagesAreForScenesAndBodiesOnly) {
  const std::string padding(70'000, ' ');
  client->send_raw(R"({"jsonrpc":"2.0","id":"a","method":"server.info"})" + padding);
  client->send_raw(
      R"({"jsonrpc":"2.0","id":"b","method":"scene.load","params":{"scene":"mixed"}})" + padding);
  client->send_raw(
      R"({"jsonrpc":"2.0","id":"c","method":"scene.load","params":{"scene":"mixed"}})" +
      std::string(4 * 1024 * 1024, ' '));
  const auto reply_to = [&](const Json& id) {
    return client->connection->wait_text(
        [&](const Json& text) { return text.contains("id") && text.at("id") == id; });
  };
  EXPECT_EQ(reply_to("a").at("error").at("data").at("limit"), "message_bytes");
  EXPECT_EQ(reply_to("a").at("error").at("data").at("maximum"), 65'536);
  EXPECT_TRUE(reply_to("b").contains("result"));
  EXPECT_EQ(reply_to(nullptr).at("error").at("data").at("limit"), "scene_message_bytes");
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
