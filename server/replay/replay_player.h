#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "server/replay/kept_moments.h"
#include "server/replay/recording.h"
#include "server/session/session_core.h"
#include "server/session/session_recovery.h"

namespace vat {

/// Plays a recording in the core of a session: what changed it is carried out again, each entry at
/// its position, by participants who are not here. Everything that fails throws Diverged, or
/// StorageError, of kind corrupt, where the recording is not what a server writes.
class ReplayPlayer {
 public:
  /// The recording must outlive this; so must the environment, which must not have limits on
  /// scenes: what was accepted once is accepted again.
  ReplayPlayer(const Recording& recording, const SessionEnvironment& environment);

  /// What a core is to be made with, which go_to_begin() then takes where the recording begins.
  Simulation begin() const;
  void go_to_begin(SessionCore& core);
  /// From now on the moments of the recording are compared with too, at some cost each.
  void compare_moments();
  /// Carries out what was done up to a position, and runs the ticks there. Where the recording
  /// tells what the state was it is compared. Throws Cancelled.
  void play_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);
  /// Takes the core to a position, from the moment that is nearest before it. The greatest part of
  /// its time is the work between two moments.
  void seek(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled);

  /// Where more work than this lies between moments of the recording, and it is played, further
  /// ones are kept in memory, of so many bytes at most: beyond them every other one goes, and so
  /// much more work lies between those that come.
  struct Keeping {
    KeptMoments::Seconds work{0.04};
    std::size_t most_bytes = std::size_t{128} << 20;
  };
  void set_keeping(const Keeping& keeping) {
    kept_ = std::make_shared<KeptMoments>(keeping.work, keeping.most_bytes);
  }
  /// The same, in a place that others use too.
  void share(std::shared_ptr<KeptMoments> moments) { kept_ = std::move(moments); }
  const KeptMoments& kept() const { return *kept_; }

  /// The same as seek(), in parts: jumps to a moment if that is nearer, and plays nothing.
  void begin_seek(SessionCore& core, std::uint64_t position);
  /// States are not compared up to the next seek.
  void stop_comparing() { next_hash_ = hashes_.size(); }

  /// Told of each comparison that did not fail.
  std::function<void(const RecordedHash&)> on_same;

 private:
  Simulation load_scene(std::uint64_t sequence) const;
  const Snapshot& scene_as_loaded(std::uint64_t sequence);
  void go_to(SessionCore& core, const RecordedMoment& moment);
  Simulation load_state(const RecordedMoment& moment) const;
  /// What comes after the sequence that the core has carried out.
  void find_place(const SessionCore& core);
  /// All that belongs to the core's position.
  void carry_out_here(SessionCore& core);
  void compare_here(const SessionCore& core);
  std::shared_ptr<const RecordedMoment> find_moment(std::uint64_t position) const;
  void keep(const SessionCore& core);

  const Recording& recording_;
  const SessionEnvironment& environment_;
  std::vector<RecordedHash> hashes_;  ///< of the recording, and of its moments
  std::size_t next_entry_ = 0;
  std::size_t next_hash_ = 0;
  std::uint64_t same_until_ = 0;  ///< tick of the last comparison
  struct Loaded {
    std::uint64_t sequence;
    Snapshot scene;
  };
  std::optional<Loaded> loaded_;  ///< the scene that was wanted last
  std::shared_ptr<KeptMoments> kept_;
  KeptMoments::Seconds work_{0};  ///< since the last moment
};

}  // namespace vat
