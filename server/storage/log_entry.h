#pragma once

#include <cstdint>
#include <string>

namespace vat {

/// Logged change of a session. The entries, repeated in order of their sequence and each at its
/// position, reproduce the session with the same bits.
struct LogEntry {
  std::uint64_t sequence = 0;  ///< number of the entry in its session, from 1
  std::uint64_t position =
      0;  ///< ticks that the session has run, including those before resets and loads
  std::uint64_t tick = 0;         ///< since the scene was loaded or reset
  std::uint64_t participant = 0;  ///< sender; 0: the server
  std::string method;             ///< of the protocol, or of the server
  std::string params;             ///< JSON, an object
  bool refused = false;           ///< refused after it was logged; changed nothing
};

}  // namespace vat
