#pragma once

#include <cstdint>
#include <string>

namespace vat {

/// Something that has changed a session: carried out again in the order of their sequence, each
/// once the session has run to its position, entries make the session anew, bit for bit.
struct LogEntry {
  std::uint64_t sequence = 0;  ///< counts a session's entries, from 1
  std::uint64_t position = 0;  ///< ticks that the session had ever run, resets and loads included
  std::uint64_t tick = 0;      ///< since the scene was loaded or reset
  std::uint64_t participant = 0;  ///< whose it is; 0: the server's own
  std::string method;             ///< of the protocol, or the server's own
  std::string params;             ///< JSON, an object
  bool refused = false;           ///< by the session once it was logged: it has changed nothing
};

}  // namespace vat
