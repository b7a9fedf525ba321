#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/relay/relayed_client.h"

namespace vat {

/// Links of this node's clients to sessions of other nodes. Thread-safe.
class RelayDoor {
 public:
  struct Place {
    std::string node;      ///< name of this node
    std::string instance;  ///< unique for this run of the node
    std::string url;       ///< URL of this node
  };
  /// The arguments must outlive the door and its clients.
  RelayDoor(Place place, NatsConnection& connection, ServerMetrics& metrics,
            boost::asio::thread_pool& pool, const Clock& clock);

  /// Returns a client with a link to the node `owner` of the session. The next call must be
  /// RelayedClient::join().
  std::shared_ptr<RelayedClient> open(std::shared_ptr<ClientOutbox> outbox,
                                      const std::string& session, const std::string& owner,
                                      std::uint64_t epoch);
  /// Returns whether the owner of this epoch has said that it has the session no longer.
  bool has_moved(const std::string& session, std::uint64_t epoch);
  /// Ends the links to all nodes for which `is_present` is false.
  void end_silent(const std::function<bool(const std::string&)>& is_present);

  /// Returns the subject on which a node receives the messages of relays.
  static std::string owner_subject(const std::string& node);

 private:
  void receive(const std::string& bytes);
  void note_move(const std::string& session, std::uint64_t epoch);
  std::shared_ptr<RelayFeed> feed(const std::string& session, const std::string& owner);
  std::string next_link();

  const Place place_;
  NatsConnection& connection_;
  ServerMetrics& metrics_;
  boost::asio::thread_pool& pool_;
  const Clock& clock_;
  const std::string subject_;

  OwnedMutex mutex_;  // guards the members below
  std::uint64_t links_opened_ = 0;
  std::map<std::string, std::weak_ptr<RelayedClient>> clients_;  // by link
  std::map<std::string, std::weak_ptr<RelayFeed>> feeds_;        // by session
  std::map<std::string, std::uint64_t> moved_;  // last ended epochs of sessions that have moved
  std::unique_ptr<NatsConnection::Subscription> subscription_;
};

}  // namespace vat
