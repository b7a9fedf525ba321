#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/access/access.h"
#include "server/clients/pending_reply.h"
#include "server/relay/relay_feed.h"

namespace vat {

/// Client of this node in a session of another node. The owner serves the client as its own, with
/// all messages except those of frames. Thread-safe.
class RelayedClient : public std::enable_shared_from_this<RelayedClient> {
 public:
  struct Place {
    std::string session;
    std::string owner;        ///< name of the node
    std::uint64_t epoch = 0;  ///< of the owner
    std::string own_url;      ///< URL of this node
    std::string subject;      ///< subject of the messages to this node's clients
  };
  /// Functions of the node. They must not wait for the client.
  struct Links {
    std::function<std::shared_ptr<RelayFeed>()> feed;  ///< of the session; its clients share it
    std::function<void()> note_move;  ///< called if the owner has the session no longer
  };
  /// Access of a client that joins by a relay.
  struct Entry {
    Grant access;
    bool is_open = false;  ///< this node requires no token
    /// Token that the client shows to the owner first; empty: none.
    std::string token;
    /// Called with the access that the owner grants for the token.
    std::function<void(const Grant&)> granted;
  };
  /// Starts a membership of the outbox.
  RelayedClient(Place place, std::unique_ptr<RelayLine> line, std::shared_ptr<ClientOutbox> outbox,
                Links links, const Clock& clock);
  ~RelayedClient();
  RelayedClient(const RelayedClient&) = delete;
  RelayedClient& operator=(const RelayedClient&) = delete;

  const Place& place() const { return place_; }
  /// Returns whether the membership has ended: by a call, a message of the owner, or a failure.
  bool has_left() const;
  /// Opens the link and joins the session. `params` are those of session.join. Call it once.
  void join(PendingReply reply, Entry entry, const Json& params);
  /// Sends a message of the client to the owner, whose reply the client receives. Returns false if
  /// the client has left.
  bool forward(std::string_view message, bool wants_reply);
  /// Leaves the session after the join is answered.
  void leave(PendingReply reply);
  /// Start or end the frames. They answer after the answer of join().
  void subscribe(PendingReply reply, const Subscription& wanted);
  void unsubscribe(PendingReply reply);
  /// Returns the tick of the last frame, or of the join.
  std::uint64_t tick() const;
  /// Leaves the session without an answer, as after the end of the client's connection. Later
  /// calls of this and of other functions have no effect on the outbox.
  void abandon();

  /// Takes a message of the owner.
  void receive(RelayMessage message);
  /// Ends the membership, because the owner cannot be reached. The client is told to join again.
  void fail();
  /// Fails if the owner is silent. Call it about once per second.
  void look();

 private:
  enum class State {
    joining,
    joined,
    closed,  ///< the session has ended, and replies to earlier requests follow
    left
  };
  /// Called when the client has joined (true), or if the join has failed.
  using Task = std::function<void(bool)>;
  void send(RelayKind kind, Json fields, std::string body);
  void receive_text(const std::string& text);
  void receive_event(std::string_view event, const std::string& text);
  void receive_end(const Json& fields);
  void start_epoch(std::uint32_t epoch);
  /// Answers a request of this object, if the message is its reply. Returns false otherwise.
  bool receive_reply(const std::string& text);
  void finish_enter(const Json& message);
  void finish_join(const Json& message);
  void fail_join(RpcError error);
  void when_joined(Task task);
  /// Ends the membership. Returns false if the link has ended before.
  bool end();
  void close();
  void count_reply();
  std::uint64_t tick_locked() const;

  const Place place_;
  const std::unique_ptr<RelayLine> line_;
  const std::shared_ptr<ClientOutbox> outbox_;
  const Links links_;
  const Clock& clock_;
  const std::uint64_t membership_;

  mutable OwnedMutex mutex_;  // guards the members below
  State state_ = State::joining;
  RelayInput received_;
  SteadyClock::time_point heard_;
  SteadyClock::time_point asked_;
  Entry entry_;
  bool is_entering_ = false;  // the owner has not answered the token
  std::optional<PendingReply> joining_;
  std::optional<PendingReply> leaving_;
  std::vector<Task> when_joined_;
  std::shared_ptr<RelayFeed> feed_;  // null: no subscription
  std::uint64_t joined_tick_ = 0;
  std::size_t replies_due_ = 0;            // to forwarded requests
  std::shared_ptr<RelayedClient> keeper_;  // this client, while it waits for replies
};

}  // namespace vat
