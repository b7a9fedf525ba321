#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "server/storage/log_entry.h"

namespace vat {

/// State of a session at a position of a recording, see Checkpoint.
struct RecordedMoment {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::string fields;
  std::vector<std::uint8_t> state;  ///< compressed
};

/// Hash of a session's state at a position, after a log entry.
struct RecordedHash {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::uint64_t hash = 0;
};

/// Returns the sort key of a hash: position, then sequence.
inline std::pair<std::uint64_t, std::uint64_t> key_of(const RecordedHash& hash) {
  return {hash.position, hash.sequence};
}

/// History of a session. The scene and all logged commands reproduce the session with the same bits
/// if the instruction set is the same. Moments are starting points for a replay, and hashes allow
/// comparisons.
struct Recording {
  std::string program;  ///< version of the program that wrote the recording
  InstructionSet instructions = InstructionSet::baseline;
  std::string name;  ///< name of the session
  std::uint64_t begin = 0;
  std::uint64_t end = 0;                ///< last position
  std::vector<LogEntry> log;            ///< first entry: the scene
  std::vector<RecordedMoment> moments;  ///< ascending by position, then by sequence
  std::vector<RecordedHash> hashes;     ///< ascending by position, then by sequence

  /// Returns whether the recording begins with its scene. Otherwise, the recording begins with its
  /// first moment, which can be after the end of the log.
  bool is_whole() const {
    if (begin != log[0].position) return false;
    if (log.size() > 1) return log[1].sequence == log[0].sequence + 1;
    return moments.empty() || moments[0].sequence == log[0].sequence;
  }
  /// Returns the sequence of the last entry that is executed in the recording.
  std::uint64_t last_sequence() const {
    const std::uint64_t last = log.back().sequence;
    return log.size() > 1 || moments.empty() ? last : std::max(last, moments[0].sequence);
  }
};

/// Greatest sizes [bytes] of a file and of its log.
inline constexpr std::size_t kMaxRecordingBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMaxRecordedLogBytes = std::size_t{256} << 20;

/// Returns the content of a `.vatrec` file.
std::vector<std::uint8_t> write_recording(const Recording& recording);
/// Returns the recording in a `.vatrec` file. Error codes: too_large, other_format, other_version,
/// wrong_length, damaged, bad_value. The parts of the recording are in order, but texts and states
/// can have any content.
Result<Recording> read_recording(std::span<const std::uint8_t> bytes);

}  // namespace vat
