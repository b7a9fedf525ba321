#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "tests/bench/soak/tally.h"

namespace vat::bench {

/// The server of the clients, and their tokens.
struct FaultPlace {
  std::uint16_t port = 0;
  std::string session;
  std::string admin;   ///< token
  std::string viewer;  ///< token of a viewer of this session
};

/// Behaviour of a client under faults.
enum class FaultManner {
  commanding,    ///< sends commands at a fixed rate, and notes the successful ones
  slow,          ///< reads five messages per second
  silent,        ///< joins and never reads
  malformed,     ///< sends invalid messages
  reconnecting,  ///< joins, and leaves without a message after a fraction of a second
  flooding,      ///< sends more than is permitted
  stranger,      ///< sends invalid tokens
};

/// Results of the clients of one life of the server. Thread-safe.
class LifeNotes {
 public:
  std::atomic<bool> ends = false;  ///< the life ends: broken connections are no faults
  std::atomic<std::uint64_t> strangers_refused = 0;
  std::atomic<std::uint64_t> strangers_admitted = 0;
  std::atomic<std::uint64_t> memory_refusals = 0;  ///< commands that max_memory rejected
  std::atomic<std::uint64_t> reconnects = 0;

  /// Adds a successful command of a session.
  void add_answered(const std::string& session, const std::string& command);
  /// Notes the tick of a session at this moment [s].
  void add_tick(const std::string& session, double time, double tick);

  /// Commands by session, as method and params.
  std::map<std::string, std::vector<std::string>> answered() const;
  /// Returns the ticks per second of each session from its first to its last note.
  std::map<std::string, double> tick_rates() const;

 private:
  struct Ticks {
    double first_time = 0, first = 0, last_time = 0, last = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<std::string>> answered_;
  std::map<std::string, Ticks> ticks_;
};

/// Returns the text of a command in LifeNotes.
std::string command_text(const std::string& method, const std::string& params);

/// Runs a client until the life ends. `name` must be unique, because the values of the client's
/// commands derive from it. Faults are recorded in the tally.
void run_fault_client(FaultManner manner, const FaultPlace& place, std::uint32_t name,
                      LifeNotes& notes, Tally& tally);

}  // namespace vat::bench
