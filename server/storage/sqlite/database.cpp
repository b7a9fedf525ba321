#include "server/storage/sqlite/database.h"

#include <sqlite3.h>

#include <filesystem>
#include <limits>
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kBusyTimeout = 10'000;  // [ms] for move_log(), which locks briefly

StorageError::Kind kind_of_code(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return StorageError::Kind::full;
    case SQLITE_READONLY:
    case SQLITE_PERM:
    case SQLITE_CANTOPEN:
      return StorageError::Kind::read_only;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    // The statements are constant, so that only the content of a file can contradict them.
    case SQLITE_ERROR:
    case SQLITE_MISMATCH:
    case SQLITE_CONSTRAINT:
      return StorageError::Kind::corrupt;
    default:
      return StorageError::Kind::failed;
  }
}

[[noreturn]] void fail(const std::string& path, sqlite3* connection, int code) {
  const char* message = connection != nullptr ? sqlite3_errmsg(connection) : sqlite3_errstr(code);
  throw StorageError(kind_of_code(code), path + ": " + message);
}

}  // namespace

std::size_t database_memory() {
  return static_cast<std::size_t>(sqlite3_memory_used());
}

void Database::Close::operator()(sqlite3* connection) const {
  sqlite3_close_v2(connection);
}

Database::Database(const std::string& path, Mode mode) : path_(path) {
  const int flags =
      mode == Mode::create ? SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE : SQLITE_OPEN_READWRITE;
  sqlite3* connection = nullptr;
  const int opened =
      sqlite3_open_v2(path.c_str(), &connection, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  connection_.reset(connection);  // there is one even after a failure, to ask for its message
  if (opened != SQLITE_OK) fail(path_, connection, opened);
  sqlite3_extended_result_codes(connection, 1);
  sqlite3_busy_timeout(connection, kBusyTimeout);
  if (mode == Mode::read) {
    sqlite3_db_config(connection, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
    execute("PRAGMA query_only = 1");
  }
}

void Database::execute(const char* sql) {
  const int code = sqlite3_exec(connection_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) fail(path_, connection_.get(), code);
}

void Database::roll_back() noexcept {
  // Some failures, such as a full disk, have rolled back already.
  if (!is_in_transaction()) return;
  sqlite3_exec(connection_.get(), "ROLLBACK", nullptr, nullptr, nullptr);
}

Statement Database::prepare(std::string_view sql) {
  return {*this, sql};
}

std::int64_t Database::number(std::string_view sql) {
  Statement query = prepare(sql);
  if (!query.step()) throw StorageError(StorageError::Kind::corrupt, path_ + ": a row is missing");
  const std::int64_t value = query.integer(0);
  query.reset();
  return value;
}

std::int64_t Database::last_row() const {
  return sqlite3_last_insert_rowid(connection_.get());
}

bool Database::is_in_transaction() const {
  return sqlite3_get_autocommit(connection_.get()) == 0;
}

void Database::use_log(Durability durability) {
  execute("PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0; PRAGMA temp_store = MEMORY");
  execute(durability == Durability::power ? "PRAGMA synchronous = FULL"
                                          : "PRAGMA synchronous = NORMAL");
}

void Database::use_rollback() {
  execute("PRAGMA journal_mode = TRUNCATE; PRAGMA synchronous = FULL; PRAGMA temp_store = MEMORY");
}

void Database::enable_compaction() {
  constexpr std::int64_t kIncremental = 2;
  if (number("PRAGMA auto_vacuum") == kIncremental) return;
  execute("PRAGMA auto_vacuum = INCREMENTAL");
  if (number("PRAGMA page_count") == 0) return;
  try {
    execute("VACUUM");
  } catch (const StorageError&) {
    // The disk is too full for a copy. The database works as before, and compact() does nothing.
  }
}

bool Database::compact() {
  const std::int64_t before = number("PRAGMA freelist_count");
  if (before == 0) return false;
  execute("PRAGMA incremental_vacuum(200)");  // less than a megabyte, because others wait
  const std::int64_t left = number("PRAGMA freelist_count");
  return left > 0 && left < before;
}

std::size_t Database::move_log(bool wait) {
  const int mode = wait ? SQLITE_CHECKPOINT_RESTART : SQLITE_CHECKPOINT_PASSIVE;
  const int code = sqlite3_wal_checkpoint_v2(connection_.get(), nullptr, mode, nullptr, nullptr);
  // Busy: pages that readers need stay in the log until the next call.
  if (code != SQLITE_OK && (code & 0xff) != SQLITE_BUSY) fail(path_, connection_.get(), code);
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(path_ + "-wal", missing);
  return missing ? 0 : static_cast<std::size_t>(bytes);
}

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

Statement::Statement(Database& database, std::string_view sql) : database_(&database) {
  sqlite3_stmt* statement = nullptr;
  const int code =
      sqlite3_prepare_v3(database.connection_.get(), sql.data(), static_cast<int>(sql.size()),
                         SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  statement_.reset(statement);
  check(code);
}

void Statement::check(int code) {
  VAT_CHECK(database_ != nullptr);
  if (code == SQLITE_OK || code == SQLITE_ROW || code == SQLITE_DONE) return;
  sqlite3* connection = database_->connection_.get();
  const std::string message = database_->path_ + ": " + sqlite3_errmsg(connection);
  if (statement_) sqlite3_reset(statement_.get());
  throw StorageError(kind_of_code(code), message);
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  check(sqlite3_bind_int64(statement_.get(), parameter + 1, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::uint64_t value) {
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (value > kMost) throw StorageError(StorageError::Kind::failed, "a count beyond 2^63");
  return bind(parameter, static_cast<std::int64_t>(value));
}

Statement& Statement::bind(int parameter, double value) {
  check(sqlite3_bind_double(statement_.get(), parameter + 1, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  check(sqlite3_bind_text64(statement_.get(), parameter + 1, text.data(), text.size(),
                            SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::uint8_t> bytes) {
  check(sqlite3_bind_blob64(statement_.get(), parameter + 1, bytes.data(), bytes.size(),
                            SQLITE_STATIC));
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  check(code);
  reset();
  return false;
}

void Statement::run() {
  if (!step()) return;
  reset();
  throw StorageError(StorageError::Kind::failed, "a statement returned rows that are not read");
}

std::int64_t Statement::integer(int column) const {
  VAT_CHECK(column < sqlite3_column_count(statement_.get()));
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const {
  return sqlite3_column_double(statement_.get(), column);
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(statement_.get(), column) == SQLITE_NULL;
}

std::string_view Statement::text(int column) const {
  const auto bytes = this->bytes(column);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::span<const std::uint8_t> Statement::bytes(int column) const {
  const void* data = sqlite3_column_blob(statement_.get(), column);
  VAT_CHECK(column < sqlite3_column_count(statement_.get()));
  const int size = sqlite3_column_bytes(statement_.get(), column);
  return {static_cast<const std::uint8_t*>(data), static_cast<std::size_t>(size)};
}

void Statement::reset() {
  sqlite3_reset(statement_.get());  // returns the result of step() again
  sqlite3_clear_bindings(statement_.get());
}

Transaction::Transaction(Database& database)
    : database_(database), is_part_(database.is_in_transaction()) {
  database_.execute(is_part_ ? "SAVEPOINT part" : "BEGIN IMMEDIATE");
}

Transaction::~Transaction() {
  // The owner of the open transaction rolls back its parts.
  if (open_ && !is_part_) database_.roll_back();
}

void Transaction::commit() {
  VAT_CHECK(open_);
  database_.execute(is_part_ ? "RELEASE part" : "COMMIT");
  open_ = false;
}

}  // namespace vat
