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
    std::string owner;    ///< name of the node
    std::uint64_t epoch;  ///< of the owner
    std::string own_url;  ///< URL of this node
    std::string subject;  ///< subject of the messages to this node's clients
  };
  /// The node's other links.
  struct Links {
    std::function<std::shared_ptr<RelayFeed>()> feed;  ///< of the session; its clients share it
    std::function<void()> note_move;  ///< called if the owner has the session no longer
  };
  /// Starts a membership of the outbox.
  RelayedClient(Place place, std::unique_ptr<RelayLine> line, std::shared_ptr<ClientOutbox> outbox,
                Links links, const Clock& clock);
  ~RelayedClient();
  RelayedClient(const RelayedClient&) = delete;
  RelayedClient& operator=(const RelayedClient&) = delete;

  const std::string& session() const { return place_.session; }
  const std::string& owner() const { return place_.owner; }
  /// Returns whether the membership has ended: by a call, a message of the owner, or a failure.
  bool has_left() const;
  /// Opens the link and joins the session. `access` is that of the client. If `token` is not
  /// empty, the client shows it to the owner first. `params` are those of session.join.
  void join(PendingReply reply, const Grant& access, const std::string& token, const Json& params);
  /// Sends a message of the client to the owner, whose reply the client receives.
  void forward(std::string_view message, bool wants_reply);
  void leave(PendingReply reply);
  /// Answers after the answer of join().
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

 private:
  enum class State {
    joining,
    joined,
    closed,  ///< the session has ended, and replies to earlier requests follow
    left
  };
  void send(RelayKind kind, Json fields, std::string body);
  void receive_text(const std::string& text);
  void receive_event(std::string_view event, const std::string& text);
  /// Answers the join or the departure, if the message is its reply. Returns false otherwise.
  bool receive_reply(const std::string& text);
  void finish_join(const Json& message);
  /// Calls `task` when the client has joined, or drops it if the join fails.
  void when_joined(std::function<void()> task);
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
  std::optional<PendingReply> joining_;
  std::optional<PendingReply> leaving_;
  bool is_entering_ = false;               ///< the owner has not answered the token
  std::size_t replies_due_ = 0;            ///< to forwarded requests
  std::shared_ptr<RelayedClient> keeper_;  ///< this client, while it waits for replies
  std::vector<std::function<void()>> when_joined_;
  std::shared_ptr<RelayFeed> feed_;  // null: no subscription
  std::uint64_t joined_tick_ = 0;
};

}  // namespace vat
