#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/history/recording.h"
#include "server/replay/moment_cache.h"
#include "server/session/core/session_core.h"

namespace vat {

/// Player of a recording in a SessionCore. Repeats each logged command at its position. Throws
/// Diverged if the state differs or a command is refused. Throws StorageError (kind `corrupt`) if
/// the recording is invalid.
class ReplayPlayer {
 public:
  /// The recording and the environment must outlive the player. The environment must not limit
  /// scenes, so that all recorded commands are accepted again.
  ReplayPlayer(const Recording& recording, const SessionEnvironment& environment);

  /// Returns the initial simulation for the constructor of a SessionCore. go_to_begin() then sets
  /// the core to the start of the recording.
  Simulation begin() const;
  void go_to_begin(SessionCore& core);
  /// Enables comparisons with the states of the recording's moments. Each comparison takes
  /// additional time.
  void compare_moments();
  /// Runs commands and ticks up to a position. Compares the state with the hashes of the recording.
  /// Throws Cancelled.
  void play_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);
  /// Sets the core to a position, starting from the nearest moment before the position. A seek
  /// takes at most the computing time between two moments.
  void seek(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);

  /// Settings of the cache of moments (MomentCache): least computing time between two moments, and
  /// greatest total size.
  struct CacheSettings {
    MomentCache::Seconds work{0.04};
    std::size_t most_bytes = std::size_t{128} << 20;
  };
  void set_cache(const CacheSettings& keeping) {
    kept_ = std::make_shared<MomentCache>(keeping.work, keeping.most_bytes);
  }
  /// Uses a cache of moments that other players share.
  void share(std::shared_ptr<MomentCache> moments) { kept_ = std::move(moments); }
  const MomentCache& kept() const { return *kept_; }

  /// Starts a seek. Restores a stored moment if the moment is nearer to `position` than the core.
  /// Does not run ticks.
  void begin_seek(SessionCore& core, std::uint64_t position);
  /// Disables comparisons of states until the next seek.
  void stop_comparing() { next_hash_ = hashes_.size(); }

  /// Callback after each comparison with equal hashes.
  std::function<void(const RecordedHash&)> on_same;

 private:
  Simulation load_scene(std::uint64_t sequence) const;
  const Snapshot& scene_as_loaded(std::uint64_t sequence);
  void go_to(SessionCore& core, const RecordedMoment& moment);
  Simulation load_state(const RecordedMoment& moment) const;
  /// Finds the next log entry and the next hash after the core's sequence.
  void find_place(const SessionCore& core);
  /// Executes all log entries at the core's position.
  void execute_here(SessionCore& core);
  void compare_here(const SessionCore& core);
  std::shared_ptr<const RecordedMoment> find_moment(std::uint64_t position) const;
  void keep(const SessionCore& core);

  const Recording& recording_;
  const SessionEnvironment& environment_;
  std::vector<RecordedHash> hashes_;  ///< hashes of the recording and its moments
  std::size_t next_entry_ = 0;
  std::size_t next_hash_ = 0;
  std::uint64_t same_until_ = 0;  ///< tick of the last comparison
  struct Loaded {
    std::uint64_t sequence;
    Snapshot scene;
  };
  std::optional<Loaded> loaded_;  ///< last requested scene
  std::shared_ptr<MomentCache> kept_;
  MomentCache::Seconds work_{0};  ///< work since the last moment
};

}  // namespace vat
