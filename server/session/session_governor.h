#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/session/core/session_core.h"
#include "server/session/ticks/governor.h"

namespace vat {

/// Measures the ticks of a session, and changes its numerics if its owner permits it (see
/// SessionHistory::governor_points()). Each change is a logged command of the server. Not
/// thread-safe.
class SessionGovernor {
 public:
  /// Adds the time of a tick of a playing session, including its publication.
  void add_tick(SteadyClock::duration time);
  /// Returns the command that changes the numerics, if a change is due. Must be called at regular
  /// intervals. `period` is the time between ticks, and zero if no ticks run.
  std::optional<SessionCommand> next_command(const SessionCore& core, SteadyClock::time_point now,
                                             SteadyClock::duration period);
  /// Sends the event governor.switched after the execution of the command. If the command was
  /// refused, its point is not used for some time.
  void tell_switch(SessionCore& core);

 private:
  /// Point to which the last command changes.
  struct Switch {
    std::size_t point = 0;
    bool is_cheaper = false;
  };

  Governor governor_;
  std::vector<GovernorPoint> points_;               // points for which governor_ has measured
  SteadyClock::duration busy_{};                    // time of the ticks since the last sample
  std::uint64_t ticks_ = 0;                         // since the last sample
  std::optional<SteadyClock::time_point> sampled_;  // absent: no ticks ran since
  std::optional<Switch> switch_;
};

}  // namespace vat
