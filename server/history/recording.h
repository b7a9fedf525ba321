#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/saved/archive.h"
#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "server/storage/log_entry.h"

namespace vat {

/// State of a session at one moment of a recording; see Checkpoint.
struct RecordedMoment {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::string fields;
  std::vector<std::uint8_t> state;  ///< compressed
};

/// Hash of a session's state, at a position and after an entry of its log.
struct RecordedHash {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::uint64_t hash = 0;
};

/// Order of hashes: position, then sequence.
inline std::pair<std::uint64_t, std::uint64_t> key_of(const RecordedHash& hash) {
  return {hash.position, hash.sequence};
}

/// History of a session: its scene and all logged commands, which reproduce it with the same bits
/// and instruction set; moments to start from; hashes to compare with.
struct Recording {
  std::string program;  ///< version of the program that wrote it
  InstructionSet instructions = InstructionSet::baseline;
  std::string name;  ///< of the session
  std::uint64_t begin = 0;
  std::uint64_t end = 0;                ///< range of positions
  std::vector<LogEntry> log;            ///< the first entry has the scene
  std::vector<RecordedMoment> moments;  ///< ascending by position and sequence
  std::vector<RecordedHash> hashes;     ///< ascending by position and sequence

  /// Whether it begins with its scene. Otherwise it begins with its first moment, which may be
  /// after the end of the log.
  bool is_whole() const {
    if (begin != log[0].position) return false;
    if (log.size() > 1) return log[1].sequence == log[0].sequence + 1;
    return moments.empty() || moments[0].sequence == log[0].sequence;
  }
  /// Sequence of the last executed entry at the end.
  std::uint64_t last_sequence() const {
    const std::uint64_t last = log.back().sequence;
    return log.size() > 1 || moments.empty() ? last : std::max(last, moments[0].sequence);
  }
};

/// Greatest size of a file, and of the log in it.
inline constexpr std::size_t kMaxRecordingBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMaxRecordedLogBytes = std::size_t{256} << 20;

/// Returns the bytes of a `.vatrec` file.
std::vector<std::uint8_t> write_recording(const Recording& recording);
/// Error codes: too_large, other_format, other_version, wrong_length, damaged, bad_value. The parts
/// of the result are in order, but its texts and states can have any content.
Result<Recording> read_recording(std::span<const std::uint8_t> bytes);

}  // namespace vat
