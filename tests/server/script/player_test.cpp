#include "server/script/player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "protocol/frame/frame_codec.h"

namespace vat::script::player_test {
namespace {

using client::Connected;
using client::Connection;
using client::ConnectRequest;
using client::Message;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// A connection whose replies the test defines. It replies immediately.
class FakeConnection final : public Connection {
 public:
  using Answer = std::function<std::vector<Message>(const std::string& sent)>;
  explicit FakeConnection(Answer answer) : answer_(std::move(answer)) {}

  void send_text(const std::string& text) override {
    for (Message& message : answer_(text)) waiting_.push_back(std::move(message));
  }
  void send_binary(const std::string& bytes) override { send_text(bytes); }
  void close() override { waiting_.push_back({Message::Kind::closed, "", 1000}); }
  void read(bool) override {}
  std::optional<Message> next(client::Deadline) override {
    if (waiting_.empty()) return {};
    Message message = std::move(waiting_.front());
    waiting_.pop_front();
    return message;
  }

 private:
  Answer answer_;
  std::deque<Message> waiting_;
};

Message text(const Json& json) {
  return {Message::Kind::text, json.dump(), 0};
}

Message frame(std::uint32_t number, std::uint32_t epoch) {
  GridFrame shown;
  shown.header.number = number;
  shown.header.epoch = epoch;
  shown.scale.grid = make_frame_grid({0, 0, 0}, {1, 1, 1}, 0);
  const std::vector<std::uint8_t> bytes = encode_key_frame(shown);
  return {Message::Kind::binary, std::string(bytes.begin(), bytes.end()), 0};
}

/// A server that replies to {"say": [...]} with these messages. An object is sent unchanged, a list
/// [number, epoch] as a key frame, a text as raw text. A number closes the connection. The reply to
/// a request with id and method contains its params.
std::vector<Message> answer(const std::string& sent) {
  const Json message = Json::parse(sent, nullptr, false);
  if (!message.is_object()) return {{Message::Kind::closed, "garbage", 1002}};
  if (message.contains("method")) {
    return {text({{"jsonrpc", "2.0"}, {"id", message["id"]}, {"result", message["params"]}})};
  }
  std::vector<Message> messages;
  for (const Json& item : message.at("say")) {
    if (item.is_object()) messages.push_back(text(item));
    if (item.is_array()) messages.push_back(frame(item[0], item[1]));
    if (item.is_number()) messages.push_back({Message::Kind::closed, "", item});
    if (item.is_string()) messages.push_back({Message::Kind::text, item, 0});
  }
  return messages;
}

/// Returns the error that ends a script after {"connect": "a"}; "" if the script succeeds.
std::string outcome(const std::vector<const char*>& lines) {
  Player player(
      [](const ConnectRequest& request) -> Connected {
        if (request.subprotocol != "vat.v1") return {nullptr, 400};
        return {std::make_unique<FakeConnection>(answer), 101};
      },
      std::chrono::milliseconds(10));
  std::vector<Line> script{{"s:1", {{"connect", "a"}}}};
  for (const char* line : lines) {
    script.push_back({"s:" + std::to_string(script.size() + 1), Json::parse(line)});
  }
  try {
    player.play(script);
  } catch (const Failure& failure) {
    return failure.what();
  } catch (const ScriptError& error) {
    return std::string("mistake: ") + error.what();
  }
  return "";
}

constexpr const char* kSayReply =
    R"({"send": {"say": [{"jsonrpc": "2.0", "id": 7, "result": {"x": 1}}]}})";

TEST(Player, CallsMustHaveTheExpectedReply) {
  EXPECT_EQ(outcome({R"({"call": "m", "params": {"x": 1, "y": 2}, "result": {"x": 1}})"}), "");
  EXPECT_EQ(
      outcome({R"({"comment": "c"})", R"({"call": "m", "params": {"x": 2}, "result": {"x": 1}})"}),
      "s:3: at /result/x\n  expected 1\n  came     2");
  EXPECT_THAT(outcome({R"({"call": "m", "params": {}, "error": {"code": -32601}})"}),
              StartsWith("s:2: at "));
  // The reply contains the request's params, so the tick is missing.
  EXPECT_THAT(outcome({R"({"wait_ticks": 3})"}), HasSubstr("at /result\n  expected a member"));
}

TEST(Player, RepliesAreTakenByTheirId) {
  const char* two = R"({"send": {"say": [{"jsonrpc": "2.0", "id": 1, "result": {}},
                                         {"jsonrpc": "2.0", "id": 2, "result": {}}]}})";
  EXPECT_EQ(outcome({two, R"({"expect": {"id": 2}})", R"({"expect": {"id": 1}})"}), "");
  EXPECT_THAT(outcome({two, R"({"expect": {"id": 3}})"}), HasSubstr("none came"));
}

TEST(Player, ExpectedRepliesMustMatch) {
  EXPECT_EQ(outcome({kSayReply, R"({"expect": {"id": 7, "result": {"x": 1}}})"}), "");
  EXPECT_THAT(outcome({kSayReply, R"({"expect": {"id": 7, "result": {"x": 2}}})"}),
              HasSubstr("s:3: at /result/x\n  expected 2\n  came     1"));
  EXPECT_THAT(outcome({R"({"expect": {"id": 7}})"}), HasSubstr("none came"));
}

TEST(Player, WaitsForAnEventAndPassesOverOthers) {
  const char* events = R"({"send": {"say": [{"jsonrpc": "2.0", "method": "e", "params": {"n": 1}},
                                            {"jsonrpc": "2.0", "method": "e", "params": {"n": 2}}]}})";
  EXPECT_EQ(outcome({events, R"({"wait_event": {"params": {"n": 2}}})"}), "");
  EXPECT_THAT(outcome({events, R"({"wait_event": {"params": {"n": 3}}})"}),
              HasSubstr("the last received: at /params/n\n  expected 3\n  came     2"));
}

TEST(Player, FramesMustMatch) {
  EXPECT_EQ(outcome({R"({"send": {"say": [[1, 4], [2, 4]]}})", R"({"expect_frame": {"number": 1}})",
                     R"({"wait_frame": {"number": 2, "blocks": []}})"}),
            "");
  EXPECT_THAT(outcome({R"({"send": {"say": [[1, 4]]}})", R"({"expect_frame": {"epoch": 5}})"}),
              HasSubstr("at /epoch\n  expected 5\n  came     4"));
  EXPECT_THAT(outcome({R"({"expect_frame": {}})"}), HasSubstr("expected a frame, received none"));
}

TEST(Player, FramesBelongToTheLastDescription) {
  EXPECT_THAT(
      outcome({R"({"send": {"say": [{"jsonrpc": "2.0", "method": "d", "params": {"epoch": 2}},
                                            [1, 1]]}})",
               R"({"expect_frame": {}})"}),
      HasSubstr("a frame of epoch 1 after the description of epoch 2"));
}

TEST(Player, RefusesForbiddenMessages) {
  EXPECT_EQ(outcome({R"({"expect_none": "frame", "for": 0.01})"}), "");
  EXPECT_THAT(outcome({kSayReply, R"({"expect_none": "reply", "for": 0.01})"}),
              HasSubstr("expected none, came"));
  EXPECT_EQ(outcome({kSayReply, R"({"expect_none": "reply", "for": 0.01, "matching": {"id": 8}})"}),
            "");
}

TEST(Player, ClosingIsExpectedOrAFailure) {
  EXPECT_EQ(outcome({R"({"send": {"say": [1009]}})", R"({"expect_close": 1009})"}), "");
  EXPECT_THAT(outcome({R"({"send": {"say": [1009]}})", R"({"expect_close": 1002})"}),
              HasSubstr("closed with 1002, came 1009"));
  EXPECT_THAT(outcome({R"({"expect_close": 1002})"}), HasSubstr("it is open"));
  EXPECT_THAT(outcome({R"({"send_text": "garbage"})", R"({"expect": {}})"}),
              HasSubstr("the connection was closed with 1002"));
}

TEST(Player, MessagesMustBeJsonRpc) {
  for (const char* message :
       {R"("no json")", R"({"id": 1, "result": 1})",
        R"({"jsonrpc": "2.0", "id": 1, "method": "m"})", R"({"jsonrpc": "2.0"})"}) {
    const std::string line = R"({"send": {"say": [)" + std::string(message) + "]}}";
    EXPECT_THAT(outcome({line.c_str(), R"({"expect_none": "frame", "for": 0.01})"}),
                HasSubstr("expected a JSON-RPC reply or event"))
        << message;
  }
}

TEST(Player, RefusedConnections) {
  EXPECT_EQ(outcome({R"({"connect": "b", "subprotocol": "other", "refused": 400})"}), "");
  EXPECT_THAT(outcome({R"({"connect": "b", "subprotocol": "other"})"}),
              HasSubstr("expected HTTP status 101, came 400"));
  EXPECT_THAT(outcome({R"({"connect": "b", "refused": 400})"}), HasSubstr("came 101"));
}

TEST(Player, RepeatsWithACounterAndKeepsCaptures) {
  EXPECT_EQ(
      outcome(
          {R"({"repeat": 3, "do": [{"call": "m", "params": {"n": "$i"}, "result": {"n": {"$capture": "$last"}}}]})",
           R"({"call": "m", "params": {"n": 2}, "result": {"n": "$last"}})"}),
      "");
}

TEST(Player, MistakesInScriptsAreNamed) {
  EXPECT_THAT(outcome({R"({"cal": "m"})"}),
              AllOf(HasSubstr("mistake: s:2: no known action"), HasSubstr("call, close, connect")));
  EXPECT_THAT(outcome({R"({"send": {}, "call": "m"})"}), HasSubstr("two actions"));
  EXPECT_THAT(outcome({R"({"call": "m", "resul": {}})"}),
              HasSubstr("\"resul\" does not belong to call"));
  EXPECT_THAT(outcome({R"({"client": "z", "send": {}})"}),
              HasSubstr(R"(no client z; a line before it has to be {"connect": "z"})"));
}

TEST(ReadScript, NamesTheLineOfAMistake) {
  const std::string path = testing::TempDir() + "mistake.jsonl";
  std::ofstream(path) << "{\"comment\": \"fine\"}\n\n[1]\n";
  try {
    read_script(path);
    FAIL();
  } catch (const ScriptError& error) {
    EXPECT_STREQ(error.what(), "mistake.jsonl:3: is not a JSON object");
  }
}

TEST(ReadDocument, TakesTheExchangeOrTheScriptAfterTheHeading) {
  const std::string path = testing::TempDir() + "document.md";
  std::ofstream(path) << "```text\n> {\"no\": 1}\n```\n## Here\nWords.\n```text\n> {\"a\": 1}\n"
                         "< {\"b\": 2}\n```\n> more\n"
                         "## Script\n\n```jsonl\n{\"close\": true}\n```\n```jsonl\n{}\n```\n";
  std::vector<Line> lines = read_document(path, "## Here");
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].action, Json::parse(R"({"connect": "a"})"));
  EXPECT_EQ(lines[1].action, Json::parse(R"({"send": {"a": 1}})"));
  EXPECT_EQ(lines[2].action, Json::parse(R"({"expect": {"b": 2}})"));
  EXPECT_EQ(lines[2].place, "document.md:8");
  lines = read_document(path, "## Script");
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines[0].action, Json::parse(R"({"close": true})"));
  EXPECT_THROW(read_document(path, "## There"), ScriptError);
}

}  // namespace
}  // namespace vat::script::player_test
