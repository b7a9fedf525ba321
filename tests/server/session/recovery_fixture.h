#pragma once

// Crashes of a server: the test copies the data folder of a running server, and starts a second
// server on the copy.

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include "server/storage/sqlite/database.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {

/// A server on a data folder, and a client in its session s1.
class Life {
 public:
  Life(const Catalogue& catalogue, const std::string& folder, ManualClock& clock,
       ServerLimits limits = {}, StorageSettings storage = {})
      : server_(catalogue, with_storage(test_settings(limits, folder), storage), clock),
        recovered(server_.recover()) {
    if (recovered == 0 && !server_.create_session("first", to_scene(mixed_scene_text()))) {
      throw std::runtime_error("the first session was refused");
    }
    client.emplace(server_, 1);
    joined = client->result("session.join", {{"session", "s1"}});
  }

  std::string hash() { return client->result("session.hash").at("hash"); }
  std::uint64_t tick() { return client->result("session.hash").at("tick"); }
  /// Waits until all posted data is written.
  void flush() { server_.flush(); }

 private:
  static ServerSettings with_storage(ServerSettings settings, const StorageSettings& storage) {
    settings.storage = storage;
    return settings;
  }
  TestServer server_;

 public:
  const std::size_t recovered;
  std::optional<TestClient> client;
  Json joined;
};

/// Copies the data as it is at this moment, as after a crash.
inline void copy_data(const std::string& from, const std::string& to) {
  std::filesystem::create_directories(to);
  for (const std::string name :
       {"/checkpoints.db", "/vat.db"}) {  // a checkpoint must not precede its log
    Database(from + name, Database::Mode::create)
        .execute(("VACUUM INTO '" + to + name + "'").c_str());
  }
  std::filesystem::copy(from + "/recent", to + "/recent");
}

class SessionRecoveryTest : public testing::Test {
 protected:
  SessionRecoveryTest() : catalogue(make_catalogue()) {}

  /// Ends the present server as a crash does, and starts the next.
  void crash(ServerLimits limits = {}) {
    end_by_crash();
    life.emplace(catalogue, data, clock, limits, storage);
  }
  void end_by_crash() {
    const std::string next = folder.file("data" + std::to_string(++lives_));
    life->flush();
    copy_data(data, next);
    life.reset();
    data = next;
  }
  void begin() { life.emplace(catalogue, data, clock, ServerLimits{}, storage); }
  TestClient& client() { return *life->client; }
  void execute(const std::string& sql, const char* file = "/vat.db") {
    Database(data + file, Database::Mode::create).execute(sql.c_str());
  }

  const TemporaryFolder folder;
  const Catalogue catalogue;
  ManualClock clock;
  StorageSettings storage;
  std::string data = folder.file("data0");
  std::optional<Life> life;

 private:
  int lives_ = 0;
};

}  // namespace vat::test
