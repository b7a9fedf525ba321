#pragma once

#include <cstdint>
#include <string>

namespace vat {

/// Logged change of a session. A log reproduces the session with the same bits if its entries are
/// executed in order of sequence, each at its position.
struct LogEntry {
  std::uint64_t sequence = 0;  ///< number of the entry in its session, from 1
  /// Number of ticks of the session, including ticks before resets and loads.
  std::uint64_t position = 0;
  std::uint64_t tick = 0;         ///< ticks since the scene was loaded or reset
  std::uint64_t participant = 0;  ///< sender; 0: the server
  std::string method;             ///< method of the protocol or of the server
  std::string params;             ///< JSON object
  bool refused = false;           ///< refused after logging, without effect
};

}  // namespace vat
