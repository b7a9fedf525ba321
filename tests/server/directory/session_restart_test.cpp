// State that persists across a restart besides sessions: participants and invitations.

#include "server/storage/sqlite/database.h"
#include "tests/server/fixture/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::session_restart_test {
namespace {

using namespace std::chrono_literals;

class Restart : public testing::Test {
 protected:
  Restart() : catalogue(make_catalogue()) { restart(); }
  void restart() {
    host.reset();
    host.emplace(catalogue, folder, limits, clock);
  }
  std::unique_ptr<TestClient> connect() {
    return std::make_unique<TestClient>(host->server, ++last_);
  }
  std::unique_ptr<TestClient> connect_admin() {
    auto admin = connect();
    admin->result("access.enter", {{"token", kAdminToken}});
    admin->result("session.join", {{"session", "s1"}});
    return admin;
  }
  bool is_good(const std::string& token) {
    return connect()->call("access.enter", {{"token", token}}).contains("result");
  }

  const TemporaryFolder temporary;
  const std::string folder = temporary.file("data");
  const Catalogue catalogue;
  ServerLimits limits = unhurried_limits();
  ManualClock clock;
  std::optional<Host> host;

 private:
  ConnectionId last_ = 10;
};

TEST_F(Restart, InvitationsStayGoodForTheUsesThatAreLeft) {
  std::string twice;
  std::string always;
  {
    const auto admin = connect_admin();
    twice = admin->result("session.invite", {{"role", "viewer"}, {"uses", 2}}).at("token");
    always = admin->result("session.invite", {{"role", "controller"}}).at("token");
  }
  EXPECT_TRUE(is_good(twice));
  restart();
  {
    const auto guest = connect();
    const Json entered = guest->result("access.enter", {{"token", always}});
    EXPECT_EQ(entered.at("role"), "controller");
    EXPECT_EQ(entered.at("session"), "s1");
  }
  EXPECT_TRUE(is_good(twice));
  EXPECT_FALSE(is_good(twice));
  restart();
  EXPECT_FALSE(is_good(twice)) << "already used";
  EXPECT_TRUE(is_good(always));
}

TEST_F(Restart, InvitationsEndInTimeAndWithTheirSession) {
  std::string brief;
  std::string of_second;
  {
    const auto admin = connect_admin();
    brief = admin->result("session.invite", {{"role", "viewer"}, {"expires", 1}}).at("token");
    const std::string second = admin->create_session();
    admin->result("session.join", {{"session", second}});
    of_second = admin->result("session.invite", {{"role", "viewer"}}).at("token");
    admin->result("session.close", {{"session", second}});
  }
  clock.advance(1s);
  restart();
  EXPECT_FALSE(is_good(brief));
  EXPECT_FALSE(is_good(of_second));
  host.reset();
  EXPECT_EQ(
      Database(folder + "/vat.db", Database::Mode::read).number("SELECT count(*) FROM tokens"), 0);
}

TEST_F(Restart, AKickedParticipantIsNotRestored) {
  Json joined;
  {
    const auto admin = connect_admin();
    const auto guest = connect();
    joined = guest->result("session.join", {{"session", "s1"}, {"name", "Bo"}});
    admin->result("participant.kick", {{"participant", joined.at("participant")}});
  }
  restart();
  const auto guest = connect();
  const Json back =
      guest->result("session.join", {{"session", "s1"}, {"resume", joined.at("resume")}});
  EXPECT_FALSE(back.at("resumed"));
  EXPECT_GT(back.at("participant"), joined.at("participant"));
}

TEST_F(Restart, ExpiredSessionsAreNotRestored) {
  limits.expire_after = 60s;
  limits.hibernate_after = 1s;
  limits.resume_time = 0ms;
  restart();
  {
    const auto other = connect();
    other->create_session();
    EXPECT_EQ(other->result("session.list").at("sessions").size(), 2U);
    clock.advance(80s);
    host->server.flush();  // the session ends after its end is stored
    EXPECT_EQ(other->result("session.list").at("sessions").size(), 1U);
  }
  restart();
  EXPECT_EQ(connect()->result("session.list").at("sessions").size(), 1U);
}

TEST_F(Restart, AdminsSeeAllSessionsAndTheirPeople) {
  const auto admin = connect_admin();
  const auto guest = connect();
  guest->result("session.join", {{"session", "s1"}, {"name", "Bo"}});
  const Json sessions = admin->result("server.sessions").at("sessions");
  ASSERT_EQ(sessions.size(), 1U);
  EXPECT_EQ(sessions[0].at("session"), "s1");
  EXPECT_EQ(sessions[0].at("kind"), "live");
  const Json& people = sessions[0].at("participants");
  ASSERT_EQ(people.size(), 3U);
  EXPECT_EQ(people[0].at("name"), "Ada");
  EXPECT_EQ(people[1].at("role"), "admin");
  EXPECT_EQ(people[2].at("name"), "Bo");
  EXPECT_EQ(people[2].at("address"), "127.0.0.1");
  EXPECT_FALSE(people[2].at("away"));
  EXPECT_EQ(guest->error("server.sessions").at("data").at("least_role"), "admin");
  guest->disconnect();
  const Json later = admin->result("session.hash");  // executed after the end
  const Json away = admin->result("server.sessions").at("sessions")[0].at("participants")[2];
  EXPECT_TRUE(away.at("away"));
  EXPECT_FALSE(away.contains("address"));
  admin->result("replay.open", {{"session", "s1"}});
  EXPECT_EQ(admin->result("server.sessions").at("sessions")[1].at("kind"), "replay");
  // This server has no handler that ends it.
  EXPECT_EQ(admin->error("server.drain").at("code"), 1006);
}

TEST_F(Restart, ATokenOfOneSessionOpensNoRecording) {
  const auto guest = connect();
  const Json invited = connect_admin()->result("session.invite", {{"role", "controller"}});
  guest->result("access.enter", {{"token", invited.at("token")}});
  const Json error = guest->error("replay.open", {{"recording", "x"}});
  EXPECT_EQ(error.at("data").at("kind"), "not_allowed");
}

// A data folder of schema version 1 that contains a session with a held ball after 50 ticks.
TEST(StoredByVersion1, IsReadUnchanged) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.file("data");
  std::filesystem::create_directories(folder);
  for (const char* name : {"/vat.db", "/checkpoints.db"}) {
    std::filesystem::copy_file(VAT_SOURCE_DIR "/tests/recovery/version1" + std::string(name),
                               folder + name);
    EXPECT_EQ(Database(folder + name, Database::Mode::read).number("PRAGMA user_version"), 1);
  }
  const Catalogue catalogue = make_catalogue();
  {
    ManualClock clock;
    Host host(catalogue, folder, unhurried_limits(), clock);
    EXPECT_TRUE(host.client->events("session.diverged").empty());
    EXPECT_EQ(host.tick(), 50U);
    EXPECT_EQ(host.hash(), "5c0e6d6e4e745f62");
    const Json ada = host.client->result("session.join",
                                         {{"session", "s1"}, {"resume", "C9inCU4TBD5hfCvIpfS9AA"}});
    EXPECT_TRUE(ada.at("resumed"));
    host.client->result("grab.move", {{"grab", 1}, {"target", {0, 0, 1}}});
    host.client->result("session.save", {{"name", "of version 1"}});
  }
  Database now(folder + "/vat.db", Database::Mode::read);
  EXPECT_EQ(now.number("PRAGMA user_version"), 2);
  EXPECT_GE(now.number("SELECT count(*) FROM log"), 7);
  EXPECT_EQ(now.number("SELECT count(*) FROM scenes"), 0);
}

}  // namespace
}  // namespace vat::test::session_restart_test
