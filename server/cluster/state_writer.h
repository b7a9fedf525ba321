#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/cluster/cluster_streams.h"
#include "server/cluster/log_records.h"

namespace vat {

/// Writer of a session's states to the stream of states: chunks, and then a manifest. A state
/// without a manifest does not count. The two newest states are kept. No function waits.
/// Thread-safe. Create it with std::make_shared.
class StateWriter : public std::enable_shared_from_this<StateWriter> {
 public:
  using Stored = std::function<void()>;
  /// `manifest` is the newest manifest, and `sequence` the number of its message (0: none).
  StateWriter(ClusterStreams& streams, std::uint64_t session, std::uint64_t epoch,
              StateManifest manifest, std::uint64_t sequence);

  /// Stores the state if no other state is being stored. With `always`, waits for the other state
  /// first, and replaces a waiting state. May wait for NATS.
  void write(PackedState state, bool always);
  /// Calls `done` after the states of all previous calls are stored or have failed.
  void flush(Stored done);

 private:
  struct Writing {
    PackedState state;
    std::vector<std::uint64_t> chunks;  // numbers of the stored messages
    std::size_t left = 0;               // chunks that are not stored yet
    bool has_failed = false;
  };
  /// Reads the newest manifest if this node does not know it. Waits. Returns false on failure.
  bool read_manifest_again();
  void begin(PackedState state);
  void chunk_stored(const std::shared_ptr<Writing>& writing, std::size_t index,
                    const Stream::Appended& result);
  void write_manifest_of(const std::shared_ptr<Writing>& writing);
  void manifest_stored(const StateManifest& manifest, const Stream::Appended& result);
  void purge(const StateManifest& manifest, std::uint64_t sequence);
  void end();

  ClusterStreams& streams_;
  const std::uint64_t session_;
  const std::uint64_t epoch_;
  std::atomic<bool> is_unsure_ = false;  // whether manifest_ may not be the newest one
  std::mutex mutex_;                     // guards the members below
  StateManifest manifest_;
  std::uint64_t manifest_sequence_;
  bool is_writing_ = false;
  std::optional<PackedState> waiting_;
  std::vector<Stored> flushes_;
};

}  // namespace vat
