#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "server/storage/sqlite/storage_error.h"

struct sqlite3;
struct sqlite3_stmt;

namespace vat {

class Statement;

/// Connection to an SQLite database. Used by one thread at a time. All functions throw
/// StorageError.
class Database {
 public:
  enum class Mode {
    create,  ///< read and write; created if missing
    read     ///< read only
  };

  Database(const std::string& path, Mode mode);

  const std::string& path() const { return path_; }

  /// Runs statements without results.
  void execute(const char* sql);
  Statement prepare(std::string_view sql);
  /// Returns the number in the only row of a query.
  std::int64_t number(std::string_view sql);
  std::int64_t last_row() const;
  /// Rolls back the current transaction, if any.
  void roll_back() noexcept;

  /// Uses a write-ahead log, which survives the end of the process at any moment. Only move_log()
  /// copies it into the file.
  void use_log();
  /// Runs a checkpoint: copies the part of the log that no reader uses into the file. If `wait` is
  /// true, writers wait and the log restarts from its beginning. Returns the size of the log in
  /// bytes.
  std::size_t move_log(bool wait);

 private:
  friend class Statement;
  struct Close {
    void operator()(sqlite3* connection) const;
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> connection_;
};

/// A prepared statement. Parameters and columns count from 0. Bound texts and bytes must live until
/// the statement has run.
class Statement {
 public:
  Statement(Database& database, std::string_view sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, std::uint64_t value);  ///< at most 2^63 - 1
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::uint8_t> bytes);

  /// Runs to the next row. Returns false at the end; the statement can then be bound again.
  bool step();
  /// Runs a statement without rows.
  void run();

  // Column of the current row.
  std::int64_t integer(int column) const;
  std::uint64_t count(int column) const { return static_cast<std::uint64_t>(integer(column)); }
  double real(int column) const;
  bool is_null(int column) const;
  /// Valid until the next step.
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

/// Writes between construction and commit() are stored together or not at all.
class Transaction {
 public:
  explicit Transaction(Database& database);
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit();

 private:
  Database& database_;
  bool open_ = true;
};

}  // namespace vat
