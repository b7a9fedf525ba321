// Sessions on a slow disk and on a failing disk.

#include <gmock/gmock.h>

#include <thread>

#include "tests/server/fixture/host.h"
#include "tests/server/fixture/test_disk.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::session_durability_test {
namespace {

using testing::HasSubstr;

class SessionDurability : public testing::Test {
 protected:
  SessionDurability() { begin(); }
  ~SessionDurability() override { disk.release_syncs(); }  // a failed test may hold them
  void begin() { host.emplace(catalogue, folder.file("data"), unhurried_limits(), clock); }
  TestClient& client() { return *host->client; }
  bool has_reply(int id) {
    return client()
        .connection->find_text([id](const Json& text) { return text.value("id", Json()) == id; })
        .has_value();
  }
  /// Sends a command. Returns its id when its write waits for the disk.
  int send_and_hold(std::string_view method, const Json& params) {
    host->server.flush();  // no other write of the session is running
    disk.hold_syncs();
    const int id = client().send(method, params);
    disk.wait_for_held_sync();
    return id;
  }

  TestDisk disk;
  const TemporaryFolder folder;
  const Catalogue catalogue = make_catalogue();
  ManualClock clock;
  std::optional<Host> host;
};

const Json kGravity = {{"gravity", {0, 0, -1}}};

TEST_F(SessionDurability, ACommandIsExecutedAndAnsweredAfterItsSync) {
  client().mark();
  const int first = send_and_hold("world.set_gravity", kGravity);
  const int second = client().send("world.set_gravity", {{"gravity", {0, 0, -2}}});
  const int read = client().send("session.hash");
  EXPECT_FALSE(has_reply(first));
  EXPECT_TRUE(client().events("session.description").empty()) << "the command was executed";
  disk.release_syncs();
  client().wait_reply(read);
  EXPECT_TRUE(has_reply(first));
  EXPECT_TRUE(has_reply(second)) << "requests of one client are answered in order";
}

TEST_F(SessionDurability, AStepIsAnsweredAfterItsTickIsStored) {
  const int step = send_and_hold("control.step", {{"ticks", 3}});
  EXPECT_FALSE(has_reply(step));
  disk.release_syncs();
  EXPECT_EQ(client().wait_reply(step).at("result").at("tick"), 3);
  host.reset();
  begin();
  EXPECT_GE(host->tick(), 3U);
}

TEST_F(SessionDurability, OnAFailingDiskTheSessionRefusesCommandsAndContinues) {
  const std::pair<TestDisk::Fault, const char*> faults[] = {
      {TestDisk::Fault::full, "full"},
      {TestDisk::Fault::short_write, "full"},
      {TestDisk::Fault::io_error, "failed"},
      {TestDisk::Fault::sync_error, "failed"},
      {TestDisk::Fault::read_only, "read_only"}};
  EXPECT_TRUE(has_sample(host->server.metrics(), "vat_storage_failures_total 0"));
  const auto is_failing = [](bool failing) {
    return [failing](const Json& params) { return params.at("failing") == failing; };
  };
  for (const auto& [fault, reason] : faults) {
    SCOPED_TRACE(reason);
    client().mark();
    const std::string before = host->hash();
    host->server.flush();
    disk.fail(fault);
    const Json error = client().error("world.set_gravity", kGravity);
    EXPECT_EQ(error.at("data").at("kind"), "storage_failed");
    EXPECT_EQ(host->hash(), before) << "the command was executed";
    EXPECT_EQ(client().wait_event("session.storage", is_failing(true)).at("reason"), reason);
    EXPECT_THAT(host->server.health(), HasSubstr("\"storage\":\"failing\""));
    EXPECT_THAT(host->server.health(), HasSubstr("\"reason\":\"" + std::string(reason) + '"'));
    EXPECT_EQ(client().result("session.stats").at("tick"), host->tick());

    disk.fail({});
    client().result("world.set_gravity", kGravity);
    client().result("world.set_gravity", {{"gravity", {0, 0, -9}}});
    client().wait_event("session.storage", is_failing(false));
    EXPECT_THAT(host->server.health(), HasSubstr("\"storage\":\"ok\""));
    EXPECT_THAT(host->server.health(), HasSubstr("\"durability\":\"power\""));
    host->step(1);
  }
  EXPECT_FALSE(has_sample(host->server.metrics(), "vat_storage_failures_total 0"));
  const std::string last = host->hash();
  host.reset();
  begin();
  EXPECT_EQ(host->hash(), last);
  EXPECT_TRUE(client().events("session.diverged").empty());
}

TEST_F(SessionDurability, OnAFailingDiskAPlayingSessionTicks) {
  client().result("frames.subscribe");
  client().result("control.play");
  host->server.flush();
  disk.fail(TestDisk::Fault::io_error);
  const std::uint64_t begin = host->tick();
  client().wait_frame([&](const GridFrame& frame) { return frame.header.tick >= begin + 20; });
  disk.fail({});
}

TEST_F(SessionDurability, LeavesOnAFailingDiskTakeEffectLater) {
  TestClient guest(host->server, 2);
  guest.result("session.join", {{"session", "s1"}, {"name", "Bo"}});
  guest.grab(3);
  host->server.flush();
  disk.fail(TestDisk::Fault::full);
  guest.result("session.leave");
  disk.fail({});
  host->server.advance_until(
      [&] { return client().result("presence.list").dump().find("Bo") == std::string::npos; });
  client().grab(3);  // no longer held
}

TEST_F(SessionDurability, SettingsThatCannotBeStoredDoNotChange) {
  host->server.flush();
  disk.fail(TestDisk::Fault::full);
  const auto admin = std::make_unique<TestClient>(host->server, 2);
  admin->result("access.enter", {{"token", std::string(kAdminToken)}});
  admin->result("session.join", {{"session", "s1"}});
  EXPECT_EQ(admin->error("session.configure", {{"name", "other"}}).at("data").at("kind"),
            "storage_failed");
  disk.fail({});
  EXPECT_EQ(admin->result("session.configure", {{"locked", true}}).at("name"), "first");
}

// More sessions wait for the disk than the server has threads for sessions.
TEST_F(SessionDurability, WhileTheDiskIsBlockedOtherSessionsContinue) {
  constexpr std::size_t kBusySessions = 6;
  TestServer& server = host->server;
  const Json scene = Json::parse(mixed_scene_text());
  std::vector<std::unique_ptr<TestClient>> busy;
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < kBusySessions; ++i) {
    busy.push_back(std::make_unique<TestClient>(server, 10 + static_cast<int>(i)));
    ids.push_back(busy[i]->create_session(scene, "busy"));
    busy[i]->result("session.join", {{"session", ids[i]}});
    busy[i]->result("control.pause");
    busy[i]->result("session.save", {{"name", "a"}});
  }
  client().result("scene.save", {{"name", "mine"}});
  client().result("control.play");
  server.flush();
  disk.hold_syncs();
  std::vector<std::pair<TestClient*, int>> waiting;
  const auto send = [&](TestClient& to, std::string_view method, const Json& params) {
    waiting.emplace_back(&to, to.send(method, params));
  };
  for (std::size_t i = 0; i < kBusySessions; ++i) {
    TestClient& one = *busy[i];
    if (i % 2 == 0) send(one, "session.invite", {{"role", "viewer"}});
    send(one, "session.save", {{"name", "b"}});
    send(one, "scene.save", {{"name", "of " + ids[i]}});
    send(one, "scene.get", {{"scene", "mine"}});
    send(one, "session.saves", Json::object());
    send(one, "session.load", {{"name", "b"}});
    send(one, "world.set_gravity", kGravity);
    send(one, "session.leave", Json::object());
    send(one, "session.create", {{"name", "new"}, {"scene", "mixed"}});
    send(one, "scene.list", Json::object());
    send(one, "scene.delete", {{"name", "mine"}});
    if (i == 5) send(one, "session.close", {{"session", ids[i]}});
  }
  disk.wait_for_held_sync();

  std::uint64_t tick = client().result("session.stats").at("tick");
  for (int i = 0; i < 40; ++i) {  // before the first timer of the blocked storage thread
    clock.advance(std::chrono::milliseconds(20));
    const std::uint64_t now = client().result("session.hash").at("tick");
    EXPECT_EQ(now, tick + 1);
    tick = now;
  }
  TestClient other(server, 2);
  other.result("server.info");
  other.result("session.list");
  other.result("session.join", {{"session", "s1"}});
  other.result("state.query");
  EXPECT_FALSE(server.metrics().empty());
  disk.release_syncs();
  for (const auto& [to, id] : waiting) to->wait_reply(id);
}

TEST_F(SessionDurability, AClosedServerExecutesTheCommandThatItIsStoring) {
  const int id = send_and_hold("world.set_gravity", kGravity);
  std::thread stop([this] { host->server.stop(); });
  disk.release_syncs();
  stop.join();
  EXPECT_TRUE(client().wait_reply(id).contains("result"));
}

}  // namespace
}  // namespace vat::test::session_durability_test
