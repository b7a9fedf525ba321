#include "server/storage/backup.h"

#include <filesystem>
#include <string_view>
#include <vector>

#include "server/storage/checkpoint_store.h"
#include "server/storage/data_folder.h"
#include "server/storage/saved/saved_state_database.h"
#include "server/storage/sqlite/main_database.h"
#include "server/storage/sqlite/schema.h"

namespace vat {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kBackupApplication = 0x76617462;  // "vatb"
constexpr const char* kBackupSteps[] = {
    "CREATE TABLE versions (file TEXT PRIMARY KEY, version INTEGER NOT NULL) STRICT"};
constexpr Schema kBackupSchema{kBackupApplication, kBackupSteps};

/// Database of a data folder. Table names of different databases differ.
struct Part {
  const char* file;
  Schema schema;
  std::vector<const char*> tables;
};

/// Returns the parts. A checkpoint must not be newer than its log, so that the checkpoints are read
/// first and written last.
std::vector<Part> parts() {
  return {{"checkpoints.db", checkpoint_schema(), {"checkpoints", "hashes"}},
          {"states.db", state_schema(), {"states"}},
          {"vat.db", main_schema(), {"sessions", "log", "tokens", "scenes", "sqlite_sequence"}}};
}

/// Returns the name of a table in the backup. SQLite reserves names with its prefix.
std::string copied(std::string_view table) {
  return table == "sqlite_sequence" ? "sequence" : std::string(table);
}

void attach(Database& database, const std::string& path, const std::string& name) {
  database.prepare("ATTACH ? AS " + name).bind(0, std::string_view(path)).run();
}

std::string schema_name(const Part& part) {
  return std::string(part.file).substr(0, std::string_view(part.file).find('.'));
}

/// Returns the tables of the part that the database has. An older version can lack some.
std::vector<const char*> existing_tables(Database& database, const std::string& schema,
                                         const Part& part) {
  std::vector<const char*> tables;
  for (const char* const table : part.tables) {
    Statement query = database.prepare("SELECT 1 FROM " + schema + ".sqlite_master WHERE name = ?");
    query.bind(0, std::string_view(table));
    if (query.step()) tables.push_back(table);
  }
  return tables;
}

void copy_parts(const std::string& folder, Database& backup) {
  const std::vector<Part> all = parts();
  for (const Part& part : all) attach(backup, folder + "/" + part.file, schema_name(part));
  // Not a Transaction, which would lock all attached databases for writing.
  backup.execute("BEGIN");
  // The first read of each database determines the moment of its copy.
  for (const Part& part : all) {
    const std::int64_t version = backup.number("PRAGMA " + schema_name(part) + ".user_version");
    if (version == 0) {
      throw StorageError(StorageError::Kind::failed,
                         folder + "/" + part.file + " is missing or empty");
    }
    backup.prepare("INSERT INTO main.versions VALUES (?, ?)")
        .bind(0, std::string_view(part.file))
        .bind(1, version)
        .run();
    backup.number("SELECT count(*) FROM " + schema_name(part) + ".sqlite_master");
  }
  for (const Part& part : all) {
    for (const char* const table : existing_tables(backup, schema_name(part), part)) {
      backup.execute(("CREATE TABLE main." + copied(table) + " AS SELECT * FROM " +
                      schema_name(part) + "." + table)
                         .c_str());
    }
  }
  backup.execute("COMMIT");
}

void restore_part(const Part& part, const std::string& file, const std::string& path) {
  Database database(path, Database::Mode::create);
  database.enable_compaction();
  attach(database, file, "backup");
  Statement query = database.prepare("SELECT version FROM backup.versions WHERE file = ?");
  query.bind(0, std::string_view(part.file));
  if (!query.step()) {
    throw StorageError(StorageError::Kind::corrupt, std::string(part.file) + " is missing in it");
  }
  const std::int64_t version = query.integer(0);
  query.reset();
  database.execute("BEGIN");  // see copy_parts()
  create_schema(database, part.schema, version);
  for (const char* const table : existing_tables(database, "main", part)) {
    const std::string name(table);
    // The table of a sequence is created with a row for each table.
    if (copied(name) != name) database.execute(("DELETE FROM main." + name).c_str());
    database.execute(
        ("INSERT INTO main." + name + " SELECT * FROM backup." + copied(name)).c_str());
  }
  database.execute("COMMIT");
}

void remove_files(const std::string& path) {
  std::error_code ignored;  // a file that is absent
  for (const char* const ending : {"", "-journal", "-wal", "-shm"}) {
    fs::remove(path + ending, ignored);
  }
}

}  // namespace

void write_backup(const std::string& folder, const std::string& file) {
  if (!fs::exists(folder + "/vat.db")) {
    throw StorageError(StorageError::Kind::failed, folder + " is not a data folder");
  }
  if (fs::exists(file)) throw StorageError(StorageError::Kind::failed, file + " exists already");
  const std::string part = file + ".part";
  remove_files(part);
  try {
    {
      Database backup = open_database(part, kBackupSchema, Durability::power, Journaling::rollback);
      copy_parts(folder, backup);
    }
    fs::rename(part, file);
    remove_files(part);  // its journal
  } catch (const fs::filesystem_error& error) {
    remove_files(part);
    throw StorageError(StorageError::Kind::failed, error.what());
  } catch (const StorageError&) {
    remove_files(part);
    throw;
  }
}

void restore_backup(const std::string& file, const std::string& folder) {
  if (!fs::exists(file)) {
    throw StorageError(StorageError::Kind::failed, file + " does not exist");
  }
  inspect_database(file, kBackupSchema);
  if (Database(file, Database::Mode::read).number("PRAGMA user_version") == 0) {
    throw StorageError(StorageError::Kind::corrupt, file + " is empty");
  }
  const DataFolder target(folder);
  if (fs::exists(target.file("vat.db"))) {
    throw StorageError(StorageError::Kind::failed, folder + " contains sessions already");
  }
  try {
    // The sessions last: without them, the folder counts as empty.
    for (const Part& part : parts()) {
      remove_files(target.file(part.file));
      restore_part(part, file, target.file(part.file));
    }
  } catch (const StorageError& error) {
    for (const Part& part : parts()) remove_files(target.file(part.file));
    throw StorageError(error.kind(), file + " cannot be restored: " + error.what());
  }
}

}  // namespace vat
