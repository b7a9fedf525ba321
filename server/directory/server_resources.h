#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <map>
#include <memory>
#include <string>

#include "server/cluster/cluster_node.h"
#include "server/directory/server_settings.h"
#include "server/http/downloads.h"
#include "server/messages/rpc_message.h"
#include "server/relay/relay_door.h"
#include "server/replay/imports.h"
#include "server/session/core/session_environment.h"
#include "server/session/ticks/slow_tick_gate.h"
#include "server/storage/storage.h"
#include "server/support/deferred_tasks.h"

namespace vat {

/// Saved states and scenes of a server without a data folder. The data is deleted when the server
/// ends.
struct SavedInMemory {
  SavedStateDatabase states{MainDatabase::kInMemory};
  SavedSceneDatabase scenes{std::make_shared<MainDatabase>(MainDatabase::kInMemory)};
};

/// Threads, storage and budgets that all sessions share. Each member depends only on previous
/// members. All members are thread-safe.
struct ServerResources {
  /// Throws StorageError if the data folder cannot be used, and NatsError if the servers of the
  /// cluster cannot be reached.
  ServerResources(const Catalogue& catalogue_in, ServerSettings settings_in, Clock& clock_in,
                  const SessionMethods& methods);
  ServerResources(const ServerResources&) = delete;
  ServerResources& operator=(const ServerResources&) = delete;

  const Catalogue& catalogue;
  const ServerSettings settings;
  Clock& clock;
  /// Runs blocks of simulation steps on helper threads.
  ThreadPoolRunner runner;
  ServerMetrics metrics;
  const MemoryLimit memory;
  AccessTokens tokens;
  ResourceBudget budget;
  SlowTickGate slow_tick_gate;
  boost::asio::thread_pool frame_threads;
  boost::asio::thread_pool read_threads{1};
  boost::asio::thread_pool storage_threads{2};
  Downloads downloads;
  Imports imports;
  const std::unique_ptr<Storage> storage;                // null: sessions are in memory only
  const std::unique_ptr<SavedInMemory> saved_in_memory;  // null: saved data is in the storage
  const std::unique_ptr<ClusterNode> cluster;            // null: this server is no node
  const std::unique_ptr<RelayDoor> relay;                // null: clients are redirected
  const SessionEnvironment environment;
  // Limits and budget for the recovery of sessions, which must accept all previously accepted
  // sessions.
  const ServerLimits recovery_limits;
  ResourceBudget recovery_budget;
  const SessionEnvironment recovery_environment;
  boost::asio::thread_pool pool;
  const std::shared_ptr<DeferredTasks> deferred;
  /// Strand of `storage_threads` that creates sessions one at a time, so that creations use at most
  /// one thread.
  boost::asio::strand<boost::asio::thread_pool::executor_type> creations;
  /// Strand of `storage_threads` for requests to the server that use the storage.
  boost::asio::strand<boost::asio::thread_pool::executor_type> storage_requests;
  /// Results of scene.levels by scene of the catalogue. Only for use on `storage_requests`.
  mutable std::map<std::string, RpcResult> levels;

  /// Return the store of the cluster, of the data folder or in memory.
  SavedStates* saved_states() const;
  SavedScenes* saved_scenes() const;
};

}  // namespace vat
