#pragma once

#include <cstdint>
#include <string>

#include "core/simulation/simulation.h"
#include "protocol/json/json_reader.h"
#include "server/session/participants.h"
#include "server/session/session_settings.h"
#include "server/storage/session_store.h"

namespace vat {

/// A session as it is at one moment, to come back to it. May be read by any thread.
struct SessionMoment {
  std::uint64_t position = 0;   ///< as in a LogEntry
  std::uint64_t tick = 0;       ///< the same
  std::uint64_t sequence = 0;   ///< of the last entry of the log that was carried out
  std::uint64_t loaded = 0;     ///< of the entry that has its scene
  std::uint64_t last_grab = 0;  ///< the greatest id of a grab
  std::uint32_t epoch = 1;
  bool playing = true;
  double speed = 1;
  std::uint64_t people = 0;  ///< changes of the participants so far; is not written
  Json participants;         ///< see write_participants()
  Snapshot snapshot;

  SessionProgress beat() const;
  /// All but the snapshot.
  std::string fields() const;
};

/// What fields() has told; throws StorageError, of kind corrupt, for anything else.
SessionMoment read_moment(const std::string& fields, Snapshot snapshot);

/// What its owner has decided of a session, but for its name.
Json write_settings(const SessionSettings& settings);
/// Throws StorageError, of kind corrupt, for anything else.
SessionSettings read_settings(std::string name, const std::string& settings);

/// Who takes part, with the hashes of their tokens, and what they hold.
Json write_participants(const Participants& participants);
/// Takes over all that write_participants() told, each as somebody without a connection. Throws
/// StorageError, of kind corrupt, for anything else.
void read_participants(const Json& json, Participants& participants);

}  // namespace vat
