#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "server/clients/pending_reply.h"
#include "server/directory/server_settings.h"
#include "server/relay/relayed_client.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Signed token of a connection, whose validity is not known yet: the owner of its session decides.
/// The connection may only be redirected or relayed to the owner.
struct UncheckedToken {
  std::string token;
  TokenHash hash{};
  TokenClaims claims;
  Grant before;  ///< access of the connection before this token
};

/// Connection, and the session that the connection has joined.
struct Client {
  std::shared_ptr<ClientOutbox> outbox;
  SessionNumber session = 0;  ///< 0: no session
  Grant access;
  std::optional<UncheckedToken> unchecked;
  /// Requests that wait for the check of the token; not empty: the check runs.
  std::vector<std::function<void(std::optional<RpcError>)>> checks;
  std::size_t wrong_tokens = 0;
  std::shared_ptr<RelayedClient> relay;  ///< null, or the session is on another node
  bool is_relayed = false;               ///< another node relays the client
  /// Tickets of the sessions on other nodes that the client has created, until they are used.
  std::map<SessionId, std::string> tickets;
  std::map<SessionId, Grant> relay_access;  ///< access that owners granted for tickets
};

/// Connections of a server. The caller must hold the directory's lock.
class ClientRegistry {
 public:
  explicit ClientRegistry(const OwnedMutex& mutex) : mutex_(mutex) {}

  /// Adds a client. The connection must be new.
  Client& add(std::shared_ptr<ClientOutbox> outbox);
  /// Returns the client, or null if the connection has ended.
  Client* find(ConnectionId id);
  const Client* find(ConnectionId id) const;
  /// Returns the client to which the reply belongs, or null.
  const Client* find(const PendingReply& reply) const { return find(reply.client()->id()); }
  Client* find(const PendingReply& reply) { return find(reply.client()->id()); }
  void remove(ConnectionId id);
  std::size_t size() const;
  /// Returns the number of clients that have joined the session.
  std::size_t count_in(SessionNumber session) const;
  const std::map<ConnectionId, Client>& all() const;
  /// Returns the memory of the messages that wait for the clients [bytes].
  std::size_t queue_bytes() const;
  /// If the queues of all clients have more than `maximum` bytes, closes the clients with the
  /// greatest shares. Returns their number.
  std::size_t bound_queues(std::size_t maximum) const;
  /// Ends the membership of all clients of the session, and sends `event` to them, or
  /// `relayed_event` to the clients of other nodes.
  void close_session(SessionNumber session, const std::string& event,
                     const std::string& relayed_event);

 private:
  const OwnedMutex& mutex_;
  std::map<ConnectionId, Client> clients_;
};

}  // namespace vat
