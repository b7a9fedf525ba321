#include "server/storage/saved/saved_state_database.h"

#include <algorithm>
#include <bit>
#include <span>
#include <string_view>

namespace vat {
namespace {

constexpr std::uint32_t kStateApplication = 0x76617474;  // "vatt"

constexpr const char* kStateSteps[] = {R"(
CREATE TABLE states (
  number INTEGER PRIMARY KEY,
  session TEXT NOT NULL,
  name TEXT NOT NULL,
  saved_by TEXT NOT NULL,
  time REAL NOT NULL,
  tick INTEGER NOT NULL,
  simulation_time REAL NOT NULL,
  hash INTEGER NOT NULL,
  bytes INTEGER NOT NULL,
  fields TEXT NOT NULL,
  state BLOB NOT NULL,
  UNIQUE (session, name)
) STRICT;
CREATE INDEX bytes_of_states ON states (session, name, bytes);
)"};

constexpr const char* kWriteState =
    "INSERT OR REPLACE INTO states"
    " (session, name, saved_by, time, tick, simulation_time, hash, bytes, fields, state)"
    " VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr const char* kColumns = "name, saved_by, time, tick, simulation_time, hash, bytes";

SavedStateEntry to_state_entry(const Statement& row) {
  return {std::string(row.text(0)),
          std::string(row.text(1)),
          row.real(2),
          row.count(3),
          row.real(4),
          std::bit_cast<std::uint64_t>(row.integer(5)),
          static_cast<std::size_t>(row.count(6))};
}

}  // namespace

SavedStateDatabase::SavedStateDatabase(const std::string& path, Durability durability)
    : database_(open_database(path, state_schema(), durability)) {}

Schema state_schema() {
  return {kStateApplication, kStateSteps};
}

SavedStateUse SavedStateDatabase::use_without(const std::string& session, const std::string& name) {
  Statement query = database_.prepare(
      "SELECT coalesce(sum(session = ?1), 0), coalesce(sum(iif(session = ?1, bytes, 0)), 0),"
      " coalesce(sum(bytes), 0) FROM states WHERE session <> ?1 OR name <> ?2");
  query.bind(0, std::string_view(session)).bind(1, std::string_view(name));
  if (!query.step()) return {};
  return {static_cast<std::size_t>(query.count(0)), static_cast<std::size_t>(query.count(1)),
          static_cast<std::size_t>(query.count(2))};
}

std::optional<LimitExcess> SavedStateDatabase::write(const std::string& session,
                                                     const SavedState& state,
                                                     const SavedStateLimits& limits) {
  const std::lock_guard lock(mutex_);
  const SavedStateEntry& entry = state.entry;
  const SavedStateUse use = use_without(session, entry.name);
  if (auto excess = find_excess(use, state.size(), limits)) return excess;
  database_.prepare(kWriteState)
      .bind(0, std::string_view(session))
      .bind(1, std::string_view(entry.name))
      .bind(2, std::string_view(entry.saved_by))
      .bind(3, entry.time)
      .bind(4, entry.tick)
      .bind(5, entry.simulation_time)
      .bind(6, std::bit_cast<std::int64_t>(entry.hash))
      .bind(7, std::uint64_t{state.size()})
      .bind(8, std::string_view(state.fields))
      .bind(9, std::span<const std::uint8_t>(state.state))
      .run();
  return {};
}

std::vector<SavedStateEntry> SavedStateDatabase::list(const std::string& session) {
  const std::lock_guard lock(mutex_);
  std::vector<SavedStateEntry> entries;
  Statement query = database_.prepare(std::string("SELECT ") + kColumns +
                                      " FROM states WHERE session = ? ORDER BY name");
  query.bind(0, std::string_view(session));
  while (query.step()) entries.push_back(to_state_entry(query));
  return entries;
}

std::optional<SavedState> SavedStateDatabase::find(const std::string& session,
                                                   const std::string& name) {
  const std::lock_guard lock(mutex_);
  Statement query = database_.prepare(std::string("SELECT ") + kColumns +
                                      ", fields, state FROM states WHERE session = ? AND name = ?");
  query.bind(0, std::string_view(session)).bind(1, std::string_view(name));
  if (!query.step()) return {};
  const std::span<const std::uint8_t> state = query.bytes(8);
  return SavedState{
      to_state_entry(query), std::string(query.text(7)), {state.begin(), state.end()}};
}

bool SavedStateDatabase::remove(const std::string& session, const std::string& name) {
  const std::lock_guard lock(mutex_);
  database_.prepare("DELETE FROM states WHERE session = ? AND name = ?")
      .bind(0, std::string_view(session))
      .bind(1, std::string_view(name))
      .run();
  return database_.number("SELECT changes()") > 0;
}

void SavedStateDatabase::remove_session(const std::string& session) {
  const std::lock_guard lock(mutex_);
  database_.prepare("DELETE FROM states WHERE session = ?")
      .bind(0, std::string_view(session))
      .run();
  while (database_.compact()) {
  }
}

void SavedStateDatabase::keep_only(const std::vector<std::string>& sessions) {
  std::vector<std::string> gone;
  {
    const std::lock_guard lock(mutex_);
    Statement query = database_.prepare("SELECT DISTINCT session FROM states");
    while (query.step()) {
      const std::string session(query.text(0));
      if (std::ranges::find(sessions, session) == sessions.end()) gone.push_back(session);
    }
  }
  for (const std::string& session : gone) remove_session(session);
}

std::size_t SavedStateDatabase::move_log(bool wait) {
  const std::lock_guard lock(mutex_);
  return database_.move_log(wait);
}

}  // namespace vat
