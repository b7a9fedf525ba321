#include "server/history/recording.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/saved/archive.h"
#include "core/saved/sealed_bytes.h"
#include "protocol/recording/recording_index.h"
#include "server/storage/sqlite/compression.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {

template <>
inline constexpr InstructionSet kLastOf<InstructionSet> = InstructionSet::avx512;

namespace {

constexpr Seal kSeal{"vat.rec\n", 1, "a recording"};

Error bad_value(std::string path, std::string message) {
  return {"bad_value", std::move(path), std::move(message)};
}

Result<std::vector<LogEntry>> read_log(const std::vector<std::uint8_t>& compressed) {
  try {
    const std::vector<std::uint8_t> bytes = decompress(compressed, kMaxRecordedLogBytes);
    LoadingArchive archive(bytes);
    std::vector<LogEntry> log;
    archive(log);
    if (archive.failed() || archive.left() > 0) return bad_value("/log", "must be entries");
    return log;
  } catch (const StorageError& error) {
    return bad_value("/log", error.what());
  }
}

bool is_in_order(const std::vector<LogEntry>& log) {
  for (std::size_t i = 1; i < log.size(); ++i) {
    const bool follows =
        i == 1 ? log[i].sequence > log[0].sequence : log[i].sequence == log[i - 1].sequence + 1;
    if (!follows || log[i].position < log[i - 1].position) return false;
  }
  return !log.empty() && log[0].sequence > 0;
}

/// Whether they ascend by position and sequence, within the range of the log.
template <class Place>
bool is_in_order(const std::vector<Place>& places, const Recording& recording) {
  const auto key = [](const Place& place) { return std::tuple(place.position, place.sequence); };
  const std::uint64_t last = recording.last_sequence();
  return std::ranges::is_sorted(places, {}, key) &&
         std::ranges::all_of(places, [&](const Place& place) {
           return place.position >= recording.begin && place.position <= recording.end &&
                  place.sequence >= recording.log.front().sequence && place.sequence <= last;
         });
}

Status check(const Recording& recording) {
  if (!is_in_order(recording.log)) return bad_value("/log", "must be entries one after another");
  if (recording.begin > recording.end || recording.log.back().position > recording.end) {
    return bad_value("/end", "must not be before the log's");
  }
  if (!is_in_order(recording.moments, recording)) {
    return bad_value("/moments", "must be one after another");
  }
  if (!is_in_order(recording.hashes, recording)) {
    return bad_value("/hashes", "must be one after another");
  }
  if (recording.is_whole()) return {};
  // The log must contain all entries after the first moment, from which the session starts.
  const std::vector<RecordedMoment>& moments = recording.moments;
  const bool goes_on =
      !moments.empty() && moments[0].position == recording.begin &&
      (recording.log.size() < 2 || recording.log[1].sequence <= moments[0].sequence + 1);
  if (!goes_on) return bad_value("/moments", "must begin where the log does");
  return {};
}

}  // namespace

std::vector<std::uint8_t> write_recording(const Recording& recording) {
  std::vector<std::uint8_t> log;
  SavingArchive{log}(recording.log);
  std::vector<std::uint8_t> bytes = begin_sealed(kSeal);
  SavingArchive archive(bytes);
  archive(recording.program, recording.instructions, recording.name, recording.begin, recording.end,
          compress(log), recording.moments, recording.hashes);
  close_seal(bytes);
  return bytes;
}

Result<Recording> read_recording(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > kMaxRecordingBytes) {
    return Error{"too_large", "",
                 "a recording has at most " + std::to_string(kMaxRecordingBytes) + " bytes"};
  }
  if (is_frame_recording(bytes)) {
    return Error{
        "other_format", "",
        "this recording contains frames, not the commands of a session; a viewer shows it"};
  }
  const auto content = open_sealed(kSeal, bytes);
  if (!content) return content.errors();
  LoadingArchive archive(content.value());
  Recording recording;
  std::vector<std::uint8_t> log;
  archive(recording.program, recording.instructions, recording.name, recording.begin, recording.end,
          log, recording.moments, recording.hashes);
  if (archive.failed()) return bad_value("", "the recording's values end early");
  if (archive.left() > 0) return bad_value("", "there is more than one recording");
  Result<std::vector<LogEntry>> entries = read_log(log);
  if (!entries) return entries.errors();
  recording.log = std::move(entries).value();
  if (Status status = check(recording); !status) return status.errors();
  return recording;
}

}  // namespace vat
