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
  LogEnds last_messages{};          ///< last messages of the log
  StateManifest manifest;
  std::uint64_t manifest_message = 0;
};

/// Ends the writes of the session's previous owner, and reads the session. `session` is the entry
/// after SessionLocator::take(). Waits. Throws NatsError, and StorageError (kind `corrupt`) if the
/// session is incomplete.
SessionImage take_image(ClusterStreams& streams, const LocatedSession& session);

/// Returns the last messages of a session's log. Waits. Throws NatsError.
LogEnds last_messages(ClusterStreams& streams, std::uint64_t session);

/// Returns the messages of a session's log after `after`, up to `last`, in the order of their
/// writes. A message that both streams have appears once. Waits. Throws NatsError, and StorageError
/// (kind `corrupt`) if a message is missing.
std::vector<StoredMessage> read_log(ClusterStreams& streams, std::uint64_t session,
                                    const LogEnds& after, const LogEnds& last);

/// Replaces the session in the data folder. Waits for the disk. Throws StorageError.
void store_image(Storage& storage, const SessionImage& image);

/// Removes the messages of a session that is permanently closed. Waits. Throws NatsError.
void remove_messages(ClusterStreams& streams, std::uint64_t session);

}  // namespace vat
