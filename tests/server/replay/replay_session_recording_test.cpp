// Import of recordings, and their replay.

#include "server/history/recording.h"
#include "server/session/core/scene_loading.h"
#include "tests/server/replay/replay_session_fixture.h"

namespace vat::test::replay_session_recording_test {
namespace {

TEST_F(ReplaySession, IsRestoredFromItsFile) {
  live();
  const std::string file = exported();
  TestClient carl(server_, 3);
  const Json whole = import(carl, file, 1000);
  EXPECT_EQ(whole.at("whole"), true);
  EXPECT_EQ(whole.at("received"), file.size());
  EXPECT_GE(whole.at("ticks"), position_ - first_);
  open({{"recording", whole.at("recording")}, {"name", "again"}});
  EXPECT_EQ(joined_.at("description").at("name"), "again");
  expect_states();
}

TEST_F(ReplaySession, RefusesFilesThatAreNoRecordings) {
  live();
  std::string file = exported();
  TestClient carl(server_, 3);
  const auto code = [&](const Json& reply) {
    return reply.at("error").at("data").at("errors")[0].at("code").get<std::string>();
  };
  std::string damaged = file;
  damaged[file.size() / 2] ^= 1;
  EXPECT_EQ(code(import(carl, damaged)), "damaged");
  EXPECT_EQ(carl.error("recording.import", {{"size", 9}, {"offset", 0}, {"data", "a"}})
                .at("data")
                .at("path"),
            "/data");
  EXPECT_EQ(carl.error("recording.import", {{"size", 9}, {"offset", 3}, {"data", "AAAA"}})
                .at("data")
                .at("path"),
            "/offset");
  const Json begun =
      carl.result("recording.import", {{"size", 9}, {"offset", 0}, {"data", "AAAA"}});
  Json next{{"recording", begun.at("recording")}, {"size", 9}, {"offset", 3}, {"data", "AAAA"}};
  TestClient other(server_, 4);
  EXPECT_EQ(other.error("recording.import", next).at("data").at("path"), "/recording");
  next["size"] = 10;
  EXPECT_EQ(carl.error("recording.import", next).at("data").at("path"), "/size");
  EXPECT_EQ(carl.error("replay.open", {{"recording", begun.at("recording")}}).at("data").at("path"),
            "/recording");
}

/// Recordings that no server writes: names that are not UTF-8, and commands that do not belong in a
/// log.
TEST_F(ReplaySession, RefusesManipulatedRecordings) {
  live();
  Recording recording = record();
  recording.name = "\xff\xfe";
  recording.moments.clear();
  const auto gravity = std::ranges::find(recording.log, "world.set_gravity", &LogEntry::method);
  TestClient carl(server_, 3);
  bob_.emplace(server_, 2);
  for (const char* method : {"frames.subscribe", "participant.kick", "replay.seek", "\xff"}) {
    gravity->method = method;
    gravity->params = "{}";
    const Json whole = import(carl, recording);
    EXPECT_EQ(whole.at("name"), "??");
    const Json opened = bob_->result("replay.open", {{"recording", whole.at("recording")}});
    bob_->result("session.join", {{"session", opened.at("session")}});
    bob_->mark();
    EXPECT_EQ(seek(position_).at("position"), gravity->position);
    EXPECT_EQ(bob_->wait_event("replay.diverged").at("tick"), 7);
    bob_->result("session.close", {{"session", opened.at("session")}});
  }
}

/// The server does not decompress states that exceed the limits of a session.
TEST_F(ReplaySession, UnpacksNoMoreThanASessionMayBe) {
  live();
  ServerLimits limits;
  limits.max_particles = kMaxParticlesOfSession;
  const std::size_t most = max_state_bytes(limits);
  ASSERT_LT(most, std::size_t{1} << 30);
  const auto reason = [&](const Recording& recording) -> std::string {
    const Json whole = import(*client_, recording);
    bob_->result("session.join", {{"session", "s1"}});
    const Json opened = bob_->result("replay.open", {{"recording", whole.at("recording")}});
    bob_->result("session.join", {{"session", opened.at("session")}});
    bob_->mark();
    seek(position_);
    bob_->result("session.close", {{"session", opened.at("session")}});
    return bob_->wait_event("replay.diverged").at("reason");
  };
  bob_.emplace(server_, 2);
  for (const std::uint32_t more : {0U, 1U}) {
    Recording recording = record();
    recording.moments.back().state = bytes_that_say(static_cast<std::uint32_t>(most) + more);
    const std::string told = reason(recording);
    EXPECT_EQ(told.find("too large") != std::string::npos, more == 1) << told;
  }
}

TEST_F(ReplaySession, ShowsAnyNameAsText) {
  live();
  Recording recording = record();
  recording.name = std::string(200, 'n');
  for (RecordedMoment& moment : recording.moments) {
    Json fields = Json::parse(moment.fields);
    for (Json& person : fields.at("participants").at("list")) person["name"] = "A\xe2\x80\xaenn";
    moment.fields = fields.dump();
  }
  bob_.emplace(server_, 2);
  const Json whole = import(*bob_, recording);
  EXPECT_EQ(whole.at("name"), std::string(64, 'n'));
  const Json opened = bob_->result("replay.open", {{"recording", whole.at("recording")}});
  bob_->result("session.join", {{"session", opened.at("session")}});
  seek(first_ + 5);
  const Json people = bob_->result("replay.info").at("people");
  ASSERT_EQ(people.size(), 1U);
  EXPECT_EQ(people[0].at("name").get<std::string>().find("\xe2\x80\xae"), std::string::npos);
}

TEST_F(ReplaySession, RefusesRecordingsThatAreTooLong) {
  live();
  Recording recording = record();
  recording.moments.clear();
  TestClient carl(server_, 3);
  const auto limit_of = [&](const Recording& one) {
    const Json reply = import(carl, one);
    return reply.contains("error") ? reply.at("error").at("data").at("limit").get<std::string>()
                                   : "";
  };
  recording.end = recording.begin + kMaxRecordedTicks;
  EXPECT_EQ(limit_of(recording), "");
  ++recording.end;
  EXPECT_EQ(limit_of(recording), "recording_ticks");
  --recording.end;
  LogEntry last = recording.log.back();
  last.method = "leave";
  last.params = "{}";
  while (recording.log.size() < kMaxRecordedEntries) {
    ++last.sequence;
    recording.log.push_back(last);
  }
  EXPECT_EQ(limit_of(recording), "");
  ++last.sequence;
  recording.log.push_back(last);
  EXPECT_EQ(limit_of(recording), "recording_entries");
}

}  // namespace
}  // namespace vat::test::replay_session_recording_test
