#include <gmock/gmock.h>

#include <iostream>
#include <random>

#include "server/script/server_process.h"
#include "tests/recovery/load.h"
#include "tests/recovery/past.h"
#include "tests/support/pool_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::kill_test {
namespace {

constexpr int kSessions = 4;
constexpr int kClientsPerSession = 2;

int kill_count() {
  const char* wanted = std::getenv("VAT_KILLS");
  return wanted == nullptr ? 10 : std::atoi(wanted);
}

class Kill : public testing::Test {
 protected:
  Kill() { scenes.write("pool.json", kPoolScene); }

  script::ServerProcess start() {
    return {
        VAT_PROGRAM,
        {"serve", "--port", "0", "--scenes", scenes.path().string(), "--scene", "pool", "--data",
         data, "--checkpoint-seconds", "0.005", "--log-level", "warn", "--threads", "2"}};
  }

  /// Runs a server under load and kills it after a random number of replies.
  void live(int life, Told& told) {
    script::ServerProcess server = start();
    const auto listed = list_sessions(server.port());
    if (life == 0) {
      names[listed.at(0).first] = listed.at(0).second;
      for (int i = 1; i < kSessions; ++i) {
        const std::string name = "pool " + std::to_string(i);
        names[create_session(server.port(), name, "pool")] = name;
      }
    } else {
      const std::map<std::string, std::string> back(listed.begin(), listed.end());
      EXPECT_EQ(back, names) << "after kill " << life;
    }
    std::vector<std::thread> clients;
    for (const auto& [session, name] : names) {
      for (int i = 0; i < kClientsPerSession; ++i) {
        const std::uint64_t own_name = ++last_client;
        clients.emplace_back(
            [&, client = connect(server.port()), session = session, own_name]() mutable {
              load_session(std::move(client), session, own_name, told);
            });
      }
    }
    const auto answers = std::uniform_int_distribution<std::size_t>(0, 400)(chance);
    EXPECT_TRUE(wait_until([&] { return told.answer_count() >= answers; }));
    server.kill();
    for (std::thread& client : clients) client.join();
  }

  TemporaryFolder scenes;
  TemporaryFolder folder;
  const std::string data = folder.file("data");
  std::mt19937 chance{20260101};
  std::map<std::string, std::string> names;
  std::uint64_t last_client = 0;
};

using Command = std::pair<std::string, std::string>;

TEST_F(Kill, AtAnyMomentLosesNothingThatWasAnswered) {
  std::vector<Seen> seen;
  std::size_t commands = 0;
  for (int life = 0; life < kill_count(); ++life) {
    Told told;
    live(life, told);
    EXPECT_THAT(told.faults, testing::IsEmpty());
    std::map<std::string, StoredPast> past = read_past(data);
    ASSERT_EQ(past.size(), names.size());
    std::map<std::string, std::multiset<Command>> logged;
    for (const auto& [session, stored] : past) {
      EXPECT_EQ(stored.name, names.at(session));
      for (const LogEntry& entry : stored.log) {
        if (!entry.refused) logged[session].emplace(entry.method, entry.params);
      }
    }
    for (const Answered& answered : told.answered) {
      EXPECT_TRUE(logged[answered.session].contains({answered.method, answered.params}))
          << answered.method << " " << answered.params << " is lost from " << answered.session;
    }
    commands += told.answered.size();
    // States seen after the recovered position are no longer part of the history.
    for (const Seen& state : told.seen) {
      if (state.position <= past.at(state.session).position) seen.push_back(state);
    }
  }
  // The histories after all kills are consistent: each state that a client saw is at its position.
  const Catalogue catalogue = Catalogue::open(scenes.path().string()).value();
  for (const auto& [session, past] : read_past(data)) {
    const auto hashes = hashes_of(past, catalogue);
    for (const Seen& state : seen) {
      if (state.session != session) continue;
      const auto at = hashes.find(state.position);
      ASSERT_NE(at, hashes.end()) << session << " at " << state.position;
      EXPECT_TRUE(at->second.contains(state.hash)) << session << " at " << state.position;
    }
  }
  std::cout << kill_count() << " kills, " << commands << " commands answered, " << seen.size()
            << " states compared\n";
  EXPECT_GT(commands, 20U * static_cast<std::size_t>(kill_count()));
  EXPECT_GT(seen.size(), 10U * static_cast<std::size_t>(kill_count()));
}

}  // namespace
}  // namespace vat::test::kill_test
