#include "server/history/recorder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/support/check.h"
#include "protocol/json/json_reader.h"

namespace vat {
namespace {

StoredSession find_session(SessionStore& sessions, std::uint64_t number) {
  for (StoredSession& session : sessions.sessions()) {
    if (session.number == number) return std::move(session);
  }
  throw StorageError(StorageError::Kind::corrupt, "the session is no longer stored");
}

std::vector<LogEntry> read_log(SessionStore& sessions, std::uint64_t number) {
  std::vector<LogEntry> log;
  for (auto entries = sessions.read(number, 0); !entries.empty();
       entries = sessions.read(number, log.back().sequence)) {
    std::ranges::move(entries, std::back_inserter(log));
  }
  if (log.empty()) throw StorageError(StorageError::Kind::corrupt, "the session has no log");
  return log;
}

/// Returns a moment's fields without token hashes.
std::string without_tokens(const std::string& fields) {
  const Result<Json> json = parse_json(fields, {fields.size(), 16, fields.size()});
  if (!json) throw StorageError(StorageError::Kind::corrupt, "a checkpoint's fields");
  Json copy = json.value();
  const auto participants = copy.find("participants");
  if (participants == copy.end() || !participants->contains("list")) return fields;
  for (Json& participant : participants->at("list")) participant["resume"] = "";
  return copy.dump();
}

/// Moments from which the log continues.
std::vector<RecordedMoment> read_moments(CheckpointStore& checkpoints, std::uint64_t number,
                                         const std::vector<LogEntry>& log) {
  const std::vector<CheckpointPlace> places = checkpoints.places(number);
  // A trimmed log may have no entry after the newest checkpoint.
  const std::uint64_t newest = places.empty() ? 0 : places.back().sequence;
  const bool goes_on = log.size() > 1;
  const std::uint64_t last = goes_on ? log.back().sequence : std::max(newest, log[0].sequence);
  const std::uint64_t first = goes_on ? log[1].sequence - 1 : last;
  std::vector<RecordedMoment> moments;
  for (const CheckpointPlace& place : places) {
    if (place.sequence < first || place.sequence > last) continue;
    std::optional<Checkpoint> checkpoint = checkpoints.read_compressed(place);
    if (!checkpoint) continue;  // thinned meanwhile
    moments.push_back({checkpoint->position, checkpoint->sequence,
                       without_tokens(checkpoint->fields), std::move(checkpoint->state)});
  }
  return moments;
}

/// Hashes within the recording. A tick's hash is that before the commands at its position.
std::vector<RecordedHash> read_hashes(CheckpointStore& checkpoints, std::uint64_t number,
                                      const Recording& recording) {
  const std::uint64_t first =
      recording.is_whole() ? recording.log.front().sequence : recording.moments.front().sequence;
  std::vector<RecordedHash> hashes;
  auto next = recording.log.begin();
  for (const TickHash& one : checkpoints.hashes(number, recording.begin)) {
    if (one.position <= recording.begin || one.position > recording.end) continue;
    while (next != recording.log.end() && next->position < one.position) ++next;
    const std::uint64_t sequence = next == recording.log.begin() ? first : (next - 1)->sequence;
    hashes.push_back({one.position, std::max(first, sequence), one.hash});
  }
  return hashes;
}

std::size_t kept_bytes(Storage& storage, std::uint64_t number) {
  std::size_t bytes = storage.sessions().log_bytes(number);
  bytes += storage.checkpoints().hash_count(number) * sizeof(RecordedHash);
  for (const CheckpointPlace& place : storage.checkpoints().places(number)) bytes += place.bytes;
  return bytes;
}

}  // namespace

std::optional<Recording> record_session(Storage& storage, std::uint64_t number,
                                        std::size_t max_bytes) {
  if (kept_bytes(storage, number) > max_bytes) return {};  // before all is read
  const StoredSession session = find_session(storage.sessions(), number);
  const Result<InstructionSet> instructions = parse_instruction_set(session.instruction_set);
  if (!instructions) throw StorageError(StorageError::Kind::corrupt, "its instruction set");
  Recording recording;
  recording.program = VAT_VERSION;
  recording.instructions = instructions.value();
  recording.name = session.name;
  recording.log = read_log(storage.sessions(), number);
  recording.moments = read_moments(storage.checkpoints(), number, recording.log);
  VAT_CHECK(!recording.log.empty());
  const LogEntry& last = recording.log.back();
  recording.begin = recording.log.front().position;
  if (!recording.is_whole() && !recording.moments.empty()) {
    recording.begin = recording.moments.front().position;
  }
  recording.end = std::max(recording.begin, last.position);
  if (!recording.moments.empty()) {
    recording.end = std::max(recording.end, recording.moments.back().position);
  }
  const auto& progress = session.progress;
  VAT_CHECK(recording.begin <= recording.end);
  const bool is_seen = progress && progress->sequence <= recording.last_sequence();
  if (is_seen) recording.end = std::max(recording.end, progress->position);
  recording.hashes = read_hashes(storage.checkpoints(), number, recording);
  if (is_seen && progress->position >= recording.begin) {
    const RecordedHash seen{progress->position, progress->sequence, progress->hash};
    const auto behind = std::ranges::upper_bound(recording.hashes, key_of(seen), {}, key_of);
    recording.hashes.insert(behind, seen);
  }
  return recording;
}

}  // namespace vat
