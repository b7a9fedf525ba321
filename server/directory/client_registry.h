#pragma once

#include <cstddef>
#include <map>
#include <memory>

#include "server/clients/pending_reply.h"
#include "server/directory/server_settings.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// A connection, and the session that it has joined.
struct Client {
  std::shared_ptr<ClientOutbox> outbox;
  SessionNumber session = 0;  ///< 0: none
  Grant access;
  std::size_t wrong_tokens = 0;
};

/// The connections of a server. The caller must hold the directory's lock.
class ClientRegistry {
 public:
  explicit ClientRegistry(const OwnedMutex& mutex) : mutex_(mutex) {}

  /// The connection must be new.
  Client& add(std::shared_ptr<ClientOutbox> outbox);
  /// Returns null if the connection has ended.
  Client* find(ConnectionId id);
  const Client* find(ConnectionId id) const;
  /// Returns the client that the reply is for, or null.
  const Client* find(const PendingReply& reply) const { return find(reply.client()->id()); }
  Client* find(const PendingReply& reply) { return find(reply.client()->id()); }
  void remove(ConnectionId id);
  std::size_t size() const;
  /// Number of clients that have joined the session.
  std::size_t count_in(SessionNumber session) const;
  const std::map<ConnectionId, Client>& all() const;
  /// Ends the membership of all clients of the session, and sends them `event`.
  void close_session(SessionNumber session, const std::string& event);

 private:
  const OwnedMutex& mutex_;
  std::map<ConnectionId, Client> clients_;
};

}  // namespace vat
