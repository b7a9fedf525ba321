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
#include "server/messages/limits.h"
#include "server/support/limit_excess.h"
#include "server/support/owned_mutex.h"
#include "server/transport/transport.h"

namespace vat {

/// An encoded frame, shared by several clients.
using SharedFrame = std::shared_ptr<const std::string>;

/// Messages that the socket has not taken yet. The queue is derived from the sizes of all sent
/// messages and the number of currently queued bytes. Control messages are limited to `max_bytes`
/// in total. Up to kMaxLongMessages messages that are each longer than `max_bytes`, such as large
/// descriptions, are not counted.
class ControlQueue {
 public:
  /// Memory of a waiting message in addition to its text: its entries here and in the transport,
  /// its header, its counters.
  static constexpr std::size_t kMessageCost = 512;

  explicit ControlQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  /// Notes that a message is sent. `queued`: bytes that the socket had not taken just before.
  void sent(std::size_t bytes, bool control, std::size_t queued);
  bool over_limit() const;
  /// Whether a frame waits. `queued`: bytes that the socket has not taken.
  bool holds_frame(std::size_t queued);
  /// The client has received all frames, even if the transport still counts them.
  void frames_arrived();

 private:
  struct QueuedMessage {
    std::size_t bytes;
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

/// State of the frames to a client.
struct FrameChannel {
  bool is_open = false;   ///< the subscription has not ended
  bool is_ready = false;  ///< a frame can be sent
  AckDelays delays;
};

/// Receives a call if a client that was not ready for a frame may have become ready.
class FrameWaker {
 public:
  virtual ~FrameWaker() = default;
  virtual void wake(ConnectionId client) = 0;
};

/// Flow control for one client, see PROTOCOL.md: replies and events are reliable; frames are sent
/// in a window of three. Safe to use from any thread.
///
/// Events belong to a membership, which starts with a join. Frames belong to a subscription and an
/// epoch. Events and frames are dropped if their membership, subscription or epoch has ended.
class ClientOutbox {
 public:
  explicit ClientOutbox(
      std::shared_ptr<Connection> connection,
      std::size_t max_control_queue_bytes = ServerLimits{}.max_control_queue_bytes);

  ConnectionId id() const { return connection_->id(); }
  const std::string& address() const { return connection_->address(); }
  /// Counts received messages. Used only by the connection's transport thread. Null if messages are
  /// not counted.
  MessageMeter* meter() const { return meter_.get(); }
  void set_meter(std::unique_ptr<MessageMeter> meter) { meter_ = std::move(meter); }
  /// Closes the connection with a code of PROTOCOL.md. Nothing is sent or received afterwards.
  void close(std::uint16_t code, std::string_view reason);
  bool is_closed();
  /// Sends a reply, in any membership.
  void send(std::string text);

  /// Starts a membership and ends the one before. Frames in flight no longer count.
  std::uint64_t join();
  void leave();
  /// Role in the session; Role::none until the session has admitted the client.
  void set_role(std::uint64_t membership, Role role);
  Role role();
  void send_event(std::uint64_t membership, const std::string& text);
  /// Drops frames of other epochs from now on.
  void start_epoch(std::uint64_t membership, std::uint32_t epoch);
  /// Starts a subscription and ends the one before. Returns 0 if the membership has ended.
  std::uint64_t subscribe(std::uint64_t membership, std::weak_ptr<FrameWaker> waker,
                          SteadyClock::time_point now);
  void unsubscribe();

  /// A frame can be sent while fewer than three are unacknowledged and the system has taken all
  /// sent ones. If no frame can be sent, the waker is called a single time when sending may have
  /// become possible.
  FrameChannel frame_channel(std::uint64_t subscription);
  /// Returns false if the subscription or the epoch has ended.
  bool send_frame(std::uint64_t subscription, std::uint32_t epoch, const SharedFrame& frame,
                  SteadyClock::time_point now);
  /// Acknowledges all frames up to this number. Returns false if no such frame was sent since the
  /// last join.
  bool acknowledge(std::uint32_t number, SteadyClock::time_point now);
  /// Closes the connection with a reason if a subscriber has acknowledged nothing for `patience`
  /// after a frame was sent.
  void close_if_silent(SteadyClock::time_point now, std::chrono::seconds patience);

  /// Counts a command as in flight. Returns the limit if more than `max_commands`, or `max_bytes`
  /// of their messages, would be in flight.
  std::optional<LimitExcess> begin_command(std::size_t bytes, std::size_t max_commands,
                                           std::size_t max_bytes);
  void end_command(std::size_t bytes);

 private:
  // The caller must hold the mutex.
  void send_control(std::string text);
  void close_as_too_slow(std::string_view reason);

  const std::shared_ptr<Connection> connection_;
  std::unique_ptr<MessageMeter> meter_;
  OwnedMutex mutex_;
  ControlQueue queue_;
  bool closed_ = false;
  std::uint64_t membership_ = 0;  // odd: in a session
  Role role_ = Role::none;
  std::uint32_t epoch_ = 0;
  std::size_t commands_ = 0;  // in flight
  std::size_t command_bytes_ = 0;
  std::uint64_t subscription_ = 0;
  bool is_subscribed_ = false;
  std::weak_ptr<FrameWaker> waker_;
  bool wants_wake_ = false;
  SteadyClock::time_point subscribed_at_{};
  FrameWindow window_;
};

}  // namespace vat
