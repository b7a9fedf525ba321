#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/frames/frame_delivery.h"

namespace vat {

/// Queue from a session to its FrameDelivery, which runs on a strand of the frame threads. The
/// frame threads have a low priority, so that encoding does not delay ticks. While the strand is
/// busy, a newer state replaces the waiting state. Thread-safe.
class FrameFeed final : public FrameWaker, public std::enable_shared_from_this<FrameFeed> {
 public:
  /// `metrics` and `clock` must outlive the threads of `pool`.
  FrameFeed(std::string session, const std::optional<Vat>& vat, ServerMetrics& metrics,
            boost::asio::thread_pool& pool, const Clock& clock);

  /// Adds or replaces a subscription. The change applies to all later published states. Returns
  /// true if a waiting state was dropped. Such a state may lack attributes of the new subscription.
  /// The caller should then publish a state soon.
  bool add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription, Subscription wish);
  void remove(ConnectionId client);
  void set_vat(const std::optional<Vat>& vat);
  /// See FrameDelivery::set_default_error().
  void set_default_error(double max_error);

  /// Queues the state for delivery. Exchanges `state` for an older state, so that publishing does
  /// not allocate.
  void publish(PublishedState& state);
  void wake(ConnectionId client) override;
  /// See FrameDelivery::restart(). The caller must also call wake().
  void frame_rejected(ConnectionId client, std::uint32_t number) override;
  /// Runs `task` after all earlier calls have taken effect.
  void post(std::function<void()> task);

 private:
  struct Added {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription;
    Subscription wish;
  };
  struct DefaultError {
    double max_error;
  };
  struct Rejected {
    ConnectionId client;
    std::uint32_t number;
  };
  using Change = std::variant<Added, ConnectionId, std::optional<Vat>, DefaultError, Rejected>;
  struct PendingChanges {
    std::vector<Change> changes;
    PublishedState state;
    bool has_state = false;  // if false, `state` is only reusable memory
    std::vector<ConnectionId> woken;
    bool serves_rest = false;  // see FrameDelivery::serve_rest()
  };
  template <class Put>
  void put(Put&& put);
  void turn();
  void apply_pending_changes();
  void send_frames();

  const std::string session_;
  const Clock& clock_;
  boost::asio::strand<boost::asio::thread_pool::executor_type> strand_;

  std::mutex mutex_;
  PendingChanges pending_;
  bool turn_scheduled_ = false;

  // Members that only the strand uses.
  PendingChanges active_changes_;  // empty between turns; the memory is reused
  FrameDelivery delivery_;
};

}  // namespace vat
