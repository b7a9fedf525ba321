#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/support/instruction_set.h"
#include "server/access/access.h"
#include "server/messages/limits.h"
#include "server/storage/sqlite/storage_limits.h"

namespace vat {

/// Number of a session, from which its id is made. Sessions from kFirstReplay on are replays, which
/// are not stored.
using SessionNumber = std::uint64_t;
inline constexpr SessionNumber kFirstReplay = SessionNumber{1} << 62;

/// Identifies a session for the life of the server. Not used twice.
using SessionId = std::string;
SessionId to_id(SessionNumber number);

struct ServerSettings {
  ServerLimits limits;
  std::string version;  ///< reported by server.info
  InstructionSet instructions = best_instruction_set();
  std::size_t threads = 0;  ///< of sessions; 0: as many as the machine has cores
  AccessSettings access;
  std::string data_folder;  ///< stores sessions; empty: sessions are in memory only
  StorageLimits storage;
  /// Ends the server after the given time for clients, or after its default time, and returns that
  /// time. May be called from any thread. Empty: clients cannot end the server.
  std::function<std::chrono::milliseconds(std::optional<std::chrono::milliseconds>)> end;
};

}  // namespace vat
