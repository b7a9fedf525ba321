#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "server/directory/admission.h"

namespace vat {

/// Recovers the stored sessions on own threads. Safe to use from any thread.
class SessionRecoverer {
 public:
  /// Joins a recovered session for a client that has waited for it.
  using Join = std::function<std::optional<RpcError>(PendingReply&, const std::optional<SessionId>&,
                                                     JoinRequest)>;
  SessionRecoverer(ServerResources& resources, DirectoryTables& tables, const Admission& admission,
                   Join join);

  /// Starts to recover all stored sessions, and returns their number.
  std::size_t start();
  /// Waits for the recoveries, which Admission::stop() cancels.
  void join();

 private:
  void recover(const StoredSession& stored);
  std::shared_ptr<Session> make_session(const StoredSession& stored);
  /// `session` is null if the recovery has failed.
  void finish(const StoredSession& stored, std::shared_ptr<Session> session);

  ServerResources& resources_;
  DirectoryTables& tables_;
  const Admission& admission_;
  const Join join_;
  std::unique_ptr<boost::asio::thread_pool> threads_;  // null: nothing is recovered
};

}  // namespace vat
