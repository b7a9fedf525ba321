#include "server/replay/recorder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "protocol/json_reader.h"
#include "server/storage/compression.h"

namespace vat {
namespace {

StoredSession find_session(SessionStore& sessions, std::uint64_t number) {
  for (StoredSession& session : sessions.sessions()) {
    if (session.number == number) return std::move(session);
  }
  throw StorageError(StorageError::Kind::corrupt, "the session is not kept any more");
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

/// A moment's fields without what proves who took part.
std::string without_tokens(const std::string& fields) {
  const Result<Json> json = parse_json(fields, {fields.size(), 16, fields.size()});
  if (!json) throw StorageError(StorageError::Kind::corrupt, "a checkpoint's fields");
  Json copy = json.value();
  const auto participants = copy.find("participants");
  if (participants == copy.end() || !participants->contains("list")) return fields;
  for (Json& participant : participants->at("list")) participant["resume"] = "";
  return copy.dump();
}

/// Those that the log goes on from.
std::vector<RecordedMoment> read_moments(CheckpointStore& checkpoints, std::uint64_t number,
                                         const std::vector<LogEntry>& log) {
  const std::uint64_t first = log.size() < 2 ? 0 : log[1].sequence - 1;
  std::vector<RecordedMoment> moments;
  for (const CheckpointPlace& place : checkpoints.places(number)) {
    if (place.sequence < first || place.sequence > log.back().sequence) continue;
    const std::optional<Checkpoint> checkpoint = checkpoints.read(place);
    if (!checkpoint) continue;  // thinned meanwhile
    moments.push_back({checkpoint->position, checkpoint->sequence,
                       without_tokens(checkpoint->fields), compress(checkpoint->state)});
  }
  return moments;
}

/// Before much is read.
void check_size(Storage& storage, std::uint64_t number) {
  std::size_t bytes = storage.sessions().log_bytes(number);
  for (const CheckpointPlace& place : storage.checkpoints().places(number)) bytes += place.bytes;
  if (bytes <= kMaxRecordingBytes) return;
  throw StorageError(StorageError::Kind::full, "the session is too large for a recording");
}

}  // namespace

Recording record_session(Storage& storage, std::uint64_t number) {
  check_size(storage, number);
  const StoredSession session = find_session(storage.sessions(), number);
  const Result<InstructionSet> instructions = parse_instruction_set(session.instruction_set);
  if (!instructions) throw StorageError(StorageError::Kind::corrupt, "its instruction set");
  Recording recording;
  recording.program = VAT_VERSION;
  recording.instructions = instructions.value();
  recording.name = session.name;
  recording.log = read_log(storage.sessions(), number);
  recording.moments = read_moments(storage.checkpoints(), number, recording.log);
  const LogEntry& last = recording.log.back();
  recording.begin = recording.log.front().position;
  if (!recording.is_whole() && !recording.moments.empty()) {
    recording.begin = recording.moments.front().position;
  }
  recording.end = std::max(recording.begin, last.position);
  if (!recording.moments.empty()) {
    recording.end = std::max(recording.end, recording.moments.back().position);
  }
  if (const auto& beat = session.beat; beat && beat->sequence <= last.sequence) {
    recording.end = std::max(recording.end, beat->position);
    if (beat->position >= recording.begin) {
      recording.hashes.push_back({beat->position, beat->sequence, beat->hash});
    }
  }
  return recording;
}

}  // namespace vat
