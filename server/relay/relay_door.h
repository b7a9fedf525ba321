#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/relay/relayed_client.h"
#include "server/relay/relayed_request.h"

namespace vat {

/// Links of this node's clients to sessions of other nodes. Thread-safe.
class RelayDoor {
 public:
  struct Place {
    std::string node;      ///< name of this node
    std::string instance;  ///< unique for this run of the node
    std::string url;       ///< URL of this node
  };
  /// The owner of a session, as the directory shows it.
  struct Owner {
    std::string node;
    std::uint64_t epoch = 0;
  };
  /// The arguments must outlive the door and its clients.
  RelayDoor(Place place, NatsConnection& connection, ServerMetrics& metrics,
            boost::asio::thread_pool& pool, const Clock& clock);
  ~RelayDoor();
  RelayDoor(const RelayDoor&) = delete;
  RelayDoor& operator=(const RelayDoor&) = delete;

  /// Returns a client with a link to the owner of the session. The next call must be
  /// RelayedClient::join().
  std::shared_ptr<RelayedClient> open(std::shared_ptr<ClientOutbox> outbox,
                                      const std::string& session, const Owner& owner);
  /// Returns a request to the owner of the session. The next call must be RelayedRequest::send().
  std::shared_ptr<RelayedRequest> open_request(const std::string& session, const Owner& owner,
                                               RelayedRequest::NoteResult note_result);
  /// Returns whether the owner of this epoch has said that it has the session no longer.
  bool has_moved(const std::string& session, std::uint64_t epoch);
  /// Once per second, ends the links to silent or previous owners, opens other links for frames
  /// that have ended, and closes viewers who acknowledge no frame for `patience`. `owner_of`
  /// returns the owner of a session, or nothing if the session has been closed. Call it often.
  void look(const std::function<std::optional<Owner>(const std::string& session)>& owner_of,
            std::chrono::seconds patience);

  /// Returns the subject on which a node receives the messages of relays.
  static std::string owner_subject(const std::string& node);
  /// Returns the subject of the messages to the client with this link.
  static std::string client_subject(const std::string& link);

 private:
  struct Feed {
    std::weak_ptr<RelayFeed> feed;
    // Not a member of the feed, which its handler may destroy.
    std::unique_ptr<NatsConnection::Subscription> subscription;
  };
  void receive(const std::string& bytes);
  void note_move(const std::string& session, std::uint64_t epoch);
  std::shared_ptr<RelayFeed> feed(const std::string& session, const Owner& owner);
  std::string next_link();
  RelayPlace place_of(const std::string& link, const std::string& session,
                      const Owner& owner) const;
  std::unique_ptr<RelayLine> make_line(const std::string& link, const Owner& owner) const;
  std::vector<std::shared_ptr<RelayEnd>> all_ends();
  std::vector<std::shared_ptr<RelayFeed>> all_feeds();

  const Place place_;
  NatsConnection& connection_;
  ServerMetrics& metrics_;
  boost::asio::thread_pool& pool_;
  const Clock& clock_;

  OwnedMutex mutex_;  // guards the members below
  std::uint64_t links_opened_ = 0;
  std::map<std::string, std::weak_ptr<RelayEnd>> ends_;  // of clients, by link
  std::map<std::string, Feed> feeds_;                    // by session
  std::map<std::string, std::uint64_t> moved_;  // last ended epochs of sessions that have moved
  SteadyClock::time_point looked_{};
  std::unique_ptr<NatsConnection::Subscription> subscription_;
};

}  // namespace vat
