#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/simulation.h"
#include "protocol/json/json_reader.h"
#include "server/people/participants.h"
#include "server/people/session_settings.h"
#include "server/storage/session_store.h"

namespace vat {

/// State of a session at one moment, sufficient to continue from it. May be read by any thread.
struct SessionMoment {
  std::uint64_t position = 0;   ///< as in a LogEntry
  std::uint64_t tick = 0;       ///< as in a LogEntry
  std::uint64_t sequence = 0;   ///< of the last executed entry of the log
  std::uint64_t loaded = 0;     ///< of the entry that loaded the scene
  std::uint64_t last_grab = 0;  ///< greatest id of a grab
  std::uint32_t epoch = 1;
  bool playing = true;
  double speed = 1;
  std::uint64_t people = 0;  ///< changes of the participants so far; not stored
  Json participants;         ///< see write_participants()
  Snapshot snapshot;

  SessionProgress progress() const;
  /// Returns all members as JSON, except the snapshot.
  std::string fields() const;
};

/// Reads the result of fields(). Throws StorageError, of kind corrupt, if it is invalid.
SessionMoment read_moment(const std::string& fields, Snapshot snapshot);

/// Returns the settings, except the name.
Json write_settings(const SessionSettings& settings);
/// Throws StorageError, of kind corrupt, if the settings are invalid.
SessionSettings read_settings(std::string name, const std::string& settings);

/// Returns the participants with the hashes of their tokens and their grabs.
Json write_participants(const Participants& participants);
/// Adds the participants of write_participants() as placeholders. Throws StorageError, of kind
/// corrupt, if they are invalid.
void read_participants(const Json& json, Participants& participants);

}  // namespace vat
