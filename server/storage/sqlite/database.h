#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "server/storage/sqlite/durability.h"

struct sqlite3;
struct sqlite3_stmt;

namespace vat {

class Statement;

/// Returns the memory of all databases of the process, including databases in memory [bytes].
std::size_t database_memory();

/// Connection to an SQLite database. Not thread-safe. Functions throw StorageError.
class Database {
 public:
  enum class Mode {
    create,  ///< reads and writes; creates a missing file
    read     ///< reads only
  };

  Database(const std::string& path, Mode mode);

  const std::string& path() const { return path_; }

  /// Runs SQL statements without results.
  void execute(const char* sql);
  Statement prepare(std::string_view sql);
  /// Returns the number in the only row of a query.
  std::int64_t number(std::string_view sql);
  std::int64_t last_row() const;
  /// Rolls back the current transaction, if any.
  void roll_back() noexcept;

  bool is_in_transaction() const;

  /// Uses a write-ahead log. Only move_log() copies the log into the database file. With
  /// Durability::power, the end of each transaction synchronises the log with the disk.
  void use_log(Durability durability);
  /// Uses a rollback journal: a transaction writes its pages once, which suits large rows. Each
  /// transaction is synchronised with the disk at its end.
  void use_rollback();
  /// Enables compact(). Rewrites the file of an older version once.
  void enable_compaction();
  /// Returns some of the free space to the system. Returns whether the next call can return more.
  bool compact();
  /// Runs an SQLite checkpoint: copies log pages into the database file, except pages that a reader
  /// still needs. Synchronises both files, so that all earlier transactions survive a power
  /// failure. If `wait` is true, blocks writers and restarts the log from its beginning. Returns
  /// the size of the log [bytes].
  std::size_t move_log(bool wait);

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> connection_;
};

/// A prepared SQL statement. Indices of parameters and columns start at 0. Bound texts and bytes
/// must exist until the statement has run.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::uint64_t value);  ///< at most 2^63 - 1
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::uint8_t> bytes);

  /// Runs the statement to the next row. Returns false at the end. The parameters can then be bound
  /// again.
  bool step();
  /// Runs a statement without rows.
  void run();

  // Return the value of a column in the current row.
  std::int64_t integer(int column) const;
  std::uint64_t count(int column) const { return static_cast<std::uint64_t>(integer(column)); }
  double real(int column) const;
  bool is_null(int column) const;
  /// Returns a text that is valid until the next step.
  std::string_view text(int column) const;
  std::span<const std::uint8_t> bytes(int column) const;

  /// Ends a query before its last row.
  void reset();

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const;
  };
  void check(int code);
  Database* database_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

/// Transaction of a database, or a part of an open transaction. Without commit(), none of its
/// writes is stored. The writes of a part are stored with the open transaction.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  const bool is_part_;
  bool open_ = true;
};

}  // namespace vat
