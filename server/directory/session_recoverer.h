#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "server/directory/admission.h"

namespace vat {

/// Recovery of the stored sessions on separate threads. Thread-safe.
class SessionRecoverer {
 public:
  /// Function that joins a recovered session for a client that waited for the recovery.
  using Join = std::function<std::optional<RpcError>(PendingReply&, const std::optional<SessionId>&,
                                                     JoinRequest)>;
  SessionRecoverer(ServerResources& resources, DirectoryTables& tables, const Admission& admission,
                   Join join);

  /// Starts the recovery of all stored sessions and returns their number.
  std::size_t start();
  /// Starts the recovery of a session that was stored after the start of the server.
  void start(const StoredSession& session);
  /// Waits for the end of the recoveries. Admission::stop() cancels recoveries.
  void join();

 private:
  /// `recovery` is the number of the recovery in the registry.
  void recover(const StoredSession& stored, std::uint64_t recovery);
  std::shared_ptr<Session> make_session(const StoredSession& stored);
  /// Ends a recovery. `session` is null if the recovery has failed.
  void finish(const StoredSession& stored, std::uint64_t recovery,
              std::shared_ptr<Session> session);

  ServerResources& resources_;
  DirectoryTables& tables_;
  const Admission& admission_;
  const Join join_;
  /// Adds the absent session and posts its recovery. The caller must hold the lock.
  void post(StoredSession session);
  // Null: no recovery was started. Guarded by the lock.
  std::unique_ptr<boost::asio::thread_pool> threads_;
};

}  // namespace vat
