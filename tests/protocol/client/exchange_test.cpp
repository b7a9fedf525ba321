#include "tests/protocol/client/exchange_fixture.h"

namespace vat::client::test::exchange_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(ClientExchange, OpensAfterTheServersReply) {
  exchange_.start_connecting();
  exchange_.connected(now_);
  EXPECT_EQ(exchange_.state(), ConnectionState::connecting);
  call("control.pause");
  EXPECT_THAT(outcomes_, ElementsAre("disconnected"));
  answer("server.info", make_info("open"));
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  call("control.pause");
  answer("control.pause", {{"tick", 5}});
  EXPECT_EQ(outcomes_.back(), R"({"tick":5})");
}

TEST_F(ClientExchange, EntersWithTheToken) {
  options_.token = "invitation";
  Exchange other(options_, handlers_, calls_, 1);
  other.connected(now_);
  const auto pass = [&](const Json& message) {
    other.receive({Message::Kind::text, message.dump(), 0}, now_);
  };
  pass({{"id", sent().at("id")}, {"result", make_info("token")}});
  const Json enter = sent();
  EXPECT_EQ(enter.at("method"), "access.enter");
  EXPECT_EQ(enter.at("params").at("token"), "invitation");
  EXPECT_NE(other.state(), ConnectionState::open);
  pass({{"id", enter.at("id")}, {"result", {{"role", "viewer"}}}});
  EXPECT_EQ(other.state(), ConnectionState::open);
}

TEST_F(ClientExchange, ClosesWithoutAValidToken) {
  open("token");
  EXPECT_EQ(exchange_.state(), ConnectionState::closed);
  EXPECT_THAT(changes_.back().reason, HasSubstr("token"));
}

TEST_F(ClientExchange, AFailedFirstAttemptIsFinal) {
  exchange_.start_connecting();
  exchange_.lost(0, "no server at 127.0.0.1:1", now_);
  EXPECT_EQ(exchange_.state(), ConnectionState::closed);
  EXPECT_EQ(changes_.back().reason, "no server at 127.0.0.1:1");
}

TEST_F(ClientExchange, CallsWithoutRepliesFailIfTheConnectionIsLost) {
  open();
  call("control.step", {{"ticks", 10}});
  exchange_.receive({Message::Kind::closed, "", 1001}, now_);
  EXPECT_THAT(outcomes_, ElementsAre("disconnected"));
  EXPECT_EQ(exchange_.state(), ConnectionState::waiting);
  EXPECT_EQ(changes_.back().reason, "the server stops");
  EXPECT_EQ(sent(), nullptr);  // the message is not sent on the next connection
}

TEST_F(ClientExchange, CallsExpire) {
  open();
  call("control.step");
  const Json late = sent();
  now_ += 60s;
  exchange_.check(now_);
  EXPECT_EQ(outcomes_.back(), "timed_out");
  reply(late, {{"tick", 1}});
  EXPECT_EQ(outcomes_.size(), 1U);
  EXPECT_TRUE(faults_.empty());
}

TEST_F(ClientExchange, DeliversTypedEvents) {
  std::vector<double> times;
  std::vector<std::string> described;
  handlers_.events.session_status = [&](const SessionStatusEvent& status) {
    times.push_back(status.time);
  };
  handlers_.events.session_description = [&](const SessionDescription& description) {
    described.push_back(description.title);
  };
  join_and_subscribe();
  Json status = {
      {"tick", 50},   {"time", 1.0},    {"playing", true}, {"speed", 1}, {"real_time_factor", 0.9},
      {"clients", 1}, {"particles", 30}};
  receive({{"method", "session.status"}, {"params", status}});
  EXPECT_THAT(times, ElementsAre(1.0));
  EXPECT_THAT(described, ElementsAre("Pool"));
  receive({{"method", "event.of_a_later_version"}, {"params", {{"x", 1}}}});
  EXPECT_TRUE(faults_.empty());
  status["time"] = "noon";
  receive({{"method", "session.status"}, {"params", status}});
  EXPECT_THAT(faults_, ElementsAre("session.status: /time is not a number"));
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
}

TEST_F(ClientExchange, ReportsInvalidMessages) {
  open();
  const std::string deep = std::string(100, '[') + std::string(100, ']');
  for (const std::string& text : {std::string("{"), std::string("[]"), std::string("7"), deep,
                                  std::string(R"({"method": 7})")}) {
    faults_.clear();
    exchange_.receive({Message::Kind::text, text, 0}, now_);
    EXPECT_EQ(faults_.size(), 1U) << text;
  }
  faults_.clear();
  receive({{"id", nullptr},
           {"error", {{"code", -32700}, {"message", "not JSON"}, {"data", Json::object()}}}});
  EXPECT_THAT(faults_, ElementsAre("not JSON"));
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
}

TEST_F(ClientExchange, AReplyWithoutAResultFailsItsCall) {
  open();
  call("control.pause");
  receive({{"id", sent().at("id")}});
  EXPECT_EQ(outcomes_.back(), "invalid_reply");
  call("session.join");
  reply(sent(), {{"tick", 3}});
  EXPECT_EQ(outcomes_.back(), "invalid_reply");
}

TEST_F(ClientExchange, AcknowledgesFramesAfterTheHandler) {
  std::vector<std::uint32_t> numbers;
  handlers_.on_frame = [&](const Frame& frame) {
    numbers.push_back(frame.number);
    EXPECT_EQ(sent(), nullptr);
  };
  join_and_subscribe();
  receive_frame(6);
  EXPECT_THAT(numbers, ElementsAre(6U));
  const Json ack = sent();
  EXPECT_EQ(ack.at("method"), "frames.ack");
  EXPECT_EQ(ack.at("params"), Json({{"number", 6}}));
  EXPECT_FALSE(ack.contains("id"));
}

TEST_F(ClientExchange, AsksForAKeyFrameOnce) {
  join_and_subscribe();
  receive_frame(6, true);
  EXPECT_EQ(sent().at("params"), Json({{"number", 6}, {"rejected", true}}));
  EXPECT_EQ(faults_.size(), 1U);
  receive_frame(7);
  EXPECT_EQ(sent().at("params"), Json({{"number", 7}}));
  receive_frame(8, true);
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  receive_frame(9, true);  // the requested key frame
  EXPECT_EQ(exchange_.state(), ConnectionState::waiting);
}

TEST_F(ClientExchange, LimitsTheNumberOfCalls) {
  open();
  for (std::size_t i = 0; i < kMaxCalls; ++i) call("control.play");
  EXPECT_TRUE(outcomes_.empty());
  call("control.play");
  EXPECT_THAT(outcomes_, ElementsAre("too_many_calls"));
  reply(sent(), {{"tick", 1}});
  call("control.play");
  EXPECT_EQ(outcomes_.size(), 2U);  // the reply, and no further error
}

TEST_F(ClientExchange, LimitsTheBytesThatWait) {
  open();
  const Json params = {{"text", std::string(kMaxOutputBytes / 2, 'x')}};
  EXPECT_TRUE(calls_.add_notification("a.b", params, CallList::Origin::application));
  EXPECT_TRUE(calls_.add_notification("a.b", params, CallList::Origin::application));
  EXPECT_FALSE(calls_.add_notification("a.b", params, CallList::Origin::application));
  call("a.b", params);
  EXPECT_THAT(outcomes_, ElementsAre("too_many_calls"));
  calls_.take_output();
  EXPECT_TRUE(calls_.add_notification("a.b", params, CallList::Origin::application));
}

TEST_F(ClientExchange, RejectsTextThatIsNotUtf8) {
  open();
  EXPECT_THROW(call("scene.get", {{"scene", "\xff"}}), std::invalid_argument);
  EXPECT_EQ(sent(), nullptr);
}

}  // namespace
}  // namespace vat::client::test::exchange_test
