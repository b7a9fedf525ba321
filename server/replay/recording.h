#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/saved/archive.h"
#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "server/storage/log_entry.h"

namespace vat {

/// A session at a moment of a recording; see Checkpoint.
struct RecordedMoment {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::string fields;
  std::vector<std::uint8_t> state;  ///< compressed
};

/// What a session's state was when it had run to a position and carried out a sequence of its log.
struct RecordedHash {
  std::uint64_t position = 0;
  std::uint64_t sequence = 0;
  std::uint64_t hash = 0;
};

/// Where that is, to compare.
inline std::pair<std::uint64_t, std::uint64_t> key_of(const RecordedHash& hash) {
  return {hash.position, hash.sequence};
}

/// A session's history: its scene and all that changed it, from which it can be run again, bit for
/// bit, by whoever has the instruction set; moments to begin at; and hashes to compare with.
struct Recording {
  std::string program;  ///< version of the program that wrote it
  InstructionSet instructions = InstructionSet::baseline;
  std::string name;  ///< of the session
  std::uint64_t begin = 0;
  std::uint64_t end = 0;                ///< positions that it covers
  std::vector<LogEntry> log;            ///< the first has the scene
  std::vector<RecordedMoment> moments;  ///< rising by position and sequence
  std::vector<RecordedHash> hashes;     ///< the same

  /// It begins with its scene; otherwise at its first moment, which may be behind all of the log.
  bool is_whole() const {
    if (begin != log[0].position) return false;
    if (log.size() > 1) return log[1].sequence == log[0].sequence + 1;
    return moments.empty() || moments[0].sequence == log[0].sequence;
  }
  /// The last that has been carried out at the end.
  std::uint64_t last_sequence() const {
    const std::uint64_t last = log.back().sequence;
    return log.size() > 1 || moments.empty() ? last : std::max(last, moments[0].sequence);
  }
};

/// Files are no larger, nor is a log in them.
inline constexpr std::size_t kMaxRecordingBytes = std::size_t{256} << 20;
inline constexpr std::size_t kMaxRecordedLogBytes = std::size_t{256} << 20;

/// The bytes of a `.vatrec` file.
std::vector<std::uint8_t> write_recording(const Recording& recording);
/// Codes: too_large, other_format, other_version, wrong_length, damaged, bad_value. What is read
/// has its parts in order, but texts may say anything, and states too.
Result<Recording> read_recording(std::span<const std::uint8_t> bytes);

}  // namespace vat
