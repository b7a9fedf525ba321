#include "server/clients/client_outbox.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "core/support/check.h"
#include "protocol/frame/frame_codec.h"
#include "protocol/json/printable.h"
#include "server/messages/limits.h"

namespace vat {
namespace {

constexpr std::uint16_t kTooSlow = 4008;
constexpr std::uint16_t kNotOwner = 4012;
constexpr std::size_t kMaxReasonBytes = 123;  // RFC 6455, section 5.5

}  // namespace

void ControlQueue::sent(std::size_t own_bytes, const SharedText& shared, bool control,
                        std::size_t queued) {
  take(queued);
  const std::size_t bytes = own_bytes + (shared == nullptr ? 0 : shared->size());
  waiting_.push_back({bytes, own_bytes, shared, control});
  waiting_bytes_ += bytes;
  count(waiting_.back(), true);
}

bool ControlQueue::over_limit() const {
  return control_bytes_ > max_bytes_ || long_messages_ > kMaxLongMessages;
}

bool ControlQueue::holds_frame(std::size_t queued) {
  take(queued);
  return std::ranges::any_of(waiting_, [](const QueuedMessage& message) {
    return !message.control && !message.has_arrived;
  });
}

void ControlQueue::frames_arrived() {
  for (QueuedMessage& message : waiting_) message.has_arrived = !message.control;
}

std::size_t ControlQueue::add_to(QueueMemory& memory, std::size_t queued) {
  take(queued);
  std::size_t share = 0;
  for (const QueuedMessage& message : waiting_) {
    const std::size_t own = message.own_bytes + kMessageCost;
    share += own;
    memory.add(own);
    const auto owners = static_cast<std::size_t>(message.shared.use_count());
    if (const SharedText shared = message.shared.lock()) {
      share += shared->size() / std::max<std::size_t>(1, owners);
      memory.add_shared(*shared);
    }
  }
  return share;
}

// The socket takes messages in order, so the last ones still wait.
void ControlQueue::take(std::size_t queued) {
  while (!waiting_.empty() && waiting_bytes_ - waiting_.front().bytes >= queued) {
    waiting_bytes_ -= waiting_.front().bytes;
    count(waiting_.front(), false);
    waiting_.pop_front();
  }
}

void ControlQueue::count(const QueuedMessage& message, bool adds) {
  if (!message.control) return;
  const std::size_t cost = message.bytes + kMessageCost;
  const bool is_long = cost > max_bytes_;
  std::size_t& counter = is_long ? long_messages_ : control_bytes_;
  const std::size_t amount = is_long ? 1 : cost;
  VAT_CHECK(adds || counter >= amount);
  counter = adds ? counter + amount : counter - amount;
}

ClientOutbox::ClientOutbox(std::shared_ptr<Connection> connection,
                           std::size_t max_control_queue_bytes)
    : connection_(std::move(connection)), queue_(max_control_queue_bytes) {}

void ClientOutbox::close(std::uint16_t code, std::string_view reason) {
  const std::lock_guard lock(mutex_);
  close_locked(code, reason);
}

bool ClientOutbox::is_closed() {
  const std::lock_guard lock(mutex_);
  return closed_;
}

void ClientOutbox::send(std::string head, SharedText tail) {
  const std::lock_guard lock(mutex_);
  send_control(std::move(head), std::move(tail));
}

void ClientOutbox::report_rejected(std::string_view method, const RpcError& error) {
  const std::lock_guard lock(mutex_);
  ++rejected_;
  last_rejected_ = printable(method);
  if (!std::has_single_bit(rejected_)) return;
  const ErrorRow& row = error_row(error.kind);
  send_control(write_event("notification.rejected", {{"count", rejected_},
                                                     {"method", last_rejected_},
                                                     {"code", row.code},
                                                     {"kind", row.name},
                                                     {"message", error.message}}),
               nullptr);
}

std::uint64_t ClientOutbox::join() {
  const std::lock_guard lock(mutex_);
  membership_ += membership_ % 2 == 0 ? 1 : 2;
  role_ = Role::none;
  is_subscribed_ = false;
  window_.clear();
  return membership_;
}

void ClientOutbox::leave() {
  const std::lock_guard lock(mutex_);
  end_membership();
}

void ClientOutbox::leave(std::uint64_t membership) {
  const std::lock_guard lock(mutex_);
  if (membership == membership_) end_membership();
}

void ClientOutbox::end_membership() {
  VAT_CHECK(mutex_.is_held());
  membership_ += membership_ % 2;
  role_ = Role::none;
  is_subscribed_ = false;
}

void ClientOutbox::set_role(std::uint64_t membership, Role role) {
  const std::lock_guard lock(mutex_);
  if (membership == membership_) role_ = role;
}

Role ClientOutbox::role() {
  const std::lock_guard lock(mutex_);
  return role_;
}

void ClientOutbox::send_event(std::uint64_t membership, const SharedText& text) {
  const std::lock_guard lock(mutex_);
  if (membership == membership_) send_control({}, text);
}

void ClientOutbox::start_epoch(std::uint64_t membership, std::uint32_t epoch) {
  const std::lock_guard lock(mutex_);
  if (membership == membership_) epoch_ = epoch;
}

std::uint64_t ClientOutbox::subscribe(std::uint64_t membership, std::weak_ptr<FrameWaker> waker,
                                      SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (membership != membership_) return 0;
  waker_ = std::move(waker);
  is_subscribed_ = true;
  subscribed_at_ = now;
  return ++subscription_;
}

void ClientOutbox::unsubscribe() {
  const std::lock_guard lock(mutex_);
  is_subscribed_ = false;
}

FrameChannel ClientOutbox::frame_channel(std::uint64_t subscription) {
  const std::lock_guard lock(mutex_);
  if (closed_ || !is_subscribed_ || subscription != subscription_) return {};
  const bool is_ready =
      window_.in_flight() < kFrameWindow && !queue_.holds_frame(connection_->queued_bytes());
  wants_wake_ = !is_ready;
  return {true, is_ready, window_.delays()};
}

bool ClientOutbox::send_frame(std::uint64_t subscription, std::uint32_t epoch,
                              const SharedFrame& frame, SteadyClock::time_point now) {
  const std::lock_guard lock(mutex_);
  if (closed_ || !is_subscribed_ || subscription != subscription_ || epoch != epoch_) return false;
  VAT_CHECK(frame != nullptr && !frame->empty());
  if (is_gate_closed()) return true;  // a later frame follows, or the end of the session
  window_.sent(frame_number({reinterpret_cast<const std::uint8_t*>(frame->data()), frame->size()}),
               now);
  queue_.sent(0, frame, false, connection_->queued_bytes());
  connection_->send_binary(frame);
  return true;
}

bool ClientOutbox::acknowledge(std::uint32_t number, SteadyClock::time_point now,
                               bool is_rejected) {
  std::shared_ptr<FrameWaker> waker;
  bool was_sent = false;
  {
    const std::lock_guard lock(mutex_);
    const std::size_t before = window_.in_flight();
    was_sent = window_.acknowledge(number, now);
    if (before > 0 && window_.in_flight() == 0) queue_.frames_arrived();
    // Also after an acknowledgement of an earlier membership, whose frames may have filled the
    // window.
    is_rejected = is_rejected && was_sent;
    if ((std::exchange(wants_wake_, false) || is_rejected) && is_subscribed_) waker = waker_.lock();
  }
  if (waker == nullptr) return was_sent;
  if (is_rejected) waker->frame_rejected(id(), number);
  waker->wake(id());
  return was_sent;
}

void ClientOutbox::close_if_silent(SteadyClock::time_point now, std::chrono::seconds patience) {
  const std::lock_guard lock(mutex_);
  const auto waits_since = window_.waits_since();
  if (closed_ || !is_subscribed_ || !waits_since) return;
  if (now - std::max(*waits_since, subscribed_at_) < patience) return;
  close_as_too_slow("too slow: no frame was acknowledged for " + std::to_string(patience.count()) +
                    " s");
}

std::size_t ClientOutbox::add_queue(QueueMemory& memory) {
  const std::lock_guard lock(mutex_);
  if (closed_) return 0;
  return queue_.add_to(memory, connection_->queued_bytes());
}

void ClientOutbox::close_for_others() {
  const std::lock_guard lock(mutex_);
  close_as_too_slow("too slow: the queues of all clients are full");
}

std::optional<LimitExcess> ClientOutbox::begin_command(std::size_t bytes, std::size_t max_commands,
                                                       std::size_t max_bytes) {
  const std::lock_guard lock(mutex_);
  if (commands_ >= max_commands) return LimitExcess{"commands_in_flight", max_commands};
  if (command_bytes_ + bytes > max_bytes) {
    return LimitExcess{"command_bytes_in_flight", max_bytes};
  }
  ++commands_;
  command_bytes_ += bytes;
  return {};
}

void ClientOutbox::end_command(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  VAT_CHECK(commands_ > 0 && command_bytes_ >= bytes);
  --commands_;
  command_bytes_ -= bytes;
}

void ClientOutbox::send_control(std::string head, SharedText tail) {
  VAT_CHECK(mutex_.is_held());
  if (closed_) return;
  if (is_gate_closed()) return close_locked(kNotOwner, "the server may not serve the session now");
  queue_.sent(head.size(), tail, true, connection_->queued_bytes());
  if (queue_.over_limit()) {
    close_as_too_slow("too slow: the control queue is full");
    return;
  }
  connection_->send_text(std::move(head), std::move(tail));
}

bool ClientOutbox::is_gate_closed() const {
  return gate_ != nullptr && membership_ % 2 == 1 && !gate_->is_open();
}

void ClientOutbox::close_as_too_slow(std::string_view reason) {
  close_locked(kTooSlow, reason);
}

void ClientOutbox::close_locked(std::uint16_t code, std::string_view reason) {
  VAT_CHECK(mutex_.is_held());
  closed_ = true;
  std::string text(reason);
  // A misspelt acknowledgement is a frequent cause.
  if (code == kTooSlow && rejected_ > 0) {
    text += "; rejected notifications: " + std::to_string(rejected_) + ", last " + last_rejected_;
    text.resize(std::min(text.size(), kMaxReasonBytes));
  }
  connection_->close(code, text);
}

}  // namespace vat
