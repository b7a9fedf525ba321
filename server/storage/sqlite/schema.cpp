#include "server/storage/sqlite/schema.h"

#include <filesystem>

#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

void check_health(Database& database) {
  Statement check = database.prepare("PRAGMA quick_check(1)");
  if (!check.step()) return;
  const std::string verdict(check.text(0));
  check.reset();
  if (verdict == "ok") return;
  throw StorageError(StorageError::Kind::corrupt, database.path() + " is damaged: " + verdict);
}

void run_steps(Database& database, const Schema& schema, std::size_t from, std::size_t to) {
  for (const char* const step : schema.steps.subspan(from, to - from)) database.execute(step);
  database.execute(("PRAGMA user_version = " + std::to_string(to)).c_str());
  database.execute(("PRAGMA application_id = " + std::to_string(schema.application)).c_str());
}

void migrate(Database& database, const Schema& schema) {
  const auto version = static_cast<std::size_t>(database.number("PRAGMA user_version"));
  if (version >= schema.steps.size()) return;
  Transaction transaction(database);
  run_steps(database, schema, version, schema.steps.size());
  transaction.commit();
}

}  // namespace

void inspect_database(const std::string& path, const Schema& schema) {
  Database database(path, Database::Mode::read);
  const std::int64_t version = database.number("PRAGMA user_version");
  const std::int64_t application = database.number("PRAGMA application_id");
  if (application != std::int64_t{schema.application}) {
    if (version == 0 && database.number("SELECT count(*) FROM sqlite_master") == 0) return;
    throw StorageError(StorageError::Kind::corrupt, path + " is a database of another program");
  }
  const auto present = static_cast<std::int64_t>(schema.steps.size());
  if (version > present) {
    throw StorageError(StorageError::Kind::newer,
                       path + " is of a later version of this program: its schema is " +
                           std::to_string(version) + ", and at most " + std::to_string(present) +
                           " can be read here");
  }
  check_health(database);
}

void create_schema(Database& database, const Schema& schema, std::int64_t version) {
  if (version < 1 || version > static_cast<std::int64_t>(schema.steps.size())) {
    throw StorageError(StorageError::Kind::newer, database.path() + ": the version " +
                                                      std::to_string(version) +
                                                      " of the copied data is unknown");
  }
  run_steps(database, schema, 0, static_cast<std::size_t>(version));
}

Database open_database(const std::string& path, const Schema& schema, Durability durability,
                       Journaling journaling) {
  std::error_code missing;
  if (std::filesystem::file_size(path, missing) > 0 && !missing) inspect_database(path, schema);
  Database database(path, Database::Mode::create);
  database.enable_compaction();
  if (journaling == Journaling::write_ahead) {
    database.use_log(durability);
  } else {
    database.use_rollback();
  }
  migrate(database, schema);
  return database;
}

}  // namespace vat
