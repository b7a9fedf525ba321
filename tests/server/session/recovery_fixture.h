#pragma once

// Crashes of a server: the test copies the data folder of a running server, and starts a second
// server on the copy.

#include "server/storage/sqlite/database.h"
#include "tests/server/fixture/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {

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
  void crash(const ServerLimits& limits = {}) {
    end_by_crash();
    begin(limits);
  }
  void end_by_crash() {
    const std::string next = folder.file("data" + std::to_string(++lives_));
    life->server.flush();
    copy_data(data, next);
    life.reset();
    data = next;
  }
  void begin(const ServerLimits& limits = {}) {
    ServerSettings settings = test_settings(limits, data);
    settings.storage = storage;
    life.emplace(catalogue, settings, clock, false);
  }
  TestClient& client() { return *life->client; }
  void execute(const std::string& sql, const char* file = "/vat.db") {
    Database(data + file, Database::Mode::create).execute(sql.c_str());
  }

  const TemporaryFolder folder;
  const Catalogue catalogue;
  ManualClock clock;
  StorageSettings storage;
  std::string data = folder.file("data0");
  std::optional<Host> life;

 private:
  int lives_ = 0;
};

}  // namespace vat::test
