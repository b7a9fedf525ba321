#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/access/access.h"
#include "server/clients/client_outbox.h"
#include "server/frames/subscription.h"
#include "server/relay/relayed_connection.h"

namespace vat {

/// Serves the clients and viewers of other nodes, whose sessions this node owns. Thread-safe.
class RelayHost {
 public:
  /// The part of the server that has sessions and clients.
  struct Server {
    /// Receives the messages and the end of clients.
    ConnectionHandler& clients;
    /// Adds a client with the access that it has at its node, which may require no token
    /// (`is_open`). Returns false if the client is refused.
    std::function<bool(std::shared_ptr<Connection>, const Grant& access, bool is_open)> open;
    /// Sends the frames of a session to a viewer without a participant. The second call for a
    /// viewer changes the frames. Returns false if the session does not run here.
    std::function<bool(const std::shared_ptr<ClientOutbox>& viewer, const std::string& session,
                       const Subscription& wanted)>
        watch;
    std::function<void(const std::string& session, std::shared_ptr<ClientOutbox> viewer)> unwatch;
    const SendGate& gate;  ///< of the viewers
  };
  /// Listens from now on. The arguments must outlive the host.
  RelayHost(std::string node, NatsConnection& connection, Server server, const Clock& clock);
  ~RelayHost();
  RelayHost(const RelayHost&) = delete;
  RelayHost& operator=(const RelayHost&) = delete;

  /// Ends the links that are silent, and those of nodes for which `is_present` is false. Call it
  /// often.
  void look(std::function<bool(const std::string& node)> is_present);
  /// Listens no longer, and ends the thread. Later calls have no effect.
  void stop();

 private:
  struct Link {
    std::shared_ptr<RelayedConnection> connection;
    std::shared_ptr<RelayLine> line;
    RelayInput received;
    SteadyClock::time_point heard{};
    std::string session;                   ///< empty: a client
    std::shared_ptr<ClientOutbox> viewer;  ///< null: a client
  };
  using Links = std::map<std::string, Link>;

  // On the thread.
  void receive(const std::string& bytes);
  void open(const RelayMessage& message);
  void watch(const RelayMessage& message);
  void acknowledge(Link& link, const RelayMessage& message);
  /// Answers a message of a link that this process does not have.
  void refuse(const RelayMessage& message);
  Link& add(RelayMessage message);
  /// Removes the link and ends its client.
  void remove(Links::iterator link);
  void remove(const std::string& link);

  const std::string node_;
  NatsConnection& connection_;
  const Server server_;
  const Clock& clock_;
  boost::asio::thread_pool thread_{1};
  // Used by the thread only.
  Links links_;
  SteadyClock::time_point looked_{};
  ConnectionId last_id_;
  std::unique_ptr<NatsConnection::Subscription> subscription_;
};

}  // namespace vat
