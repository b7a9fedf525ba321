#include "server/storage/session_store.h"

#include <bit>
#include <limits>
#include "core/support/check.h"

namespace vat {
namespace {

constexpr const char* kInsertEntry =
    "INSERT INTO log (session, sequence, position, tick, participant, method, params)"
    " VALUES (?, ?, ?, ?, ?, ?, ?)";
constexpr const char* kWriteProgress =
    "UPDATE sessions SET position = ?, tick = ?, sequence = ?, hash = ?, epoch = ?, playing = ?,"
    " speed = ?, participants = ?, reached = max(reached, ?1) WHERE number = ?";
constexpr const char* kWriteReached =
    "UPDATE sessions SET reached = max(reached, ?) WHERE number = ?";
constexpr std::size_t kEntriesAtOnce = 500;  // read or removed while commands wait

std::optional<SessionProgress> to_progress(const Statement& row, int column) {
  if (row.is_null(column)) return {};
  SessionProgress progress;
  progress.position = row.count(column);
  progress.tick = row.count(column + 1);
  progress.sequence = row.count(column + 2);
  progress.hash = std::bit_cast<std::uint64_t>(row.integer(column + 3));
  progress.epoch = static_cast<std::uint32_t>(row.integer(column + 4));
  progress.playing = row.integer(column + 5) != 0;
  progress.speed = row.real(column + 6);
  progress.participants = row.text(column + 7);
  return progress;
}

LogEntry to_log_entry(const Statement& row) {
  return {row.count(0),
          row.count(1),
          row.count(2),
          row.count(3),
          std::string(row.text(4)),
          std::string(row.text(5)),
          row.integer(6) != 0};
}

constexpr const char* kSelectEntries =
    "SELECT sequence, position, tick, participant, method, params, refused FROM log";

}  // namespace

SessionStore::SessionStore(const std::string& path, Durability durability)
    : main_(std::make_shared<MainDatabase>(path, durability)),
      mutex_(main_->mutex),
      database_(main_->database),
      mover_(path, Database::Mode::create),
      insert_entry_(database_, kInsertEntry),
      write_progress_(database_, kWriteProgress),
      write_reached_(database_, kWriteReached) {
  mover_.use_log(durability);
}

std::uint64_t SessionStore::create(const StoredSession& session, const LogEntry& first) {
  VAT_CHECK(first.sequence == 1);
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  const std::uint64_t number = insert(session);
  insert(number, first);
  transaction.commit();
  return number;
}

std::uint64_t SessionStore::insert(const StoredSession& session) {
  Statement row = database_.prepare(
      "INSERT INTO sessions (number, name, instruction_set, settings, reached)"
      " VALUES (?, ?, ?, ?, ?)");
  if (session.number > 0) row.bind(0, session.number);  // otherwise NULL, which chooses one
  row.bind(1, session.name)
      .bind(2, session.instruction_set)
      .bind(3, session.settings)
      .bind(4, session.reached)
      .run();
  return static_cast<std::uint64_t>(database_.last_row());
}

void SessionStore::replace(const StoredSession& session, std::span<const LogEntry> entries) {
  VAT_CHECK(session.number > 0);
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  for (const char* const deletion :
       {"DELETE FROM log WHERE session = ?", "DELETE FROM sessions WHERE number = ?"}) {
    database_.prepare(deletion).bind(0, session.number).run();
  }
  insert(session);
  for (const LogEntry& entry : entries) {
    insert(session.number, entry);
    if (entry.refused) refuse(session.number, entry.sequence);
  }
  if (session.progress) write_progress(session.number, *session.progress);
  transaction.commit();
}

std::vector<StoredSession> SessionStore::sessions() {
  const std::lock_guard lock(mutex_);
  std::vector<StoredSession> sessions;
  Statement query = database_.prepare(
      "SELECT number, name, instruction_set, settings, reached,"
      " position, tick, sequence, hash, epoch, playing, speed, participants"
      " FROM sessions WHERE closed = 0 ORDER BY number");
  while (query.step()) {
    sessions.push_back({query.count(0), std::string(query.text(1)), std::string(query.text(2)),
                        std::string(query.text(3)), query.count(4), to_progress(query, 5)});
  }
  return sessions;
}

void SessionStore::configure(std::uint64_t session, const std::string& name,
                             const std::string& settings) {
  const std::lock_guard lock(mutex_);
  database_.prepare("UPDATE sessions SET name = ?, settings = ? WHERE number = ?")
      .bind(0, std::string_view(name))
      .bind(1, std::string_view(settings))
      .bind(2, session)
      .run();
}

void SessionStore::close(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  database_.prepare("UPDATE sessions SET closed = 1 WHERE number = ?").bind(0, session).run();
}

std::vector<std::uint64_t> SessionStore::remove_closed() {
  std::vector<std::uint64_t> closed;
  {
    const std::lock_guard lock(mutex_);
    Statement query = database_.prepare("SELECT number FROM sessions WHERE closed = 1");
    while (query.step()) closed.push_back(query.count(0));
  }
  for (const std::uint64_t session : closed) {
    trim(session, std::numeric_limits<std::int64_t>::max(), 0);
    const std::lock_guard lock(mutex_);
    database_.prepare("DELETE FROM sessions WHERE number = ?").bind(0, session).run();
  }
  while (!closed.empty() && compact_some()) {
  }
  return closed;
}

bool SessionStore::compact_some() {
  const std::lock_guard lock(mutex_);
  return database_.compact();
}

void SessionStore::insert(std::uint64_t session, const LogEntry& entry) {
  VAT_CHECK(entry.sequence > 0);
  insert_entry_.bind(0, session)
      .bind(1, entry.sequence)
      .bind(2, entry.position)
      .bind(3, entry.tick)
      .bind(4, entry.participant)
      .bind(5, std::string_view(entry.method))
      .bind(6, std::string_view(entry.params))
      .run();
}

void SessionStore::append(std::uint64_t session, std::span<const LogEntry> entries) {
  VAT_CHECK(!entries.empty());
  const std::lock_guard lock(mutex_);
  if (entries.size() == 1) {  // a transaction by itself
    insert(session, entries.front());
    return;
  }
  Transaction transaction(database_);
  for (const LogEntry& entry : entries) insert(session, entry);
  transaction.commit();
}

void SessionStore::refuse(std::uint64_t session, std::uint64_t sequence) {
  const std::lock_guard lock(mutex_);
  database_.prepare("UPDATE log SET refused = 1 WHERE session = ? AND sequence = ?")
      .bind(0, session)
      .bind(1, sequence)
      .run();
}

std::vector<LogEntry> SessionStore::read(std::uint64_t session, std::uint64_t after) {
  const std::lock_guard lock(mutex_);
  std::vector<LogEntry> entries;
  Statement query =
      database_.prepare(std::string(kSelectEntries) +
                        " WHERE session = ? AND sequence > ? ORDER BY sequence LIMIT ?");
  query.bind(0, session).bind(1, after).bind(2, std::uint64_t{kEntriesAtOnce});
  while (query.step()) {
    entries.push_back(to_log_entry(query));
    // Callers read until there are no entries, which must not continue without end.
    if (entries.back().sequence <= after) {
      throw StorageError(StorageError::Kind::corrupt,
                         database_.path() + ": the entries of a log are out of order");
    }
    after = entries.back().sequence;
  }
  return entries;
}

std::optional<LogEntry> SessionStore::find(std::uint64_t session, std::uint64_t sequence) {
  const std::lock_guard lock(mutex_);
  Statement query =
      database_.prepare(std::string(kSelectEntries) + " WHERE session = ? AND sequence = ?");
  query.bind(0, session).bind(1, sequence);
  if (!query.step()) return {};
  return to_log_entry(query);
}

std::uint64_t SessionStore::last_sequence(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  Statement query =
      database_.prepare("SELECT coalesce(max(sequence), 0) FROM log WHERE session = ?");
  query.bind(0, session);
  return query.step() ? query.count(0) : 0;
}

std::size_t SessionStore::log_bytes(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  Statement query = database_.prepare(
      "SELECT coalesce(sum(length(CAST(params AS BLOB))), 0) FROM log WHERE session = ?");
  query.bind(0, session);
  return query.step() ? static_cast<std::size_t>(query.count(0)) : 0;
}

void SessionStore::trim(std::uint64_t session, std::uint64_t last, std::uint64_t kept) {
  while (trim_some(session, last, kept)) {
  }
}

bool SessionStore::trim_some(std::uint64_t session, std::uint64_t last, std::uint64_t kept) {
  const std::lock_guard lock(mutex_);
  database_
      .prepare(
          "DELETE FROM log WHERE session = ?1 AND sequence IN (SELECT sequence FROM log"
          " WHERE session = ?1 AND sequence <= ?2 AND sequence <> ?3 LIMIT ?4)")
      .bind(0, session)
      .bind(1, last)
      .bind(2, kept)
      .bind(3, std::uint64_t{kEntriesAtOnce})
      .run();
  return database_.number("SELECT changes()") > 0;
}

void SessionStore::write_progress(std::uint64_t session, const SessionProgress& progress) {
  const std::lock_guard lock(mutex_);
  write_progress_.bind(0, progress.position)
      .bind(1, progress.tick)
      .bind(2, progress.sequence)
      .bind(3, std::bit_cast<std::int64_t>(progress.hash))
      .bind(4, std::int64_t{progress.epoch})
      .bind(5, std::int64_t{progress.playing})
      .bind(6, progress.speed)
      .bind(7, std::string_view(progress.participants))
      .bind(8, session)
      .run();
}

void SessionStore::reach(std::uint64_t session, std::uint64_t position) {
  const std::lock_guard lock(mutex_);
  write_reached_.bind(0, position).bind(1, session).run();
}

}  // namespace vat
