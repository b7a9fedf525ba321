#pragma once

#include <optional>
#include <string_view>

#include "server/directory/admission.h"

namespace vat {

/// Access control of connections by tokens. Thread-safe.
class AccessControl {
 public:
  AccessControl(ServerResources& resources, DirectoryTables& tables, const Admission& admission);

  /// Sets the initial access of a new connection. Without tokens, the connection gets all access.
  /// Otherwise, the connection has no access and is closed if it sends no token in time. The caller
  /// must hold the directory's lock.
  void start(Client& client);
  /// Grants the access of the token to the client. Answers after the use of the token is stored.
  /// The reply to an invalid token is delayed.
  std::optional<RpcResult> enter(PendingReply& reply, std::string_view token);
  /// Answers with a token that is valid once, for a short time. Only an admin may request a token
  /// without a session, which is valid in all sessions. Errors that are known immediately are
  /// returned instead.
  std::optional<RpcError> issue_ticket(PendingReply& reply, Role role,
                                       const std::optional<SessionId>& session);

 private:
  std::optional<AccessTokens::Use> use_token(const TokenHash& token);
  /// Restores the previous access of a client that has not joined a session.
  void withdraw(ConnectionId id, const Grant& before);
  void close_unless_entered(ConnectionId id);

  ServerResources& resources_;
  DirectoryTables& tables_;
  const Admission& admission_;
};

}  // namespace vat
