#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/scene/device_choice.h"
#include "core/support/instruction_set.h"
#include "server/access/access.h"
#include "server/cluster/cluster_settings.h"
#include "server/messages/limits.h"
#include "server/operations/memory_limit.h"
#include "server/storage/sqlite/storage_settings.h"

namespace vat {

/// Number of a session, which determines its id. Numbers from kFirstReplay are for replays, which
/// are not stored.
using SessionNumber = std::uint64_t;
inline constexpr SessionNumber kFirstReplay = SessionNumber{1} << 62;

/// Identifier of a session. An id is not used twice.
using SessionId = std::string;
SessionId to_id(SessionNumber number);
/// Returns the number in an id ("s12", or "r3" of a replay), or nothing.
std::optional<SessionNumber> number_of(const SessionId& id);

struct ServerSettings {
  ServerLimits limits;
  std::string version;  ///< version in the result of server.info
  InstructionSet instructions = best_instruction_set();
  std::optional<DeviceChoice> device{};  ///< see SessionEnvironment::device
  std::size_t threads = 0;               ///< threads for sessions; 0: number of cores
  AccessSettings access;
  std::string data_folder;  ///< folder for stored sessions; empty: sessions are in memory only
  StorageSettings storage;
  ClusterSettings cluster;  ///< requires a data folder
  /// Returns the memory of the process, for ServerLimits::max_memory.
  MemoryLimit::Measure measure_memory = process_memory;
  /// Ends the server after the given time for clients, or after the default time. Returns the time.
  /// Must be thread-safe. Empty: clients cannot end the server.
  std::function<std::chrono::milliseconds(std::optional<std::chrono::milliseconds>)> end;
};

}  // namespace vat
