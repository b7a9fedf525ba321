#pragma once

#include <optional>
#include <string_view>

#include "server/directory/admission.h"

namespace vat {

/// Access of connections by tokens. Safe to use from any thread.
class AccessControl {
 public:
  AccessControl(ServerResources& resources, DirectoryTables& tables, const Admission& admission);

  /// Grants a new connection its first access: without tokens all, otherwise none, and it is closed
  /// unless it enters in time. The caller must hold the directory's lock.
  void start(Client& client);
  /// Gives the client the access of the token. Answered at once, or later if the token is invalid.
  std::optional<RpcResult> enter(PendingReply& reply, std::string_view token);
  /// Returns a token that is valid once, for a short time. Only an admin may ask for one without a
  /// session, which is valid in all sessions.
  RpcResult issue_ticket(const PendingReply& reply, Role role,
                         const std::optional<SessionId>& session);

 private:
  std::optional<Grant> find_grant(std::string_view token);
  void close_unless_entered(ConnectionId id);

  ServerResources& resources_;
  DirectoryTables& tables_;
  const Admission& admission_;
};

}  // namespace vat
