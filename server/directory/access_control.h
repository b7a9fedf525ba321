#pragma once

#include <functional>
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
  /// The reply to an invalid token is delayed. In a cluster, only the owner of the token's session
  /// decides about a signed token. Another node answers at once, and grants no more than a
  /// redirection to the owner.
  std::optional<RpcResult> enter(PendingReply& reply, std::string_view token);
  /// Returns whether the client's token must be checked before the client joins a session. The
  /// caller must hold the directory's lock.
  bool must_check(const Client& client) const;
  /// Checks the client's token, grants its access, and then calls `then` without the directory's
  /// lock, which the caller must hold.
  void check_then(Client& client, std::function<void(std::optional<RpcError>)> then);
  /// Answers with a token that is valid once, for a short time. Only an admin may request a token
  /// without a session, which is valid in all sessions. Errors that are known immediately are
  /// returned instead.
  std::optional<RpcError> issue_ticket(PendingReply& reply, Role role,
                                       const std::optional<SessionId>& session);
  /// Answers with a new session. If another node relays the client, the result contains a ticket
  /// for the owner of the session, because the client joins by another link.
  void answer_created(PendingReply& reply, RpcResult result);

 private:
  std::optional<AccessTokens::Use> use_token(std::string_view token, const TokenHash& hash);
  /// Returns the content of a valid signed token that must be checked later.
  std::optional<TokenClaims> claims_to_check(std::string_view token) const;
  std::optional<RpcResult> enter_unchecked(PendingReply& reply, Client& client,
                                           UncheckedToken token);
  void finish_check(ConnectionId id, const AccessTokens::SharedUse& use);
  /// Counts a wrong token, and answers after a delay.
  void refuse_token(Client& client, PendingReply reply);
  void limit_enter_time(ConnectionId id);
  /// Restores the previous access of a client that has not joined a session.
  void withdraw(ConnectionId id, const Grant& before);
  void close_unless_entered(ConnectionId id);

  ServerResources& resources_;
  DirectoryTables& tables_;
  const Admission& admission_;
};

}  // namespace vat
