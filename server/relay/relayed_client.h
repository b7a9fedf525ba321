#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/clients/pending_reply.h"
#include "server/relay/relay_end.h"
#include "server/relay/relay_feed.h"

namespace vat {

/// Client of this node in a session of another node. The owner serves the client as its own, with
/// all messages except those of frames. Thread-safe.
class RelayedClient final : public RelayEnd, public std::enable_shared_from_this<RelayedClient> {
 public:
  /// Functions of the node. They must not wait for the client.
  struct Links {
    std::function<std::shared_ptr<RelayFeed>()> feed;  ///< of the session; its clients share it
    std::function<void()> note_move;  ///< called if the owner has the session no longer
  };
  /// Called with the result of a forwarded request before the client receives it, and may change
  /// it.
  using NoteResult = std::function<void(Json& result)>;
  /// Starts a membership of the outbox.
  RelayedClient(RelayPlace place, std::unique_ptr<RelayLine> line,
                std::shared_ptr<ClientOutbox> outbox, Links links, const Clock& clock);
  ~RelayedClient() override;

  /// Returns whether the membership has ended: by a call, a message of the owner, or a failure.
  bool has_left() const;
  /// Opens the link and joins the session. `params` are those of session.join. Call it once.
  void join(PendingReply reply, RelayEntry entry, const Json& params);
  /// Sends a message of the client to the owner, whose reply the client receives. `id` is the id of
  /// a request, and `note_result` may be empty. Returns false if the client has left.
  bool forward(std::string_view message, const std::optional<Json>& id,
               NoteResult note_result = {});
  /// Shows a token to the owner, which gives the client the token's access.
  void enter(const std::string& token);
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

  void receive(RelayMessage message) override;
  /// Ends the membership, because the owner cannot be reached. The client is told to join again.
  void fail() override;
  void look() override;

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
  /// Notes the result of a forwarded request, if a function waits for it.
  bool note_result(Json& message);
  void finish_enter(const Json& message);
  void finish_join(const Json& message);
  void fail_join(RpcError error);
  void when_joined(Task task);
  /// Ends the membership. Returns false if the link has ended before.
  bool end();
  void close();
  void count_reply();
  std::uint64_t tick_locked() const;

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
  std::function<void(const Grant&)> granted_;  // of the entry
  std::size_t tokens_shown_ = 0;               // that the owner has not answered
  std::optional<PendingReply> joining_;
  std::optional<PendingReply> leaving_;
  std::vector<Task> when_joined_;
  std::shared_ptr<RelayFeed> feed_;  // null: no subscription
  std::uint64_t joined_tick_ = 0;
  std::size_t replies_due_ = 0;                     // to forwarded requests
  std::vector<std::pair<Json, NoteResult>> noted_;  // requests whose results are noted, by id
  std::shared_ptr<RelayedClient> keeper_;           // this client, while it waits for replies
};

}  // namespace vat
