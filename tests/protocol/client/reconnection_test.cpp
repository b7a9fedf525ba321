#include "tests/protocol/client/exchange_fixture.h"

namespace vat::client::test::reconnection_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

TEST_F(ClientExchange, ResumesTheParticipantAfterAReconnection) {
  std::vector<bool> rejoined;
  handlers_.on_rejoined = [&](const SessionJoin::Result& joined) {
    rejoined.push_back(joined.resumed);
    EXPECT_NE(exchange_.state(), ConnectionState::open);
  };
  join_and_subscribe();
  reconnect();
  const Json join = sent();
  EXPECT_EQ(join.at("method"), "session.join");
  EXPECT_EQ(join.at("params"),
            Json({{"name", "watcher"}, {"session", "s1"}, {"resume", "secret"}}));
  call("control.pause");
  EXPECT_EQ(outcomes_.back(), "disconnected");  // it would precede the join
  reply(join, make_joined(true, "secret"));
  EXPECT_THAT(rejoined, ElementsAre(true));
  EXPECT_NE(exchange_.state(), ConnectionState::open);
  const Json subscribe = sent();
  EXPECT_EQ(subscribe.at("method"), "frames.subscribe");
  EXPECT_EQ(subscribe.at("params"), Json({{"max_error", 0.01}}));
  reply(subscribe, {{"tick", 9}});
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
}

TEST_F(ClientExchange, ANewParticipantSubscribesAgain) {
  join_and_subscribe();
  reconnect();
  answer("session.join", make_joined(false, "another"));
  EXPECT_NE(exchange_.state(), ConnectionState::open);
  const Json subscribe = sent();
  EXPECT_EQ(subscribe.at("method"), "frames.subscribe");
  EXPECT_EQ(subscribe.at("params"), Json({{"max_error", 0.01}}));
  reply(subscribe, {{"tick", 0}});
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  // The next reconnection uses the new token.
  reconnect();
  EXPECT_EQ(sent().at("params").at("resume"), "another");
}

TEST_F(ClientExchange, AnEndedSubscriptionIsNotRestored) {
  join_and_subscribe();
  call("frames.unsubscribe");
  answer("frames.unsubscribe", {{"tick", 5}});
  reconnect();
  answer("session.join", make_joined(false, "another"));
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  EXPECT_EQ(sent(), nullptr);
}

TEST_F(ClientExchange, DoesNotRejoinASessionThatItLeft) {
  join_and_subscribe();
  call("session.leave");
  answer("session.leave", {{"tick", 5}});
  reconnect();
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  EXPECT_EQ(sent(), nullptr);
}

TEST_F(ClientExchange, ContinuesWithoutASessionThatTheServerEnded) {
  join_and_subscribe();
  receive({{"method", "session.closed"}, {"params", {{"session", "s1"}, {"reason", "closed"}}}});
  reconnect();
  refuse(sent(), "no_such_session", 1002);
  EXPECT_EQ(exchange_.state(), ConnectionState::open);
  reconnect();
  EXPECT_EQ(sent(), nullptr);
}

TEST_F(ClientExchange, ClosesIfItsSessionIsLost) {
  join_and_subscribe();
  reconnect();
  refuse(sent(), "no_such_session", 1002);
  EXPECT_EQ(exchange_.state(), ConnectionState::closed);
  EXPECT_EQ(changes_.back().reason, "no: no_such_session");
}

TEST_F(ClientExchange, RepeatsAJoinThatFailsForATime) {
  join_and_subscribe();
  reconnect();
  refuse(sent(), "rate_limited", 1009);
  EXPECT_EQ(exchange_.state(), ConnectionState::waiting);
  EXPECT_EQ(changes_.back().reason, "no: rate_limited");
}

TEST_F(ClientExchange, DelaysGrowUpToALimit) {
  open();
  std::vector<double> delays;
  for (int i = 0; i < 6; ++i) {
    exchange_.lost(0, "refused", now_);
    delays.push_back(static_cast<double>(changes_.back().retry_in.count()));
    EXPECT_EQ(exchange_.retry_time(), now_ + changes_.back().retry_in);
    now_ = exchange_.retry_time();
    exchange_.start_connecting();
  }
  const double expected[] = {500, 1000, 2000, 4000, 8000, 8000};
  for (std::size_t i = 0; i < delays.size(); ++i) {
    EXPECT_THAT(delays[i], AllOf(Ge(expected[i]), Le(1.25 * expected[i]))) << i;
  }
  // A connection that lasted starts with the first delay again.
  open();
  now_ += 1h;
  exchange_.lost(0, "refused", now_);
  EXPECT_LE(changes_.back().retry_in, 625ms);
}

TEST_F(ClientExchange, DoesNotReconnectAfterARemoval) {
  for (const std::uint16_t code : {std::uint16_t{4003}, std::uint16_t{4010}}) {
    Exchange removed(options_, handlers_, calls_, 1);
    removed.connected(now_);
    removed.receive({Message::Kind::text,
                     Json({{"id", sent().at("id")}, {"result", make_info("open")}}).dump(), 0},
                    now_);
    ASSERT_EQ(removed.state(), ConnectionState::open);
    removed.receive({Message::Kind::closed, "too loud", code}, now_);
    EXPECT_EQ(removed.state(), ConnectionState::closed) << code;
    EXPECT_THAT(changes_.back().reason, HasSubstr("too loud"));
  }
}

TEST_F(ClientExchange, TriesAgainIfANodeRefusesAnAcceptedTokenAtTheJoin) {
  join_and_subscribe();
  exchange_.lost(0, "end of file", now_);
  now_ = exchange_.retry_time();
  open("token");
  answer("access.enter", {{"role", "viewer"}, {"session", "s1"}});
  refuse(sent(), "not_authenticated");
  ASSERT_EQ(exchange_.state(), ConnectionState::waiting);
  now_ = exchange_.retry_time();
  open("token");
  refuse(sent(), "not_authenticated");  // the node knows the session now
  EXPECT_EQ(exchange_.state(), ConnectionState::closed);
}

TEST_F(ClientExchange, DoesNotReconnectIfTheOptionsForbidIt) {
  options_.reconnects = false;
  open();
  exchange_.lost(0, "end of file", now_);
  EXPECT_EQ(exchange_.state(), ConnectionState::closed);
}

TEST_F(ClientExchange, ASilentServerIsLost) {
  open();
  EXPECT_EQ(exchange_.next_check(), now_ + options_.timeout);
  now_ += options_.timeout - 1ms;
  exchange_.check(now_);
  EXPECT_EQ(sent(), nullptr);
  now_ += 1ms;
  exchange_.check(now_);
  answer("server.info", make_info("open"));
  now_ += options_.timeout;
  exchange_.check(now_);
  EXPECT_EQ(sent().at("method"), "server.info");
  EXPECT_EQ(exchange_.next_check(), now_ + options_.timeout);
  now_ += options_.timeout;
  exchange_.check(now_);
  EXPECT_EQ(exchange_.state(), ConnectionState::waiting);
  EXPECT_EQ(changes_.back().reason, "the server does not answer");
}

}  // namespace
}  // namespace vat::client::test::reconnection_test
