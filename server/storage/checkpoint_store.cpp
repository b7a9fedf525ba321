#include "server/storage/checkpoint_store.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>

#include "core/support/byte_io.h"
#include "core/support/check.h"
#include "server/storage/sqlite/compression.h"

namespace vat {
namespace {

constexpr std::uint32_t kCheckpointApplication = 0x76617463;  // "vatc"

constexpr const char* kCheckpointSteps[] = {R"(
CREATE TABLE checkpoints (
  number INTEGER PRIMARY KEY,
  session INTEGER NOT NULL,
  position INTEGER NOT NULL,
  sequence INTEGER NOT NULL,
  fields TEXT NOT NULL,
  state BLOB NOT NULL
) STRICT;
CREATE INDEX checkpoints_of_session ON checkpoints (session, position, sequence);
)",
                                            R"(
CREATE TABLE hashes (
  session INTEGER NOT NULL,
  last INTEGER NOT NULL,
  count INTEGER NOT NULL,
  list BLOB NOT NULL,
  PRIMARY KEY (session, last)
) STRICT;
)"};

/// Returns the index of the checkpoint whose removal leaves the smallest gap, the oldest of
/// several. Never the newest, and the oldest only of two.
std::size_t find_redundant(const std::vector<CheckpointPlace>& places) {
  VAT_CHECK(places.size() > 1);
  std::size_t redundant = 0;
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 1; i + 1 < places.size(); ++i) {
    const std::uint64_t gap = places[i + 1].position - places[i - 1].position;
    if (gap >= least) continue;
    least = gap;
    redundant = i;
  }
  return redundant;
}

}  // namespace

CheckpointStore::CheckpointStore(const std::string& path, std::size_t session_bytes,
                                 std::size_t bytes_in_all)
    : session_bytes_(session_bytes),
      bytes_in_all_(bytes_in_all),
      database_(open_database(path, checkpoint_schema(), Durability::power, Journaling::rollback)) {
}

Schema checkpoint_schema() {
  return {kCheckpointApplication, kCheckpointSteps};
}

std::size_t CheckpointStore::write(const Checkpoint& checkpoint) {
  const std::vector<std::uint8_t> state = compress(checkpoint.state);
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  database_
      .prepare(
          "INSERT INTO checkpoints (session, position, sequence, fields, state)"
          " VALUES (?, ?, ?, ?, ?)")
      .bind(0, checkpoint.session)
      .bind(1, checkpoint.position)
      .bind(2, checkpoint.sequence)
      .bind(3, std::string_view(checkpoint.fields))
      .bind(4, std::span<const std::uint8_t>(state))
      .run();
  thin(checkpoint.session);
  thin_all();
  transaction.commit();
  return state.size();
}

std::vector<CheckpointPlace> CheckpointStore::places(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  return places_locked(session);
}

std::vector<CheckpointPlace> CheckpointStore::places_locked(std::uint64_t session) {
  VAT_CHECK(mutex_.is_held());
  std::vector<CheckpointPlace> places;
  Statement query = database_.prepare(
      "SELECT number, position, sequence, length(state) FROM checkpoints WHERE session = ?"
      " ORDER BY position, sequence, number");
  query.bind(0, session);
  while (query.step()) {
    places.push_back(
        {query.count(0), query.count(1), query.count(2), static_cast<std::size_t>(query.count(3))});
  }
  return places;
}

void CheckpointStore::thin(std::uint64_t session) {
  VAT_CHECK(mutex_.is_held());
  std::vector<CheckpointPlace> places = places_locked(session);
  const auto add = [](std::size_t sum, const CheckpointPlace& place) { return sum + place.bytes; };
  std::size_t bytes = std::accumulate(places.begin(), places.end(), std::size_t{0}, add);
  while (bytes > session_bytes_ && places.size() > 1) {
    const std::size_t redundant = find_redundant(places);
    VAT_CHECK(redundant + 1 < places.size() && bytes >= places[redundant].bytes);
    remove_row(places[redundant].row);
    bytes -= places[redundant].bytes;
    places.erase(places.begin() + static_cast<std::ptrdiff_t>(redundant));
  }
}

void CheckpointStore::thin_all() {
  VAT_CHECK(mutex_.is_held());
  for (;;) {
    const std::int64_t bytes =
        database_.number("SELECT coalesce(sum(length(state)), 0) FROM checkpoints");
    if (static_cast<std::size_t>(bytes) <= bytes_in_all_) return;
    Statement query = database_.prepare(
        "SELECT session FROM checkpoints GROUP BY session HAVING count(*) > 1"
        " ORDER BY sum(length(state)) DESC LIMIT 1");
    if (!query.step()) return;
    const std::uint64_t largest = query.count(0);
    query.reset();
    remove_redundant(largest);
  }
}

void CheckpointStore::remove_redundant(std::uint64_t session) {
  const std::vector<CheckpointPlace> places = places_locked(session);
  remove_row(places[find_redundant(places)].row);
}

void CheckpointStore::remove_row(std::uint64_t row) {
  database_.prepare("DELETE FROM checkpoints WHERE number = ?").bind(0, row).run();
}

std::optional<Checkpoint> CheckpointStore::read(const CheckpointPlace& place) {
  std::optional<Checkpoint> checkpoint = read_compressed(place);
  if (checkpoint) checkpoint->state = decompress(checkpoint->state, kMaxStateBytes);
  return checkpoint;
}

std::optional<Checkpoint> CheckpointStore::read_compressed(const CheckpointPlace& place) {
  const std::lock_guard lock(mutex_);
  Statement query = database_.prepare(
      "SELECT session, position, sequence, fields, state FROM checkpoints WHERE number = ?");
  query.bind(0, place.row);
  if (!query.step()) return {};
  const std::span<const std::uint8_t> state = query.bytes(4);
  return Checkpoint{query.count(0),
                    query.count(1),
                    query.count(2),
                    std::string(query.text(3)),
                    {state.begin(), state.end()}};
}

void CheckpointStore::write_hashes(std::uint64_t session, std::span<const TickHash> hashes) {
  if (hashes.empty()) return;
  const std::lock_guard lock(mutex_);
  Transaction transaction(database_);
  insert_hashes(session, hashes);
  const std::uint64_t last = hashes.back().position;
  if (last > kMaxHashes) {
    database_.prepare("DELETE FROM hashes WHERE session = ? AND last < ?")
        .bind(0, session)
        .bind(1, last - kMaxHashes)
        .run();
  }
  transaction.commit();
}

void CheckpointStore::insert_hashes(std::uint64_t session, std::span<const TickHash> hashes) {
  VAT_CHECK(mutex_.is_held() && !hashes.empty());
  std::vector<std::uint8_t> bytes;
  ByteWriter writer(bytes);
  for (const TickHash& one : hashes) {
    writer.put(one.position);
    writer.put(one.hash);
  }
  database_
      .prepare("INSERT OR REPLACE INTO hashes (session, last, count, list) VALUES (?, ?, ?, ?)")
      .bind(0, session)
      .bind(1, hashes.back().position)
      .bind(2, std::uint64_t{hashes.size()})
      .bind(3, std::span<const std::uint8_t>(bytes))
      .run();
}

std::vector<TickHash> CheckpointStore::hashes(std::uint64_t session, std::uint64_t from) {
  const std::lock_guard lock(mutex_);
  return hashes_locked(session, from);
}

std::vector<TickHash> CheckpointStore::hashes_locked(std::uint64_t session, std::uint64_t from) {
  VAT_CHECK(mutex_.is_held());
  std::vector<TickHash> hashes;
  Statement query =
      database_.prepare("SELECT list FROM hashes WHERE session = ? AND last >= ? ORDER BY last");
  query.bind(0, session).bind(1, from);
  while (query.step()) {
    ByteReader reader(query.bytes(0));
    while (reader.left() >= 2 * sizeof(std::uint64_t)) {
      const auto position = reader.get<std::uint64_t>();
      hashes.push_back({position, reader.get<std::uint64_t>()});
    }
  }
  return hashes;
}

std::size_t CheckpointStore::hash_count(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  Statement query =
      database_.prepare("SELECT coalesce(sum(count), 0) FROM hashes WHERE session = ?");
  query.bind(0, session);
  return query.step() ? static_cast<std::size_t>(query.count(0)) : 0;
}

void CheckpointStore::drop_hashes(std::uint64_t session, std::uint64_t behind) {
  const std::lock_guard lock(mutex_);
  std::vector<TickHash> some = hashes_locked(session, behind + 1);  // of rows that end behind it
  if (some.empty()) return;
  std::erase_if(some, [&](const TickHash& one) { return one.position > behind; });
  Transaction transaction(database_);
  database_.prepare("DELETE FROM hashes WHERE session = ? AND last > ?")
      .bind(0, session)
      .bind(1, behind)
      .run();
  if (!some.empty()) insert_hashes(session, some);
  transaction.commit();
}

void CheckpointStore::remove(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  remove_locked(session);
}

void CheckpointStore::remove_locked(std::uint64_t session) {
  VAT_CHECK(mutex_.is_held());
  database_.prepare("DELETE FROM checkpoints WHERE session = ?").bind(0, session).run();
  database_.prepare("DELETE FROM hashes WHERE session = ?").bind(0, session).run();
}

void CheckpointStore::keep_only(const std::vector<std::uint64_t>& sessions) {
  const std::lock_guard lock(mutex_);
  std::vector<std::uint64_t> gone;
  Statement query =
      database_.prepare("SELECT session FROM checkpoints UNION SELECT session FROM hashes");
  while (query.step()) {
    const std::uint64_t session = query.count(0);
    if (std::ranges::find(sessions, session) == sessions.end()) gone.push_back(session);
  }
  for (const std::uint64_t session : gone) remove_locked(session);
  while (!gone.empty() && database_.compact()) {
  }
}

}  // namespace vat
