#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/storage/checkpoint_store.h"
#include "server/storage/session_store.h"

/// Content of the messages in the log of a session. A message has one or more records, and is
/// stored as a whole or not at all.
namespace vat {

/// Log entries that follow the previous ones.
struct EntriesRecord {
  std::vector<LogEntry> entries;
};
/// The entry had no effect.
struct RefusedRecord {
  std::uint64_t sequence = 0;
};
/// A recovery must repeat at least the ticks up to this position.
struct ReachedRecord {
  std::uint64_t position = 0;
};
struct SettingsRecord {
  std::string name;
  std::string settings;
};
/// Another node became the owner. The previous owner can append nothing after this record.
struct OwnerRecord {
  std::string node;
  std::uint64_t epoch = 0;
};
using LogRecord = std::variant<EntriesRecord, RefusedRecord, ReachedRecord, SettingsRecord,
                               OwnerRecord, SessionProgress>;

/// Return the bytes of a message, compressed if they are many, and its content. read_records()
/// throws StorageError (kind `corrupt`) if the message is invalid.
std::string write_records(const std::vector<LogRecord>& records);
std::vector<LogRecord> read_records(const std::string& bytes);

/// Part of a long message of a log. A message of NATS has at most 1 MB.
struct LogPart {
  static constexpr std::size_t kBytes = 384 * 1024;

  std::string header;  ///< number of the part from 0, "/", and the number of parts
  std::string bytes;
};
/// Returns the parts of a message. A short message has one part.
std::deque<LogPart> split_message(const std::string& bytes);

/// Joins the parts of a log's messages, in the order of the log.
class LogParts {
 public:
  /// Returns the whole message after its last part. Ignores the parts of a message that was not
  /// completed. Throws StorageError (kind `corrupt`) if the header is invalid.
  std::optional<std::string> take(const std::string& header, const std::string& bytes);

 private:
  std::string joined_;
  std::size_t next_ = 0;  // number of the next part
};

/// The messages of a log are in two streams.
inline constexpr std::size_t kLogStreams = 2;
/// Number of a message of the log in each stream; 0: none.
using LogEnds = std::array<std::uint64_t, kLogStreams>;

/// A checkpoint with all that a recovery needs beside the later log.
struct PackedState {
  Checkpoint state;  ///< with the compressed state
  LogEntry loaded;   ///< entry that loaded the scene
  std::string name;
  std::string settings;
  LogEnds covered{};  ///< the last log messages before later entries
};
/// Return the bytes of the state, and the state. unpack_state() throws StorageError (kind
/// `corrupt`).
std::string pack_state(const PackedState& state);
PackedState unpack_state(const std::string& bytes);

/// Location of a state in the stream of states.
struct StateManifest {
  std::uint64_t epoch = 0;
  std::vector<std::uint64_t> chunks;    ///< message numbers; empty: no state is stored
  LogEnds covered{};                    ///< see PackedState
  std::vector<std::uint64_t> previous;  ///< chunks of the state before
  LogEnds previous_covered{};
};
std::string write_manifest(const StateManifest& manifest);
StateManifest read_manifest(const std::string& bytes);

}  // namespace vat
