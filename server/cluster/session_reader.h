#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/cluster/cluster_streams.h"
#include "server/cluster/log_records.h"
#include "server/cluster/session_locator.h"
#include "server/storage/storage.h"

namespace vat {

/// The data with which a node continues a session.
struct SessionImage {
  StoredSession stored;
  std::vector<LogEntry> entries;    ///< the entry that loaded the scene, and those after the state
  std::optional<Checkpoint> state;  ///< with the compressed state
  std::uint64_t last_message = 0;   ///< number of the log's last message
  StateManifest manifest;
  std::uint64_t manifest_message = 0;
};

/// Ends the writes of the session's previous owner, and reads the session. `session` is the entry
/// after SessionLocator::take(). Waits. Throws NatsError, and StorageError (kind `corrupt`) if the
/// session is incomplete.
SessionImage take_image(ClusterStreams& streams, const LocatedSession& session);

/// Replaces the session in the data folder. Waits for the disk. Throws StorageError.
void store_image(Storage& storage, const SessionImage& image);

/// Removes the messages of a session that is permanently closed. Waits. Throws NatsError.
void remove_messages(ClusterStreams& streams, std::uint64_t session);

}  // namespace vat
