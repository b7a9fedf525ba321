// Backups of a data folder that a server uses.

#include "server/storage/backup.h"

#include "server/storage/checkpoint_store.h"
#include "server/storage/saved/saved_state_database.h"
#include "server/storage/sqlite/main_database.h"
#include "tests/server/fixture/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::backup_test {
namespace {

namespace fs = std::filesystem;

class Backup : public testing::Test {
 protected:
  Backup() { start(data); }
  void start(const std::string& path) {
    host.reset();
    host.emplace(catalogue, path, unhurried_limits(), clock);
  }
  TestClient& client() { return *host->client; }

  const TemporaryFolder folder;
  const std::string data = folder.file("data");
  const std::string file = folder.file("backup");
  const std::string restored = folder.file("restored");
  const Catalogue catalogue = make_catalogue();
  ManualClock clock;
  std::optional<Host> host;
};

TEST_F(Backup, OfARunningServerHasAllThatWasAnswered) {
  host->step(30);
  client().result("session.save", {{"name", "a state"}});
  client().result("scene.save", {{"name", "a scene"}});
  const std::string other = client().create_session();
  client().result("session.close", {{"session", other}});
  client().result("world.set_gravity", {{"gravity", {0, 0, -3}}});
  host->step(5);
  const std::string hash = host->hash();
  write_backup(data, file);
  client().result("world.set_gravity", {{"gravity", {0, 0, 3}}});
  host->step(5);
  EXPECT_NE(host->hash(), hash);

  restore_backup(file, restored);
  start(restored);
  EXPECT_EQ(host->hash(), hash);
  EXPECT_EQ(client().result("session.saves").at("states").size(), 1U);
  EXPECT_TRUE(client().events("session.diverged").empty());
  EXPECT_EQ(client().result("session.load", {{"name", "a state"}}).at("tick"), 30);
  EXPECT_EQ(client().error("scene.save", {{"name", "a scene"}}).at("code"), 1006) << "its key";
  EXPECT_NE(client().create_session(), other) << "numbers are not used again";
}

TEST_F(Backup, OfAnOlderVersionIsOfThatVersion) {
  host.reset();
  fs::create_directory(folder.file("older"));
  const std::pair<const char*, Schema> databases[] = {{"checkpoints.db", checkpoint_schema()},
                                                      {"states.db", state_schema()},
                                                      {"vat.db", main_schema()}};
  for (const auto& [name, schema] : databases) {
    Database database(folder.file("older/") + name, Database::Mode::create);
    Transaction transaction(database);
    create_schema(database, schema, 1);
    transaction.commit();
  }
  Database(folder.file("older/vat.db"), Database::Mode::create)
      .execute("INSERT INTO log VALUES (7, 1, 2, 3, 4, 'a', 'b', 0)");
  write_backup(folder.file("older"), file);
  restore_backup(file, restored);
  for (const auto& [name, schema] : databases) {
    Database database(restored + "/" + name, Database::Mode::read);
    EXPECT_EQ(database.number("PRAGMA user_version"), 1) << name;
  }
  EXPECT_EQ(Database(restored + "/vat.db", Database::Mode::read).number("SELECT session FROM log"),
            7);

  fs::remove(folder.file("older/checkpoints.db"));
  EXPECT_THROW(write_backup(folder.file("older"), folder.file("b")), StorageError);
}

TEST_F(Backup, DoesNotReplaceFilesAndSessions) {
  write_backup(data, file);
  EXPECT_THROW(write_backup(data, file), StorageError);
  EXPECT_THROW(write_backup(folder.file("none"), folder.file("b")), StorageError);
  EXPECT_THROW(restore_backup(file, data), StorageError) << "a server uses the folder";
  host.reset();
  EXPECT_THROW(restore_backup(file, data), StorageError) << "the folder contains sessions";
  EXPECT_THROW(restore_backup(folder.file("none"), restored), StorageError);
  start(data);
  EXPECT_EQ(host->tick(), 0U);
}

TEST_F(Backup, ThatIsDamagedIsNotRestored) {
  write_backup(data, file);
  const auto size = fs::file_size(file);
  const auto restore_changed = [&](const std::function<void(const std::string&)>& change) {
    const std::string changed = folder.file("changed");
    fs::remove(changed);
    fs::copy_file(file, changed);
    change(changed);
    try {
      restore_backup(changed, restored);
      ADD_FAILURE() << "restored";
    } catch (const StorageError& error) {
      using enum StorageError::Kind;
      EXPECT_TRUE(error.kind() == corrupt || error.kind() == newer) << error.what();
      EXPECT_TRUE(std::string_view(error.what()).starts_with(changed)) << error.what();
    }
    EXPECT_FALSE(fs::exists(restored + "/vat.db"));
  };
  restore_changed([&](const std::string& path) { fs::resize_file(path, size / 2); });
  restore_changed([](const std::string& path) { fs::resize_file(path, 0); });
  restore_changed([](const std::string& path) { std::ofstream(path) << "no database"; });
  for (const char* const sql :
       {"PRAGMA application_id = 1", "PRAGMA user_version = 2", "DROP TABLE log",
        "DELETE FROM versions WHERE file = 'vat.db'", "UPDATE versions SET version = 99",
        "UPDATE versions SET version = 0", "INSERT INTO sessions SELECT * FROM sessions",
        "UPDATE log SET position = 'x'", "ALTER TABLE states ADD COLUMN more"}) {
    SCOPED_TRACE(sql);
    restore_changed(
        [sql](const std::string& path) { Database(path, Database::Mode::create).execute(sql); });
  }
  restore_backup(file, restored);
  start(restored);
  EXPECT_EQ(host->tick(), 0U);
}

}  // namespace
}  // namespace vat::test::backup_test
