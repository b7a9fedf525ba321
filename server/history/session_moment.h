#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/snapshot.h"
#include "protocol/json/json_reader.h"
#include "server/people/participants.h"
#include "server/people/session_settings.h"
#include "server/storage/session_store.h"

namespace vat {

/// State of a session from which the session can continue. Thread-safe if not modified.
struct SessionMoment {
  std::uint64_t position = 0;   ///< see LogEntry
  std::uint64_t tick = 0;       ///< see LogEntry
  std::uint64_t sequence = 0;   ///< sequence of the last executed log entry
  std::uint64_t loaded = 0;     ///< sequence of the entry that loaded the scene
  std::uint64_t last_grab = 0;  ///< greatest id of a grab
  std::uint32_t epoch = 1;
  bool playing = true;
  double speed = 1;
  std::uint64_t people = 0;  ///< number of changes of the participants; not stored
  bool on_cpu = false;       ///< the CPU continues, because the device of the scene has failed
  Json participants;         ///< see write_participants()
  Snapshot snapshot;

  SessionProgress progress() const;
  /// Returns all members as JSON, except the snapshot.
  std::string fields() const;
};

/// Returns the moment with the result of fields(). Throws StorageError (kind `corrupt`) if `fields`
/// is invalid.
SessionMoment read_moment(const std::string& fields, Snapshot snapshot);

/// Returns the settings as JSON, without the name.
Json write_settings(const SessionSettings& settings);
/// Returns the settings. Throws StorageError (kind `corrupt`) if the settings are invalid.
SessionSettings read_settings(std::string name, const std::string& settings);

/// Returns the participants as JSON, with their grabs and the hashes of their tokens.
Json write_participants(const Participants& participants);
/// Adds the participants in the result of write_participants() as placeholders. Throws StorageError
/// (kind `corrupt`) if the JSON is invalid.
void read_participants(const Json& json, Participants& participants);

}  // namespace vat
