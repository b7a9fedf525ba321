// Sessions that replay another session.

#include <gmock/gmock.h>

#include "tests/server/replay/replay_session_fixture.h"

namespace vat::test::replay_session_test {
namespace {

using testing::HasSubstr;

TEST_F(ReplaySession, ShowsEveryStateThatThereWas) {
  live();
  const Json opened = open();
  EXPECT_EQ(opened.at("session"), "r1");
  EXPECT_EQ(opened.at("end"), position_);
  EXPECT_EQ(joined_.at("description").at("replay").at("end"), position_);
  EXPECT_FALSE(joined_.at("description").at("playing"));
  expect_states();
  seek(first_);
  for (std::uint64_t at = first_; at <= position_; ++at) {
    ASSERT_EQ(bob_->result("session.hash").at("position"), at);
    ASSERT_EQ(hash(), hashes_.at(at)) << at;
    bob_->result("control.step");
  }
}

TEST_F(ReplaySession, PlaysToItsEndAndPauses) {
  live();
  open();
  bob_->result("control.set_speed", {{"speed", 4}});
  seek(position_);
  seek(first_);
  bob_->mark();
  bob_->result("control.play");
  const Json ended = bob_->wait_event("replay.ended");
  EXPECT_EQ(ended.at("position"), position_);
  EXPECT_EQ(ended.at("tick"), 11);
  const Json info = bob_->result("replay.info");
  EXPECT_FALSE(info.at("playing"));
  EXPECT_EQ(info.at("speed"), 4);
  EXPECT_TRUE(info.at("diverged").is_null());
  EXPECT_EQ(hash(), hashes_.at(position_));
  // Steps beyond the end have no effect.
  EXPECT_EQ(bob_->result("control.step", {{"ticks", 5}}).at("tick"), 11);
}

TEST_F(ReplaySession, DistinguishesRecordedParticipantsFromViewers) {
  live();
  open();
  EXPECT_EQ(joined_.at("participant"), 1);  // Ann has the same number in the recording
  seek(first_ + 5);
  Json people = bob_->result("replay.info").at("people");
  ASSERT_EQ(people.size(), 1U);
  EXPECT_EQ(people[0].at("name"), "Ann");
  EXPECT_EQ(people[0].at("person"), 1);
  EXPECT_EQ(people[0].at("grabs"), Json::array({2}));
  EXPECT_EQ(people[0].at("pointer").at("position"), Json::array({0.5, 0.5, 0.9}));
  EXPECT_FALSE(people[0].contains("participant"));
  seek(first_ + 9);
  people = bob_->result("replay.info").at("people");
  EXPECT_EQ(people[0].at("grabs"), Json::array());
  EXPECT_TRUE(people[0].at("pointer").is_null());
  const Json watching = bob_->result("presence.list").at("participants");
  ASSERT_EQ(watching.size(), 1U);
  EXPECT_EQ(watching[0].at("name"), "Bob");
  EXPECT_EQ(watching[0].at("grabs"), Json::array());
  // Viewers do not change the shown state.
  {
    TestClient carl(server_, 3);
    carl.result("session.join", {{"session", "r1"}});
    carl.result("control.step");
    carl.result("session.leave");
  }
  EXPECT_EQ(bob_->result("control.step").at("tick"), 11);
  EXPECT_EQ(hash(), hashes_.at(first_ + 11));
}

TEST_F(ReplaySession, IsNotChangedByViewers) {
  live();
  open();
  seek(first_ + 5);
  const std::string before = hash();
  const std::pair<const char*, Json> calls[] = {
      {"world.set_gravity", {{"gravity", {0, 0, 0}}}},
      {"world.remove_body", {{"body", 3}}},
      {"grab.start", {{"body", 3}, {"particle", 0}, {"target", {0, 0, 0}}}},
      {"grab.end", {{"grab", 1}}},
      {"scene.load", {{"scene", "mixed"}}},
      {"control.reset", nullptr},
      {"session.save", {{"name", "a"}}},
      {"session.load", {{"name", "a"}}},
  };
  for (const auto& [method, params] : calls) {
    const Json error = bob_->error(method, params);
    EXPECT_EQ(error.at("data").at("kind"), "not_allowed") << method;
    EXPECT_THAT(error.at("message"), HasSubstr("replay")) << method;
  }
  EXPECT_EQ(bob_->error("recording.export").at("data").at("kind"), "not_allowed");
  EXPECT_EQ(bob_->error("replay.open", {{"session", "r1"}}).at("data").at("kind"), "not_allowed");
  EXPECT_EQ(hash(), before);
  EXPECT_EQ(client_->error("replay.seek", {{"position", 1}}).at("data").at("kind"), "not_allowed");
  EXPECT_EQ(client_->error("replay.info").at("data").at("kind"), "not_allowed");
}

TEST_F(ReplaySession, BeginsAnEpochWithEverySeek) {
  live();
  open();
  bob_->result("frames.subscribe");
  const auto epoch = [&] { return joined_.at("description").at("epoch").get<std::uint32_t>(); };
  std::uint32_t last = epoch();
  for (const std::uint64_t at : {8U, 2U, 20U, 0U}) {
    bob_->mark();
    seek(first_ + at);
    const std::uint32_t next = bob_->wait_event("session.description").at("epoch");
    EXPECT_GT(next, last);
    last = next;
    bob_->wait_frame([&](const GridFrame& frame) { return frame.header.epoch == next; });
  }
}

TEST_F(ReplaySession, SendsItsPeopleTenTimesASecondAtMost) {
  live();
  open();
  constexpr int kSeeks = 10;
  const auto told_of_seeks = [&] {
    bob_->mark();
    server_.clock().advance(std::chrono::milliseconds(100));
    // A grab is active at one of the two positions, and none at the other.
    for (int i = 0; i < kSeeks; ++i) seek(first_ + (i % 2 == 0 ? 5 : 9));
    return bob_->events("replay.people").size();
  };
  EXPECT_EQ(told_of_seeks(), 1U);
  EXPECT_EQ(told_of_seeks(), 1U);
}

TEST_F(ReplaySession, GoesToTicksOfThePresentRun) {
  live();
  open();
  seek(first_ + 2);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 9}}).at("position"), first_ + 9);
  EXPECT_EQ(bob_->error("replay.seek", {{"tick", 20}}).at("data").at("path"), "/tick");
  seek(position_);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 3}}).at("position"), first_ + 15);
  EXPECT_EQ(hash(), hashes_.at(first_ + 15));
}

TEST_F(ReplaySession, ARunIsNotEndedByASceneThatWasRefused) {
  live();
  Json large = Json::parse(mixed_scene_text());
  large["bodies"][0]["spacing"] = 0.03;
  large["bodies"][0]["shape"]["size"] = {0.9, 0.9, 0.3};
  EXPECT_EQ(client_->error("scene.load", {{"scene", large}}).at("data").at("limit"), "particles");
  step(2);
  open();
  seek(position_ - 4);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 13}}).at("position"), position_);
}

TEST_F(ReplaySession, ContinuesFromALoadedState) {
  note();
  step(3);
  client_->result("session.save", {{"name", "third"}});
  step(4);
  client_->result("session.load", {{"name", "third"}});
  note();
  client_->result("session.delete_save", {{"name", "third"}});
  step(2);
  open();
  expect_states();
  EXPECT_EQ(hashes_.at(first_ + 9), hashes_.at(first_ + 5));
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 4}}).at("position"), first_ + 8);
  seek(first_ + 1);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 6}}).at("position"), first_ + 6);
  EXPECT_EQ(bob_->error("replay.seek", {{"tick", 7}}).at("data").at("path"), "/tick");
}

TEST_F(ReplaySession, ThereAreSoManyAtMost) {
  live();
  bob_.emplace(server_, 2);
  EXPECT_EQ(bob_->error("replay.open", {{"session", "s1"}}).at("data").at("role"), "viewer");
  bob_->result("session.join");
  for (int n = 1; n <= 4; ++n) bob_->result("replay.open", {{"session", "s1"}});
  const Json error = bob_->error("replay.open", {{"session", "s1"}});
  EXPECT_EQ(error.at("data").at("limit"), "replays");
  bob_->result("session.join", {{"session", "r2"}});
  const Json closed = bob_->call("session.close", {{"session", "r2"}});
  EXPECT_TRUE(closed.contains("result")) << closed;
  bob_->result("session.join", {{"session", "s1"}});
  EXPECT_EQ(bob_->result("replay.open", {{"session", "s1"}}).at("session"), "r5");
}

}  // namespace
}  // namespace vat::test::replay_session_test
