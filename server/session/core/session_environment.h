#pragma once

#include <boost/asio/thread_pool.hpp>
#include <optional>

#include "core/scene/device_choice.h"
#include "core/support/instruction_set.h"
#include "core/threads/thread_pool.h"
#include "protocol/scene/scene_json.h"
#include "server/access/access.h"
#include "server/messages/limits.h"
#include "server/operations/server_metrics.h"
#include "server/session/core/session_command.h"
#include "server/support/clock.h"
#include "server/support/resource_budget.h"

namespace vat {

class Downloads;
class MemoryLimit;
class SavedScenes;
class SavedStates;
class SessionReplicas;

/// Resources that all sessions share.
struct SessionEnvironment {
  const Catalogue& catalogue;
  const ServerLimits& limits;
  InstructionSet instructions;
  ThreadPoolRunner& runner;  ///< runs the blocks of the simulation steps of all sessions
  ServerMetrics& metrics;
  ResourceBudget& resources;
  boost::asio::thread_pool& frame_threads;  ///< threads that quantise, encode and send frames
  boost::asio::thread_pool& read_threads;   ///< threads that compute results of reads
  AccessTokens& tokens;
  Clock& clock;
  const SessionMethods& methods;
  Downloads* downloads = nullptr;  ///< null: downloads are disabled
  // Null if the server cannot save states and scenes.
  SavedStates* states = nullptr;
  SavedScenes* scenes = nullptr;
  const MemoryLimit* memory = nullptr;  ///< limit for new simulations; null: no limit
  /// Threads that may wait for the disk: reads and writes of saved data. Null: like `states`.
  boost::asio::thread_pool* storage_threads = nullptr;
  /// Replicas of stored sessions on other machines. Null: the data folder has the only copy.
  SessionReplicas* replicas = nullptr;
  /// Device of the steps of new scenes. Absent: the device that the scene names. The CPU also
  /// continues stored sessions of other devices.
  std::optional<DeviceChoice> device{};
};

}  // namespace vat
