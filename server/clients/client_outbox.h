#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "server/access/role.h"
#include "server/clients/frame_window.h"
#include "server/clients/message_meter.h"
#include "server/clients/queue_memory.h"
#include "server/clients/read_budget.h"
#include "server/clients/send_gate.h"
#include "server/messages/limits.h"
#include "server/messages/rpc_message.h"
#include "server/support/limit_excess.h"
#include "server/support/owned_mutex.h"
#include "server/transport/transport.h"

namespace vat {

/// An encoded frame that several clients share.
using SharedFrame = std::shared_ptr<const std::string>;
/// The text of an event, or the end of a reply, that several clients share.
using SharedText = std::shared_ptr<const std::string>;

/// Messages that the socket has not accepted yet. The queue is computed from the sizes of all sent
/// messages and the number of currently queued bytes. The control messages may have at most
/// `max_bytes` in total. Up to kMaxLongMessages messages longer than `max_bytes`, such as large
/// descriptions, are not counted.
class ControlQueue {
 public:
  /// Memory of a waiting message in addition to its text: queue entries, header and counters.
  static constexpr std::size_t kMessageCost = 512;

  explicit ControlQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  /// Adds a sent message with `own_bytes` and a shared part, which may be null. `queued` is the
  /// number of bytes that the socket had not accepted before.
  void sent(std::size_t own_bytes, const SharedText& shared, bool control, std::size_t queued);
  bool over_limit() const;
  /// Returns whether a frame waits. `queued` is the number of bytes that the socket has not
  /// accepted.
  bool holds_frame(std::size_t queued);
  /// Marks all frames as received, even if the transport still counts their bytes.
  void frames_arrived();
  /// Adds the memory of the waiting messages. Returns the queue's share of this memory: the owners
  /// of a shared part share its bytes equally. `queued` as in holds_frame().
  std::size_t add_to(QueueMemory& memory, std::size_t queued);

 private:
  struct QueuedMessage {
    std::size_t bytes;
    std::size_t own_bytes;
    std::weak_ptr<const std::string> shared;
    bool control;
    bool has_arrived = false;
  };
  void take(std::size_t queued);
  void count(const QueuedMessage& message, bool adds);

  const std::size_t max_bytes_;
  std::deque<QueuedMessage> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::size_t control_bytes_ = 0;
  std::size_t long_messages_ = 0;
};

/// State of the frame transmission to a client.
struct FrameChannel {
  bool is_open = false;   ///< the subscription is active
  bool is_ready = false;  ///< a frame can be sent
  AckDelays delays;
};

/// Source of a client's frames.
class FrameWaker {
 public:
  virtual ~FrameWaker() = default;
  /// Called if the client was not ready for a frame and may have become ready.
  virtual void wake(ConnectionId client) = 0;
  /// Called if the client could not decode the frame with this number.
  virtual void frame_rejected(ConnectionId client, std::uint32_t number) = 0;
};

/// Flow control for one client (PROTOCOL.md, "Flow control"). Replies and events are reliable.
/// Frames are sent in a window of three. Thread-safe.
///
/// An event belongs to a membership, which begins with a join. A frame belongs to a subscription
/// and an epoch. Events and frames of an ended membership, subscription or epoch are dropped.
class ClientOutbox {
 public:
  explicit ClientOutbox(
      std::shared_ptr<Connection> connection,
      std::size_t max_control_queue_bytes = ServerLimits{}.max_control_queue_bytes);

  ConnectionId id() const { return connection_->id(); }
  const std::string& address() const { return connection_->address(); }
  /// Returns the meter of received messages, or null if messages are not counted. Only the
  /// connection's transport thread may use the meter.
  MessageMeter* meter() const { return meter_.get(); }
  void set_meter(std::unique_ptr<MessageMeter> meter) { meter_ = std::move(meter); }
  /// Returns the budget of the client's reads, or null if reads are not limited.
  ReadBudget* read_budget() const { return read_budget_.get(); }
  void set_read_budget(std::unique_ptr<ReadBudget> budget) { read_budget_ = std::move(budget); }
  /// Sets the gate, which must outlive the outbox. While the gate is closed, frames for a client in
  /// a session are dropped, and any other message closes the connection instead.
  void set_gate(const SendGate& gate) { gate_ = &gate; }
  /// Closes the connection with a code of PROTOCOL.md. No messages are sent or received afterwards.
  void close(std::uint16_t code, std::string_view reason);
  bool is_closed();
  /// Sends a reply, regardless of the membership. The text is `head` followed by `tail`, if any.
  void send(std::string head, SharedText tail = nullptr);
  /// Counts a rejected notification. Sends notification.rejected for the first one and whenever the
  /// number has doubled, so that a client cannot request many events.
  void report_rejected(std::string_view method, const RpcError& error);

  /// Starts a membership and ends the previous membership. Unacknowledged frames are no longer
  /// counted.
  std::uint64_t join();
  void leave();
  /// As leave(), unless another membership has started.
  void leave(std::uint64_t membership);
  /// Sets the role in the session. The role is Role::none until the session has admitted the
  /// client.
  void set_role(std::uint64_t membership, Role role);
  Role role();
  void send_event(std::uint64_t membership, const SharedText& text);
  /// Drops frames of other epochs from now on.
  void start_epoch(std::uint64_t membership, std::uint32_t epoch);
  /// Starts a subscription and ends the previous subscription. Returns 0 if the membership has
  /// ended.
  std::uint64_t subscribe(std::uint64_t membership, std::weak_ptr<FrameWaker> waker,
                          SteadyClock::time_point now);
  void unsubscribe();

  /// Returns the state of the frame transmission. A frame can be sent if fewer than three frames
  /// are unacknowledged and the socket has accepted all sent frames. If no frame can be sent, the
  /// waker is called once when sending may be possible.
  FrameChannel frame_channel(std::uint64_t subscription);
  /// Sends a frame. Returns false if the subscription or the epoch has ended.
  bool send_frame(std::uint64_t subscription, std::uint32_t epoch, const SharedFrame& frame,
                  SteadyClock::time_point now);
  /// Acknowledges all frames up to this number. If the client has rejected the frame, its source
  /// sends a key frame. Returns false if no frame with this number was sent since the last join.
  bool acknowledge(std::uint32_t number, SteadyClock::time_point now, bool is_rejected = false);
  /// Closes the connection if a subscriber has acknowledged no frame for `patience` after a frame
  /// was sent.
  void close_if_silent(SteadyClock::time_point now, std::chrono::seconds patience);

  /// Adds the memory of the waiting messages. Returns the client's share of it [bytes], as in
  /// ControlQueue::add_to(). A closed connection has no queue.
  std::size_t add_queue(QueueMemory& memory);
  /// Closes the connection because the queues of all clients are too long.
  void close_for_others();

  /// Counts a command as in flight. Returns the exceeded limit if more than `max_commands` commands
  /// or `max_bytes` of their messages would be in flight.
  std::optional<LimitExcess> begin_command(std::size_t bytes, std::size_t max_commands,
                                           std::size_t max_bytes);
  void end_command(std::size_t bytes);

 private:
  // The caller must hold the mutex for these functions.
  void end_membership();
  void send_control(std::string head, SharedText tail);
  bool is_gate_closed() const;
  void close_as_too_slow(std::string_view reason);
  /// `reason` is ASCII text.
  void close_locked(std::uint16_t code, std::string_view reason);

  const std::shared_ptr<Connection> connection_;
  std::unique_ptr<MessageMeter> meter_;
  std::unique_ptr<ReadBudget> read_budget_;
  const SendGate* gate_ = nullptr;  // null: always open
  OwnedMutex mutex_;
  ControlQueue queue_;
  bool closed_ = false;
  std::uint64_t rejected_ = 0;    // notifications
  std::string last_rejected_;     // method of the last rejected notification
  std::uint64_t membership_ = 0;  // odd: the client is in a session
  Role role_ = Role::none;
  std::uint32_t epoch_ = 0;
  std::size_t commands_ = 0;  // commands in flight
  std::size_t command_bytes_ = 0;
  std::uint64_t subscription_ = 0;
  bool is_subscribed_ = false;
  std::weak_ptr<FrameWaker> waker_;
  bool wants_wake_ = false;
  SteadyClock::time_point subscribed_at_{};
  FrameWindow window_;
};

}  // namespace vat
