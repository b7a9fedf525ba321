#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/support/instruction_set.h"
#include "server/operations/slow_ticks.h"
#include "server/storage/storage_counts.h"
#include "server/support/stage_clock.h"

namespace vat {

/// Buffer of the last 512 values of a sequence, for quantiles.
class RecentValues {
 public:
  void add(double value) {
    values_[next_] = value;
    next_ = (next_ + 1) % values_.size();
    count_ = std::min(count_ + 1, values_.size());
  }
  /// Returns the quantile at `share` (0 to 1), or 0 without values.
  double quantile(double share) const {
    if (count_ == 0) return 0;
    std::vector<double> values(values_.begin(), values_.begin() + static_cast<long>(count_));
    const auto rank = static_cast<long>(share * static_cast<double>(count_ - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
  }

 private:
  std::array<double, 512> values_{};
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

/// Counters of the server since its start, for Prometheus. Thread-safe.
class ServerMetrics {
 public:
  struct Tick {
    std::chrono::duration<double> time{};
    std::uint64_t substeps = 0;  ///< includes repeated and undone substeps
    std::uint64_t undone_substeps = 0;
    std::span<const StageClock::Stage> stages;
  };
  void add_tick(const Tick& tick);
  SlowTicks& slow_ticks() { return slow_ticks_; }
  /// Adds the delay between the due time and the start of a tick.
  void add_lateness(std::chrono::duration<double> lateness);
  void add_encoded_frame(std::chrono::duration<double> time, bool is_key);
  /// Adds the number of encodings of one state.
  void add_frame_groups(std::size_t count);
  void add_sent_frames(std::size_t count, std::size_t bytes_each);
  /// Adds frames that were due but not sent, because the client's frame window was full or the
  /// limit of encodings was reached.
  void add_missed_frames(std::size_t count);
  /// Counts a refusal because of a limit. `limit` is the name in server.info's `limits`.
  void add_refusal(std::string_view limit);
  /// Counts a message that exceeded a rate limit.
  void add_rate_limited(std::string_view limit);
  /// Counts a closed WebSocket. All codes that are not listed in PROTOCOL.md have one common
  /// counter.
  void add_close(std::uint16_t code);

  /// Memory of the process [bytes].
  struct Memory {
    std::size_t process = 0;  ///< pages in memory and in the swap space
    std::size_t maximum = 0;  ///< setting max_memory; 0: no limit
    std::size_t heap = 0;     ///< heap in use, without freed memory
    std::vector<std::pair<std::string_view, std::size_t>> uses;  ///< parts of it, by use
  };
  /// Current values of the server.
  struct Gauges {
    std::string version;
    InstructionSet instructions = InstructionSet::baseline;
    std::size_t threads = 0;
    std::size_t playing_sessions = 0;
    std::size_t paused_sessions = 0;
    std::size_t hibernating_sessions = 0;  ///< playing, but stopped without participants
    /// Sessions without participants whose creator has disconnected; also counted by their state.
    std::size_t abandoned_sessions = 0;
    std::size_t connections = 0;
    std::size_t clients = 0;    ///< connections that have joined a session
    std::size_t particles = 0;  ///< in all sessions
    Memory memory;
    StorageCounts storage;
  };
  /// Returns all metrics in the text format of Prometheus, version 0.0.4.
  std::string to_text(const Gauges& gauges) const;

 private:
  struct TickBound {
    double seconds;
    const char* text;
  };
  static constexpr std::array kTickBounds = {
      TickBound{0.0005, "0.0005"}, TickBound{0.001, "0.001"}, TickBound{0.002, "0.002"},
      TickBound{0.005, "0.005"},   TickBound{0.01, "0.01"},   TickBound{0.02, "0.02"},
      TickBound{0.05, "0.05"},     TickBound{0.1, "0.1"},     TickBound{0.2, "0.2"},
      TickBound{0.5, "0.5"},       TickBound{1, "1"},         TickBound{2, "2"}};
  struct StageTotal {
    std::uint64_t calls = 0;
    double seconds = 0;
  };
  void append_ticks(std::string& text) const;
  void append_recent_ticks(std::string& text) const;
  void append_stages(std::string& text) const;
  void append_frames(std::string& text) const;
  void append_refusals(std::string& text) const;

  SlowTicks slow_ticks_;
  mutable std::mutex mutex_;
  std::array<std::uint64_t, kTickBounds.size() + 1> ticks_{};  // by bound; last: above all bounds
  double tick_seconds_ = 0;
  RecentValues recent_ticks_;
  RecentValues recent_lateness_;
  std::uint64_t substeps_ = 0;
  std::uint64_t undone_substeps_ = 0;
  std::uint64_t encoded_frames_ = 0;
  std::uint64_t encoded_keys_ = 0;
  double encode_seconds_ = 0;
  std::uint64_t shown_states_ = 0;
  std::uint64_t frame_groups_ = 0;
  std::uint64_t sent_frames_ = 0;
  std::uint64_t sent_bytes_ = 0;
  std::uint64_t missed_frames_ = 0;
  std::map<std::string, std::uint64_t, std::less<>> refusals_;      // by name of the limit
  std::map<std::string, std::uint64_t, std::less<>> rate_limited_;  // by name of the limit
  std::map<std::uint16_t, std::uint64_t> closes_;                   // by code; 0: all other codes
  std::map<std::string_view, StageTotal> stages_;                   // by name of the stage
};

}  // namespace vat
