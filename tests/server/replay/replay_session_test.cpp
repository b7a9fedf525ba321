// Sessions that show what another one did.

#include <gmock/gmock.h>
#include <openssl/evp.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "server/history/recording.h"
#include "server/http/downloads.h"
#include "server/session/core/scene_loading.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::replay_session_test {
namespace {

using testing::HasSubstr;

std::string to_base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

constexpr std::size_t kMaxParticlesOfSession = 5000;

/// A kept session `s1` that somebody called Ann has done something in, and a client that watches.
class ReplaySession : public testing::Test {
 protected:
  ReplaySession() : catalogue_(make_catalogue()), server_(catalogue_, settings()) {
    EXPECT_TRUE(server_.create_session("first", to_scene(mixed_scene_text())).ok());
    ann_.emplace(server_, 1);
    ann_->result("session.join", {{"name", "Ann"}});
    ann_->result("control.pause");
    ann_->result("control.reset");
    position_ = ann_->result("session.hash").at("position");
    first_ = position_;
  }
  void TearDown() override { ann_->disconnect(); }

  /// Notes the state of every position. The session ends at tick 11 of its second run.
  void live() {
    note();
    step(3);
    const Json grab =
        ann_->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.8}}});
    note();
    step(4);
    ann_->result("grab.end", {{"grab", grab.at("grab")}});
    ann_->result("world.set_gravity", {{"gravity", {1, 0, -5}}});
    note();
    step(5);
    ann_->result("control.reset");
    note();
    step(11);
  }
  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      ann_->result("control.step");
      ++position_;
      note();
    }
  }
  void note() { hashes_[position_] = ann_->result("session.hash").at("hash"); }

  /// Opens the replay and has `bob_` join it; what was opened.
  Json open(const Json& params = {{"session", "s1"}}) {
    bob_.emplace(server_, 2);
    // Who opens a session's past has to be a controller in it.
    if (params.contains("session")) bob_->result("session.join");
    const Json opened = bob_->result("replay.open", params);
    joined_ = bob_->result("session.join", {{"session", opened.at("session")}, {"name", "Bob"}});
    return opened;
  }
  Json seek(std::uint64_t position) {
    return bob_->result("replay.seek", {{"position", position}});
  }
  std::string hash() { return bob_->result("session.hash").at("hash"); }

  std::string exported() {
    const std::string path = ann_->result("recording.export").at("path");
    return server_.downloads().take(path, server_.clock().now())->content;
  }
  static Recording read(const std::string& bytes) {
    return read_recording({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})
        .value();
  }
  /// Brings it in parts of so many bytes; the answer to the last.
  Json import(TestClient& client, const std::string& file, std::size_t part = 3'000'000) {
    Json last;
    for (std::size_t at = 0; at < file.size(); at += part) {
      Json params{
          {"size", file.size()}, {"offset", at}, {"data", to_base64(file.substr(at, part))}};
      if (at > 0) params["recording"] = last.at("recording");
      last = client.call("recording.import", params);
      if (!last.contains("result")) return last;
      last = last.at("result");
    }
    return last;
  }
  Json import(TestClient& client, const Recording& recording) {
    const std::vector<std::uint8_t> bytes = write_recording(recording);
    return import(client, std::string(bytes.begin(), bytes.end()));
  }
  /// Every state that was noted is shown again.
  void expect_states() {
    for (const auto& [position, expected] : hashes_) {
      seek(position);
      ASSERT_EQ(hash(), expected) << position;
    }
  }

 private:
  ServerSettings settings() const {
    ServerLimits limits = unhurried_limits();
    limits.max_particles = kMaxParticlesOfSession;
    return test_settings(limits, folder_.file("data"));
  }

 protected:
  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  TestServer server_;
  std::optional<TestClient> ann_;
  std::optional<TestClient> bob_;
  Json joined_;
  std::uint64_t first_ = 0;
  std::uint64_t position_ = 0;
  std::map<std::uint64_t, std::string> hashes_;
};

TEST_F(ReplaySession, ShowsEveryStateThatThereWas) {
  live();
  const Json opened = open();
  EXPECT_EQ(opened.at("session"), "r1");
  EXPECT_EQ(opened.at("end"), position_);
  EXPECT_EQ(joined_.at("description").at("replay").at("end"), position_);
  EXPECT_FALSE(joined_.at("description").at("playing"));
  std::uint64_t at = first_;
  for (int n = 0; n < 40; ++n) {
    at = first_ + (at * 7 + 5) % (position_ - first_ + 1);
    const Json there = seek(at);
    ASSERT_EQ(there.at("position"), at);
    ASSERT_EQ(hash(), hashes_.at(at)) << at;
  }
  seek(first_);
  while (at = bob_->result("session.hash").at("position"), at < position_) {
    ASSERT_EQ(hash(), hashes_.at(at)) << at;
    bob_->result("control.step");
  }
  EXPECT_EQ(hash(), hashes_.at(position_));
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
  // Further steps lead nowhere.
  EXPECT_EQ(bob_->result("control.step", {{"ticks", 5}}).at("tick"), 11);
}

TEST_F(ReplaySession, TellsThoseWhoWereRecordedFromThoseWhoWatch) {
  live();
  open();
  EXPECT_EQ(joined_.at("participant"), 1);  // a number that Ann has in the recording
  seek(first_ + 5);
  Json people = bob_->result("replay.info").at("people");
  ASSERT_EQ(people.size(), 1U);
  EXPECT_EQ(people[0].at("name"), "Ann");
  EXPECT_EQ(people[0].at("person"), 1);
  EXPECT_EQ(people[0].at("grabs"), Json::array({2}));
  EXPECT_EQ(people[0].at("pointer").at("position"), Json::array({0.5, 0.5, 0.8}));
  EXPECT_FALSE(people[0].contains("participant"));
  seek(first_ + 9);
  people = bob_->result("replay.info").at("people");
  EXPECT_EQ(people[0].at("grabs"), Json::array());
  EXPECT_TRUE(people[0].at("pointer").is_null());
  const Json watching = bob_->result("presence.list").at("participants");
  ASSERT_EQ(watching.size(), 1U);
  EXPECT_EQ(watching[0].at("name"), "Bob");
  EXPECT_EQ(watching[0].at("grabs"), Json::array());
  // Who watches leaves without a trace in what is shown.
  {
    TestClient carl(server_, 3);
    carl.result("session.join", {{"session", "r1"}});
    carl.result("control.step");
    carl.result("session.leave");
  }
  EXPECT_EQ(bob_->result("control.step").at("tick"), 11);
  EXPECT_EQ(hash(), hashes_.at(first_ + 11));
}

TEST_F(ReplaySession, IsNotChangedByThoseWhoWatch) {
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
  EXPECT_EQ(ann_->error("replay.seek", {{"position", 1}}).at("data").at("kind"), "not_allowed");
  EXPECT_EQ(ann_->error("replay.info").at("data").at("kind"), "not_allowed");
}

TEST_F(ReplaySession, BeginsAnEpochWithEverySeek) {
  live();
  open();
  bob_->result("frames.subscribe");
  const auto epoch = [&] { return joined_.at("description").at("epoch").get<std::uint32_t>(); };
  std::uint32_t last = epoch();
  for (const std::uint64_t at : {8, 2, 20, 0}) {
    bob_->mark();
    seek(first_ + at);
    const std::uint32_t next = bob_->wait_event("session.description").at("epoch");
    EXPECT_GT(next, last);
    last = next;
    bob_->wait_frame([&](const GridFrame& frame) { return frame.header.epoch == next; });
  }
}

TEST_F(ReplaySession, TellsOfItsPeopleTenTimesASecondAtMost) {
  live();
  open();
  constexpr int kSeeks = 10;
  const auto told_of_seeks = [&] {
    bob_->mark();
    server_.clock().advance(std::chrono::milliseconds(100));
    // Somebody holds something at one of the two positions, and nobody does at the other.
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
  EXPECT_EQ(ann_->error("scene.load", {{"scene", large}}).at("data").at("limit"), "particles");
  step(2);
  open();
  seek(position_ - 4);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 13}}).at("position"), position_);
}

TEST_F(ReplaySession, GoesOnFromAStateThatWasLoaded) {
  note();
  step(3);
  ann_->result("session.save", {{"name", "third"}});
  step(4);
  ann_->result("session.load", {{"name", "third"}});
  note();
  ann_->result("session.delete_save", {{"name", "third"}});
  step(2);
  open();
  expect_states();
  EXPECT_EQ(hashes_.at(first_ + 9), hashes_.at(first_ + 5));
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 4}}).at("position"), first_ + 8);
  seek(first_ + 1);
  EXPECT_EQ(bob_->result("replay.seek", {{"tick", 6}}).at("position"), first_ + 6);
  EXPECT_EQ(bob_->error("replay.seek", {{"tick", 7}}).at("data").at("path"), "/tick");
}

TEST_F(ReplaySession, ComesBackFromItsFile) {
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
  EXPECT_EQ(code(import(carl, file.substr(0, file.size() - 1))), "wrong_length");
  EXPECT_EQ(code(import(carl, std::string("no recording at all"))), "other_format");
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

/// What no server has written: names that are no text, and commands that belong in no log.
TEST_F(ReplaySession, IsNotHarmedByWhatAnybodyMayHaveWritten) {
  live();
  Recording recording = read(exported());
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

/// States that are larger than a session's limits allow are not unpacked.
TEST_F(ReplaySession, UnpacksNoMoreThanASessionMayBe) {
  live();
  ServerLimits limits;
  limits.max_particles = kMaxParticlesOfSession;
  const std::size_t most = max_state_bytes(limits);
  ASSERT_LT(most, std::size_t{1} << 30);
  const auto reason = [&](const Recording& recording) -> std::string {
    const Json whole = import(*ann_, recording);
    bob_->result("session.join", {{"session", "s1"}});
    const Json opened = bob_->result("replay.open", {{"recording", whole.at("recording")}});
    bob_->result("session.join", {{"session", opened.at("session")}});
    bob_->mark();
    seek(position_);
    bob_->result("session.close", {{"session", opened.at("session")}});
    return bob_->wait_event("replay.diverged").at("reason");
  };
  bob_.emplace(server_, 2);
  for (const std::uint32_t more : {0, 1}) {
    Recording recording = read(exported());
    recording.moments.back().state = bytes_that_say(static_cast<std::uint32_t>(most) + more);
    const std::string told = reason(recording);
    EXPECT_EQ(told.find("too large") != std::string::npos, more == 1) << told;
  }
}

TEST_F(ReplaySession, ShowsNamesAsTextWhateverTheyAre) {
  live();
  Recording recording = read(exported());
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

TEST_F(ReplaySession, RefusesRecordingsThatAreTooLong) {
  live();
  Recording recording = read(exported());
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
}  // namespace vat::test::replay_session_test
