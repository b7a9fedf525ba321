#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/access/role.h"
#include "server/admission/message_meter.h"
#include "server/admission/resource_budget.h"
#include "server/limits.h"
#include "server/net/transport.h"
#include "server/session/frame_window.h"

namespace vat {

/// An encoded frame that many clients share.
using SharedFrame = std::shared_ptr<const std::string>;

/// Control messages that the socket has not taken yet, known from the sizes of all that was sent
/// and the bytes that are queued now. The bound of PROTOCOL.md: `max_bytes`, and beside it two
/// messages that are longer than that themselves (a description or a state of very many particles).
class ControlQueue {
 public:
  /// What a message that waits takes in memory beside its text, and counts for: its place here and
  /// in the transport, its header, its counts. Of a short one that is several times its text.
  static constexpr std::size_t kMessageCost = 512;

  explicit ControlQueue(std::size_t max_bytes) : max_bytes_(max_bytes) {}
  /// Notes a message that is sent; `queued` is what the socket had not taken just before.
  void sent(std::size_t bytes, bool control, std::size_t queued);
  bool over_limit() const;
  /// Whether some message that is not control waits, `queued` being what the socket has not taken.
  bool holds_frame(std::size_t queued);
  /// The client has got all frames, even if the transport has not said so yet.
  void frames_arrived();

 private:
  struct Entry {
    std::size_t bytes;
    bool control;
    bool has_arrived = false;
  };
  void take(std::size_t queued);
  void count(const Entry& entry, bool adds);

  const std::size_t max_bytes_;
  std::deque<Entry> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::size_t control_bytes_ = 0;
  std::size_t long_messages_ = 0;
};

/// The way of frames to a client at a moment.
struct FrameChannel {
  bool is_open = false;   ///< the subscription goes on
  bool is_ready = false;  ///< for a frame
  AckDelays delays;
};

/// Told that a client which was not ready for a frame may be so now.
class FrameWaker {
 public:
  virtual ~FrameWaker() = default;
  virtual void wake(ConnectionId client) = 0;
};

/// One client's side of the flow control in PROTOCOL.md: replies and events are reliable, frames
/// go out in a window of three. Safe to use from any thread.
///
/// What a session sends names the membership that the client's last join got, frames the
/// subscription and the epoch; after these have ended, it goes nowhere, however late it comes.
class ClientOutbox {
 public:
  explicit ClientOutbox(
      std::shared_ptr<Connection> connection,
      std::size_t max_control_queue_bytes = ServerLimits{}.max_control_queue_bytes);

  ConnectionId id() const { return connection_->id(); }
  const std::string& address() const { return connection_->address(); }
  /// Counts what the client sends; used by the transport's thread of the connection only. Null
  /// where nothing is counted.
  MessageMeter* meter() const { return meter_.get(); }
  void set_meter(std::unique_ptr<MessageMeter> meter) { meter_ = std::move(meter); }
  /// Ends the connection with a code of PROTOCOL.md; nothing is sent or read any more.
  void close(std::uint16_t code, std::string_view reason);
  bool is_closed();
  /// Sends, whatever the membership is: replies.
  void send(std::string text);

  /// Begins a membership and ends the one before. Frames that are in flight no longer count.
  std::uint64_t join();
  void leave();
  /// What the client may do in the session that it is in; none before it is taken in.
  void set_role(std::uint64_t membership, Role role);
  Role role();
  void send_event(std::uint64_t membership, const std::string& text);
  /// From now on frames are sent in this epoch only.
  void start_epoch(std::uint64_t membership, std::uint32_t epoch);
  /// Begins a subscription and ends the one before. 0 if the membership has ended.
  std::uint64_t subscribe(std::uint64_t membership, std::weak_ptr<FrameWaker> waker,
                          SteadyClock::time_point now);
  void unsubscribe();

  /// A frame may go out where fewer than three are not acknowledged, and the system has taken those
  /// that were sent. If not, the waker is called once that may have changed.
  FrameChannel frame_channel(std::uint64_t subscription);
  /// False where the subscription or the epoch has ended.
  bool send_frame(std::uint64_t subscription, std::uint32_t epoch, const SharedFrame& frame,
                  SteadyClock::time_point now);
  /// All frames up to this number; false if none so late was sent since the last join.
  bool acknowledge(std::uint32_t number, SteadyClock::time_point now);
  /// Closes the connection, told why, where a subscriber has acknowledged nothing for `patience`
  /// since a frame was sent.
  void close_if_silent(SteadyClock::time_point now, std::chrono::seconds patience);

  /// Counts a command in, unless the client would then have more than `max_commands` of them, or
  /// `max_bytes` of their messages, in flight: which limit that is.
  std::optional<ResourceExcess> begin_command(std::size_t bytes, std::size_t max_commands,
                                              std::size_t max_bytes);
  void end_command(std::size_t bytes);

 private:
  // All with the mutex held.
  void send_control(std::string text);
  void close_as_too_slow(std::string_view reason);

  const std::shared_ptr<Connection> connection_;
  std::unique_ptr<MessageMeter> meter_;
  std::mutex mutex_;
  ControlQueue queue_;
  bool closed_ = false;
  std::uint64_t membership_ = 0;  // even: in no session
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
